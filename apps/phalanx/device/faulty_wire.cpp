// SPDX-License-Identifier: Apache-2.0
#include "device/faulty_wire.h"

#include <algorithm>

namespace phalanx {
namespace {

constexpr double kLargestNoise = 64.0;  ///< [bytes]
constexpr int kPacketsPerCall = 64;     ///< limit, so that a flood does not delay the controller's tick

}  // namespace

bool FaultyLine::happens(double probability) noexcept {
  return probability > 0.0 && random_.uniform() < probability;
}

void FaultyLine::put(double t, const PacketFaults& faults, std::span<const std::uint8_t> frame,
                     Peer peer) noexcept {
  if (faults.silence || happens(faults.drop)) return;
  put_one(t, faults, frame, peer);
  if (happens(faults.duplicate)) put_one(t, faults, frame, peer);
}

void FaultyLine::put_one(double t, const PacketFaults& faults, std::span<const std::uint8_t> frame,
                         Peer peer) noexcept {
  const auto free =
      std::find_if(place_.begin(), place_.end(), [](const Packet& packet) { return !packet.used; });
  if (free == place_.end() || frame.empty() || frame.size() > free->bytes.size()) return;
  const bool held = happens(faults.reorder);
  free->due = t + faults.delay + (faults.jitter > 0.0 ? faults.jitter * random_.uniform() : 0.0);
  free->order = ++order_;
  free->peer = peer;
  free->size = frame.size();
  std::copy(frame.begin(), frame.end(), free->bytes.begin());
  if (happens(faults.corrupt)) {
    const auto bit = static_cast<std::size_t>(random_.uniform() * 8.0 * static_cast<double>(frame.size()));
    free->bytes[bit / 8] = static_cast<std::uint8_t>(free->bytes[bit / 8] ^ (1U << (bit % 8)));
  }
  free->used = true;
  ++waiting_;
  release_held(free->due);
  free->held = held;
}

/// Releases held packets right after the packet that has just been put.
void FaultyLine::release_held(double due) noexcept {
  for (Packet& packet : place_) {
    if (!packet.used || !packet.held) continue;
    packet.held = false;
    packet.due = std::max(packet.due, due);
    packet.order = ++order_;
  }
}

std::size_t FaultyLine::take(double t, std::span<std::uint8_t> out, Peer& peer) noexcept {
  if (waiting_ == 0) return 0;
  Packet* first = nullptr;
  for (Packet& packet : place_) {
    if (!packet.used || packet.held || packet.due > t) continue;
    const bool earlier = first == nullptr || packet.due < first->due ||
                         (packet.due == first->due && packet.order < first->order);
    if (earlier) first = &packet;
  }
  if (first == nullptr) return 0;
  first->used = false;
  --waiting_;
  peer = first->peer;
  const std::size_t size = std::min(first->size, out.size());
  std::copy_n(first->bytes.begin(), size, out.begin());
  return size;
}

void FaultyLine::clear() noexcept {
  for (Packet& packet : place_) packet.used = packet.held = false;
  waiting_ = 0;
}

std::size_t FaultyLine::noise(std::span<std::uint8_t> out) noexcept {
  const auto size =
      std::min(out.size(), 1 + static_cast<std::size_t>(random_.uniform() * (kLargestNoise - 1.0)));
  for (std::uint8_t& byte : out.first(size)) byte = static_cast<std::uint8_t>(random_.uniform() * 256.0);
  return size;
}

FaultyWire::FaultyWire(Transport& transport, std::uint64_t seed)
    : transport_(transport),
      to_controller_(seed ^ 0x5eedfa0100000000ULL),
      to_host_(seed ^ 0x5eedfa0200000000ULL) {}

std::size_t FaultyWire::receive(double t, const PacketFaults& faults, std::span<std::uint8_t> out,
                                Peer& from) noexcept {
  for (int i = 0; i < kPacketsPerCall; ++i) {
    const std::size_t size = transport_.receive(buffer_, from);
    if (size == 0) break;
    to_controller_.put(t, faults, std::span(buffer_).first(size), from);
  }
  if (faults.silence) to_controller_.clear();
  return to_controller_.take(t, out, from);
}

void FaultyWire::send(double t, const PacketFaults& faults, std::span<const std::uint8_t> frame,
                      Peer to) noexcept {
  to_host_.put(t, faults, frame, to);
}

void FaultyWire::flush(double t, const PacketFaults& faults, std::optional<Peer> host) noexcept {
  if (faults.silence) to_host_.clear();
  Peer to = 0;
  while (const std::size_t size = to_host_.take(t, buffer_, to))
    transport_.send(std::span(buffer_).first(size), to);
  if (!faults.noise_bytes) return;
  to_controller_.put(t, {}, std::span(buffer_).first(to_controller_.noise(buffer_)), host.value_or(0));
  if (host) transport_.send(std::span(buffer_).first(to_host_.noise(buffer_)), *host);
}

void FaultyWire::clear() noexcept {
  to_controller_.clear();
  to_host_.clear();
}

}  // namespace phalanx

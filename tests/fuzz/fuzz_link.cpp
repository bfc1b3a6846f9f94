// SPDX-License-Identifier: Apache-2.0
// Whatever bytes come over the wire, and in whatever order frames, ticks and sensors meet the controller: the
// torques stay finite and within limit and rate. The first byte chooses how the rest is read.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <vector>

#include "phalanx/device/link/phalanx_link.h"

namespace {

using Bytes = std::span<const std::uint8_t>;
constexpr float kLimit = 0.5F;
constexpr float kRate = 10.0F;

void demand(bool holds) {
  if (!holds) std::abort();
}

/// Takes bytes off the front; zeros once there are none.
class Reader {
 public:
  explicit Reader(Bytes bytes) : bytes_(bytes) {}
  [[nodiscard]] bool empty() const { return bytes_.empty(); }
  std::uint8_t byte() {
    if (bytes_.empty()) return 0;
    const std::uint8_t first = bytes_.front();
    bytes_ = bytes_.subspan(1);
    return first;
  }
  std::uint32_t word() {
    std::uint32_t value = 0;
    for (int i = 0; i < 4; ++i) value = (value << 8) | byte();
    return value;
  }
  Bytes take(std::size_t count) {
    const Bytes front = bytes_.first(std::min(count, bytes_.size()));
    bytes_ = bytes_.subspan(front.size());
    return front;
  }

 private:
  Bytes bytes_;
};

std::uint32_t crc_of(Bytes bytes) {
  std::uint32_t crc = 0xFFFFFFFFU;
  for (const std::uint8_t byte : bytes) {
    crc ^= byte;
    for (int bit = 0; bit < 8; ++bit) crc = (crc & 1U) != 0 ? (crc >> 1) ^ 0xEDB88320U : crc >> 1;
  }
  return ~crc;
}

void put(std::vector<std::uint8_t>& frame, std::uint64_t value, int size) {
  for (int i = 0; i < size; ++i) frame.push_back(static_cast<std::uint8_t>((value >> (8 * i)) & 0xFFU));
}

/// What is whole is written back to the same bytes, but for what a welcome carries behind its channels.
void decode(Bytes bytes) {
  phx_message message;
  const std::vector<std::uint8_t> exact(bytes.begin(), bytes.end());
  if (phx_decode(exact.data(), exact.size(), &message) != PHX_OK) return;
  std::vector<std::uint8_t> again(exact.size());
  demand(phx_encode(&message, again.data(), again.size()) == exact.size());
  demand(message.header.type == PHX_WELCOME || again == exact);
}

/// A stream, and the same bytes stuffed and taken back.
void receive(Bytes bytes) {
  phx_receiver receiver;
  phx_receiver_init(&receiver);
  for (const std::uint8_t byte : bytes) {
    const std::size_t size = phx_receiver_take(&receiver, byte);
    demand(size <= PHX_FRAME_MAX);
    if (size != 0) decode({receiver.frame, size});
  }
  const Bytes frame = bytes.first(std::min<std::size_t>(bytes.size(), PHX_FRAME_MAX));
  std::vector<std::uint8_t> stuffed(PHX_COBS_MAX);
  stuffed.resize(phx_cobs_encode(frame.data(), frame.size(), stuffed.data(), stuffed.size()));
  phx_receiver_init(&receiver);
  std::size_t size = 0;
  for (const std::uint8_t byte : stuffed) size = phx_receiver_take(&receiver, byte);
  demand(size == frame.size() && std::equal(frame.begin(), frame.end(), receiver.frame));
}

class Bench {
 public:
  /// Without the ramp a step acts in full at once, which a second of ticks would cost otherwise.
  explicit Bench(bool start_ramp) : start_ramp_(start_ramp) {
    phx_device device{};
    device.rate_hz = 1000;
    device.channel_count = 4;
    for (std::uint8_t i = 0; i < 4; ++i)
      device.channel[i] = {PHX_CHANNEL_ANGLE, static_cast<std::uint8_t>(4 + i), -2000, 2000, 1e-3F, 0.0F};
    device.torque_limit = kLimit;
    device.torque_rate = kRate;
    phx_controller_init(&controller_, &device, 1);
  }

  /// One input costs at most so much time.
  [[nodiscard]] bool tired() const { return ticks_ > 2000; }

  void act(Reader& input) {
    switch (input.byte() % 8) {
      case 0:
        sensors(input);
        break;
      case 1:
        raw_frame(input.take(input.byte()));
        break;
      case 2:
      case 3:
      case 4:
        frame(input);
        break;
      default:
        ticks(1U + input.byte() % 32U, input.byte());
        break;
    }
  }

 private:
  void sensors(Reader& input) {
    estop_ = input.byte() % 4 == 1;
    drive_fault_ = input.byte() % 4 == 1;
    for (std::size_t i = 0; i < 4; ++i) raw_[i] = static_cast<std::int32_t>(input.word());
  }

  void raw_frame(Bytes bytes) {
    const std::vector<std::uint8_t> exact(bytes.begin(), bytes.end());
    std::uint8_t reply[PHX_FRAME_MAX];
    std::size_t size = 0;
    phx_controller_receive(&controller_, exact.data(), exact.size(), now_, reply, &size);
    demand(size <= PHX_FRAME_MAX);
    if (!start_ramp_) controller_.started_us = 0;
    if (size != 0) decode({reply, size});
  }

  /// A frame of a right size and CRC, mostly of the right epoch and with a tick and a time that can be taken;
  /// the other fields are the input's.
  void frame(Reader& input) {
    const std::uint8_t type = input.byte() % 13;
    const std::uint8_t choice = input.byte();
    const std::size_t size = std::max<std::size_t>(phx_frame_size(type), PHX_HEADER_SIZE + PHX_CRC_SIZE);
    std::vector<std::uint8_t> frame{'P', 'X', static_cast<std::uint8_t>(choice == 255 ? 2 : 1), type};
    put(frame, size, 2);
    put(frame, 0, 2);
    put(frame, choice % 16 == 15 ? input.word() : controller_.epoch, 4);
    put(frame, ++sequence_, 4);
    if ((type == PHX_COMMAND || type == PHX_COMMAND_WALLS) && choice % 8 != 7) {
      put(frame, ++tick_, 8);
      put(frame, now_ - choice % 4 * 1000U, 8);
      frame.push_back(choice % 32 == 6 ? 0 : PHX_COMMAND_ENABLE);
    }
    const Bytes rest = input.take(size - PHX_CRC_SIZE - frame.size());
    frame.insert(frame.end(), rest.begin(), rest.end());
    frame.resize(size - PHX_CRC_SIZE);
    put(frame, crc_of(frame), 4);
    raw_frame(frame);
  }

  void ticks(unsigned count, std::uint8_t how) {
    ticks_ += count;
    for (unsigned i = 0; i < count; ++i) {
      const std::uint64_t after = how % 16 == 15 ? how * 100U : 1000U;
      if (how == 0) {
        now_ -= std::min<std::uint64_t>(now_, 5000);
      } else {
        now_ += after;
      }
      phx_controller_tick(&controller_, now_, raw_, estop_, drive_fault_, &output_);
      judge();
    }
  }

  // Towards zero the torque may jump (fade, latch), away from it only at the rate, of two periods at most.
  void judge() {
    const float most = kRate * 2e-3F + 1e-5F;
    for (std::size_t i = 0; i < PHX_JOINTS; ++i) {
      const float torque = output_.torque[i];
      demand(std::isfinite(torque) && std::fabs(torque) <= kLimit);
      demand(torque <= std::max(last_[i], 0.0F) + most && torque >= std::min(last_[i], 0.0F) - most);
      demand(torque == 0.0F || (controller_.session && controller_.configured && controller_.fault == 0));
      last_[i] = torque;
    }
    demand(controller_.factor >= 0.0F && controller_.factor <= 1.0F);
    demand((output_.sample_size != 0) == controller_.session);
    if (output_.sample_size == 0) return;
    phx_message message;
    demand(phx_decode(output_.sample, output_.sample_size, &message) == PHX_OK);
  }

  bool start_ramp_;
  phx_controller controller_{};
  phx_output output_{};
  std::int32_t raw_[PHX_CHANNELS]{};
  float last_[PHX_JOINTS]{};
  bool estop_ = false;
  bool drive_fault_ = false;
  std::uint64_t now_ = 2'000'000;
  std::uint64_t tick_ = 0;
  std::uint32_t sequence_ = 0;
  unsigned ticks_ = 0;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 2) return 0;
  const Bytes rest(data + 1, size - 1);
  if (data[0] % 4 == 0) {
    decode(rest);
  } else if (data[0] % 4 == 1) {
    receive(rest);
  } else {
    Bench bench(data[0] % 4 == 2);
    Reader input(rest);
    while (!input.empty() && !bench.tired()) bench.act(input);
  }
  return 0;
}

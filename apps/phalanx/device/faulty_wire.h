// SPDX-License-Identifier: Apache-2.0
// A transport that loses, duplicates, delays, reorders and damages packets, for tests of a host.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "device/controller_faults.h"
#include "phalanx/core/random.h"
#include "phalanx/device/link/phalanx_link.h"
#include "phalanx/device/link/transport.h"

namespace phalanx {

/// One direction of a faulty transport: packets go in, and come out when they are due. There is room for
/// kRoom packets on their way; further ones are lost.
class FaultyLine {
 public:
  static constexpr std::size_t kRoom = 512;

  explicit FaultyLine(std::uint64_t seed) : random_(seed), place_(kRoom) {}

  void put(double t, const PacketFaults& faults, std::span<const std::uint8_t> frame, Peer peer) noexcept;
  /// Fetches the packet that is due first. @returns its size, 0: none is due
  [[nodiscard]] std::size_t take(double t, std::span<std::uint8_t> out, Peer& peer) noexcept;
  void clear() noexcept;
  /// Makes random bytes. @returns how many
  [[nodiscard]] std::size_t noise(std::span<std::uint8_t> out) noexcept;

 private:
  struct Packet {
    bool used = false;
    bool held = false;  ///< until the next packet has been put
    double due = 0.0;   ///< [s]
    std::uint64_t order = 0;
    Peer peer = 0;
    std::size_t size = 0;
    std::array<std::uint8_t, PHX_FRAME_MAX> bytes{};
  };
  [[nodiscard]] bool happens(double probability) noexcept;
  void put_one(double t, const PacketFaults& faults, std::span<const std::uint8_t> frame, Peer peer) noexcept;
  void release_held(double due) noexcept;

  Random random_;
  std::vector<Packet> place_;
  std::size_t waiting_ = 0;
  std::uint64_t order_ = 0;
};

/// A Transport with a faulty line in each direction. Delays end at a call: at the controller's ticks.
class FaultyWire {
 public:
  FaultyWire(Transport& transport, std::uint64_t seed);

  /// Fetches the next frame for the controller at its tick at `t` [s]. @returns its size, 0: none for now
  [[nodiscard]] std::size_t receive(double t, const PacketFaults& faults, std::span<std::uint8_t> out,
                                    Peer& from) noexcept;
  void send(double t, const PacketFaults& faults, std::span<const std::uint8_t> frame, Peer to) noexcept;
  /// Sends the packets that have become due, and noise. Call it once at each tick.
  /// @param host  the host that has the session; none: no noise is sent
  void flush(double t, const PacketFaults& faults, std::optional<Peer> host) noexcept;
  /// Drops all packets on their way.
  void clear() noexcept;

 private:
  Transport& transport_;
  FaultyLine to_controller_;
  FaultyLine to_host_;
  std::array<std::uint8_t, PHX_FRAME_MAX> buffer_{};
};

}  // namespace phalanx

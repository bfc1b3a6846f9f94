// SPDX-License-Identifier: Apache-2.0
// Round trips of PING and PONG frames: sent, received, and their times.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace phalanx {

/// Percentiles of the round trips [s]; 0 if none came back.
struct RoundTripTimes {
  double p50 = 0.0, p90 = 0.0, p99 = 0.0, p999 = 0.0, max = 0.0;
};

/// Record of the round trips.
class RoundTrips {
 public:
  /// Reserves memory for `capacity` round trips, so that nothing is allocated while times are measured.
  explicit RoundTrips(std::size_t capacity) { sent_.reserve(capacity), seconds_.reserve(capacity); }

  /// Records a PING. @returns its number, from 0
  std::uint64_t send(double now);
  /// Records an answer; one to an unknown PING is ignored.
  void receive(std::uint64_t number, double now);

  [[nodiscard]] std::uint64_t sent() const noexcept { return sent_.size(); }
  [[nodiscard]] std::uint64_t received() const noexcept { return seconds_.size(); }
  [[nodiscard]] std::uint64_t lost() const noexcept { return sent() - received(); }
  [[nodiscard]] double loss() const noexcept {
    return sent() > 0 ? static_cast<double>(lost()) / static_cast<double>(sent()) : 0.0;
  }
  [[nodiscard]] std::uint64_t duplicates() const noexcept { return duplicates_; }
  [[nodiscard]] std::uint64_t reordered() const noexcept { return reordered_; }  ///< came after a later one
  /// @returns the percentiles: the smallest time that at least this part of the answers did not exceed.
  [[nodiscard]] RoundTripTimes times() const;
  /// Draws bars over doubling times, one line each.
  [[nodiscard]] std::string histogram() const;

 private:
  struct Ping {
    double at = 0.0;
    bool answered = false;
  };
  std::vector<Ping> sent_;
  std::vector<double> seconds_;
  std::uint64_t newest_ = 0;
  std::uint64_t duplicates_ = 0;
  std::uint64_t reordered_ = 0;
};

}  // namespace phalanx

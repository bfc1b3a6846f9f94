// SPDX-License-Identifier: Apache-2.0
// Where a glove is to stop each finger, from the hand that is shown.
#pragma once

#include <optional>
#include <span>

#include "phalanx/device/device.h"
#include "phalanx/device/opengloves/opengloves_codec.h"
#include "phalanx/hand/hand_parameters.h"

namespace phalanx {

/// The shown curl of a digit is the mean over its flexion joints of (q_gdp - min) / (max - min). The stop
/// stands where the glove itself would read that curl c:
///   stop = round(1000 (1 - raw(c) / full scale)),   raw(c) = (c - offset) / gain,
/// with the nominal gain 1000 (1 - c). A digit whose joints are sensed one by one takes the mean of
/// raw(q_gdp) over these joints. Bounded to 0 .. 1000; a number that is not finite lets go.
class GloveStopper {
 public:
  GloveStopper() = default;
  /// @param hand  without one, nothing is ever stopped
  GloveStopper(std::span<const DeviceChannel> channels, int full_scale,
               const std::optional<HandParameters>& hand);

  /// Real-time: no allocation, lock, throw or I/O. 0 (free) for all digits unless `command` is enabled, and
  /// for each digit that is not stopped or not sensed.
  [[nodiscard]] GloveStops stops(const DeviceCommand& command) const noexcept;

 private:
  /// Fraction of the full scale that the glove reads = sum over the digit's flexion joints of weight q, +
  /// offset.
  struct Reading {
    bool sensed = false;
    std::array<double, kJointsPerDigit> weight{};
    double offset = 0.0;
  };
  std::array<Reading, kDigits> reading_{};
};

}  // namespace phalanx

// SPDX-License-Identifier: Apache-2.0
// The stop positions of a glove's fingers, from the displayed hand.
#pragma once

#include <optional>
#include <span>

#include "phalanx/device/device.h"
#include "phalanx/device/opengloves/opengloves_codec.h"
#include "phalanx/hand/hand_parameters.h"

namespace phalanx {

/// Converter from the displayed hand to stops. The displayed curl c of a digit is the mean over its flexion
/// joints of (q_gdp - min) / (max - min). The stop is placed where the glove itself would read that curl:
///   stop = round(1000 (1 - raw(c) / full scale)),   raw(c) = (c - offset) / gain,
/// with the nominal gain 1000 (1 - c). A digit whose joints are sensed separately uses the mean of raw(q_gdp)
/// over these joints. A stop is bounded to 0 .. 1000; a number that is not finite releases the finger.
class GloveStopper {
 public:
  GloveStopper() = default;
  /// @param hand  without one, no finger is ever stopped
  GloveStopper(std::span<const DeviceChannel> channels, int full_scale,
               const std::optional<HandParameters>& hand);

  /// @returns the stops: 0 (free) for all digits unless `command` is enabled, and for each digit that is not
  /// stopped or not sensed. Real-time: no allocation, lock, throw or I/O.
  [[nodiscard]] GloveStops stops(const DeviceCommand& command) const noexcept;

 private:
  /// Linear model of the glove's reading, as a fraction of the full scale: the sum over the digit's flexion
  /// joints of weight q, plus offset.
  struct Reading {
    bool sensed = false;
    std::array<double, kJointsPerDigit> weight{};
    double offset = 0.0;
  };
  std::array<Reading, kDigits> reading_{};
};

}  // namespace phalanx

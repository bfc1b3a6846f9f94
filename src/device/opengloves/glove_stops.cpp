// SPDX-License-Identifier: Apache-2.0
#include "device/opengloves/glove_stops.h"

#include <algorithm>
#include <cmath>

#include "device/opengloves/glove_channels.h"

namespace phalanx {

GloveStopper::GloveStopper(std::span<const DeviceChannel> channels, int full_scale,
                           const std::optional<HandParameters>& hand) {
  if (!hand) return;
  std::array<int, kDigits> joints_sensed{};
  for (const DeviceChannel& c : channels)
    if (c.kind == ChannelKind::kAngle) ++joints_sensed[static_cast<std::size_t>(digit_of_joint(c.index))];

  for (const DeviceChannel& c : channels) {
    const double per_unit = 1.0 / (c.gain * full_scale);
    if (c.kind == ChannelKind::kCurl) {
      Reading& digit = reading_[static_cast<std::size_t>(c.index)];
      digit.sensed = true;
      digit.offset = -c.offset * per_unit;
      for (int k = 0; k < kGloveJoints; ++k) {
        const auto j = static_cast<std::size_t>(glove_joint(c.index, k));
        const double weight = per_unit / (kGloveJoints * (hand->max_angle[j] - hand->min_angle[j]));
        digit.weight[j % kJointsPerDigit] = weight;
        digit.offset -= weight * hand->min_angle[j];
      }
    } else if (c.kind == ChannelKind::kAngle) {
      const auto d = static_cast<std::size_t>(digit_of_joint(c.index));
      reading_[d].sensed = true;
      const double weight = per_unit / joints_sensed[d];
      reading_[d].weight[static_cast<std::size_t>(c.index % kJointsPerDigit)] = weight;
      reading_[d].offset -= weight * c.offset;
    }
  }
}

GloveStops GloveStopper::stops(const DeviceCommand& command) const noexcept {
  GloveStops stops{};
  if (!command.enable) return stops;
  for (std::size_t d = 0; d < kDigits; ++d) {
    if (!command.stopped[d] || !reading_[d].sensed) continue;
    double read = reading_[d].offset;
    for (std::size_t i = 0; i < kJointsPerDigit; ++i)
      read += reading_[d].weight[i] * command.gdp_angle[d * kJointsPerDigit + i];
    const double stop = 1000.0 * (1.0 - read);
    if (std::isfinite(stop)) stops[d] = static_cast<int>(std::lround(std::clamp(stop, 0.0, 1000.0)));
  }
  return stops;
}

}  // namespace phalanx

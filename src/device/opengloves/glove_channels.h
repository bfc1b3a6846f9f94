// SPDX-License-Identifier: Apache-2.0
// What a glove sends, and the channels that come of it.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "phalanx/device/device.h"
#include "phalanx/device/opengloves/opengloves_codec.h"
#include "phalanx/hand/hand_parameters.h"

namespace phalanx {

/// The joint of a digit that a glove calls its `joint`: base, middle, tip. Gloves do not sense abduction
/// joint by joint.
[[nodiscard]] constexpr int glove_joint(int digit, int joint) noexcept {
  return joint_index(digit, joint == 0 ? 0 : joint + 1);
}

/// What the lines of a glove had in common while it was learnt.
class LearntGlove {
 public:
  void add(const GloveLine& line) noexcept;
  [[nodiscard]] bool has(std::size_t key) const noexcept { return count_[key] > 0; }
  /// Whether a later line has every number that all lines had: else it is a part of one.
  [[nodiscard]] bool is_whole(const GloveLine& line) const noexcept;
  [[nodiscard]] int lines() const noexcept { return lines_; }
  /// 4095 if any number was above 1023, else 1023.
  [[nodiscard]] int full_scale() const noexcept;

 private:
  std::array<int, kGloveKeys> count_{};  ///< of lines that had this number
  std::int32_t largest_ = 0;
  int lines_ = 0;
};

struct GloveChannel {
  DeviceChannel channel;
  std::size_t key = 0;  ///< of GloveLine::value
};

/// Per digit its three joints if it sends all of them, else its curl, else the joints that it does send; and
/// its splay.
/// @param hand  for the joints' nominal gains; without one a joint moves 0 .. 90 deg
[[nodiscard]] std::vector<GloveChannel> glove_channels(const LearntGlove& glove, int full_scale,
                                                       const std::optional<HandParameters>& hand);

}  // namespace phalanx

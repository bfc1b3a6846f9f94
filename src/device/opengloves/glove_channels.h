// SPDX-License-Identifier: Apache-2.0
// The numbers that a glove sends, and the channels made from them.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "phalanx/device/device.h"
#include "phalanx/device/opengloves/opengloves_codec.h"
#include "phalanx/hand/hand_parameters.h"

namespace phalanx {

/// @returns the joint of a digit for the glove's `joint`: base, middle, tip. Gloves do not sense abduction
/// joint by joint.
[[nodiscard]] constexpr int glove_joint(int digit, int joint) noexcept {
  return joint_index(digit, joint == 0 ? 0 : joint + 1);
}

/// Numbers that a glove's lines had in common during learning.
class LearntGlove {
 public:
  void add(const GloveLine& line) noexcept;
  [[nodiscard]] bool has(std::size_t key) const noexcept { return count_[key] > 0; }
  /// @returns true if a later line has every number that all learnt lines had; else it is a partial line.
  [[nodiscard]] bool is_whole(const GloveLine& line) const noexcept;
  [[nodiscard]] int lines() const noexcept { return lines_; }
  /// @returns 4095 if any number was above 1023, else 1023.
  [[nodiscard]] int full_scale() const noexcept;

 private:
  std::array<int, kGloveKeys> count_{};  ///< number of lines that had each key
  std::int32_t largest_ = 0;
  int lines_ = 0;
};

/// A channel and the number of a line that it takes.
struct GloveChannel {
  DeviceChannel channel;
  std::size_t key = 0;  ///< index in GloveLine::value
};

/// Makes the channels. A digit has three joint channels if the glove sends all three; else its curl; else the
/// joints that are sent. Its splay is added.
/// @param hand  for the joints' nominal gains; without one a joint moves 0 .. 90 deg
[[nodiscard]] std::vector<GloveChannel> glove_channels(const LearntGlove& glove, int full_scale,
                                                       const std::optional<HandParameters>& hand);

}  // namespace phalanx

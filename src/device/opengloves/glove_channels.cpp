// SPDX-License-Identifier: Apache-2.0
#include "device/opengloves/glove_channels.h"

#include <algorithm>
#include <numbers>

namespace phalanx {
namespace {

DeviceChannel channel(ChannelKind kind, int index, int full_scale, double at_zero, double at_full) {
  return {.kind = kind,
          .index = index,
          .raw_min = 0,
          .raw_max = full_scale,
          .gain = (at_full - at_zero) / full_scale,
          .offset = at_zero};
}

DeviceChannel joint_channel(int joint, int full_scale, const std::optional<HandParameters>& hand) {
  const auto j = static_cast<std::size_t>(joint);
  const double open = hand ? hand->min_angle[j] : 0.0;
  const double closed = hand ? hand->max_angle[j] : std::numbers::pi / 2.0;
  return channel(ChannelKind::kAngle, joint, full_scale, open, closed);
}

int joints_sent(const LearntGlove& glove, int digit) {
  int count = 0;
  for (int j = 0; j < kGloveJoints; ++j) count += glove.has(glove_joint_key(digit, j)) ? 1 : 0;
  return count;
}

}  // namespace

void LearntGlove::add(const GloveLine& line) noexcept {
  for (std::size_t key = 0; key < count_.size(); ++key) count_[key] += line.has[key] ? 1 : 0;
  largest_ = std::max(largest_, line.largest);
  ++lines_;
}

bool LearntGlove::is_whole(const GloveLine& line) const noexcept {
  for (std::size_t key = 0; key < count_.size(); ++key)
    if (lines_ > 0 && count_[key] == lines_ && !line.has[key]) return false;
  return true;
}

int LearntGlove::full_scale() const noexcept { return largest_ > kGloveNarrow ? kGloveWide : kGloveNarrow; }

std::vector<GloveChannel> glove_channels(const LearntGlove& glove, int full_scale,
                                         const std::optional<HandParameters>& hand) {
  std::vector<GloveChannel> channels;
  for (int d = 0; d < kDigits; ++d) {
    const bool by_joint = joints_sent(glove, d) == kGloveJoints || !glove.has(glove_curl_key(d));
    if (!by_joint)
      channels.push_back({channel(ChannelKind::kCurl, d, full_scale, 0.0, 1.0), glove_curl_key(d)});
    for (int j = 0; by_joint && j < kGloveJoints; ++j) {
      const std::size_t key = glove_joint_key(d, j);
      if (glove.has(key)) channels.push_back({joint_channel(glove_joint(d, j), full_scale, hand), key});
    }
    if (glove.has(glove_splay_key(d)))
      channels.push_back({channel(ChannelKind::kSplay, d, full_scale, -1.0, 1.0), glove_splay_key(d)});
  }
  return channels;
}

}  // namespace phalanx

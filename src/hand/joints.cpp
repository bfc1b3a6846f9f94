// SPDX-License-Identifier: Apache-2.0
#include "phalanx/hand/joints.h"

#include <algorithm>

namespace phalanx {
namespace {

constexpr std::array<std::string_view, kJoints> kJointNames = {
    "thumb_cmc_flexion",  "thumb_cmc_abduction",  "thumb_mcp_flexion",  "thumb_ip_flexion",
    "index_mcp_flexion",  "index_mcp_abduction",  "index_pip_flexion",  "index_dip_flexion",
    "middle_mcp_flexion", "middle_mcp_abduction", "middle_pip_flexion", "middle_dip_flexion",
    "ring_mcp_flexion",   "ring_mcp_abduction",   "ring_pip_flexion",   "ring_dip_flexion",
    "little_mcp_flexion", "little_mcp_abduction", "little_pip_flexion", "little_dip_flexion",
};

constexpr std::array<std::string_view, kSegments> kSegmentNames = {
    "thumb-metacarpal",
    "thumb-phalanx-proximal",
    "thumb-phalanx-distal",
    "index-finger-phalanx-proximal",
    "index-finger-phalanx-intermediate",
    "index-finger-phalanx-distal",
    "middle-finger-phalanx-proximal",
    "middle-finger-phalanx-intermediate",
    "middle-finger-phalanx-distal",
    "ring-finger-phalanx-proximal",
    "ring-finger-phalanx-intermediate",
    "ring-finger-phalanx-distal",
    "pinky-finger-phalanx-proximal",
    "pinky-finger-phalanx-intermediate",
    "pinky-finger-phalanx-distal",
    "wrist",
};

constexpr std::array<std::string_view, kDigits> kDigitNames = {"thumb", "index", "middle", "ring", "little"};

template <std::size_t N>
std::optional<int> find(const std::array<std::string_view, N>& names, std::string_view name) noexcept {
  const auto it = std::find(names.begin(), names.end(), name);
  if (it == names.end()) return std::nullopt;
  return static_cast<int>(it - names.begin());
}

}  // namespace

std::string_view joint_name(int joint) noexcept { return kJointNames[static_cast<std::size_t>(joint)]; }
std::string_view segment_name(int segment) noexcept {
  return kSegmentNames[static_cast<std::size_t>(segment)];
}
std::string_view digit_name(int digit) noexcept { return kDigitNames[static_cast<std::size_t>(digit)]; }
std::optional<int> find_joint(std::string_view name) noexcept { return find(kJointNames, name); }
std::optional<int> find_segment(std::string_view name) noexcept { return find(kSegmentNames, name); }

}  // namespace phalanx

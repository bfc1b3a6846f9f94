// SPDX-License-Identifier: Apache-2.0
#include "phalanx/figures/human_names.h"

#include <array>

#include "phalanx/hand/joints.h"

namespace phalanx {
namespace {

constexpr std::array<const char*, kJointsPerDigit> kThumbJoints = {"CMC flexion", "CMC abduction", "MCP",
                                                                   "IP"};
constexpr std::array<const char*, kJointsPerDigit> kFingerJoints = {"MCP flexion", "MCP abduction", "PIP",
                                                                    "DIP"};
constexpr std::array<const char*, kSegmentsPerDigit> kThumbSegments = {"metacarpal", "proximal", "distal"};
constexpr std::array<const char*, kSegmentsPerDigit> kFingerSegments = {"proximal", "intermediate", "distal"};

}  // namespace

std::string human_joint_name(int joint) {
  const int digit = digit_of_joint(joint);
  const auto& names = digit == 0 ? kThumbJoints : kFingerJoints;
  return std::string(digit_name(digit)) + " " + names[static_cast<std::size_t>(joint % kJointsPerDigit)];
}

std::string human_segment_name(int segment) {
  if (segment == kPalm) return "palm";
  const int digit = digit_of_segment(segment);
  const auto& names = digit == 0 ? kThumbSegments : kFingerSegments;
  return std::string(digit_name(digit)) + " " + names[static_cast<std::size_t>(segment % kSegmentsPerDigit)];
}

}  // namespace phalanx

// SPDX-License-Identifier: Apache-2.0
#include "phalanx/device/calibration_session.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <functional>
#include <string_view>

namespace phalanx {
namespace {

bool is_abduction(int joint) { return joint % kJointsPerDigit == kAbductionJoint; }
bool is_thumb(int digit) { return digit == static_cast<int>(Digit::kThumb); }

// @returns the position of an angle between the hand's smallest (0) and largest angle (1) of a joint.
double fraction(const HandParameters& hand, int joint, double angle) {
  const auto j = static_cast<std::size_t>(joint);
  return (angle - hand.min_angle[j]) / (hand.max_angle[j] - hand.min_angle[j]);
}

double open_curl(const HandParameters& hand, int digit) {
  double sum = 0.0;
  for (const int i : {0, 2, 3}) {
    const int joint = joint_index(digit, i);
    sum += fraction(hand, joint, hand.open_angle[static_cast<std::size_t>(joint)]);
  }
  return sum / 3.0;
}

double open_value(const DeviceChannel& c, const HandParameters& hand) {
  if (c.kind == ChannelKind::kAngle) return hand.open_angle[static_cast<std::size_t>(c.index)];
  if (c.kind == ChannelKind::kCurl) return open_curl(hand, c.index);
  const int joint = joint_index(c.index, kAbductionJoint);
  return 2.0 * fraction(hand, joint, hand.open_angle[static_cast<std::size_t>(joint)]) - 1.0;
}

double smallest(const DeviceChannel& c, const HandParameters& hand) {
  if (c.kind == ChannelKind::kAngle) return hand.min_angle[static_cast<std::size_t>(c.index)];
  return c.kind == ChannelKind::kSplay ? -1.0 : 0.0;
}

double largest(const DeviceChannel& c, const HandParameters& hand) {
  return c.kind == ChannelKind::kAngle ? hand.max_angle[static_cast<std::size_t>(c.index)] : 1.0;
}

bool can_be_posed(const DeviceChannel& c) {
  if (c.kind == ChannelKind::kAngle) return c.index >= 0 && c.index < kJoints;
  const bool of_digit = c.kind == ChannelKind::kCurl || c.kind == ChannelKind::kSplay;
  return of_digit && c.index >= 0 && c.index < kDigits;
}

bool spreads(const DeviceChannel& c) {
  return c.kind == ChannelKind::kSplay || (c.kind == ChannelKind::kAngle && is_abduction(c.index));
}

int digit_of(const DeviceChannel& c) {
  return c.kind == ChannelKind::kAngle ? digit_of_joint(c.index) : c.index;
}

std::string digit_words(int digit) {
  return is_thumb(digit) ? "thumb" : fmt::format("{} finger", digit_name(digit));
}

// Names a joint in words: "the middle joint of the index finger".
std::string joint_words(int joint) {
  constexpr std::array<std::string_view, kJointsPerDigit> kFinger = {"knuckle", "", "middle joint",
                                                                     "end joint"};
  constexpr std::array<std::string_view, kJointsPerDigit> kThumb = {"", "", "middle joint", "end joint"};
  const int digit = digit_of_joint(joint);
  const auto i = static_cast<std::size_t>(joint % kJointsPerDigit);
  return fmt::format("the {} of the {}", is_thumb(digit) ? kThumb[i] : kFinger[i], digit_words(digit));
}

struct EndStops {
  std::string name, towards_largest, towards_smallest;
};

EndStops end_stops(const DeviceChannel& c) {
  const std::string digit = digit_words(digit_of(c));
  if (spreads(c)) {
    return {.name = fmt::format("{} splay", digit_name(digit_of(c))),
            .towards_largest = fmt::format("Spread the {} away from the middle finger as far as it goes "
                                           "(the middle finger: towards the thumb).",
                                           digit),
            .towards_smallest = fmt::format("Move the {} the other way as far as it goes.", digit)};
  }
  if (c.kind == ChannelKind::kCurl) {
    return {.name = fmt::format("{} curl", digit_name(c.index)),
            .towards_largest = fmt::format("Close the {}, all its joints, as far as it goes.", digit),
            .towards_smallest = fmt::format("Stretch the {} and bend it back as far as it goes.", digit)};
  }
  if (c.index == joint_index(static_cast<int>(Digit::kThumb), 0)) {  // its flexion is opposition
    return {.name = std::string(joint_name(c.index)),
            .towards_largest = "Move the thumb across the palm towards the little finger as far as it goes.",
            .towards_smallest =
                "Move the thumb back to the side of the hand as far as it goes, "
                "behind the palm's plane if it can."};
  }
  const std::string joint = joint_words(c.index);
  return {
      .name = std::string(joint_name(c.index)),
      .towards_largest = fmt::format("Bend {} as far as it goes.", joint),
      .towards_smallest = fmt::format("Straighten {} as far as it goes, beyond straight if it can.", joint)};
}

using Value = std::function<std::optional<double>(const DeviceChannel&)>;

class Poses {
 public:
  explicit Poses(std::span<const DeviceChannel> channels) : channels_(channels) {}

  void add(std::string name, std::string instruction, const Value& value) {
    CalibrationPose pose{.name = std::move(name), .instruction = std::move(instruction), .value = {}};
    for (const DeviceChannel& c : channels_)
      pose.value.push_back(can_be_posed(c) ? value(c) : std::optional<double>{});
    const bool says_something =
        std::any_of(pose.value.begin(), pose.value.end(), [](const auto& v) { return v.has_value(); });
    if (says_something) poses_.push_back(std::move(pose));
  }
  void add_for(const DeviceChannel& only, std::string name, std::string instruction, double value) {
    add(std::move(name), std::move(instruction),
        [&](const DeviceChannel& c) { return &c == &only ? std::optional<double>(value) : std::nullopt; });
  }
  [[nodiscard]] std::vector<CalibrationPose> take() { return std::move(poses_); }

 private:
  std::span<const DeviceChannel> channels_;
  std::vector<CalibrationPose> poses_;
};

}  // namespace

std::vector<CalibrationPose> calibration_poses(std::span<const DeviceChannel> channels,
                                               const HandParameters& hand) {
  using Known = std::optional<double>;
  Poses poses(channels);
  poses.add("open hand", "Lay the hand flat on a table, fingers straight and side by side.",
            [&](const DeviceChannel& c) -> Known { return open_value(c, hand); });
  poses.add("fist", "Make a fist, every joint of the four fingers bent as far as it goes.",
            [&](const DeviceChannel& c) -> Known {
              if (spreads(c) || is_thumb(digit_of(c))) return std::nullopt;
              return largest(c, hand);
            });
  poses.add("spread", "Spread all fingers and the thumb as wide as they go.",
            [&](const DeviceChannel& c) -> Known {
              const bool stays = digit_of(c) == static_cast<int>(Digit::kMiddle);
              if (!spreads(c) || stays) return std::nullopt;
              return largest(c, hand);
            });
  for (const DeviceChannel& c : channels) {
    if (!can_be_posed(c)) continue;
    const EndStops stops = end_stops(c);
    poses.add_for(c, stops.name + " largest", stops.towards_largest, largest(c, hand));
    poses.add_for(c, stops.name + " smallest", stops.towards_smallest, smallest(c, hand));
  }
  return poses.take();
}

}  // namespace phalanx

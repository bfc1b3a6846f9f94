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

/// A motion of one channel in words.
struct MotionWords {
  std::string name;     ///< "index_pip_flexion", "index curl"
  std::string part;     ///< "the middle joint of the index finger"
  std::string larger;   ///< "bent"
  std::string smaller;  ///< "straight"
};

// Names a joint in words: "the middle joint of the index finger".
std::string joint_words(int joint) {
  constexpr std::array<std::string_view, kJointsPerDigit> kFinger = {"knuckle", "", "middle joint",
                                                                     "end joint"};
  constexpr std::array<std::string_view, kJointsPerDigit> kThumb = {"", "", "middle joint", "end joint"};
  const int digit = digit_of_joint(joint);
  const auto i = static_cast<std::size_t>(joint % kJointsPerDigit);
  return fmt::format("the {} of the {}", is_thumb(digit) ? kThumb[i] : kFinger[i], digit_words(digit));
}

MotionWords motion_words(const DeviceChannel& c) {
  const int digit = digit_of(c);
  const std::string whole = fmt::format("the {}", digit_words(digit));
  if (spreads(c)) {
    const bool middle = digit == static_cast<int>(Digit::kMiddle);
    return {.name = fmt::format("{} splay", digit_name(digit)),
            .part = whole,
            .larger = middle ? "spread towards the thumb" : "spread away from the middle finger",
            .smaller = "moved to the other side"};
  }
  if (c.kind == ChannelKind::kCurl)
    return {.name = fmt::format("{} curl", digit_name(digit)),
            .part = whole,
            .larger = "closed",
            .smaller = "open"};
  if (c.index == joint_index(static_cast<int>(Digit::kThumb), 0))  // its flexion is opposition
    return {.name = std::string(joint_name(c.index)),
            .part = whole,
            .larger = "across the palm, towards the little finger",
            .smaller = "at the side of the hand"};
  return {.name = std::string(joint_name(c.index)),
          .part = joint_words(c.index),
          .larger = "bent",
          .smaller = "straight"};
}

using Value = std::function<std::optional<double>(const DeviceChannel&)>;

class Poses {
 public:
  Poses(std::span<const DeviceChannel> channels, const CalibrationPlan& plan)
      : channels_(channels), plan_(plan) {}

  [[nodiscard]] bool chosen(const DeviceChannel& c) const {
    if (!can_be_posed(c)) return false;
    const auto& joints = plan_.joints;
    return joints.empty() || std::find(joints.begin(), joints.end(), leading_joint(c)) != joints.end();
  }
  void add(std::string name, std::string instruction, const Value& value) {
    CalibrationPose pose{
        .name = std::move(name), .instruction = std::move(instruction), .value = {}, .concerns = {}};
    for (const DeviceChannel& c : channels_) {
      pose.value.push_back(chosen(c) ? value(c) : std::optional<double>{});
      pose.concerns.push_back(pose.value.back().has_value());
    }
    const bool says_something =
        std::find(pose.concerns.begin(), pose.concerns.end(), true) != pose.concerns.end();
    if (says_something) poses_.push_back(std::move(pose));
  }
  /// Adds a pose of one channel. @param value  none: it is to be entered
  void add_for(const DeviceChannel& only, std::string name, std::string instruction,
               std::optional<double> value) {
    add(std::move(name), std::move(instruction),
        [&](const DeviceChannel& c) { return &c == &only ? value.value_or(0.0) : std::optional<double>{}; });
    if (!value && !poses_.empty()) poses_.back().value.assign(channels_.size(), std::nullopt);
  }
  [[nodiscard]] std::vector<CalibrationPose> take() { return std::move(poses_); }

 private:
  std::span<const DeviceChannel> channels_;
  const CalibrationPlan& plan_;
  std::vector<CalibrationPose> poses_;
};

void add_jig(Poses& poses, std::span<const DeviceChannel> channels, const HandParameters& hand) {
  using Known = std::optional<double>;
  poses.add("open hand", "On the jig: the open hand, each joint at the angle that is shown.",
            [&](const DeviceChannel& c) -> Known { return open_value(c, hand); });
  poses.add("fist", "On the jig: the fist, each joint of the four fingers at the angle that is shown.",
            [&](const DeviceChannel& c) -> Known {
              if (spreads(c) || is_thumb(digit_of(c))) return std::nullopt;
              return largest(c, hand);
            });
  poses.add("spread", "On the jig: fingers and thumb spread, each at the angle that is shown.",
            [&](const DeviceChannel& c) -> Known {
              const bool stays = digit_of(c) == static_cast<int>(Digit::kMiddle);
              if (!spreads(c) || stays) return std::nullopt;
              return largest(c, hand);
            });
  for (const DeviceChannel& c : channels) {
    if (!poses.chosen(c)) continue;
    const MotionWords words = motion_words(c);
    const auto text = [&](const std::string& where) {
      return fmt::format("On the jig: {} {}, at the angle that is shown.", words.part, where);
    };
    poses.add_for(c, words.name + " largest", text(words.larger), largest(c, hand));
    poses.add_for(c, words.name + " smallest", text(words.smaller), smallest(c, hand));
  }
}

void add_stops(Poses& poses, std::span<const DeviceChannel> channels, const CalibrationPlan& plan) {
  for (const DeviceChannel& c : channels) {
    if (!poses.chosen(c) || c.kind != ChannelKind::kAngle) continue;
    const auto stops = std::find_if(plan.stops.begin(), plan.stops.end(),
                                    [&](const JointStops& s) { return s.joint == c.index; });
    if (stops == plan.stops.end()) continue;
    const MotionWords words = motion_words(c);
    const auto text = [&](const std::string& where) {
      return fmt::format("No hand in the device. Move {} by hand to the device's stop: {}.", words.part,
                         where);
    };
    poses.add_for(c, words.name + " largest", text(words.larger), stops->max);
    poses.add_for(c, words.name + " smallest", text(words.smaller), stops->min);
  }
}

void add_goniometer(Poses& poses, std::span<const DeviceChannel> channels) {
  for (const DeviceChannel& c : channels) {
    if (!poses.chosen(c)) continue;
    const MotionWords words = motion_words(c);
    const bool curl = c.kind == ChannelKind::kCurl;
    const std::string where = curl ? "its middle joint" : "the joint";
    poses.add_for(
        c, words.name + " first",
        fmt::format(
            "Hold {} {} as far as is comfortable. Measure {} with the goniometer and enter the angle.",
            words.part, words.smaller, where),
        std::nullopt);
    poses.add_for(
        c, words.name + " second",
        fmt::format("Hold {} further {}, at least 20 degrees from the first position. Measure {} and enter "
                    "the angle.",
                    words.part, words.larger, where),
        std::nullopt);
    poses.add_for(
        c, words.name + " third",
        fmt::format("To check both: hold {} between the two positions, measure {} and enter the angle. It "
                    "may be skipped.",
                    words.part, where),
        std::nullopt);
  }
}

}  // namespace

std::vector<CalibrationPose> calibration_poses(std::span<const DeviceChannel> channels,
                                               const HandParameters& hand, const CalibrationPlan& plan) {
  Poses poses(channels, plan);
  if (plan.method == CalibrationMethod::kJig) add_jig(poses, channels, hand);
  if (plan.method == CalibrationMethod::kStops) add_stops(poses, channels, plan);
  if (plan.method == CalibrationMethod::kGoniometer) add_goniometer(poses, channels);
  return poses.take();
}

}  // namespace phalanx

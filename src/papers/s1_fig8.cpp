// SPDX-License-Identifier: Apache-2.0
#include "papers/s1_fig8.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <stdexcept>

#include "phalanx/core/constants.h"
#include "phalanx/scene/build_model.h"

namespace phalanx {
namespace {

constexpr int kIndex = static_cast<int>(Digit::kIndex);
constexpr double kSpeed = 20.0 * kDeg;     // speed of a closing joint [rad/s]
constexpr double kApproach = 20.0 * kDeg;  // distance before the touch at which the first joint starts [rad]
constexpr double kReach = 90.0 * kDeg;  // range beyond its start in which a joint searches for the ball [rad]

/// Angles of MCP flexion, PIP and DIP of the index finger [rad].
using FingerAngles = std::array<double, 3>;

/// A joint that closes until its segment (0 proximal, 1 middle, 2 distal) touches, and `press` further [rad].
struct Closing {
  std::size_t joint;
  int segment;
  double press;
};

struct Plan {
  char letter;
  const char* title;
  std::array<bool, 3> touching;
  double ball_diameter;
  FingerAngles posture_deg;  ///< posture in which `under` just touches the ball
  int under;                 ///< the segment under which the ball lies
  double along;              ///< its position along the segment, as a part of the length
  std::vector<Closing> closings;
};

const std::vector<Plan>& plans() {
  // The ball meets the proximal phalanx beyond its middle. The other phalanges fold onto it one by one: (b),
  // (c) and (d) are one grasp.
  static const std::vector<Plan> kPlans = {
      {'a', "free", {false, false, false}, 0.04, {35, 5, 5}, 0, 0.65, {}},
      {'b', "proximal", {true, false, false}, 0.04, {35, 5, 5}, 0, 0.65, {{0, 0, 4 * kDeg}}},
      {'c',
       "proximal and middle",
       {true, true, false},
       0.04,
       {35, 5, 5},
       0,
       0.65,
       {{0, 0, 4 * kDeg}, {1, 1, 6 * kDeg}}},
      {'d',
       "whole finger",
       {true, true, true},
       0.04,
       {35, 5, 5},
       0,
       0.65,
       {{0, 0, 4 * kDeg}, {1, 1, 6 * kDeg}, {2, 2, 8 * kDeg}}},
      {'e', "distal, extended", {false, false, true}, 0.04, {25, 10, 5}, 2, 0.5, {{0, 2, 2 * kDeg}}},
      {'f', "distal, flexed", {false, false, true}, 0.03, {40, 30, 20}, 2, 0.5, {{0, 2, 2 * kDeg}}},
      {'g', "middle", {false, true, false}, 0.03, {35, 25, 0}, 1, 0.5, {{0, 1, 3 * kDeg}}},
  };
  return kPlans;
}

JointArray with_index(JointArray angle, const FingerAngles& finger) {
  angle[static_cast<std::size_t>(joint_index(kIndex, 0))] = finger[0];
  angle[static_cast<std::size_t>(joint_index(kIndex, 2))] = finger[1];
  angle[static_cast<std::size_t>(joint_index(kIndex, 3))] = finger[2];
  return angle;
}

/// @returns the ball's centre so that it touches segment `under` from the palm's side in this posture.
Vec3 ball_centre(const HandModel& hand, const Plan& plan, const JointArray& posture) {
  DigitPose pose;
  hand.digit_pose(kIndex, digit_angles(posture, kIndex), pose);
  const SegmentShape& shape =
      hand.parameters().segments[static_cast<std::size_t>(segment_index(kIndex, plan.under))];
  const double radius = shape.radius_base + plan.along * (shape.radius_tip - shape.radius_base);
  const double away = plan.letter == 'a' ? 0.1 : 0.0;  // out of reach
  return pose.segment[static_cast<std::size_t>(plan.under)] *
         Vec3(0.0, -(radius + 0.5 * plan.ball_diameter + away), -plan.along * shape.length);
}

SceneDescription scene_with_ball(double diameter, const Vec3& centre) {
  SceneDescription scene;
  scene.name = "s1-fig8";
  scene.hand.file = "papers";
  scene.hand.mesh_source = HandMeshSource::kCapsules;  // the ball is placed against capsules
  scene.hand.coupling = HandCoupling::kNone;           // as S1's digits
  ObjectDescription ball;
  ball.kind = "sphere";
  ball.diameter = diameter;
  ball.triangles = 2000;
  ball.pose.p = centre;
  scene.objects = {ball};
  return scene;
}

/// Loop of steps that holds the finger at given angles.
class Player {
 public:
  explicit Player(const HapticModel& model)
      : model_(model),
        state_(std::make_unique<HapticState>(model, parameters_)),
        angle_(model.hand.parameters().open_angle) {}

  void tick() {
    status_ |=
        step(model_, parameters_,
             {.time_s = static_cast<double>(ticks_++) / parameters_.rate_hz, .angle = angle_}, *state_);
  }
  /// Moves in a straight line over `seconds`.
  void move_to(const JointArray& target, double seconds) {
    const JointArray from = angle_;
    const int n = static_cast<int>(std::lround(seconds * parameters_.rate_hz));
    for (int i = 1; i <= n; ++i) {
      for (std::size_t j = 0; j < angle_.size(); ++j) angle_[j] = from[j] + (target[j] - from[j]) * i / n;
      tick();
    }
  }
  void hold(double seconds) { move_to(JointArray(angle_), seconds); }
  void close(std::size_t joint, int segment, double press) {
    const auto j =
        static_cast<std::size_t>(joint_index(kIndex, joint == 0 ? 0 : static_cast<int>(joint) + 1));
    const auto s = static_cast<std::size_t>(segment_index(kIndex, segment));
    const double start = angle_[j];
    while (!snapshot().segment[s].contact) {
      angle_[j] += kSpeed / parameters_.rate_hz;
      if (angle_[j] > start + kReach + kApproach) {
        throw std::runtime_error(
            fmt::format("s1-fig8: {} did not meet the ball", segment_name(static_cast<int>(s))));
      }
      tick();
    }
    JointArray pressed = angle_;
    pressed[j] += press;
    move_to(pressed, press / kSpeed);
  }
  [[nodiscard]] const Snapshot& snapshot() const { return state_->snapshot(); }
  [[nodiscard]] Status status() const { return status_; }

 private:
  const HapticModel& model_;
  const HapticParameters parameters_;
  std::unique_ptr<HapticState> state_;
  JointArray angle_;
  std::uint64_t ticks_ = 0;
  Status status_ = Status::kOk;
};

Fig8Situation play(const Plan& plan, const HapticModel& empty_handed) {
  const JointArray& open = empty_handed.hand.parameters().open_angle;
  const FingerAngles touch = {kDeg * plan.posture_deg[0], kDeg * plan.posture_deg[1],
                              kDeg * plan.posture_deg[2]};
  Fig8Situation situation{.letter = plan.letter,
                          .title = plan.title,
                          .touching = plan.touching,
                          .ball_diameter = plan.ball_diameter,
                          .ball_centre = ball_centre(empty_handed.hand, plan, with_index(open, touch)),
                          .held = {}};
  const auto model =
      std::make_unique<HapticModel>(build_model(scene_with_ball(plan.ball_diameter, situation.ball_centre)));
  FingerAngles before = touch;
  before[0] -= kApproach;
  Player player(*model);
  player.move_to(with_index(open, plan.closings.empty() ? touch : before), 0.5);
  for (const Closing& closing : plan.closings) player.close(closing.joint, closing.segment, closing.press);
  player.hold(0.5);
  situation.held = player.snapshot();
  situation.limited = player.status();
  return situation;
}

}  // namespace

std::vector<Fig8Situation> run_s1_fig8() {
  SceneDescription scene;
  scene.name = "s1-fig8";
  scene.hand.file = "papers";
  scene.hand.mesh_source = HandMeshSource::kCapsules;  // the ball is placed against capsules
  scene.hand.coupling = HandCoupling::kNone;           // as S1's digits
  const auto empty_handed = std::make_unique<HapticModel>(build_model(scene));
  std::vector<Fig8Situation> situations;
  for (const Plan& plan : plans()) situations.push_back(play(plan, *empty_handed));
  return situations;
}

bool carries_torque(const Fig8Situation& situation, int joint) {
  return std::any_of(situation.touching.begin() + joint, situation.touching.end(),
                     [](bool touching) { return touching; });
}

}  // namespace phalanx

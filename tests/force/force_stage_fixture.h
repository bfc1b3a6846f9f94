// SPDX-License-Identifier: Apache-2.0
// The force stage on contact records that are written by hand: what a search would find does not matter here.
#pragma once

#include "phalanx/core/index.h"
#include "phalanx/force/force_stage.h"
#include "phalanx/mesh/primitives.h"
#include "support/simple_hand.h"

namespace phalanx::test {

inline constexpr double kTick = 0.005;  // [s]
inline constexpr int kProximal = 0;
inline constexpr int kDistal = 2;
inline constexpr int kThumb = 0;

/// The simple hand, open and straight along -Z, with records of our own and every limiter off.
class ForceStageFixture {
 public:
  ForceStageFixture() {
    parameters.stabiliser.method = Stabiliser::kNone;
    parameters.limits.fingertip_force_enabled = false;
    parameters.limits.joint_torque_enabled = false;
    parameters.limits.torque_rate_enabled = false;
    hand_.poses(hand_.parameters().open_angle, hcp);
    state.hcp_before = hcp;
  }

  /// The segment's point 10 mm from its joint presses something below it: the finger is pushed towards +Y.
  ContactRecord& press(int k, double depth, const Vec3& normal = Vec3::UnitY(), int digit = kIndex) {
    ContactRecord& record = contacts_.record[idx(segment_index(digit, k))];
    record.active = true;
    record.p_S = Vec3(0.0, 0.0, -0.010);
    record.n_c = record.force_normal = normal;
    record.depth = depth;
    record.p_hcp = hcp.digit[idx(digit)].segment[idx(k)] * record.p_S;
    record.p_gdp = contacts_.poses.digit[idx(digit)].segment[idx(k)] * record.p_S;
    return record;
  }
  /// The digit started inside the object, and has not been clear since.
  void start_inside(int digit = kIndex) { contacts_.inside[idx(digit)] = true; }
  void leave(int k, int digit = kIndex) { contacts_.record[idx(segment_index(digit, k))].active = false; }
  /// The measured finger moves by so much, all segments alike.
  void move_hcp(const Vec3& by) {
    for (Pose& segment : hcp.digit[idx(kIndex)].segment) segment.p += by;
  }
  Status tick() { return compute_command(parameters, contacts_, hcp, stale, state); }
  Status ticks(int count) {
    Status status = Status::kOk;
    for (int i = 0; i < count; ++i) status = tick();
    return status;
  }
  [[nodiscard]] double sent(int k, int digit = kIndex) const {
    return state.segment[idx(segment_index(digit, k))].sent;
  }
  [[nodiscard]] const LocalWall& wall(int k, int digit = kIndex) const {
    return state.wall[idx(segment_index(digit, k))];
  }
  [[nodiscard]] double torque(int i, int digit = kIndex) const {
    return state.torque[idx(joint_index(digit, i))];
  }

  HapticParameters parameters;  ///< Hooke's law of 500 N/m at 200 Hz
  ForceState state;
  HandPoses hcp;
  bool stale = false;

 private:
  HandModel hand_ = simple_hand();
  SegmentTrees trees_ = make_segment_trees(hand_);
  ObjectModel object_{moved(make_box(Vec3(0.01, 0.01, 0.01), 12), at(10.0, 0.0, 0.0))};
  GdpState contacts_{ContactModel{hand_, trees_, object_, parameters.contact}};
};

}  // namespace phalanx::test

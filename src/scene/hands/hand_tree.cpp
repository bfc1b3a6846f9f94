// SPDX-License-Identifier: Apache-2.0
#include "scene/hands/hand_tree.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <utility>

#include "phalanx/core/index.h"

namespace phalanx {

namespace {

/// Hinges between a segment and the one before it.
class Chain {
 public:
  Chain(const HandParameters& hand, const DigitPose& zero, int digit, int k)
      : hand_(hand), zero_(zero), digit_(digit), S_(zero.segment[idx(k)]) {}

  void add_joint(int i) {
    const int joint = joint_index(digit_, i);
    add({.name = std::string(joint_name(joint)), .joint = joint}, axis_of_joint(i));
  }
  /// Adds a hinge that follows the digit's joint i. A ratio of 0 adds none.
  void add_coupled(std::string_view rotation, int axis, int i, double ratio) {
    if (ratio == 0.0) return;
    add({.name = fmt::format("{}_{}_by_{}", digit_name(digit_), rotation,
                             i == kAbductionJoint ? "abduction" : "flexion"),
         .joint = joint_index(digit_, i),
         .ratio = ratio,
         .coupled = true},
        axis);
  }
  /// @param parent  the frame before the first hinge, at angle 0
  [[nodiscard]] std::vector<Hinge> hinges(Pose parent) {
    centres_.back() = S_.p;  // a segment's origin is on its last axis: the D-H offset d runs along it
    for (std::size_t i = 0; i < hinges_.size(); ++i) {
      const Pose child{S_.R, centres_[i]};
      hinges_[i].X_parent_child = parent.inverse() * child;
      parent = child;
    }
    return hinges_;
  }

 private:
  void add(Hinge hinge, int axis) {
    const double a = hinge.ratio * hand_.min_angle[idx(hinge.joint)];
    const double b = hinge.ratio * hand_.max_angle[idx(hinge.joint)];
    hinge.min_angle = std::min(a, b);
    hinge.max_angle = std::max(a, b);
    hinge.axis_child = S_.R.transpose() * zero_.axis[idx(axis)].axis;
    centres_.push_back(zero_.axis[idx(axis)].centre);
    hinges_.push_back(std::move(hinge));
  }

  const HandParameters& hand_;
  const DigitPose& zero_;
  int digit_;
  Pose S_;  ///< of the segment at angle 0
  std::vector<Hinge> hinges_;
  std::vector<Vec3> centres_;
};

}  // namespace

HandTree hand_tree(const LoadedHand& hand) {
  const HandModel model(hand.parameters, hand.handedness, {}, hand.meshes.collision);
  HandPoses zero;
  model.poses(JointArray{}, zero);
  HandTree tree;
  for (int digit = 0; digit < kDigits; ++digit) {
    const DigitPose& pose = zero.digit[idx(digit)];
    const DigitCoupling& coupling = model.coupling(digit);
    for (int k = 0; k < kSegmentsPerDigit; ++k) {
      Chain chain(hand.parameters, pose, digit, k);
      if (k == 0) {
        chain.add_coupled("metacarpal", kMetacarpalAxis, 0, coupling.metacarpal_per_flexion);
        chain.add_joint(0);
      }
      chain.add_joint(k + 1);
      if (k == 0) {
        chain.add_coupled("pronation", kPronationAxis, 0, coupling.pronation_per_flexion);
        chain.add_coupled("pronation", kPronationAxis, kAbductionJoint, coupling.pronation_per_abduction);
      }
      tree.hinges[idx(segment_index(digit, k))] =
          chain.hinges(k == 0 ? model.palm_pose() : pose.segment[idx(k - 1)]);
    }
  }
  return tree;
}

std::string exact(double value) { return fmt::format("{:.17g}", value); }

std::string exact(const Vec3& v) { return exact(v.x()) + " " + exact(v.y()) + " " + exact(v.z()); }

}  // namespace phalanx

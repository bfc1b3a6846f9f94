// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>

#include "grasp/candidates.h"
#include "phalanx/core/constants.h"
#include "phalanx/core/index.h"

namespace phalanx {
namespace {

/// Ranges that a type's candidates are drawn from.
struct PalmRanges {
  bool along_axis;     ///< the object's axis lies across the palm; else the palm looks along a direction
  double least_reach;  ///< of the object's centre from the wrist, over that of the knuckles [-]
  double most_reach;
  double least_oblique;  ///< of the axis across the palm, its end on the thumb's side distal [rad]
  double most_oblique;
  double most_standoff;  ///< [m]
  double least_knuckle;  ///< share of its range of flexion that the MCP joint goes [-]
  double most_knuckle;
  double most_spread;  ///< of index, ring and little finger [rad]
};

PalmRanges ranges_of(GraspType type) {
  switch (type) {
    case GraspType::kHook:
      return {true, 1.2, 1.7, 0.0, 0.0, 0.0, 0.05, 0.5, 0.0};
    case GraspType::kSphere:
      return {false, 0.75, 1.3, 0.0, 0.0, 0.0, 0.5, 1.0, 12.0 * kDeg};
    case GraspType::kDisk:
      return {false, 0.85, 1.45, 0.0, 0.0, 40e-3, 0.4, 1.0, 15.0 * kDeg};
    default:
      return {true, 0.8, 1.2, 18.0 * kDeg, 48.0 * kDeg, 0.0, 0.4, 1.0, 0.0};
  }
}

constexpr double kReachOfHand = 0.1;    // out of the palm's plane [m]
constexpr double kHandBreadth = 80e-3;  // along a cylinder [m]

Vec3 direction(Random& random) {
  Vec3 v;
  do {
    v = Vec3(random.between(-1.0, 1.0), random.between(-1.0, 1.0), random.between(-1.0, 1.0));
  } while (!(v.squaredNorm() > 1e-4 && v.squaredNorm() <= 1.0));
  return v.normalized();
}

class PalmCandidates : public GraspCandidates {
 public:
  PalmCandidates(GraspType type, const HandModel& hand, const ObjectShape& shape)
      : type_(type),
        ranges_(ranges_of(type)),
        hand_(hand.parameters()),
        side_(hand.handedness() == Handedness::kRight ? 1.0 : -1.0),
        shape_(shape) {}

  std::optional<GraspCandidate> draw(Random& random) const override {
    GraspCandidate out;
    const double knuckles = -hand_.digits[2].base.z();
    const double reach = knuckles * random.between(ranges_.least_reach, ranges_.most_reach);
    const double oblique = random.between(ranges_.least_oblique, ranges_.most_oblique);
    // In the hand's frame: the direction out of the palm, and the axis across it towards the little finger.
    const Vec3 palmar = -Vec3::UnitY();
    const Vec3 across(side_ * std::cos(oblique), 0.0, std::sin(oblique));
    Mat3 in_hand;
    in_hand << across, palmar, across.cross(palmar);

    const ShapeAxis axis = drawn_axis(random);
    Vec3 first;
    Vec3 second;
    Vec3 target = shape_.centre;
    if (ranges_.along_axis) {
      first = (random.uniform() < 0.5 ? 1.0 : -1.0) * axis.axis;
      const double free = std::max(5e-3, axis.half - 0.5 * kHandBreadth);
      target += random.between(-free, free) * axis.axis;
      const double roll = random.between(0.0, 2.0 * std::numbers::pi);
      const Vec3 u = first.unitOrthogonal();
      second = std::cos(roll) * u + std::sin(roll) * first.cross(u);
    } else {
      second = type_ == GraspType::kDisk ? Vec3((random.uniform() < 0.5 ? 1.0 : -1.0) * axis.axis)
                                         : direction(random);
      const double roll = random.between(0.0, 2.0 * std::numbers::pi);
      const Vec3 u = second.unitOrthogonal();
      first = std::cos(roll) * u + std::sin(roll) * second.cross(u);
    }
    Mat3 in_world;
    in_world << first, second, first.cross(second);
    out.X_WH.R = in_world * in_hand.transpose();
    out.approach = second;
    if (type_ == GraspType::kCylinder) out.axis = first;
    if (type_ == GraspType::kDisk) out.axis = second;
    out.standoff = random.between(0.0, ranges_.most_standoff);
    out.X_WH.p = target - out.X_WH.R * Vec3(0.0, 0.0, -reach) - (shape_.radius + kReachOfHand) * second;
    out.close = closed(random);
    return out;
  }

 private:
  /// Draws the main axis of the type in half of all cases, another principal axis or a normal of the surface in the rest.
  ShapeAxis drawn_axis(Random& random) const {
    const double drawn = random.uniform();
    const std::size_t main = type_ == GraspType::kDisk ? 2 : 0;
    if (drawn >= 0.7 && !shape_.normal.empty()) {
      const double share = (drawn - 0.7) / 0.3;
      const auto count = shape_.normal.size();
      return shape_.normal[std::min(count - 1, static_cast<std::size_t>(share * static_cast<double>(count)))];
    }
    const std::size_t axis = drawn < 0.5 ? main : drawn < 0.6 ? 1 : 2 - main;
    return {shape_.axis[axis], shape_.half[axis]};
  }

  JointArray closed(Random& random) const {
    JointArray q = hand_.open_angle;
    const auto go = [&](int digit, int joint, double share) {
      const std::size_t j = idx(joint_index(digit, joint));
      q[j] = hand_.open_angle[j] + share * (hand_.max_angle[j] - hand_.open_angle[j]);
    };
    const double knuckle = random.between(ranges_.least_knuckle, ranges_.most_knuckle);
    const double middle = random.between(0.6, 1.0);
    const double tip = middle * random.between(0.4, 0.8);
    const double spread = random.between(0.0, ranges_.most_spread);
    for (int digit = 1; digit < kDigits; ++digit) {
      go(digit, 0, knuckle);
      go(digit, 2, middle);
      go(digit, 3, tip);
      const double share = digit == 2 ? 0.0 : digit == 3 ? 0.5 : 1.0;
      const std::size_t j = idx(joint_index(digit, kAbductionJoint));
      q[j] = std::min(hand_.max_angle[j], hand_.open_angle[j] + share * spread);
    }
    if (type_ == GraspType::kHook) return q;
    go(0, 0, random.between(0.1, 1.0));
    const std::size_t abduction = idx(joint_index(0, kAbductionJoint));
    q[abduction] = random.between(hand_.min_angle[abduction] * 0.8, hand_.max_angle[abduction] * 0.8);
    go(0, 2, random.between(0.2, 1.0));
    go(0, 3, random.between(0.2, 0.9));
    return q;
  }

  GraspType type_;
  PalmRanges ranges_;
  const HandParameters& hand_;
  double side_;
  const ObjectShape& shape_;
};

}  // namespace

std::unique_ptr<GraspCandidates> palm_candidates(GraspType type, const HandModel& hand,
                                                 const ObjectShape& shape) {
  return std::make_unique<PalmCandidates>(type, hand, shape);
}

}  // namespace phalanx

// SPDX-License-Identifier: Apache-2.0
#include "grasp/placed_hand.h"

#include <algorithm>

#include "contact/containment.h"
#include "phalanx/contact/proximity.h"
#include "phalanx/contact/segment_motion.h"
#include "phalanx/core/index.h"
#include "phalanx/step/displayed_hand.h"
#include "phalanx/step/haptic_step.h"

namespace phalanx {
namespace {

constexpr double kFar = 3e-3;            // a search is faster if it need not find a greater distance [m]
constexpr int kMostAdvances = 100;       // of a digit that closes
constexpr double kPalmarCosine = 0.3;    // least cosine between a contact and the palmar direction
constexpr double kAboveMargin = 0.6e-3;  // of a palm that touches [m]

/// @returns the contact of a segment at X_WS; empty if nothing is within `within`
std::optional<PlannedContact> contact_of(int segment, const PlacedSegment& placed, const ObjectModel& object,
                                         double within) {
  if (placed.tree.empty()) return std::nullopt;
  const ContactPatch patch = contact_patch(placed, object, within);
  if (patch.pairs == 0) return std::nullopt;
  return PlannedContact{.segment = segment,
                        .point = patch.on_object,
                        .normal = patch.direction,
                        .pad = is_palmar(placed.X_WS, patch.direction)};
}

}  // namespace

bool is_palmar(const Pose& X_WS, const Vec3& normal) { return X_WS.R.col(1).dot(normal) >= kPalmarCosine; }

double palm_gap(double margin) { return std::max(PlannedGrasp::kPalmGap, margin + kAboveMargin); }

std::optional<PlannedContact> palm_contact(const HandModel& hand, const SegmentTrees& trees,
                                           const ObjectModel& object, double margin) {
  SearchScratch scratch(trees);
  return contact_of(kPalm, {trees[kPalm], hand.palm_pose(), scratch}, object, palm_gap(margin));
}

SegmentPairs::SegmentPairs(const HandModel& hand, double margin) {
  const HapticModel model(hand, ObjectModel());
  const DisplayedHand shown(model, margin);
  for (int segment = 0; segment < kSegments; ++segment) {
    as_object_[idx(segment)] = ObjectTree(hand.mesh(segment));
    for (int other = segment + 1; other < kSegments; ++other)
      if (shown.keeps_apart(segment, other)) pairs_.emplace_back(segment, other);
  }
}

PlacedHand::PlacedHand(const HandModel& hand, const SegmentTrees& trees, const SegmentPairs& pairs,
                       const ObjectModel& object, double margin)
    : hand_(hand),
      trees_(trees),
      pairs_(pairs),
      object_(object),
      touching_(margin + kTouch),
      scratch_(trees) {}

std::array<Pose, kSegmentsPerDigit> PlacedHand::digit_poses(int digit, const DigitAngles& angle) const {
  DigitPose pose;
  hand_.digit_pose(digit, angle, pose);
  std::array<Pose, kSegmentsPerDigit> placed;
  for (std::size_t k = 0; k < placed.size(); ++k) placed[k] = X_WH_ * pose.segment[k];
  return placed;
}

Pose PlacedHand::pose_of(int segment, const JointArray& angle) const {
  if (segment == kPalm) return X_WH_;
  const int digit = digit_of_segment(segment);
  return digit_poses(digit, digit_angles(angle, digit))[idx(segment % kSegmentsPerDigit)];
}

double PlacedHand::distance_of(int segment, const Pose& X_WS, double cap) {
  const SegmentTree& tree = trees_[idx(segment)];
  if (tree.empty()) return cap;
  return distance({tree, X_WS, scratch_}, object_.tree(), cap);
}

double PlacedHand::palm_distance(double cap) { return distance_of(kPalm, X_WH_, cap); }

double PlacedHand::distance_without_thumb(const JointArray& angle, double cap) {
  double least = palm_distance(cap);
  for (int digit = 1; digit < kDigits; ++digit) {
    const auto pose = digit_poses(digit, digit_angles(angle, digit));
    for (int k = 0; k < kSegmentsPerDigit; ++k)
      least = std::min(least, distance_of(segment_index(digit, k), pose[idx(k)], least));
  }
  return least;
}

bool PlacedHand::is_clear(const JointArray& angle, double least) {
  std::array<Pose, kSegments> pose;
  for (int segment = 0; segment < kSegments; ++segment) {
    pose[idx(segment)] = pose_of(segment, angle);
    if (!(distance_of(segment, pose[idx(segment)], 2.0 * least) > least)) return false;
  }
  for (int segment = 0; segment < kSegments; ++segment)
    if (object_.containment().with(hand_.mesh(segment), pose[idx(segment)])) return false;
  return true;
}

bool PlacedHand::digits_are_apart(const JointArray& angle, double least) {
  std::array<Pose, kSegments> pose;
  for (int segment = 0; segment < kSegments; ++segment) pose[idx(segment)] = pose_of(segment, angle);
  return std::all_of(pairs_.pairs().begin(), pairs_.pairs().end(), [&](const auto& pair) {
    const auto [segment, other] = pair;
    const Pose X_OS = pose[idx(other)].inverse() * pose[idx(segment)];
    return distance({trees_[idx(segment)], X_OS, scratch_}, pairs_.as_object(other), 2.0 * least) >= least;
  });
}

ClosedDigit PlacedHand::close(int digit, const DigitAngles& from, const DigitAngles& to, bool wraps) {
  ClosedDigit out;
  out.angle = from;
  int fixed = 0;  // joints that do not move any more, from the palm on
  for (int advance = 0; advance < kMostAdvances && fixed < kJointsPerDigit; ++advance) {
    DigitAngles rate{};
    double left = 0.0;
    for (int i = fixed; i < kJointsPerDigit; ++i) {
      rate[idx(i)] = to[idx(i)] - out.angle[idx(i)];
      left = std::max(left, std::abs(rate[idx(i)]));
    }
    if (left < 1e-6) break;
    const auto pose = digit_poses(digit, out.angle);
    double step = 1.0;
    int touching = -1;
    for (int k = 0; k < kSegmentsPerDigit; ++k) {
      if (joints_that_move(k) <= fixed) continue;
      const double gap = distance_of(segment_index(digit, k), pose[idx(k)], touching_ + kFar) - touching_;
      if (gap < kTolerance) {
        touching = k;
        out.touches[idx(k)] = true;
        continue;
      }
      const double speed = segment_speed(hand_, digit, rate, k);
      if (speed > 0.0) step = std::min(step, gap / speed);
    }
    if (touching >= 0) {
      if (!wraps) break;
      fixed = joints_that_move(touching);
      continue;
    }
    for (int i = fixed; i < kJointsPerDigit; ++i) out.angle[idx(i)] += step * rate[idx(i)];
  }
  return out;
}

std::optional<PlannedContact> PlacedHand::contact(int segment, const JointArray& angle, double within) {
  return contact_of(segment, {trees_[idx(segment)], pose_of(segment, angle), scratch_}, object_, within);
}

}  // namespace phalanx

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "phalanx/contact/object_model.h"
#include "phalanx/contact/object_tree.h"
#include "phalanx/contact/segment_tree.h"
#include "phalanx/grasp/plan_grasp.h"
#include "phalanx/hand/hand_model.h"

namespace phalanx {

/// @returns true if the palmar side of a segment at X_WS looks against the normal of a contact, from object to segment
[[nodiscard]] bool is_palmar(const Pose& X_WS, const Vec3& normal);
/// Returns the distance up to which the palm counts as touching [m]: PlannedGrasp::kPalmGap, or the margin and 0.6 mm.
[[nodiscard]] double palm_gap(double margin);
/// Returns the contact of the palm where it is; empty if it is farther than palm_gap().
[[nodiscard]] std::optional<PlannedContact> palm_contact(const HandModel& hand, const SegmentTrees& trees,
                                                         const ObjectModel& object, double margin);

/// Where a digit that closes comes to rest.
struct ClosedDigit {
  DigitAngles angle{};  ///< [rad]
  /// Segments that touch.
  std::array<bool, kSegmentsPerDigit> touches{};

  [[nodiscard]] bool any() const noexcept { return touches[0] || touches[1] || touches[2]; }
};

/// Segments of a hand that must not meet: those that the displayed hand keeps apart.
class SegmentPairs {
 public:
  SegmentPairs(const HandModel& hand, double margin);

  /// Pairs of a segment of a digit, and a segment of another one or the palm.
  [[nodiscard]] const std::vector<std::pair<int, int>>& pairs() const { return pairs_; }
  /// Returns a segment as an object for others, in its own frame.
  [[nodiscard]] const ObjectTree& as_object(int segment) const {
    return as_object_[static_cast<std::size_t>(segment)];
  }

 private:
  std::array<ObjectTree, kSegments> as_object_;
  std::vector<std::pair<int, int>> pairs_;
};

/// A hand whose wrist can be anywhere beside an object: distances, and digits that close until they touch. One search at
/// a time.
class PlacedHand {
 public:
  /// @param hand    with its wrist at the world's origin; must outlive the object, as the others
  /// @param margin  of the contact search [m]
  PlacedHand(const HandModel& hand, const SegmentTrees& trees, const SegmentPairs& pairs,
             const ObjectModel& object, double margin);

  void put_wrist(const Pose& X_WH) { X_WH_ = X_WH; }
  [[nodiscard]] const Pose& wrist() const { return X_WH_; }
  /// Returns the pose of segment k of a digit at these angles, in the world.
  [[nodiscard]] std::array<Pose, kSegmentsPerDigit> digit_poses(int digit, const DigitAngles& angle) const;

  /// Returns the distance of the palm from the object, at most `cap` [m].
  [[nodiscard]] double palm_distance(double cap);
  /// Returns the least distance of palm and fingers from the object, without the thumb, at most `cap` [m].
  [[nodiscard]] double distance_without_thumb(const JointArray& angle, double cap);
  /// @returns true if all segments are farther than `least` from the object, and none is inside it
  [[nodiscard]] bool is_clear(const JointArray& angle, double least);

  /// @returns true if no segments of `pairs` are nearer to each other than `least`. It does not notice one inside another.
  [[nodiscard]] bool digits_are_apart(const JointArray& angle, double least);

  /// Closes a digit along the straight line in joint space, until a segment is at touching distance.
  /// @param from  clear of the object
  /// @param wraps  beyond a segment that touches, the joints go on
  [[nodiscard]] ClosedDigit close(int digit, const DigitAngles& from, const DigitAngles& to, bool wraps);

  /// Returns the contact of a segment (or the palm) that is at touching distance; empty if nothing is near.
  /// @param within  [m]
  [[nodiscard]] std::optional<PlannedContact> contact(int segment, const JointArray& angle, double within);

  [[nodiscard]] double touching_distance() const { return touching_; }

  static constexpr double kTouch = 0.3e-3;      ///< touching distance above the margin [m]
  static constexpr double kTolerance = 0.1e-3;  ///< of it [m]

 private:
  [[nodiscard]] double distance_of(int segment, const Pose& X_WS, double cap);
  [[nodiscard]] Pose pose_of(int segment, const JointArray& angle) const;

  const HandModel& hand_;
  const SegmentTrees& trees_;
  const SegmentPairs& pairs_;
  const ObjectModel& object_;
  double touching_;
  SearchScratch scratch_;
  Pose X_WH_;
};

}  // namespace phalanx

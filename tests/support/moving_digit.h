// SPDX-License-Identifier: Apache-2.0
// One finger before an object and its way through one tick, to hold the search for the first contact against
// all pairs of triangles at many places along it.
#pragma once

#include <algorithm>

#include "contact/first_contact.h"
#include "contact/pair_search.h"
#include "support/reference/exact_triangles.h"
#include "support/search_cases.h"
#include "support/simple_hand.h"

namespace phalanx::test {

inline constexpr double kMargin = 50e-6;

class MovingDigit {
 public:
  explicit MovingDigit(const TriangleMesh& object, bool with_coupling = false)
      : MovingDigit(object, object, with_coupling) {}
  /// @param once  the object without triangles that are there more than once: all that is measured
  MovingDigit(TriangleMesh object, const TriangleMesh& once, bool with_coupling = false)
      : hand_(make_hand_model(with_coupling ? coupled(simple_parameters()) : simple_parameters(),
                              Handedness::kRight, {}, 800)),
        trees_(make_segment_trees(hand_)),
        object_(std::move(object)),
        exact_object_(corners_of(once)),
        state_(model()) {}

  [[nodiscard]] ContactModel model() const { return {hand_, trees_, object_, parameters_}; }
  [[nodiscard]] const HandModel& hand() const { return hand_; }
  [[nodiscard]] const ObjectModel& object() const { return object_; }
  [[nodiscard]] GdpState& state() { return state_; }

  /// The way from `from` to `to`, all joints free.
  void aim(const DigitAngles& from, const DigitAngles& to) {
    to_ = to;
    path_.from = from;
    path_.end = to;
    for (std::size_t i = 0; i < kJointsPerDigit; ++i) path_.rate[i] = to[i] - from[i];
    for (Clearance& clearance : state_.clearance) clearance = {};
    for (ContactRecord& record : state_.record) record = {};
    for (NearPairs& near : state_.near) near.clear();
  }

  [[nodiscard]] DigitAngles angles(double s) const { return path_.at(s, to_, 0); }
  [[nodiscard]] DigitPose pose(double s) const {
    DigitPose out;
    hand_.digit_pose(kIndex, angles(s), out);
    return out;
  }

  /// Distance of the segment k at s, by all pairs, or twice the margin if that is less [m].
  [[nodiscard]] double gap(double s, int k) const {
    return placed_exactly(s, k).gap(exact_object_, 2.0 * kMargin);
  }
  [[nodiscard]] double gap(double s) const {
    double least = 2.0 * kMargin;
    for (int k = path_.first_moving(); k < kSegmentsPerDigit; ++k) least = std::min(least, gap(s, k));
    return least;
  }
  [[nodiscard]] std::vector<ExactPair> pairs_within(double s, int k, double limit) const {
    return placed_exactly(s, k).pairs_within(exact_object_, limit);
  }
  /// Of one triangle of the segment and one slot of the object's tree.
  [[nodiscard]] double pair_gap(double s, int k, const PairList::Pair& pair) const {
    Corners mine = tree(k).corners(pair.triangle);
    const DigitPose at = pose(s);
    for (Vec3& x : mine) x = at.segment[static_cast<std::size_t>(k)] * x;
    return exact_gap(exact(mine), exact(object_.tree().corners(pair.slot)));
  }

  /// The search's question for segment k at the pose `at`, which must outlive it.
  [[nodiscard]] PairSearch search(const DigitPose& at, int k) {
    return {{tree(k), at.segment[static_cast<std::size_t>(k)], state_.scratch},
            object_.tree(),
            segment_motion(hand_, kIndex, at, path_.rate, k),
            stop_band(kMargin)};
  }

  /// @param status  what the search said
  /// @param evaluations  that the digit has used up before
  Stop advance(Status& status, int evaluations = 0) {
    const DigitPose end = pose(1.0);
    DigitTick tick{.digit = kIndex,
                   .hcp_from = path_.from,
                   .hcp = to_,
                   .hcp_pose = end,
                   .angle = path_.from,
                   .pose = pose(0.0)};
    const Stop stop = first_contact(model(), path_, 0.0, evaluations, tick, state_);
    status = tick.status;
    return stop;
  }

 private:
  [[nodiscard]] const SegmentTree& tree(int k) const {
    return trees_[static_cast<std::size_t>(segment_index(kIndex, k))];
  }
  [[nodiscard]] ExactMesh placed_exactly(double s, int k) const {
    return ExactMesh(
        corners_of(hand_.mesh(segment_index(kIndex, k)), pose(s).segment[static_cast<std::size_t>(k)]));
  }

  HandModel hand_;
  SegmentTrees trees_;
  ObjectModel object_;
  ContactParameters parameters_{.margin = kMargin};
  ExactMesh exact_object_;
  GdpState state_;
  Path path_{};
  DigitAngles to_{};
};

/// Any angles of a finger that the simple hand can have, `reach` of the way from the open hand.
inline DigitAngles any_angles(Random& random, const HandModel& hand, double reach) {
  DigitAngles q{};
  for (int i = 0; i < kJointsPerDigit; ++i) {
    const auto j = static_cast<std::size_t>(joint_index(kIndex, i));
    const HandParameters& of = hand.parameters();
    q[static_cast<std::size_t>(i)] = reach * between(random, of.min_angle[j], of.max_angle[j]);
  }
  return q;
}

}  // namespace phalanx::test

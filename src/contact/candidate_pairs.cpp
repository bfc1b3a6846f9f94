// SPDX-License-Identifier: Apache-2.0
#include "phalanx/contact/candidate_pairs.h"

#include <numbers>

#include "contact/search/views.h"

namespace phalanx {
namespace {

/// Returns an upper bound on the distance between a point of the segment at both poses [m]: that of the centre of
/// its sphere, and the greatest turn about it. The norm of the difference of two rotations is sqrt(2) times the
/// length of the longest displacement of a unit vector.
double way_between(const SegmentTree& segment, const Pose& from, const Pose& to) noexcept {
  const Vec3 centre = segment.centre();
  const double turn = (to.R - from.R).norm() / std::numbers::sqrt2;
  return ((to * centre - from * centre).norm() + turn * segment.radius()) * (1.0 + 1e-9);
}

}  // namespace

bool CandidatePairs::cover(const PlacedSegment& segment, double reach) noexcept {
  if (complete_ < 0.0) return false;
  way_ += way_between(segment.tree, X_WS_, segment.X_WS);
  X_WS_ = segment.X_WS;
  return complete_ - way_ > reach;
}

void CandidatePairs::list(const PlacedSegment& segment, const ObjectTree& object, double reach) noexcept {
  if (cover(segment, reach)) return;
  if (pause_ > 0) {
    --pause_;
    return;
  }
  clear();
  if (pair_.empty() || reach > kMostReach || segment.tree.empty() || object.empty()) return;
  const auto sink = [](void* self, const search::PairIndex& pair, double bound) {
    auto& list = *static_cast<CandidatePairs*>(self);
    if (list.count_ < kMost) list.pair_[list.count_] = {pair.triangle, pair.slot, bound};
    return ++list.count_ <= kMost;
  };
  search::functions().list(search::view_of(segment, object), search::view_of(object), reach + kAhead, sink,
                           this);
  if (count_ > kMost) {
    clear();
    pause_ = kPause;
    return;
  }
  X_WS_ = segment.X_WS;
  way_ = 0.0;
  complete_ = reach + kAhead;
}

}  // namespace phalanx

// SPDX-License-Identifier: Apache-2.0
#include "phalanx/contact/candidate_pairs.h"

#include <algorithm>
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

double CandidatePairs::drop_half() noexcept {
  const auto end = pair_.begin() + static_cast<std::ptrdiff_t>(count_);
  std::transform(pair_.begin(), end, bound_.begin(), [](const Pair& pair) { return pair.touches; });
  const auto middle = bound_.begin() + static_cast<std::ptrdiff_t>(count_ / 2);
  std::nth_element(bound_.begin(), middle, bound_.begin() + static_cast<std::ptrdiff_t>(count_));
  const double least = *middle;
  const auto kept =
      std::remove_if(pair_.begin(), end, [&](const Pair& pair) { return pair.touches >= least; });
  count_ = static_cast<std::size_t>(kept - pair_.begin());
  return least;
}

void CandidatePairs::list(const PlacedSegment& segment, const ObjectTree& object, double reach) noexcept {
  if (cover(segment, reach)) return;
  if (pause_ > 0) {
    --pause_;
    return;
  }
  count_ = 0;
  complete_ = -1.0;
  if (pair_.empty() || reach > kMostReach || segment.tree.empty() || object.empty()) return;
  struct Listing {
    CandidatePairs& list;
    double reach;
    double cap;
  };
  Listing listing{*this, reach, reach + ahead_};
  const auto sink = [](void* context, const search::PairIndex& pair, double bound) {
    auto& [list, least, cap] = *static_cast<Listing*>(context);
    list.pair_[list.count_++] = {pair.triangle, pair.slot, bound};
    if (list.count_ < kMost) return cap;
    cap = list.drop_half() * (1.0 - 1e-9);
    if (!(cap > least)) cap = -1.0;
    return cap;
  };
  search::functions().list(search::view_of(segment, object), search::view_of(object), listing.cap, sink,
                           &listing);
  if (listing.cap < 0.0) {
    clear();
    pause_ = kPause;
    return;
  }
  X_WS_ = segment.X_WS;
  way_ = 0.0;
  complete_ = listing.cap;
  ahead_ = std::clamp(2.0 * (complete_ - reach), kAhead / 64.0, kAhead);
}

}  // namespace phalanx

// SPDX-License-Identifier: Apache-2.0
#include "contact/pair_search.h"

#include <algorithm>

#include "contact/search/views.h"

namespace phalanx {
namespace {

constexpr int kBatch = 64;

/// Pairs handed to the search's inner loop at once.
struct Batch {
  std::array<search::PairIndex, kBatch> pair;
  std::array<search::PairStep, kBatch> step;
  std::array<int, kBatch> at;  ///< indices in the list
  int count = 0;
};

/// Input of the inner loop for one segment at one pose.
struct Views {
  Views(const PairSearch& search, double s_now, double s_end) noexcept
      : segment(search::view_of(search.segment, search.object)),
        object(search::view_of(search.object)),
        motion(search::view_of(search.motion)),
        band(search.band),
        s(s_now),
        horizon(s_end) {}
  search::SegmentView segment;
  search::ObjectView object;
  search::MotionView motion;
  StopBand band;
  double s;
  double horizon;
};

/// Advances the batch and empties it.
/// @returns true if a pair of the batch is blocked
bool advance_batch(const Views& v, Batch& batch, PairList& list) noexcept {
  search::functions().advance(v.segment, v.object, v.motion, v.horizon - v.s, v.band.margin, v.band.floor,
                              batch.pair.data(), batch.count, batch.step.data());
  bool blocked = false;
  for (int i = 0; i < batch.count; ++i) {
    PairList::Pair& pair = list.pair[idx(batch.at[idx(i)])];
    const search::PairStep& step = batch.step[idx(i)];
    pair.until = v.s + step.step;
    pair.near = step.near;
    blocked = blocked || step.blocked;
  }
  batch.count = 0;
  return blocked;
}

bool evaluate_range(const Views& v, int begin, int end, double due, PairList& list) noexcept {
  Batch batch;
  bool blocked = false;
  for (int i = begin; i < end; ++i) {
    const PairList::Pair& pair = list.pair[idx(i)];
    if (pair.until > due) continue;
    batch.at[idx(batch.count)] = i;
    batch.pair[idx(batch.count++)] = {pair.triangle, pair.slot};
    if (batch.count == kBatch) blocked = advance_batch(v, batch, list) || blocked;
  }
  if (batch.count > 0) blocked = advance_batch(v, batch, list) || blocked;
  return blocked;
}

}  // namespace

double gather_pairs(const PairSearch& search, double s, double horizon, int k, PairList& list) noexcept {
  if (search.segment.tree.empty() || search.object.empty()) return horizon;
  // A buffer decouples the list from the inner loop.
  struct Context {
    const PairSearch& search;
    Views views;
    int k;
    PairList& list;
    search::PairStore store;
    std::array<search::PairIndex, 256> buffer;

    void flush() noexcept {
      for (int i = 0; i < store.count; ++i) {
        if (list.count - list.begin[idx(k)] == PairList::kMostOfASegment) thin_out();
        list.pair[idx(list.count++)] = {buffer[idx(i)].triangle, buffer[idx(i)].slot, views.s, true};
      }
      store.count = 0;
    }

    /// Drops pairs of this segment that cannot be met before the horizon. If too many remain, drops those
    /// that are safe for longest and brings the horizon nearer.
    void thin_out() noexcept {
      const auto begin = list.pair.begin() + list.begin[idx(k)];
      (void)evaluate_range(views, list.begin[idx(k)], list.count, views.s, list);
      const double end = views.horizon;
      auto kept = std::remove_if(begin, list.pair.begin() + list.count,
                                 [&](const PairList::Pair& pair) { return pair.until >= end && !pair.near; });
      if (kept - begin > PairList::kMostOfASegment / 2) {
        const auto half = begin + (kept - begin) / 2;
        std::nth_element(begin, half, kept, [](const PairList::Pair& a, const PairList::Pair& b) {
          if (a.until != b.until) return a.until < b.until;
          return a.triangle != b.triangle ? a.triangle < b.triangle : a.slot < b.slot;
        });
        views.horizon = std::min(views.horizon, half->until);
        // A dropped pair may be within the margin at the old horizon. So the list's horizon must be below it.
        if (!(views.horizon < end)) views.horizon = views.s + 0.5 * (end - views.s);
        store.horizon = views.horizon - views.s;
        kept = half;
      }
      list.count = static_cast<int>(kept - list.pair.begin());
    }
  };
  Context context{search, Views(search, s, horizon), k, list, {}, {}};
  context.store = {context.buffer.data(),
                   0,
                   static_cast<int>(context.buffer.size()),
                   horizon - s,
                   [](void* self) { static_cast<Context*>(self)->flush(); },
                   &context};
  search::functions().gather(context.views.segment, context.views.object, context.views.motion,
                             search.band.margin, context.store);
  context.flush();
  return context.views.horizon;
}

void gather_candidates(const PairSearch& search, double s, double horizon, double reach,
                       CandidatePairs& candidates, PairList& list) noexcept {
  const Views v(search, s, horizon);
  std::array<search::PairIndex, kBatch> pair;
  int n = 0;
  const auto sift = [&] {
    n = search::functions().sift(v.segment, v.object, v.motion, horizon - s, v.band.margin, pair.data(), n);
    for (int i = 0; i < n; ++i)
      list.pair[idx(list.count++)] = {pair[idx(i)].triangle, pair[idx(i)].slot, s, true};
    n = 0;
  };
  candidates.for_each(reach, [&](const CandidatePairs::Pair& candidate) {
    pair[idx(n++)] = {candidate.triangle, candidate.slot};
    if (n == kBatch) sift();
  });
  sift();
}

bool evaluate_pairs(const PairSearch& search, double s, double horizon, int k, bool all,
                    PairList& list) noexcept {
  // Pairs that are due soon are evaluated now, because a pose costs more than a pair.
  const double due = all ? 1e300 : s + (horizon - s) / 16.0;
  return evaluate_range(Views(search, s, horizon), list.begin[idx(k)], list.begin[idx(k + 1)], due, list);
}

bool is_blocked(const PairSearch& search, const NearPairs& near) noexcept {
  // Whether a pair blocks does not depend on the horizon.
  const Views v(search, 0.0, 1.0);
  std::array<search::PairIndex, kBatch> pair;
  std::array<search::PairStep, kBatch> step;
  for (std::size_t first = 0; first < near.count(); first += kBatch) {
    const std::size_t n = std::min<std::size_t>(kBatch, near.count() - first);
    for (std::size_t i = 0; i < n; ++i) pair[i] = {near[first + i].triangle, near[first + i].slot};
    search::functions().advance(v.segment, v.object, v.motion, v.horizon, v.band.margin, v.band.floor,
                                pair.data(), static_cast<int>(n), step.data());
    if (std::any_of(step.begin(), step.begin() + n, [](const search::PairStep& s) { return s.blocked; }))
      return true;
  }
  return false;
}

double least_until(const PairList& list) noexcept {
  double least = 1e300;
  for (int i = 0; i < list.count; ++i) least = std::min(least, list.pair[idx(i)].until);
  return least;
}

bool any_near(const PairList& list) noexcept {
  return std::any_of(list.pair.begin(), list.pair.begin() + list.count,
                     [](const PairList::Pair& pair) { return pair.near; });
}

}  // namespace phalanx

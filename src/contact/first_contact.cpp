// SPDX-License-Identifier: Apache-2.0
#include "contact/first_contact.h"

#include <algorithm>
#include <cmath>

#include "contact/pair_search.h"

namespace phalanx {

DigitAngles Path::at(double s, const DigitAngles& now, int fixed) const noexcept {
  DigitAngles q = now;
  for (int i = fixed; i < kJointsPerDigit; ++i)
    q[idx(i)] = s >= 1.0 ? end[idx(i)] : from[idx(i)] + s * rate[idx(i)];
  return q;
}

int Path::first_moving() const noexcept {
  for (int i = 0; i < kJointsPerDigit; ++i) {
    if (rate[idx(i)] != 0.0) return segment_in_digit_of_joint(i);
  }
  return kSegmentsPerDigit;
}

namespace {

/// Distance that a segment may move before its pairs are listed again [m]. It keeps the list short, however
/// far the hand has jumped.
constexpr double kLongestReach = 2.5e-3;

/// Search for the first stop of one digit along its path.
class Search {
 public:
  Search(const ContactModel& model, const Path& path, double s, DigitTick& tick, GdpState& state) noexcept
      : model_(model), path_(path), tick_(tick), state_(state), first_(path.first_moving()), s_(s) {
    for (int k = first_; k < kSegmentsPerDigit; ++k)
      speed_[idx(k)] = segment_speed(model.hand, tick.digit, path.rate, k);
  }

  Stop run(int& evaluations) noexcept {
    if (path_.near_known) start_from_near();
    if (const int blocked = path_.near_known ? -1 : still_blocked(); blocked >= 0) {
      // As gather() does: the bounds of later ticks are then the same.
      (void)find_clear(first_horizon());
      return {s_, blocked};
    }
    while (evaluations < kMaxEvaluations) {
      const double horizon = gather();
      const bool crowded = s_ < 1.0 && !(horizon > s_);  // too many pairs to list at s
      for (bool reached = false; !reached && evaluations < kMaxEvaluations; ++evaluations) {
        const int blocked = evaluate(horizon);
        if (blocked >= 0) return stopped_by(blocked);
        if (crowded) return exhausted();
        const double next = std::min(horizon, least_until(state_.pairs));
        reached = s_ >= horizon || (next >= horizon && !any_near(state_.pairs));
        if (!reached && !(next > s_)) return exhausted();  // a step below the resolution of s
        move_to(next);
        if (reached && s_ >= 1.0) return {};
      }
    }
    return exhausted();
  }

 private:
  Stop exhausted() noexcept {
    tick_.status |= Status::kSearchExhausted;
    return {s_, kSegmentsPerDigit - 1};
  }

  [[nodiscard]] PlacedSegment placed(int k) noexcept {
    return {model_.trees[idx(segment_index(tick_.digit, k))], tick_.pose.segment[idx(k)], state_.scratch};
  }
  [[nodiscard]] Clearance& clearance(int k) noexcept {
    return state_.clearance[idx(segment_index(tick_.digit, k))];
  }
  [[nodiscard]] SegmentMotion motion(int k) const noexcept {
    return segment_motion(model_.hand, tick_.digit, tick_.pose, path_.rate, k);
  }

  [[nodiscard]] NearPairs& near(int k) noexcept { return state_.near[idx(segment_index(tick_.digit, k))]; }

  Stop stopped_by(int blocked) noexcept {
    for (int k = first_; k < kSegmentsPerDigit; ++k)
      if (!has_room(k)) near(k).stop_at(tick_.pose.segment[idx(k)]);
    return {s_, blocked};
  }
  /// @returns true if the segment is known to be farther than the margin from the object
  [[nodiscard]] bool has_room(int k) noexcept { return clearance(k).bound() > model_.parameters.margin; }

  /// Asks whether a segment that has not moved since it last stopped is blocked again. Then what the digit may
  /// meet farther on need not be listed.
  /// @returns the most distal blocked segment, as evaluate() finds it; -1 if none is known to be blocked
  int still_blocked() noexcept {
    const double reach = std::nextafter(model_.parameters.margin, 1.0) + kPatchBand;
    int blocked = -1;
    for (int k = first_; k < kSegmentsPerDigit; ++k) {
      const Pose& X_WS = tick_.pose.segment[idx(k)];
      if (has_room(k) || (blocked < 0 && !near(k).is_at(X_WS))) continue;
      if (near(k).is_at(X_WS) && near(k).overflows()) return -1;
      const PairSearch search{placed(k), model_.object.tree(), motion(k),
                              stop_band(model_.parameters.margin)};
      near(k).find(search.segment, search.object, reach);
      if (near(k).overflows()) return -1;
      if (is_blocked(search, near(k))) blocked = k;
    }
    return blocked;
  }
  /// Takes the bounds of the segments from their near pairs.
  void start_from_near() noexcept {
    for (int k = first_; k < kSegmentsPerDigit; ++k)
      clearance(k).learn(near(k).bound(tick_.pose.segment[idx(k)]), true);
  }
  /// Returns the distance within which segment k may meet pairs before s reaches the horizon [m].
  [[nodiscard]] double reach(int k, double horizon) const noexcept {
    return model_.parameters.margin + speed_[idx(k)] * (horizon - s_);
  }
  /// @returns true if the near pairs of segment k are all that it may meet before s reaches the horizon
  [[nodiscard]] bool near_suffices(int k, double horizon) noexcept {
    return path_.near_known && near(k).holds(tick_.pose.segment[idx(k)], reach(k, horizon));
  }
  /// @returns true if segment k need not be searched before s reaches the horizon
  [[nodiscard]] bool is_listed(int k, double horizon) noexcept {
    return near_suffices(k, horizon) || near(k).candidates().cover(placed(k), reach(k, horizon));
  }
  /// Lists the pairs of segment k that may be met before s reaches the horizon.
  /// @returns the horizon up to which they are complete
  double list_pairs(int k, double horizon) noexcept {
    PairList& list = state_.pairs;
    if (near_suffices(k, horizon)) {
      for (std::size_t i = 0; i < near(k).count(); ++i)
        list.pair[idx(list.count++)] = {near(k)[i].triangle, near(k)[i].slot, s_, true};
      return horizon;
    }
    const PairSearch search{placed(k), model_.object.tree(), motion(k), stop_band(model_.parameters.margin)};
    CandidatePairs& candidates = near(k).candidates();
    if (model_.parameters.mode == ContactMode::kSliding)
      candidates.list(search.segment, search.object, reach(k, horizon));
    if (!candidates.cover(search.segment, reach(k, horizon)))
      return gather_pairs(search, s_, horizon, k, list);
    gather_candidates(search, s_, horizon, reach(k, horizon), candidates, list);
    return horizon;
  }
  /// Tells which segments need no search up to the horizon, and refreshes their bounds.
  std::array<bool, kSegmentsPerDigit> find_clear(double horizon) noexcept {
    std::array<bool, kSegmentsPerDigit> clear{};
    for (int k = first_; k < kSegmentsPerDigit; ++k) clear[idx(k)] = is_clear(k, horizon);
    return clear;
  }
  [[nodiscard]] double first_horizon() noexcept {
    return std::min(1.0, s_ + std::max(kLongestReach / speed_.back(), known_to_be_clear()));
  }

  /// Lists the pairs that may be met before s reaches the horizon.
  /// @returns the horizon: 1, or less if the way is long or too many pairs are near
  double gather() noexcept {
    PairList& list = state_.pairs;
    list.count = 0;
    list.begin = {};
    double horizon = first_horizon();
    const std::array<bool, kSegmentsPerDigit> clear = find_clear(horizon);
    for (int k = first_; k < kSegmentsPerDigit; ++k) {
      if (!clear[idx(k)]) horizon = list_pairs(k, horizon);
      for (int later = k + 1; later <= kSegmentsPerDigit; ++later) list.begin[idx(later)] = list.count;
    }
    return horizon;
  }

  /// Returns how much s may grow while the known clearances guarantee that no segment comes
  /// within the margin.
  [[nodiscard]] double known_to_be_clear() noexcept {
    double least = 1.0;
    for (int k = first_; k < kSegmentsPerDigit; ++k) {
      const double gap = clearance(k).bound() - model_.parameters.margin;
      least = std::min(least, std::max(0.0, gap) / speed_[idx(k)] * (1.0 - 1e-9));
    }
    return least;
  }

  /// @returns true if the known clearance of a segment, or a new bound that is computed quickly, makes
  /// the search unnecessary
  bool is_clear(int k, double horizon) noexcept {
    constexpr double kTicks = 16.0;         // ticks at this speed that a new bound should last
    constexpr double kLeastAhead = 0.3e-3;  // least distance that it should cover [m]
    constexpr double kMostAhead = 4e-3;     // greatest, but at least twice the required one [m]
    const double margin = model_.parameters.margin;
    const double way = speed_[idx(k)] * (horizon - s_);
    Clearance& known = clearance(k);
    if (known.bound() > margin + way) return true;
    // Where a segment has candidates it is near: a new list of them is worth more than a bound.
    if (is_listed(k, horizon) || !near(k).candidates().empty()) return false;
    if (!known.worth_asking()) return false;
    if (near(k).is_within(tick_.pose.segment[idx(k)], margin)) {  // no bound can exceed the margin
      known.learn(0.0, false);
      return false;
    }
    const double ahead = margin + std::max({std::min(kTicks * way, kMostAhead), 2.0 * way, kLeastAhead});
    const double bound = distance_bound(placed(k), model_.object.tree(), ahead);
    known.learn(bound, bound > margin + way);
    return bound > margin + way;
  }

  /// Evaluates the pairs that are due at s.
  /// @returns the most distal blocked segment, or -1
  int evaluate(double horizon) noexcept {
    int blocked = -1;
    for (int k = first_; k < kSegmentsPerDigit; ++k) {
      // A pair that is not due may be within the margin too. So beyond a blocked segment all
      // pairs are evaluated.
      const bool all = blocked >= 0 || s_ >= horizon;
      if (state_.pairs.begin[idx(k)] == state_.pairs.begin[idx(k + 1)]) continue;
      const PairSearch search{placed(k), model_.object.tree(), motion(k),
                              stop_band(model_.parameters.margin)};
      if (evaluate_pairs(search, s_, horizon, k, all, state_.pairs)) blocked = k;
    }
    return blocked;
  }

  void move_to(double s) noexcept {
    if (!(s > s_)) return;
    for (int k = first_; k < kSegmentsPerDigit; ++k) {
      clearance(k).spend(speed_[idx(k)] * (s - s_));
      record_of(state_, tick_, k).active = false;  // the segment has moved
    }
    s_ = s;
    tick_.angle = path_.at(s, tick_.angle, tick_.fixed);
    if (tick_.angle == tick_.hcp) {
      tick_.pose = tick_.hcp_pose;
    } else {
      model_.hand.digit_pose(tick_.digit, tick_.angle, tick_.pose);
    }
  }

  const ContactModel& model_;
  const Path& path_;
  DigitTick& tick_;
  GdpState& state_;
  const int first_;
  double s_;
  std::array<double, kSegmentsPerDigit> speed_{};
};

}  // namespace

Stop first_contact(const ContactModel& model, const Path& path, double s, int& evaluations, DigitTick& tick,
                   GdpState& state) noexcept {
  return Search(model, path, s, tick, state).run(evaluations);
}

}  // namespace phalanx

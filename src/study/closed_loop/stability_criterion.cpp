// SPDX-License-Identifier: Apache-2.0
#include "phalanx/study/closed_loop/stability_criterion.h"

#include <algorithm>

namespace phalanx {
namespace {

constexpr std::size_t idx(int i) noexcept { return static_cast<std::size_t>(i); }

/// What may act in a trial beside the stabiliser that is studied: nothing.
constexpr Status kLimiters =
    Status::kForceLimited | Status::kTorqueLimited | Status::kTorqueRateLimited | Status::kSampleJump;

std::string limiters_in(Status status) {
  std::string names;
  for (int bit = 0; bit < kStatusBits; ++bit) {
    const auto one = static_cast<Status>(1U << static_cast<unsigned>(bit));
    if (!has(status, one) || !has(kLimiters, one)) continue;
    names += (names.empty() ? "" : ", ") + std::string(status_name(bit));
  }
  return names;
}

}  // namespace

void TrialObserver::Range::add(double value) noexcept {
  low = any ? std::min(low, value) : value;
  high = any ? std::max(high, value) : value;
  any = true;
}

TrialObserver::TrialObserver(const PressPlan& plan, const TrialSchedule& schedule,
                             const StabilityCriterion& criterion)
    : plan_(plan), schedule_(schedule), criterion_(criterion) {}

void TrialObserver::watch_window(const Snapshot& snapshot) {
  ++window_ticks_;
  for (std::size_t s = 0; s < watched_.size(); ++s) {
    const SegmentSnapshot& contact = snapshot.segment[s];
    Watched& watched = watched_[s];
    if (!watched.seen) {
      if (!contact.contact && contact.force == 0.0) continue;
      watched.seen = true;
      watched.p_S = snapshot.gdp_pose[s].inverse() * contact.point;
      watched.normal = contact.normal;
      if (window_ticks_ > 1) watched.force.add(0.0);  // it was not there at the window's beginning
    }
    watched.force.add(contact.force);
    watched.position.add(watched.normal.dot(snapshot.hcp_pose[s] * watched.p_S));
    watched.force_sum += contact.force;
    watched.depth_sum += contact.depth;
  }
}

void TrialObserver::watch_ghost(double t, const Snapshot& snapshot) {
  for (std::size_t d = 0; d < ghost_.size(); ++d) {
    if (!plan_.digit[d]) continue;
    const DigitPress& press = *plan_.digit[d];
    Ghost& ghost = ghost_[d];
    const auto s = idx(press.segment);
    const double x = press.normal.dot(snapshot.hcp_pose[s] * press.p_S - press.point);  // above the wall
    double force = 0.0;
    bool inside = false;
    for (int k = 0; k < kSegmentsPerDigit; ++k) {
      const SegmentSnapshot& segment = snapshot.segment[idx(segment_index(static_cast<int>(d), k))];
      force += segment.force;
      inside = inside || segment.depth > 0.0;
    }
    if (inside) {
      ghost = {.pressed = true, .left = false, .left_at = t, .ended_at = t, .before = x, .energy = 0.0};
    } else if (ghost.pressed && force > criterion_.ghost_force) {
      ghost.left = true;
      ghost.ended_at = t;
      ghost.energy += force * (x - ghost.before);
    }
    ghost.before = x;
  }
}

void TrialObserver::add(double t, const Snapshot& snapshot) {
  for (const SegmentSnapshot& segment : snapshot.segment) peak_depth_ = std::max(peak_depth_, segment.depth);
  if (t < schedule_.release) limited_ |= snapshot.status;
  if (t >= schedule_.window_begin && t < schedule_.window_end) watch_window(snapshot);
  if (t >= schedule_.release) watch_ghost(t, snapshot);
}

std::size_t TrialObserver::pressing_segment() const noexcept {
  std::size_t best = 0;
  for (std::size_t s = 1; s < watched_.size(); ++s)
    if (watched_[s].force_sum > watched_[best].force_sum) best = s;
  return best;
}

TrialResult TrialObserver::result() const {
  TrialResult result;
  bool touched = false;
  for (const Watched& watched : watched_) {
    if (!watched.seen) continue;
    touched = true;
    result.force_swing = std::max(result.force_swing, watched.force.swing());
    result.position_swing = std::max(result.position_swing, watched.position.swing());
  }
  result.stable = touched && result.force_swing <= criterion_.force_swing &&
                  result.position_swing <= criterion_.position_swing;
  const std::string limiters = limiters_in(limited_);
  if (!touched) result.why_invalid = "no contact in the window";
  if (!limiters.empty()) result.why_invalid = limiters;
  result.valid = result.why_invalid.empty();
  result.peak_depth = peak_depth_;
  if (window_ticks_ > 0) {
    const Watched& pressing = watched_[pressing_segment()];
    result.mean_force = pressing.force_sum / window_ticks_;
    result.mean_depth = pressing.depth_sum / window_ticks_;
  }
  for (const Ghost& ghost : ghost_) {
    if (!ghost.left) continue;
    result.ghost_s = std::max(result.ghost_s, ghost.ended_at - ghost.left_at);
    result.ghost_energy = std::max(result.ghost_energy, ghost.energy);
  }
  return result;
}

}  // namespace phalanx

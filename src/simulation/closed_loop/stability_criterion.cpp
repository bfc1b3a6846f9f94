// SPDX-License-Identifier: Apache-2.0
#include "phalanx/simulation/closed_loop/stability_criterion.h"

#include <algorithm>
#include <cmath>

#include "phalanx/core/index.h"

namespace phalanx {
namespace {

/// Limiters that make a trial invalid: only the studied stabiliser may act.
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

/// @returns the force along the press that corresponds to the torques: the f whose torques g f are nearest
/// to them [N].
double force_of(const DigitPress& press, const JointArray& torque) noexcept {
  double along = 0.0;
  double size = 0.0;
  for (std::size_t j = 0; j < torque.size(); ++j) {
    along += press.g[j] * torque[j];
    size += press.g[j] * press.g[j];
  }
  return along / size;
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
      if (window_ticks_ > 1) watched.force.add(0.0);  // the contact was not there at the window's beginning
    }
    watched.force.add(contact.force);
    watched.position.add(watched.normal.dot(snapshot.hcp_pose[s] * watched.p_S));
    watched.force_sum += contact.force;
    watched.depth_sum += contact.depth;
  }
}

void TrialObserver::watch_ghost(double t, const Snapshot& snapshot, const JointArray& rendered) {
  for (std::size_t d = 0; d < ghost_.size(); ++d) {
    if (!plan_.digit[d]) continue;
    const DigitPress& press = *plan_.digit[d];
    Ghost& ghost = ghost_[d];
    const auto s = idx(press.segment);
    const double x = press.normal.dot(snapshot.hcp_pose[s] * press.p_S - press.point);  // above the wall
    const double force = force_of(press, rendered);
    bool inside = false;
    for (int k = 0; k < kSegmentsPerDigit; ++k)
      inside = inside || snapshot.segment[idx(segment_index(static_cast<int>(d), k))].depth > 0.0;
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

void TrialObserver::add(double t, const Snapshot& snapshot, const JointArray& rendered,
                        const JointArray& unrendered) {
  for (const SegmentSnapshot& segment : snapshot.segment) peak_depth_ = std::max(peak_depth_, segment.depth);
  if (t < schedule_.release) {
    limited_ |= snapshot.status;
    halved_ = halved_ || snapshot.stiffness_factor < 1.0;
  }
  if (t >= schedule_.window_begin && t < schedule_.window_end) {
    watch_window(snapshot);
    for (std::size_t d = 0; d < kDigits; ++d)
      if (plan_.digit[d]) unrendered_sum_[d] += std::abs(force_of(*plan_.digit[d], unrendered));
  }
  if (t >= schedule_.release) watch_ghost(t, snapshot, rendered);
}

void TrialObserver::expect(const PressIntent& intent) {
  for (int digit = 0; digit < kDigits; ++digit) meant_[idx(digit)] = intent.force(digit);
  arrival_ = intent.arrival();
}

/// @returns the segment with the largest mean force among the digits that press.
std::size_t TrialObserver::pressing_segment() const noexcept {
  std::size_t best = 0;
  double most = -1.0;
  for (std::size_t s = 0; s < kPalm; ++s) {
    if (!plan_.digit[s / kSegmentsPerDigit] || watched_[s].force_sum <= most) continue;
    most = watched_[s].force_sum;
    best = s;
  }
  return best;
}

/// @returns why the trial proves nothing; empty if it is valid.
std::string TrialObserver::why_invalid(bool touched, bool swings) const {
  if (!touched) return "no contact in the window";
  if (arrival_ > schedule_.window_begin - criterion_.rest) return "the finger was still on its way";
  const std::string limiters = limiters_in(limited_);
  if (!limiters.empty()) return limiters;
  if (halved_) return "stiffness halved";
  const std::size_t pressing = pressing_segment();
  const double mean = watched_[pressing].force_sum / window_ticks_;
  if (!swings && mean < criterion_.least_press * meant_[pressing / kSegmentsPerDigit])
    return "the finger hardly presses";
  const std::size_t digit = pressing / kSegmentsPerDigit;
  if (!swings && unrendered_sum_[digit] / window_ticks_ > criterion_.most_unrendered * meant_[digit] &&
      meant_[digit] > 0.0)
    return "the motors render less than is sent";
  return "";
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
  result.stable =
      result.force_swing <= criterion_.force_swing && result.position_swing <= criterion_.position_swing;
  result.why_invalid = why_invalid(touched, !result.stable);
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

// SPDX-License-Identifier: Apache-2.0
#include "phalanx/record/summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

namespace phalanx {
namespace {

std::uint64_t ticks_with(const Summary& summary, Status bit) {
  return summary.status_ticks[static_cast<std::size_t>(std::countr_zero(static_cast<std::uint32_t>(bit)))];
}

std::string ticks_text(std::uint64_t ticks) { return fmt::format("{} tick{}", ticks, ticks == 1 ? "" : "s"); }

/// Lists the digits: "index (812 ticks), ring (3 ticks)".
std::string silent_digits(const Summary& summary) {
  std::string text;
  for (int digit = 0; digit < kDigits; ++digit) {
    const std::uint64_t ticks = summary.inside_ticks[static_cast<std::size_t>(digit)];
    if (ticks > 0)
      text += fmt::format("{}{} ({})", text.empty() ? "" : ", ", digit_name(digit), ticks_text(ticks));
  }
  return text;
}

}  // namespace

double total_force(const Snapshot& snapshot) {
  double total = 0.0;
  for (const SegmentSnapshot& segment : snapshot.segment) total += segment.force;
  return total;
}

void add_tick(Summary& summary, const Snapshot& snapshot) {
  ++summary.ticks;
  summary.angle_origin = snapshot.angle_origin;
  for (std::size_t s = 0; s < snapshot.segment.size(); ++s) {
    const SegmentSnapshot& segment = snapshot.segment[s];
    if (segment.contact) ++summary.contact_ticks[s];
    summary.peak_force[s] = std::max(summary.peak_force[s], segment.force);
    summary.peak_depth[s] = std::max(summary.peak_depth[s], segment.depth);
    summary.largest_slid = std::max(summary.largest_slid, segment.slid);
  }
  for (std::size_t d = 0; d < summary.inside_ticks.size(); ++d)
    if (snapshot.opening[d].phase != OpeningPhase::kNone) ++summary.inside_ticks[d];
  for (std::size_t j = 0; j < snapshot.torque.size(); ++j) {
    summary.peak_torque[j] = std::max(summary.peak_torque[j], std::abs(snapshot.torque[j]));
  }
  if (const double total = total_force(snapshot); total > summary.peak_total_force) {
    summary.peak_total_force = total;
    summary.peak_total_force_time_s = snapshot.time_s;
  }
  for (int bit = 0; bit < kStatusBits; ++bit) {
    if (has(snapshot.status, static_cast<Status>(1U << bit)))
      ++summary.status_ticks[static_cast<std::size_t>(bit)];
  }
}

std::array<LimiterActivity, 4> limiters(const Summary& summary) {
  return {{{"fingertip_force", "limits.fingertip_force_n", ticks_with(summary, Status::kForceLimited)},
           {"joint_torque", "limits.joint_torque_nm", ticks_with(summary, Status::kTorqueLimited)},
           {"torque_rate", "limits.torque_rate_nm_per_s", ticks_with(summary, Status::kTorqueRateLimited)},
           {"joint_speed", "limits.joint_speed_rad_per_s", ticks_with(summary, Status::kSampleJump)}}};
}

std::vector<std::string> warnings(const Summary& summary) {
  std::vector<std::string> sentences;
  const auto warn = [&](Status bit, const std::string& sentence) {
    if (const std::uint64_t ticks = ticks_with(summary, bit)) {
      sentences.push_back(fmt::format("{}: {}", ticks_text(ticks), sentence));
    }
  };
  warn(Status::kSampleNotFinite, "a measured angle was not a finite number; its last good value was used");
  warn(Status::kSampleOutOfRange,
       "a measured angle was outside the hand's range of motion and was clamped to it");
  warn(Status::kSampleJump,
       "a measured angle moved faster than limits.joint_speed_rad_per_s and was slewed at that speed");
  warn(Status::kTimeNotIncreasing, "a sample's time did not increase; its angles were not used");
  warn(Status::kSampleStale,
       "no sample had been wholly good for 50 ms; forces decay to zero until one comes");
  warn(
      Status::kStartInside,
      fmt::format(
          "{} started inside the object and gives no force until it has once been clear; lead a recording in "
          "from the open hand (motion.lead_in_s = 1), or move the object",
          silent_digits(summary)));
  warn(Status::kOscillating,
       "the force of a segment oscillated; lower force.stiffness_n_per_mm, or choose another "
       "stabiliser.method");
  warn(Status::kSlid,
       fmt::format(
           "a contact slid, up to {:.1f} mm beside its contact point: static grasping, which the forces "
           "assume, no longer holds there",
           1e3 * summary.largest_slid));
  warn(Status::kSearchExhausted,
       "the contact search ran out of iterations and stopped a digit early, without penetration");
  warn(Status::kCommandNotFinite, "a joint torque came out not finite and was set to zero");
  warn(Status::kTrajectoryExhausted,
       "gdp.method \"trajectory\" found no free pose among the recorded angles; the shown hand held");
  sentences.insert(sentences.end(), summary.notes.begin(), summary.notes.end());
  return sentences;
}

}  // namespace phalanx

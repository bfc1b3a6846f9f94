// SPDX-License-Identifier: Apache-2.0
#include "phalanx/simulation/press_cycle.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace phalanx {
namespace {

/// Time before the end of a squeeze over which the tremor is blended to that of the next squeeze [s].
constexpr double kSeam = 0.25;

void refuse_unfinished(const PressPlan& plan, const PatientParameters& patient, const HandParameters& hand,
                       double wall, double press, std::uint64_t seed, const TrialSchedule& schedule) {
  PatientParameters steady = patient;
  steady.tremor = 0.0;
  const PressIntent intent(plan, steady, hand, wall, press, seed, schedule);
  const JointArray begin = intent.angle(0.0);
  const JointArray end = intent.angle(schedule.end - kSeam);
  for (std::size_t j = 0; j < begin.size(); ++j) {
    if (std::abs(end[j] - begin[j]) <= 1e-9) continue;
    throw std::invalid_argument(fmt::format(
        "a squeeze of {:.6g} s: the patient's {} is not back at its start {:.6g} s before the end; let go "
        "earlier or faster, or make the squeeze longer",
        schedule.end, joint_name(static_cast<int>(j)), kSeam));
  }
}

}  // namespace

PressCycle::PressCycle(const PressPlan& plan, const PatientParameters& patient, const HandParameters& hand,
                       double wall, double press, std::uint64_t seed, const TrialSchedule& schedule)
    : intent_(plan, patient, hand, wall, press, seed, schedule), length_(schedule.end) {
  refuse_unfinished(plan, patient, hand, wall, press, seed, schedule);
  const JointArray begin = intent_.angle(0.0);
  const JointArray end = intent_.angle(length_);
  for (std::size_t j = 0; j < begin.size(); ++j) gap_[j] = begin[j] - end[j];
}

double PressCycle::within(double t) const noexcept { return t - length_ * std::floor(t / length_); }

JointArray PressCycle::angle(double t) const noexcept {
  const double in_squeeze = within(t);
  JointArray angle = intent_.angle(in_squeeze);
  const double x = std::clamp(1.0 - (length_ - in_squeeze) / kSeam, 0.0, 1.0);
  const double share = x * x * (3.0 - 2.0 * x);
  for (std::size_t j = 0; j < angle.size(); ++j) angle[j] += share * gap_[j];
  return angle;
}

JointArray PressCycle::push(double t) const noexcept { return intent_.push(within(t)); }

}  // namespace phalanx

// SPDX-License-Identifier: Apache-2.0
// From contacts to the command. Everything that leaves for the motors passes this one stage.
#pragma once

#include <array>

#include "phalanx/contact/gdp.h"
#include "phalanx/core/status.h"
#include "phalanx/force/force_parameters.h"
#include "phalanx/hand/hand_model.h"

namespace phalanx {

/// What the force of one segment remembers. It belongs to the SEGMENT, so that it survives a contact that
/// hops.
struct SegmentForce {
  double raw = 0.0;            ///< the law's value at this tick [N]
  double sent = 0.0;           ///< F' of S2 eq. (4): after cap and smoothing [N]
  Vec3 p_S = Vec3::Zero();     ///< where it acts, in the segment's frame [m]
  Vec3 normal = Vec3::Zero();  ///< direction of the force on the finger, in W
  double speed = 0.0;          ///< low-passed closing speed [m/s]
};

struct ForceState {
  std::array<SegmentForce, kSegments> segment;
  JointArray torque{};   ///< commanded at the last tick: what the rate limit counts from [Nm]
  HandPoses hcp_before;  ///< the HCP of the last tick, for closing speeds
  bool started = false;
};

/// The constant side of the stage.
struct ForceModel {
  const HandModel& hand;
  const ForceLawParameters& law;
  const SmoothingParameters& smoothing;
  const LimitParameters& limits;
  double period;  ///< nominal period of a step [s]
};

/// law -> fingertip cap -> smoothing -> joint torques -> torque limit -> torque-rate limit -> finite check.
/// The cap holds for each contact and for the vector sum of a digit's contacts; it is checked on the sum once
/// more after smoothing, since forces that fall slowly and others that rise may add up to more than either.
/// @param contacts  the GDP after this tick, with its records
/// @param hcp       the HCP at this tick
/// @param stale     the measured hand is no longer known: no contact pushes, what was sent decays
/// @returns which limiter acted, kCommandNotFinite if something had to be set to zero
/// Real-time: O(1), no allocation, lock, throw or I/O.
Status compute_command(const ForceModel& model, const GdpState& contacts, const HandPoses& hcp, bool stale,
                       ForceState& state) noexcept;

/// Torques of one force f_W acting at p_W on the digit's segment k, added to `torque`:  tau_i = axis_i . ((p
/// - centre_i) x f) = J_i . f. What the contact does to the finger; S1 eq. (3)-(5) print its negative, the
/// torque that balances it. Real-time.
void add_torques(const DigitPose& pose, int digit, int k, const Vec3& p_W, const Vec3& f_W,
                 JointArray& torque) noexcept;

}  // namespace phalanx

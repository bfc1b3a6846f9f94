// SPDX-License-Identifier: Apache-2.0
// From contacts to the command. Everything that leaves for the motors passes this one stage.
#pragma once

#include <array>

#include "phalanx/contact/gdp.h"
#include "phalanx/core/status.h"
#include "phalanx/force/force_parameters.h"
#include "phalanx/force/local_wall.h"
#include "phalanx/force/oscillation.h"
#include "phalanx/force/stabiliser.h"
#include "phalanx/hand/hand_model.h"

namespace phalanx {

/// What the force of one segment remembers. It belongs to the SEGMENT, so that it survives a contact that
/// hops.
struct SegmentForce {
  double raw = 0.0;            ///< the law's value at this tick, times StiffnessFactor [N]
  double sent = 0.0;           ///< F' of S2 eq. (4): after caps and stabiliser [N]
  Vec3 p_S = Vec3::Zero();     ///< where it acts, in the segment's frame [m]
  Vec3 normal = Vec3::Zero();  ///< direction of the force on the finger, in W
  double speed = 0.0;          ///< low-passed closing speed [m/s]
  StabiliserMemory memory;
};

/// The plane of a contact that has let go, kept for a while: a finger that bounces meets it again before the
/// host could have seen it. Only for Stabiliser::kLocalWall.
struct RememberedWall {
  bool kept = false;
  double age = 0.0;            ///< since the contact let go [s]
  double stiffness = 0.0;      ///< [N/m]
  Vec3 p_S = Vec3::Zero();     ///< the contact's material point, in the segment's frame [m]
  Vec3 normal = Vec3::Zero();  ///< direction of the force on the finger, in W
  Vec3 p_W = Vec3::Zero();     ///< a point of the plane: where the contact was on the GDP [m]
};

struct ForceState {
  std::array<SegmentForce, kSegments> segment;
  JointArray torque{};   ///< commanded at the last tick: what the rate limit counts from [Nm]
  HandPoses hcp_before;  ///< the HCP of the last tick, for closing speeds
  std::array<OscillationObserver, kSegments> observer;  ///< of `sent`; outlives a contact that bounces
  StiffnessFactor stiffness_factor;
  std::array<LocalWall, kSegments> wall{};  ///< only Stabiliser::kLocalWall fills it
  std::array<RememberedWall, kSegments> remembered{};
  std::array<bool, kDigits> resting{};  ///< nothing of the digit is to be forgotten or watched
  bool started = false;
};

/// The constant side of the stage.
struct ForceModel {
  const HandModel& hand;
  const ForceLawParameters& law;
  const SmoothingParameters& smoothing;
  const LimitParameters& limits;
  double period;  ///< nominal period of a step [s]
  const StabiliserParameters& stabiliser = kDefaultStabiliser;
  const OscillationParameters& oscillation = kDefaultOscillation;
};

/// law -> fingertip cap -> stabiliser -> joint torques -> torque limit -> torque-rate limit -> finite check.
/// The cap holds for each contact and for the vector sum of a digit's contacts; it is checked once more after
/// the stabiliser: on the sum, since forces that fall slowly and others that rise may add up to more than
/// either, and on each contact where the method adds to the law's force. The force sent is then watched for
/// oscillation (kOscillating).
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

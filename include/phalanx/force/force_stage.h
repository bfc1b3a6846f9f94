// SPDX-License-Identifier: Apache-2.0
// From contacts to the torque command. The folder `force` computes it in one
// stage, compute_command() (below):
// 1. force_law.h gives each contact's force from its depth and closing speed.
// 2. A cap limits each contact's force and the vector sum of a digit's forces.
// 3. stabiliser.h and stabiliser_methods.h change the force to keep the loop through device
//    and finger stable.
// 4. The forces become joint torques, which are limited in magnitude, rate and to finite values.
// 5. oscillation.h watches the force sent; local_wall.h describes contacts for the device's own controller.
// A digit that started inside an object has no force, or the small one of opening.h.
// Every torque command passes this stage. docs/stabilisers.md compares the stabilisers. S1 and S2 are the
// papers listed in docs/architecture.md; GDP and HCP are explained in contact/gdp.h.
#pragma once

#include <array>

#include "phalanx/contact/gdp.h"
#include "phalanx/core/status.h"
#include "phalanx/force/haptic_parameters.h"
#include "phalanx/force/local_wall.h"
#include "phalanx/force/opening.h"
#include "phalanx/force/oscillation.h"
#include "phalanx/force/stabiliser.h"
#include "phalanx/hand/hand_model.h"

namespace phalanx {

/// State of one segment's force. It belongs to the SEGMENT, so that it survives a contact that hops
/// to another place.
struct SegmentForce {
  double raw = 0.0;            ///< the law's force at this tick, times StiffnessFactor [N]
  double sent = 0.0;           ///< F' of S2 eq. (4): the force after caps and stabiliser [N]
  Vec3 p_S = Vec3::Zero();     ///< point where the force acts, in the segment's frame [m]
  Vec3 normal = Vec3::Zero();  ///< direction of the force on the finger, in W
  Vec3 couple = Vec3::Zero();  ///< moment about that point per force, in W [m]; 0 in static mode
  double speed = 0.0;          ///< low-passed closing speed [m/s]
  StabiliserMemory memory;
};

/// Plane of a contact that has let go, kept for a while. A finger that bounces meets it again before the host
/// can react. Only for Stabiliser::kLocalWall.
struct RememberedWall {
  bool kept = false;
  double age = 0.0;            ///< time since the contact let go [s]
  double stiffness = 0.0;      ///< [N/m]
  Vec3 p_S = Vec3::Zero();     ///< the contact's material point, in the segment's frame [m]
  Vec3 normal = Vec3::Zero();  ///< direction of the force on the finger, in W
  Vec3 p_W = Vec3::Zero();     ///< a point of the plane, in W: the contact's place on the GDP [m]
};

/// State of the force stage between ticks.
struct ForceState {
  std::array<SegmentForce, kSegments> segment;
  JointArray torque{};   ///< last commanded torques, from which the rate limit counts [Nm]
  HandPoses hcp_before;  ///< poses of the HCP at the last tick, for closing speeds
  std::array<OscillationObserver, kSegments> observer;  ///< watches `sent`; survives a contact that bounces
  StiffnessFactor stiffness_factor;
  std::array<OpeningState, kDigits> opening;  ///< of digits that started inside the object
  std::array<LocalWall, kSegments> wall{};    ///< filled only by Stabiliser::kLocalWall
  std::array<RememberedWall, kSegments> remembered{};
  std::array<bool, kDigits> resting{};  ///< the digit has nothing left to forget or to watch
  bool started = false;
};

/// Computes the torque command of one tick, in this order: law -> fingertip cap -> stabiliser -> fingertip
/// cap -> joint torques -> finite check -> torque limit -> torque-rate limit.
/// The cap holds for each contact and for the vector sum of a digit's contacts. For a digit that started inside
/// the object it is the smaller one of OpeningState, also where the scene's limit is off. The second cap acts on the
/// sum, because some forces may fall slowly while others rise. It acts on each contact where the stabiliser
/// adds to the law's force. The force sent is then watched for oscillation (kOscillating).
/// @param contacts  the GDP after this tick, with its records
/// @param hcp       poses of the HCP at this tick
/// @param stale     true if the measured hand is no longer known. Then no contact pushes, and forces decay.
/// @returns the limiters that acted, and kCommandNotFinite if a value was set to zero
/// Real-time: O(1), no allocation, lock, throw or I/O.
Status compute_command(const HapticParameters& parameters, const GdpState& contacts, const HandPoses& hcp,
                       bool stale, ForceState& state) noexcept;

}  // namespace phalanx

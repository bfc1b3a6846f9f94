// SPDX-License-Identifier: Apache-2.0
// Every number that the station's safety rests on. docs/safety.md has them in a table, with what happens.
#pragma once

#include <numbers>
#include <string>

#include "phalanx/force/force_parameters.h"

namespace phalanx {

/// Largest fingertip force of a contact, and of the vector sum of a digit's contacts [N].
inline constexpr double kForceWithoutClinician = 5.0;
inline constexpr double kForceWithClinician = 10.0;
inline constexpr double kForceNever = 15.0;  ///< a step that asks for more is a fault, whatever the settings
inline constexpr double kTorqueNever = 2.0;  ///< no setting goes beyond it [Nm]
inline constexpr double kTorqueRateNever = 100.0;  ///< [Nm/s]

struct SafetySettings {
  // What leaves.
  double fingertip_force = 5.0;  ///< [N] held by the step; checked here against kForceNever
  double joint_torque = 0.5;     ///< [Nm] each joint, absolute
  double torque_rate = 10.0;     ///< [Nm/s] each joint, absolute
  double range_taper = 3.0 * std::numbers::pi / 180.0;  ///< outward torque fades over this, up to the end of
                                                        ///< the patient's range of motion [rad]
  // How it comes and goes.
  double start_ramp = 1.0;    ///< from zero to the full torque after every start [s]
  double stop_ramp = 0.2;     ///< to zero when asked to stop [s]
  double fault_ramp = 0.005;  ///< to zero at a fault [s]

  // When samples are believed.
  double sample_timeout = 0.010;                           ///< [s] without a sample: fault
  int bad_samples = 3;                                     ///< in a row: fault
  double joint_speed = 40.0;                               ///< faster is a jump [rad/s] ...
  double jump_allowance = 2.0 * std::numbers::pi / 180.0;  ///< ... beyond this [rad]
  double range_margin = 20.0 * std::numbers::pi / 180.0;   ///< beyond the patient's range: out of range [rad]
  double stuck_after = 0.5;                                ///< a sensor unchanged for so long [s] ...
  double stuck_counts = 10.0;  ///< ... while its joint is known to have moved by more than this [counts]
  /// Measured and commanded torque may differ by  torque_error + torque_error_part |commanded|  [Nm] for at
  /// most torque_error_time [s].
  double torque_error = 0.15;
  double torque_error_part = 0.5;
  double torque_error_time = 0.2;
  /// The same for a fingertip's measured force and the magnitude of the sum of the forces commanded on its
  /// digit [N]; torque_error_part and torque_error_time hold here too.
  double force_error = 2.0;

  // When the loop is too slow.
  int overruns = 10;  ///< steps in a row that ended after the next was due: fault
};

/// The settings for a scene's limits. A station has no limit turned off and none beyond the constants above.
/// @param clinician  who answers for a fingertip force above kForceWithoutClinician; empty: nobody
/// @throws std::invalid_argument naming the limit, the value and the remedy.
[[nodiscard]] SafetySettings make_safety_settings(const LimitParameters& limits,
                                                  const std::string& clinician);

}  // namespace phalanx

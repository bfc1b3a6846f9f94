// SPDX-License-Identifier: Apache-2.0
// Parameters of the station's safety gate, its states and its faults. docs/safety.md describes the gate, and
// lists each parameter with its consequence.
#pragma once

#include <array>
#include <cstdint>
#include <numbers>
#include <string>
#include <string_view>
#include <vector>

#include "phalanx/device/device.h"
#include "phalanx/device/measured_range.h"
#include "phalanx/device/moment_arm.h"
#include "phalanx/force/force_parameters.h"
#include "phalanx/hand/joints.h"

namespace phalanx {

/// Largest fingertip force of a contact, and of the vector sum of a digit's contacts, if no clinician
/// is named [N].
inline constexpr double kForceWithoutClinician = 5.0;
/// The same if a clinician is named [N].
inline constexpr double kForceWithClinician = 10.0;
inline constexpr double kForceNever = 15.0;        ///< a step that asks for more is a fault, for all settings
inline constexpr double kTorqueNever = 2.0;        ///< upper bound of the settings [Nm]
inline constexpr double kTorqueRateNever = 100.0;  ///< upper bound of the settings [Nm/s]

/// Limits, ramps and tolerances of the safety gate.
struct SafetySettings {
  // Limits of the command.
  double fingertip_force = 5.0;  ///< held by the step; compared here with kForceNever [N]
  double joint_torque = 0.5;     ///< each joint, absolute [Nm]
  double torque_rate = 10.0;     ///< each joint, absolute [Nm/s]
  double range_taper = 3.0 * std::numbers::pi / 180.0;  ///< outward torque fades over this angle, to zero at
                                                        ///< the end of the range of motion [rad]
  // Ramps.
  double start_ramp = 1.0;    ///< from zero to full torque after every start [s]
  double stop_ramp = 0.2;     ///< to zero after a stop [s]
  double fault_ramp = 0.005;  ///< to zero at a fault [s]

  // Plausibility of samples.
  double sample_timeout = 0.010;  ///< longest time without a sample; beyond it: fault [s]
  int bad_samples = 3;            ///< number of bad samples in a row that is a fault
  double joint_speed = 40.0;      ///< a faster motion is a jump [rad/s] ...
  double jump_allowance = 2.0 * std::numbers::pi / 180.0;  ///< ... if it is also larger than this [rad]
  double range_margin = 20.0 * std::numbers::pi / 180.0;   ///< an angle this far beyond the patient's range
                                                           ///< is out of range [rad]
  double stuck_after = 0.5;    ///< a sensor that does not change for this long is stuck [s] ...
  double stuck_counts = 10.0;  ///< ... if its joint is known to have moved by more than this [counts]
  /// Measured and commanded torque may differ by  torque_error + torque_error_part |commanded|  [Nm] for at
  /// most torque_error_time [s].
  double torque_error = 0.15;
  double torque_error_part = 0.5;
  double torque_error_time = 0.2;
  /// The same bound for a fingertip's measured force and the magnitude of the sum of the forces commanded on
  /// its digit [N]. torque_error_part and torque_error_time hold here too.
  double force_error = 2.0;
  /// Sample rate of a wired device with motors. It is a fault if the rate over a window is below the promised
  /// one divided by rate_factor, or above it times rate_factor, by the device's clock or by the host's.
  double rate_window = 0.5;  ///< by the host's clock [s]
  double rate_factor = 2.0;  ///< [-]

  /// The patient's own range of motion, which narrows that of the hand for range_taper; none: only the hand's holds.
  JointRanges range{};

  /// The setting that makes this a patient's session, as stated ("hand.profile = small-woman"); empty: none.
  std::string patient;

  // Punctuality of the loop.
  int overruns = 10;  ///< number of steps in a row that end after the next was due; it is a fault
};

/// A motor that measures its wound length, and the joints that it moves. A sensor that stands still is
/// compared with it.
struct MotorWitness {
  int channel = -1;                         ///< channel of kind kMotor
  std::array<double, kJoints> arm{};        ///< moment arm of the tendon at each joint [m]
  std::vector<JointLinkage> linkages = {};  ///< of the joints whose moment arm depends on the angle
  std::array<double, kJoints> least_arm{};  ///< least moment arm of these; 0: arm is constant [m]
  double slack = 0.0;  ///< motion of the motor that moves no joint: tendon stretch at the largest torque,
                       ///< and play [m]

  /// @returns the linkage of a joint; null: its moment arm is constant. Real-time.
  [[nodiscard]] const JointLinkage* linkage_of(int joint) const noexcept {
    for (const JointLinkage& linkage : linkages)
      if (linkage.joint == joint) return &linkage;
    return nullptr;
  }
};

/// Makes the settings for a scene's limits. A station accepts no limit that is turned off, and none beyond
/// the constants above.
/// @param clinician  who answers for a fingertip force above kForceWithoutClinician; empty: no one
/// @throws std::invalid_argument naming the limit, the value and the remedy.
[[nodiscard]] SafetySettings make_safety_settings(const LimitParameters& limits,
                                                  const std::string& clinician);

/// Warning about a device without a watchdog, for people who try it out.
inline constexpr const char* kHoldsWithoutHost =
    "this device has no watchdog: it holds a finger while this program is frozen, or after it was killed. It "
    "can be tried out; a patient's session is refused (docs/device.md)";
/// @returns true if a wired device keeps its force while its host is frozen, or after its host was killed.
[[nodiscard]] bool holds_without_host(const DeviceInfo& device) noexcept;

/// Checks that the device has a watchdog if this is a patient's session.
/// @throws std::invalid_argument naming the setting that makes it one, the device and the remedy.
void check_watchdog(const SafetySettings& settings, const DeviceInfo& device);

/// State of the safety gate.
enum class SafetyState : std::uint8_t {
  kWaiting,   ///< zero torque, until the device is ready, its samples are good and no force oscillates
  kStarting,  ///< torque rises over SafetySettings::start_ramp
  kRunning,
  kStopping,  ///< torque falls over SafetySettings::stop_ramp
  kStopped,   ///< zero torque, until a person resumes it
  kFault,     ///< zero torque after SafetySettings::fault_ramp, until a reset
};

/// Names a state: "waiting", "starting", "running", "stopping", "stopped", "fault".
[[nodiscard]] std::string_view safety_state_name(SafetyState state) noexcept;

/// Rates of a device's samples over a window [Hz].
struct SampleRates {
  double promised = 0.0;   ///< DeviceInfo::rate_hz
  double by_device = 0.0;  ///< by the numbers and the clock of the device; 0: not measured
  double by_host = 0.0;    ///< by its numbers and the host's clock; 0: not measured
};

/// One fault: its kind, place and time. The first fault is kept until a reset; later ones, which may follow
/// from it, do not replace it.
struct FaultEvent {
  Fault fault = Fault::kNone;
  int channel = -1;          ///< channel of the sensor at fault; -1: no single sensor
  double time = 0.0;         ///< the host's clock [s]
  std::uint64_t tick = 0;    ///< number of the step that found it
  bool from_device = false;  ///< true: the controller found it
  SampleRates rates = {};    ///< for kSampleRate
};

/// @returns the meaning of a fault in words (fault_meaning()), with the rates of kSampleRate. Allocates.
[[nodiscard]] std::string fault_words(const FaultEvent& event);

}  // namespace phalanx

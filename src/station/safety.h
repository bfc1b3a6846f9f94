// SPDX-License-Identifier: Apache-2.0
// The safety gate between a step's torques and a patient's hand. Everything that a station sends to a device
// passes Safety::command(). docs/safety.md describes it.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "phalanx/device/channel_map.h"
#include "phalanx/device/device.h"
#include "phalanx/force/oscillation.h"
#include "phalanx/hand/hand_parameters.h"
#include "phalanx/station/safety_settings.h"
#include "phalanx/step/snapshot.h"
#include "station/sample_rate_watch.h"
#include "station/sensor_watch.h"

namespace phalanx {

/// Safety gate: a state machine without a clock or thread of its own. Once a step the loop calls
///   observe()   with every sample since the last step, the connection's state, and whether it was late
///   command()   with the step's torques; it writes the command that leaves
/// The command is finite, and no joint's torque exceeds its limit. No torque changes by more than its rate
/// limit per step, except downwards at a fault. No torque pushes a joint beyond the hand's range of
/// motion, nor beyond the patient's own one (SafetySettings::range). In every state but kStarting, kRunning
/// and kStopping it is zero, after a fault 5 ms later.
///
/// If a device has motors and is not simulated, an OscillationObserver watches the force that leaves of each
/// segment. It uses its default swing, independent of the scene. The first oscillation fades the torque over
/// stop_ramp. The torque returns by itself once the observers are quiet. An oscillation within 10 s of that
/// return is the fault kOscillation.
///
/// If a device has motors and a clock of its own, a SampleRateWatch compares the rate of its samples with the
/// promised one.
///
/// Real-time except for the constructor: no allocation, lock, throw or I/O.
class Safety {
 public:
  /// @param period  period of the loop [s]
  Safety(const SafetySettings& settings, const ChannelMap& map, const DeviceInfo& device,
         const HandParameters& hand, std::vector<MotorWitness> witnesses, double period);

  /// Judges the samples, the connection and the loop's punctuality; a violation sets the fault.
  /// @param samples     all that came since the last step, oldest first
  /// @param connection  Device::connection_fault()
  /// @param late        true if the last step ended after this one was due
  /// @param now         the host's clock [s]
  void observe(std::span<const DeviceSample> samples, Fault connection, bool late, double now) noexcept;

  /// Judges the step, advances the state machine and the ramps, and writes the command that leaves.
  /// @param used  the sample that the step was computed from
  void command(const Snapshot& snapshot, const DeviceSample& used, double now, DeviceCommand& out) noexcept;

  void start() noexcept;  ///< ends a stop(); the ramp begins once the device is ready
  /// Ramps to zero. The torque stays zero until start(), also over a fault and its reset.
  void stop() noexcept;
  /// Asks to leave kFault. It is granted once the torque is at rest and the cause is gone. The cause is gone
  /// if samples come at their rate, none is bad, and no emergency stop is pressed. It is also granted if the
  /// connection itself is in fault, because only a reset mends that. The next state is kWaiting, or kStopped
  /// if stop() was called and start() was not.
  /// @param connection  Device::connection_fault() now
  /// @returns true if granted; the caller then resets the device
  bool reset(Fault connection, double now) noexcept;
  /// @returns true if samples come at the promised rate, no sensor is bad, and no emergency stop is pressed.
  [[nodiscard]] bool cause_gone(double now) const noexcept;

  [[nodiscard]] SafetyState state() const noexcept { return state_; }
  [[nodiscard]] const FaultEvent& fault() const noexcept { return fault_; }
  /// @returns true if the torques that leave are zero.
  [[nodiscard]] bool at_rest() const noexcept { return at_rest_; }
  [[nodiscard]] double factor() const noexcept { return factor_; }  ///< factor of the ramps, 0 .. 1
  [[nodiscard]] int late_in_a_row() const noexcept { return late_in_a_row_; }
  /// @returns true if a force that leaves oscillates, or did so within the last 0.5 s. Always false on a
  /// simulated device and on one without motors.
  [[nodiscard]] bool oscillates() const noexcept { return oscillates_; }
  [[nodiscard]] const SafetySettings& settings() const noexcept { return settings_; }

 private:
  void trip(Fault fault, int channel, double now, bool from_device = false) noexcept;
  void judge_sample(const DeviceSample& sample, double now) noexcept;
  void judge_step(const Snapshot& snapshot, double now) noexcept;
  [[nodiscard]] double silent_for(double now) const noexcept;
  [[nodiscard]] double outward_room(const Snapshot& snapshot, std::size_t joint) const noexcept;
  void judge_obedience(double now) noexcept;
  void judge_oscillation(const Snapshot& snapshot, double now) noexcept;
  void advance(double now) noexcept;
  void ramp_to_zero_after_fault(double now) noexcept;
  void choose_walls(const Snapshot& snapshot, DeviceCommand& out) const noexcept;
  [[nodiscard]] double wanted(const Snapshot& snapshot, std::size_t joint) const noexcept;
  [[nodiscard]] double outward_factor(std::size_t joint, double angle, double torque) const noexcept;

  SafetySettings settings_;
  SensorWatch watch_;
  SampleRateWatch rate_watch_;
  JointArray min_{};  ///< no torque pushes a joint below it [rad]
  JointArray max_{};  ///< nor above it [rad]
  double period_;
  double timeout_;       ///< timeout of samples [s]
  double obeys_within_;  ///< longest time that the device may be enabled without acting [s]
  bool in_step_;      ///< true: silence is counted in steps, the time of a simulated device without own_clock
  bool judges_rate_;  ///< true: it has motors, and a clock of its own
  bool may_oscillate_;  ///< true: no motor moves a hand (simulated, or without motors)
  SafetyState state_ = SafetyState::kWaiting;
  FaultEvent fault_;
  double factor_ = 0.0;
  JointArray sent_{};           ///< torques of the last command [Nm]
  DigitArray sent_force_{};     ///< force of that command on each digit [N]
  JointArray sent_at_fault_{};  ///< torques from which the fault's ramp falls [Nm]
  bool held_ = false;           ///< stop() was called, and start() was not since
  double ignored_for_ = 0.0;    ///< time for which the device has ignored enabled commands [s]
  double fault_left_ = 0.0;     ///< part of the fault's ramp that is left, 1 .. 0 [-]
  std::array<OscillationObserver, kSegments> observer_{};  ///< one for each segment's force
  bool oscillates_ = false;                                ///< an observer reports an oscillation
  bool after_oscillation_ = false;  ///< an oscillation has removed the torque, perhaps as a fault
  double returned_ = -std::numeric_limits<double>::infinity();  ///< time at which the torque began to rise
                                                                ///< after an oscillation [s]
  bool at_rest_ = true;
  DeviceSample last_{};          ///< the newest sample
  double silence_ = 0.0;         ///< time without a sample, counted in steps [s]
  bool heard_ = false;           ///< a sample has come since the start or the last reset
  double waiting_since_ = -1.0;  ///< time at which waiting for a sample began [s]
  double answers_until_ = 0.0;   ///< until then the device may still report its old latch or connection [s]
  int late_in_a_row_ = 0;
  std::uint64_t tick_ = 0;  ///< number of commands; continues when models are exchanged
};

}  // namespace phalanx

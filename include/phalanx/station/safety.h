// SPDX-License-Identifier: Apache-2.0
// What stands between a step's torques and a patient's hand. Everything that a station sends to a device
// passes Safety::command(); docs/safety.md is its page.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>

#include "phalanx/device/channel_map.h"
#include "phalanx/device/device.h"
#include "phalanx/force/oscillation.h"
#include "phalanx/hand/hand_parameters.h"
#include "phalanx/station/safety_settings.h"
#include "phalanx/station/sensor_watch.h"
#include "phalanx/step/snapshot.h"

namespace phalanx {

enum class SafetyState : std::uint8_t {
  kWaiting,   ///< zero torque, until the device is ready, its samples are good and no force oscillates
  kStarting,  ///< torque rises over SafetySettings::start_ramp
  kRunning,
  kStopping,  ///< torque falls over SafetySettings::stop_ramp
  kStopped,   ///< zero torque, until start()
  kFault,     ///< zero torque after SafetySettings::fault_ramp, until reset()
};

/// "waiting", "starting", "running", "stopping", "stopped", "fault".
[[nodiscard]] std::string_view safety_state_name(SafetyState state) noexcept;

/// One fault: what, where, when. The first one counts until a reset; others that follow from it do not hide
/// it.
struct FaultEvent {
  Fault fault = Fault::kNone;
  int channel = -1;          ///< of the sensor at fault; -1: not one sensor's
  double time = 0.0;         ///< the host's clock [s]
  std::uint64_t tick = 0;    ///< of the step at which it was found
  bool from_device = false;  ///< the controller found it
};

/// A state machine and a gate, both without a clock or thread of their own: once a step the loop calls
///   observe()   every sample since the last step, the connection's state, whether the last step was late
///   command()   the step's torques -> what leaves
/// What leaves is finite; no joint's torque is above its limit; none changes by more than its rate limit a
/// step but downwards at a fault; none pushes a joint beyond the patient's range of motion; and it is zero in
/// every state but kStarting, kRunning and kStopping, and 5 ms after a fault. On a device with motors that is
/// not simulated, each segment's force that leaves is watched by an OscillationObserver with its default
/// swing, whatever the scene says. The first oscillation fades the torque over stop_ramp; the torque returns
/// by itself once the observers are quiet. An oscillation within 10 s of that return is the fault
/// kOscillation. Real-time but for the constructor: no allocation, lock, throw or I/O.
class Safety {
 public:
  /// @param period  of the loop [s]
  Safety(const SafetySettings& settings, const ChannelMap& map, const DeviceInfo& device,
         const HandParameters& hand, std::vector<MotorWitness> witnesses, double period);

  /// @param samples     that came in since the last step, oldest first
  /// @param connection  Device::connection_fault()
  /// @param late        the last step ended after this one was due
  void observe(std::span<const DeviceSample> samples, Fault connection, bool late, double now) noexcept;

  /// @param used  the sample that the step was computed from
  void command(const Snapshot& snapshot, const DeviceSample& used, double now, DeviceCommand& out) noexcept;

  void start() noexcept;  ///< after stop(); the ramp begins once the device is ready
  /// Ramps to zero and stays there until start(), also over a fault and its reset.
  void stop() noexcept;
  /// Asks to leave kFault. Granted once the torque is at rest and the cause is gone: samples come, none is
  /// bad, no emergency stop is pressed; or the connection itself is in fault, which only a reset mends. Then
  /// everything begins anew with kWaiting, or with kStopped if somebody had said stop().
  /// @param connection  Device::connection_fault() now
  /// @returns whether; the caller then resets the device
  bool reset(Fault connection, double now) noexcept;
  /// Whether reset() would be granted.
  [[nodiscard]] bool cause_gone(double now) const noexcept;

  [[nodiscard]] SafetyState state() const noexcept { return state_; }
  [[nodiscard]] const FaultEvent& fault() const noexcept { return fault_; }
  /// Nothing is sent to the motors any more.
  [[nodiscard]] bool at_rest() const noexcept { return at_rest_; }
  [[nodiscard]] double factor() const noexcept { return factor_; }  ///< on the step's torques, 0 .. 1
  [[nodiscard]] int late_in_a_row() const noexcept { return late_in_a_row_; }
  /// A force that leaves oscillates, or did within the last 0.5 s, on a device where that takes the torque
  /// away.
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
  void go_on(double now) noexcept;
  void ramp_to_zero_after_fault(double now) noexcept;
  void choose_walls(const Snapshot& snapshot, DeviceCommand& out) const noexcept;
  [[nodiscard]] double wanted(const Snapshot& snapshot, std::size_t joint) const noexcept;
  [[nodiscard]] double outward_factor(std::size_t joint, double angle, double torque) const noexcept;

  SafetySettings settings_;
  SensorWatch watch_;
  JointArray min_{};
  JointArray max_{};
  double period_;
  double timeout_;       ///< of samples [s]
  double obeys_within_;  ///< how long the device may be enabled and not act [s]
  bool simulated_;       ///< the device's time is the number of steps: so is its silence
  bool may_oscillate_;   ///< nothing moves a hand: simulated, or without motors
  SafetyState state_ = SafetyState::kWaiting;
  FaultEvent fault_;
  double factor_ = 0.0;
  JointArray sent_{};           ///< the last command [Nm]
  DigitArray sent_force_{};     ///< of each digit, with it [N]
  JointArray sent_at_fault_{};  ///< from which the fault's ramp falls [Nm]
  bool held_ = false;           ///< somebody has said stop()
  double ignored_for_ = 0.0;    ///< how long the device has not acted on enabled commands [s]
  double fault_left_ = 0.0;     ///< of the fault's ramp, 1 .. 0
  std::array<OscillationObserver, kSegments> observer_{};  ///< of the forces that leave
  bool oscillates_ = false;                                ///< an observer's verdict holds
  bool after_oscillation_ = false;                         ///< one has taken the torque away, also as a fault
  double returned_ =
      -std::numeric_limits<double>::infinity();  ///< when the torque began to rise after that [s]
  bool at_rest_ = true;
  DeviceSample last_{};          ///< the newest sample
  double silence_ = 0.0;         ///< steps without a sample, in nominal time [s]
  bool heard_ = false;           ///< a sample has come since the beginning or the last reset
  double waiting_since_ = -1.0;  ///< [s]
  double answers_until_ =
      0.0;  ///< till then a device's latch and connection may still be those of before [s]
  int late_in_a_row_ = 0;
  std::uint64_t tick_ = 0;  ///< of the commands: never goes back, also when models are exchanged
};

}  // namespace phalanx

// SPDX-License-Identifier: Apache-2.0
// One step of a station, without its clock, thread and device: from samples and requests to the command. The loop
// (station.cpp) makes it with a device, and a replay (record/replay.h) makes it again with what was recorded.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>

#include "phalanx/device/channel_map.h"
#include "phalanx/device/device.h"
#include "phalanx/station/station_view.h"
#include "phalanx/step/haptic_step.h"
#include "station/parameter_ramp.h"
#include "station/safety.h"

namespace phalanx {

/// A model, its parameters and its state, which are exchanged together.
struct Rendering {
  /// @param of_change  number of the change that asked for it; 0: the station's first
  /// @throws as HapticState. Set-up only.
  Rendering(std::shared_ptr<const HapticModel> of_model, const HapticParameters& parameters,
            std::uint64_t of_change = 0)
      : model(std::move(of_model)), ramp(parameters), state(*model, parameters), change(of_change) {}

  const std::shared_ptr<const HapticModel> model;
  ParameterRamp ramp;
  HapticState state;
  std::uint64_t change;
};

/// Writes what the newest step of a rendering was: status, stiffness, angles, forces and contacts. Real-time.
/// @param sent  torques in the command [Nm]
/// @param out   has StepRecord::factor already
void describe_rendering(const Rendering& rendering, Status status, const JointArray& sent,
                        StepRecord& out) noexcept;

/// State of a station's steps. A step is made by these calls, in this order; each may be left out but the last one:
/// serve(), confirm_openings(), wait_for_exchange() and exchange(), change_to(), step(). Same set-up and same calls, same
/// commands to the last bit: neither time nor other threads have another way in.
///
/// Real-time except for the constructor: no allocation, lock, throw or I/O.
class StationStep {
 public:
  /// @param device  of the open device; `map` is of its channels
  /// @param period  of the loop [s]
  StationStep(std::unique_ptr<Rendering> first, ChannelMap map, const DeviceInfo& device,
              const SafetySettings& safety, std::vector<MotorWitness> witnesses, double period);

  /// Serves requests, bits of StepRequest: stop, resume, reset and the end.
  /// @param connection  Device::connection_fault() now
  /// @returns true if a fault was reset; the caller then resets the device
  bool serve(unsigned requests, Fault connection, double now) noexcept;
  /// Confirms the opening of digits that started inside the object (bit d for digit d). It has no effect unless forces
  /// are on.
  void confirm_openings(unsigned digits) noexcept;
  /// Ramps to zero torque because another rendering waits. @returns true if it may be exchanged now
  bool wait_for_exchange() noexcept;
  /// Exchanges the rendering; the torque returns over the start ramp. @returns the one before, for another thread to free
  std::unique_ptr<Rendering> exchange(std::unique_ptr<Rendering> next) noexcept;
  /// Begins a change of parameters in contact: ParameterRamp::go_to().
  void change_to(const HapticParameters& parameters) noexcept { rendering_->ramp.go_to(parameters); }
  /// Makes the step.
  /// @param samples     all that came since the last step, oldest first
  /// @param connection  Device::connection_fault() now
  /// @param late        the step before ended after this one was due
  /// @returns the command; it is sent if heard() is true
  const DeviceCommand& step(std::span<const DeviceSample> samples, Fault connection, bool late,
                            double now) noexcept;

  [[nodiscard]] const Rendering& rendering() const noexcept { return *rendering_; }
  [[nodiscard]] const Safety& safety() const noexcept { return safety_; }
  [[nodiscard]] const Snapshot& snapshot() const noexcept { return rendering_->state.snapshot(); }
  [[nodiscard]] const DeviceCommand& command() const noexcept { return command_; }
  [[nodiscard]] const DeviceSample& newest_sample() const noexcept { return newest_sample_; }
  [[nodiscard]] const ChannelMap& channels() const noexcept { return channels_; }
  [[nodiscard]] Status status() const noexcept { return status_; }
  [[nodiscard]] bool heard() const noexcept {
    return heard_;
  }  ///< a sample has come since the beginning or the last reset
  [[nodiscard]] bool ending() const noexcept { return ending_; }  ///< StepRequest::kEnd was served
  [[nodiscard]] std::uint64_t resets_refused() const noexcept { return resets_refused_; }
  /// @returns StationView::running
  [[nodiscard]] std::uint64_t running() const noexcept { return running_; }
  /// @returns a hash of the newest step: measured angles, shown angles, forces with points and directions, the step's
  /// torques, and the command with its walls. Any bit that differs changes it.
  [[nodiscard]] std::uint64_t hash() const noexcept;
  /// Writes what the newest step was and did to `out`: state, fault, ramps, status, stiffness, angles, forces and contacts, but
  /// neither StepRecord::input, command, hash nor times. A replay describes a step as its station did.
  void describe(StepRecord& out) const noexcept;

 private:
  bool reset(Fault connection, double now) noexcept;
  void number_running() noexcept;
  void end_running() noexcept;

  const ChannelMap channels_;
  std::unique_ptr<Rendering> rendering_;
  Safety safety_;
  DeviceSample newest_sample_;
  Sample sample_;
  DeviceCommand command_;
  Status status_ = Status::kOk;
  bool heard_ = false;
  bool ending_ = false;
  bool resume_after_exchange_ = false;
  std::uint64_t resets_refused_ = 0;
  std::uint64_t running_ = 0;  ///< number of this period of SafetyState::kRunning; 0: another state
};

}  // namespace phalanx

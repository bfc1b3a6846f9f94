// SPDX-License-Identifier: Apache-2.0
// Steps of a program that calls step() itself, in a recording (Setup.own_steps).
#pragma once

#include <cstdint>
#include <memory>

#include "phalanx/record/step_recorder.h"
#include "phalanx/recording.pb.h"
#include "phalanx/station/station_view.h"
#include "station/station_step.h"

namespace phalanx {

/// @returns a hash of a step: measured and shown angles, torques, forces with points and directions, status
/// and tick. Any bit that differs changes it.
[[nodiscard]] std::uint64_t own_step_hash(const Snapshot& snapshot) noexcept;

/// Writes the step. `out` is cleared first. @param with_angles  also the measured and the shown angles
void write_own_step(const OwnStep& step, bool with_angles, wire::Step& out);

/// Reads the sample of a recorded step. @throws std::invalid_argument if numbers are missing
void read_own_sample(const wire::Step& step, Sample& out);

/// Makes recorded steps again.
class OwnSteps {
 public:
  explicit OwnSteps(std::unique_ptr<Rendering> first) : rendering_(std::move(first)) {}

  void change_to(const HapticParameters& parameters) noexcept { rendering_->ramp.go_to(parameters); }
  /// Makes the step, after the change that it begins. @throws as read_own_sample()
  void make(const wire::Step& recorded);
  [[nodiscard]] const Snapshot& snapshot() const noexcept { return rendering_->state.snapshot(); }
  /// Writes what the step was: all of StepRecord but `input` and times.
  void describe(StepRecord& out) const noexcept;

 private:
  std::unique_ptr<Rendering> rendering_;
  Sample sample_;
};

}  // namespace phalanx

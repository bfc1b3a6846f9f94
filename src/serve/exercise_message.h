// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "phalanx/clinic/exercise_host.h"
#include "phalanx/cockpit.pb.h"

namespace phalanx {

/// Writes what pages show of an exercise, in the form of proto/phalanx/cockpit.proto. The patient's code, the
/// records and the result are left out. While the exercise hides its scene, hand, contacts and forces are, too.
void write_exercise(const ExerciseStatus& status, wire::Exercise& out);

/// @returns true while the exercise has the station: from its order until its result is made
[[nodiscard]] bool exercise_runs(const ExerciseStatus& status) noexcept;

/// Writes what the patient's screen shows of the station: whether torque is on, stopped, or off after a fault. Scene,
/// settings, files and people are left out: some of them would tell of a hidden stimulus.
void write_patient_state(const wire::State& state, wire::State& out);

/// Removes what tells a hidden scene: the values of forces and objects.
void hide_scene(wire::State& state);

}  // namespace phalanx

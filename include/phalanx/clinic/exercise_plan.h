// SPDX-License-Identifier: Apache-2.0
// The plan of an exercise before its station begins: its limits, its scene, and who does it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "phalanx/exercise/simulated_participant.h"
#include "phalanx/record/recorded_exercise.h"
#include "phalanx/registry/patient.h"
#include "phalanx/registry/result.h"
#include "phalanx/scene/scene.h"
#include "phalanx/station/session.h"

namespace phalanx {

/// Patient of an exercise as the registry has them, with the results so far.
struct KnownPatient {
  Patient patient;
  std::vector<ResultRow> results;  ///< by date
  std::string today;               ///< UTC, "2026-05-04"
};

/// Station on which an exercise is planned.
struct PlannedStation {
  std::string device = "simulated";  ///< SessionSettings::device
  /// The device's own statement; none: it is not open yet. Sliders and the simulated device need none
  std::optional<bool> simulated = {};
  bool sliders = false;        ///< sliders move the hand, also without a simulated participant
  Overrides overrides = {};    ///< that hold for each scene, such as the loop's rate
  std::string clinician = {};  ///< SessionSettings::clinician
  /// Largest stable stiffness, as the person who answers for the device states it [N/m]
  std::optional<double> stable_stiffness = {};
};

/// Exercise that is wished for.
struct ExerciseWish {
  std::string exercise;                    ///< name or file
  std::string demo = {};                   ///< skill of a simulated participant; empty: a person
  std::optional<std::uint64_t> seed = {};  ///< none: drawn
};

/// What an exercise needs before its station begins.
struct ExercisePlan {
  /// Without conditions; the digits with an own sensor are found when the device is open
  ExerciseStart start = {};
  Overrides overrides = {};      ///< of the exercise's scene
  std::string calibration = {};  ///< of the patient; empty: none
  /// methods_of_calibration() of that file, read before the station opens; none: start_on() reads that of the station
  std::optional<std::string> methods = {};
  std::string range = {};                      ///< likewise
  std::optional<ParticipantSkill> skill = {};  ///< simulated participant; none: a person
  /// Person without measured force and range: those of the simulated participant's hand are assumed.
  bool assume_person = false;
};

/// @returns true if the device is a simulated one of this program
[[nodiscard]] bool is_own_simulation(const std::string& device);

/// Plans an exercise. Reads its file and its scene.
/// @param known  none: no patient
/// @throws what refuses the exercise or the patient, with the remedy: std::invalid_argument, ExerciseError, SceneError
[[nodiscard]] ExercisePlan plan_exercise(const ExerciseWish& wish, const PlannedStation& station,
                                         const KnownPatient* known);

/// Completes the beginning of an exercise by what the open device states: digits with an own sensor, conditions, whether it is
/// simulated.
/// @throws SceneError if the calibration cannot be read
[[nodiscard]] ExerciseStart start_on(const ExercisePlan& plan, const SessionInfo& info);

/// Checks code and hand again when the device is open, before there is a force.
/// @throws as refuse_patient() and refuse_other_hand()
void refuse_on_station(const KnownPatient& known, const ExercisePlan& plan, const SessionInfo& info);

/// Checks the code that was typed again: the wrong hand must not get the limits of another person.
/// @throws std::invalid_argument naming both
void refuse_other_code(const Patient& patient, const std::string& typed);

}  // namespace phalanx

// SPDX-License-Identifier: Apache-2.0
// What the registry of patients says before and after an exercise: may it begin, with which limits, and what
// is kept of it.
#pragma once

#include <exception>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "phalanx/exercise/exercise.h"
#include "phalanx/exercise/training.h"
#include "phalanx/patients/trainings.h"
#include "phalanx/record/recorded_exercise.h"
#include "phalanx/registry/patient.h"
#include "phalanx/registry/result.h"
#include "phalanx/registry/result_detail.h"

namespace phalanx {

/// Refusal of an exercise, with a remedy for each place at which it may begin.
class ExerciseRefusal : public std::invalid_argument {
 public:
  /// @param reason       in words
  /// @param at_terminal  remedy with commands; what() has it
  /// @param on_page      remedy for the page of patients
  ExerciseRefusal(const std::string& reason, const std::string& at_terminal, const std::string& on_page);
  [[nodiscard]] const std::string& on_page() const noexcept { return on_page_; }  ///< reason and remedy

 private:
  std::string on_page_;
};

/// @returns the text of an error for the page of patients
[[nodiscard]] std::string refusal_on_page(const std::exception& error);

/// @returns true if the patient's code begins with kSimulatedCode
[[nodiscard]] bool is_simulated(const Patient& patient);

/// @returns today's date, UTC: "2026-05-04"
[[nodiscard]] std::string utc_date(double utc);

/// Checks that this patient may do the exercise today.
/// @param simulated  a simulated participant does it
/// @throws ExerciseRefusal naming the reason and the remedies: a contraindication, no consent, an expired
/// calibration, an entry check that is not passed, or is missing (of a training, and of each measure that
/// needs torque), a simulated participant for a person or the reverse
void refuse_patient(const Patient& patient, const ExerciseDescription& exercise, bool simulated,
                    const std::string& today);

/// Checks that the station's hand is of the patient's side, before there is a force.
/// @throws ExerciseRefusal naming both sides and the remedies
void refuse_other_hand(const Patient& patient, Handedness opened);

/// @returns the exercise with the patient's prescription and limits, which only lower it
/// @throws ExerciseError as parse_prescription() and prescribed()
[[nodiscard]] ExerciseDescription exercise_of(const Patient& patient, ExerciseDescription exercise);

/// Largest dose of all trainings of a patient on one day together, whatever each of them allows. Days
/// are of UTC.
inline constexpr DoseCap kDayDose = {.repetitions = 500, .minutes = 90.0};

/// @returns what the patient can do and may do, and has done today of this exercise, by the registry. Of a
/// training, what is left of kDayDose is respected, too.
/// @param results  of the patient, by date
/// @throws std::invalid_argument if a training begins although kDayDose is used up
[[nodiscard]] PersonLimits person_of(const Patient& patient, const ExerciseDescription& exercise,
                                     std::span<const ResultRow> results, const std::string& today);

/// training_history() for next_difficulty(): a session whose difficulty the therapist changed becomes one entry for
/// each difficulty, from its trials.
[[nodiscard]] std::vector<TrainingSession> difficulty_history(std::span<const ResultRow> results,
                                                              const std::string& exercise);

/// @returns the registry's row of an exercise. What may not be scored has no valid score. A result that
/// another version or machine recorded is kept as recorded; its conditions name the rendering version.
/// @param recording  its file name, without a folder
[[nodiscard]] ResultRow result_row(const RecordedExercise& exercise, const std::string& recording);

/// @returns the row of an exercise whose recording cannot be read: its dose, and no score
/// @param why  in words
[[nodiscard]] ResultRow dose_row(const ExerciseStart& start, const ExerciseResult& result,
                                 const std::string& recording, double utc, const std::string& why);

/// @returns true if take_measured() still holds for a recording whose result was missing in the registry: it
/// is of this patient and side, and neither a later valid result of the same exercise nor a later entry check
/// is known
/// @param recording  its file name, without a folder
/// @param known      results that the registry had without it
[[nodiscard]] bool takes_late(const Patient& patient, const RecordedExercise& exercise,
                              const std::string& recording, std::span<const ResultRow> known);

/// Takes over what an assessment has measured: own force, own range, entry check. The entry check is
/// judged by judge_entry_check(), whatever its file asks for. A verdict that is not known, for want of valid
/// scores, leaves the earlier one.
/// @returns true if the patient has changed
[[nodiscard]] bool take_measured(Patient& patient, const RecordedExercise& exercise);

/// Does take_measured() if takes_late() permits it. An own force that no earlier known result has measured was entered
/// by a person, perhaps after the recording; it stays.
/// @returns true if the patient has changed
[[nodiscard]] bool take_late(Patient& patient, const RecordedExercise& exercise, const std::string& recording,
                             std::span<const ResultRow> known);

}  // namespace phalanx

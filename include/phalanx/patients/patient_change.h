// SPDX-License-Identifier: Apache-2.0
// The rules of a change of a patient, for the commands and the page: what belongs to one hand, one device or
// one exercise must not outlive it.
#pragma once

#include <string>
#include <vector>

#include "phalanx/registry/patient.h"

namespace phalanx {

/// Takes the side. Another one clears what belongs to the first hand: profile, calibration, range, own range,
/// own force and entry check.
/// @returns true if any of them was cleared
bool take_side(Patient& patient, Handedness side);

/// @returns what take_side() has cleared, in words, for the person who changed the side
[[nodiscard]] std::string cleared_by_side(Handedness side);

/// Checks that the patient's profile, if there is one, is of the patient's side. Reads the profile.
/// @throws std::invalid_argument naming both sides; SceneError as load_profile()
void check_profile_side(const Patient& patient);

/// Sets `suitable` of an entry check by the least flexion and release that this
/// device needs (EntryRequirement).
void judge_entry_check(EntryCheck& check);

/// Patient with changed fields.
struct ChangedPatient {
  Patient patient = {};
  std::vector<std::string> said = {};  ///< what was changed beyond the wanted fields, in words, a line each
};

/// Makes the change from `before` to `wanted` by these rules:
/// - Another side: as take_side(). Measurements that `wanted` states otherwise than `before` are those of
/// the other hand.
/// - Another side or profile: check_profile_side().
/// - Another calibration file or last day: bind_calibration(). Device, serial number and method come from
/// the file alone.
/// - Another range file: bind_range().
/// - New or changed lines of the prescription: check_prescribed(), and an exercise may have one line.
/// - A changed consent without a changed date is of today. An entry check is judged again.
/// Reads calibration, range and exercise files.
/// @param before  empty for a new patient
/// @param today   UTC, "2026-05-04"
/// @throws std::invalid_argument naming field, value and remedy; SceneError and ExerciseError as
/// the functions above
[[nodiscard]] ChangedPatient changed_patient(const Patient& before, const Patient& wanted,
                                             const std::string& today);

}  // namespace phalanx

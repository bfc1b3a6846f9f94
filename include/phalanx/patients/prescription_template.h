// SPDX-License-Identifier: Apache-2.0
// Templates of prescriptions: files in assets/prescriptions that a therapist can read and change.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "phalanx/registry/patient.h"

namespace phalanx {

/// Version of the format; a file of another version is refused.
inline constexpr int kPrescriptionTemplateFormat = 1;

/// Prescription for a group of patients.
struct PrescriptionTemplate {
  std::string name = {};      ///< of its file
  std::string title = {};     ///< one line for people
  std::string title_de = {};  ///< the same in German; empty: none
  std::vector<PrescribedExercise> lines = {};
  std::map<std::string, std::string> notes_de = {};  ///< notes of lines in German, by exercise
};

/// Reads a template from text; `origin` names it in messages, and its file name is the template's name. Each
/// line is checked with its exercise by check_prescribed(): it raises no dose and no limit, and an exercise
/// has one line. Reads assets/exercises.
/// @throws SceneError naming file, line, key, value and remedy
[[nodiscard]] PrescriptionTemplate parse_prescription_template(const std::string& text,
                                                               const std::string& origin);
/// Loads a template by name in assets/prescriptions, or by path (contains `/` or ends with .toml).
/// @throws SceneError likewise, or if there is no such file
[[nodiscard]] PrescriptionTemplate load_prescription_template(const std::string& name_or_path);
/// @returns the templates in assets/prescriptions, by name. A file that cannot be read is left out.
/// @throws SceneError if the data folder is not found
[[nodiscard]] std::vector<PrescriptionTemplate> list_prescription_templates();
/// @returns the names of the templates in assets/prescriptions, sorted; none if there is no data folder
[[nodiscard]] std::vector<std::string> prescription_template_names();

/// Adds the lines of a template to a patient's prescription. A line replaces the exercise's earlier one; the
/// others stay.
void take_prescription_template(Patient& patient, const PrescriptionTemplate& chosen);

}  // namespace phalanx

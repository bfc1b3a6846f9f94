// SPDX-License-Identifier: Apache-2.0
#include "phalanx/patients/prescription_template.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <set>
#include <string_view>
#include <utility>

#include "phalanx/core/number_range.h"
#include "phalanx/exercise/exercise.h"
#include "phalanx/patients/prescribed_line.h"
#include "phalanx/scene/data_paths.h"
#include "phalanx/scene/scene.h"
#include "scene/text_file.h"
#include "scene/toml/toml_reader.h"

namespace phalanx {
namespace {

constexpr const char* kTemplateFolder = "assets/prescriptions";
// Keys of a line that stay what they are in the exercise's file; parse_prescription() checks their ranges.
constexpr std::array<const char*, 5> kOverrideKeys = {"trials", "target_success", "difficulty", "pain_limit",
                                                      "fatigue_limit"};

PrescribedExercise read_line(TomlTable& table) {
  PrescribedExercise line;
  line.exercise = table.text("exercise");
  const double repetitions = table.number_or("repetitions_per_day", between(0, 1000), 0.0);
  line.repetitions_per_day = static_cast<int>(repetitions);
  if (line.repetitions_per_day != repetitions) table.fail("repetitions_per_day", "write a whole number");
  line.minutes_per_day = table.number_or("minutes_per_day", between(0, 240), 0.0);
  for (const char* key : kOverrideKeys)
    if (table.has(key)) line.overrides[key] = fmt::format("{}", table.number(key, {}));
  if (table.has("note")) line.note = table.text("note");
  table.finish();
  return line;
}

/// Refuses a line that its exercise does not permit.
void check_line(const TomlTable& table, const PrescribedExercise& line) {
  std::string problem;
  try {
    problem = check_prescribed(line);
  } catch (const ExerciseError& error) {
    problem = error.what();
  }
  if (!problem.empty()) table.fail("exercise", problem);
}

}  // namespace

PrescriptionTemplate parse_prescription_template(const std::string& text, const std::string& origin) {
  const toml::table tree = parse_toml(text, origin);
  TomlTable root(tree, origin, "");
  if (root.number("format", {}) != kPrescriptionTemplateFormat)
    root.fail("format", fmt::format("this program reads format {}", kPrescriptionTemplateFormat));
  PrescriptionTemplate made;
  made.name = std::filesystem::path(origin).stem().string();
  made.title = root.text("title");
  if (root.has("title_de")) made.title_de = root.text("title_de");
  std::set<std::string> exercises;
  for (TomlTable& table : root.tables("line", -1)) {
    if (table.has("note_de")) made.notes_de[table.text("exercise")] = table.text("note_de");
    PrescribedExercise line = read_line(table);
    if (!exercises.insert(line.exercise).second)
      table.fail("exercise", "an exercise has one line; remove one of the two");
    check_line(table, line);
    made.lines.push_back(std::move(line));
  }
  root.finish();
  return made;
}

PrescriptionTemplate load_prescription_template(const std::string& name_or_path) {
  const std::filesystem::path file = find_data_file(
      "template of a prescription", name_or_path, kTemplateFolder, ".toml", std::filesystem::current_path());
  return parse_prescription_template(read_text_file(file.string(), "template of a prescription"),
                                     file.string());
}

std::vector<PrescriptionTemplate> list_prescription_templates() {
  std::vector<PrescriptionTemplate> list;
  for (const std::string& name : names_in_folder(data_folder() / kTemplateFolder, ".toml")) {
    try {
      list.push_back(load_prescription_template(name));
    } catch (const SceneError&) {  // `phalanx patient edit --template NAME` names the problem
    }
  }
  return list;
}

std::vector<std::string> prescription_template_names() {
  try {
    return names_in_folder(data_folder() / kTemplateFolder, ".toml");
  } catch (const SceneError&) {
    return {};
  }
}

void take_prescription_template(Patient& patient, const PrescriptionTemplate& chosen) {
  for (const PrescribedExercise& line : chosen.lines) {
    const auto same =
        std::find_if(patient.prescription.begin(), patient.prescription.end(),
                     [&](const PrescribedExercise& each) { return each.exercise == line.exercise; });
    if (same == patient.prescription.end()) {
      patient.prescription.push_back(line);
    } else {
      *same = line;
    }
  }
}

}  // namespace phalanx

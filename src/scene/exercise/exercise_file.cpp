// SPDX-License-Identifier: Apache-2.0
#include "phalanx/scene/exercise_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "phalanx/core/error_text.h"
#include "phalanx/core/index.h"
#include "phalanx/scene/data_paths.h"
#include "phalanx/scene/scene_file.h"
#include "scene/exercise/exercise_rows.h"
#include "scene/text_file.h"
#include "scene/toml/toml_reader.h"

namespace phalanx {
namespace {

constexpr const char* kExerciseFolder = "assets/exercises";

void read_row(const ExerciseRow& row, TomlTable& table, ExerciseDescription& exercise) {
  const std::string name = row.name();
  if (!table.has(name)) {
    if (row.required) static_cast<void>(table.text(name));  // throws
    return;
  }
  if (!row.applies_to(exercise))
    table.fail(name, fmt::format("a {} of the measure {} does not have this key; remove it",
                                 exercise_kind_name(exercise.kind), exercise_measure_name(exercise.measure)));
  row.read(table, name, exercise);
}

void read_rows(const std::string& of_table, TomlTable table, ExerciseDescription& exercise) {
  for (const ExerciseRow& row : exercise_rows())
    if (row.table() == of_table) read_row(row, table, exercise);
  table.finish();
}

void read_objects(TomlTable& root, ExerciseDescription& exercise) {
  if (!root.has("objects")) return;
  for (TomlTable& table : root.tables("objects", -1)) {
    ObjectChoice object;
    for (const ObjectRow& row : object_rows()) row.read(table, object);
    table.finish();
    exercise.objects.push_back(std::move(object));
  }
}

void read_tables(TomlTable& root, ExerciseDescription& exercise) {
  for (const char* name : {"success", "difficulty", "dose", "ratings", "limits", "feel", "entry"}) {
    if (!root.has(name)) continue;
    if (std::string_view(name) == "success") exercise.success.emplace();
    if (std::string_view(name) == "difficulty") exercise.difficulty.emplace();
    TomlTable table = root.table(name);
    if (exercise.success && std::string_view(name) == "success" && !table.has("at_least") &&
        !table.has("at_most"))
      throw SceneError(fmt::format("{}: state at_least or at_most", table.place()));
    read_rows(name, std::move(table), exercise);
  }
}

ExerciseDescription read_exercise(TomlTable& root, const std::string& origin) {
  if (root.number("format", {}) != kExerciseFormat)
    root.fail("format", fmt::format("this program reads format {}", kExerciseFormat));
  ExerciseDescription exercise;
  exercise.name = root.has("name") ? root.text("name") : std::filesystem::path(origin).stem().string();
  for (const ExerciseRow& row : exercise_rows())
    if (row.table().empty()) read_row(row, root, exercise);
  read_tables(root, exercise);
  read_objects(root, exercise);
  root.finish();
  return exercise;
}

}  // namespace

ExerciseDescription parse_exercise(const std::string& text, const std::string& origin) {
  const toml::table tree = parse_toml(text, origin);
  TomlTable root(tree, origin, "");
  ExerciseDescription exercise = read_exercise(root, origin);
  try {
    check_exercise(exercise);
  } catch (const ExerciseError& error) {
    throw SceneError(fmt::format("{}: {}", origin, error.what()));
  }
  return exercise;
}

ExerciseDescription load_exercise(const std::string& name_or_path) {
  const std::filesystem::path file =
      find_data_file("exercise", name_or_path, kExerciseFolder, ".toml", std::filesystem::current_path());
  return parse_exercise(read_text_file(file.string(), "exercise"), file.string());
}

std::string exercise_text(const ExerciseDescription& exercise) {
  std::string text = fmt::format("format = {}\nname = {}\n", kExerciseFormat, toml_string(exercise.name));
  std::string table;
  for (const ExerciseRow& row : exercise_rows()) {
    if (!row.applies_to(exercise)) continue;
    const std::optional<std::string> value = row.write(exercise);
    if (!value) continue;
    if (row.table() != table) {
      table = row.table();
      text.append(fmt::format("\n[{}]\n", table));
    }
    text.append(fmt::format("{} = {}\n", row.name(), *value));
  }
  for (const ObjectChoice& object : exercise.objects) {
    text.append("\n[[objects]]\n");
    for (const ObjectRow& row : object_rows())
      text.append(
          fmt::format("{} = {}\n", row.key.path.substr(row.key.path.find('.') + 1), row.write(object)));
  }
  return text;
}

std::vector<ExerciseInfo> list_exercises() {
  std::vector<ExerciseInfo> list;
  for (const std::string& name : names_in_folder(data_folder() / kExerciseFolder, ".toml")) {
    ExerciseInfo info = {.name = name, .title = {}, .readable = true, .exercise = {}};
    try {
      info.exercise = load_exercise(name);
      info.title = info.exercise.title;
    } catch (const std::exception& error) {
      info.readable = false;
      info.title = error_text(error);
    }
    list.push_back(std::move(info));
  }
  return list;
}

std::vector<std::string> problems_of_exercise(const std::string& name_or_path) {
  ExerciseDescription exercise;
  try {
    exercise = load_exercise(name_or_path);
  } catch (const std::exception& error) {
    return {error_text(error)};
  }
  std::vector<std::string> problems;
  const auto try_scene = [&](const Overrides& overrides) {
    try {
      const SceneDescription scene = load_scene(exercise.scene, overrides);
      if (exercise.measure == ExerciseMeasure::kPinch &&
          scene.parameters.contact.mode != ContactMode::kSliding)
        problems.push_back(
            fmt::format("{}: scene = \"{}\": a slip of a pinch is seen only if contacts can slide; choose a "
                        "scene with contact.mode = \"sliding\"",
                        exercise.name, exercise.scene));
    } catch (const std::exception& error) {
      problems.push_back(
          fmt::format("{}: scene = \"{}\": {}", exercise.name, exercise.scene, error_text(error)));
    }
  };
  try_scene({});
  for (std::size_t i = 0; i < exercise.objects.size(); ++i)
    try_scene(object_overrides(exercise, static_cast<int>(i)));
  return problems;
}

const std::vector<ExerciseKey>& exercise_keys() {
  static const std::vector<ExerciseKey> kKeys = [] {
    std::vector<ExerciseKey> keys = {{.path = "format",
                                      .type = "integer",
                                      .unit = "",
                                      .range = fmt::format("{}", kExerciseFormat),
                                      .default_value = "",
                                      .meaning = "version of the format"},
                                     {.path = "name",
                                      .type = "text",
                                      .unit = "",
                                      .range = "",
                                      .default_value = "",
                                      .meaning = "instead of the file's name, for exercises in recordings"}};
    for (const ExerciseRow& row : exercise_rows()) keys.push_back(row.key);
    for (const ObjectRow& row : object_rows()) keys.push_back(row.key);
    return keys;
  }();
  return kKeys;
}

std::string exercise_keys_markdown() {
  std::string text =
      "| key | type | unit | range | default | meaning |\n| --- | --- | --- | --- | --- | --- |\n";
  for (const ExerciseKey& key : exercise_keys()) {
    const std::string fallback =
        key.default_value.empty() ? std::string() : fmt::format("`{}`", key.default_value);
    text.append(fmt::format("| `{}` | {} | {} | {} | {} | {} |\n", key.path, key.type, key.unit, key.range,
                            fallback, key.meaning));
  }
  return text;
}

Overrides object_overrides(const ExerciseDescription& exercise, int object) {
  const ObjectChoice& choice = exercise.objects.at(static_cast<std::size_t>(object));
  const std::string size = number_in_unit(choice.size, kMm);
  Overrides overrides = {{"objects.0.kind", toml_string(choice.kind)}};
  if (choice.kind == "box")
    overrides.emplace_back("objects.0.extent_mm", fmt::format("[{}, {}, {}]", size, size, size));
  else
    overrides.emplace_back("objects.0.diameter_mm", size);
  if (choice.kind == "cylinder") overrides.emplace_back("objects.0.length_mm", size);
  return overrides;
}

PersonLimits apply_exercise(SceneDescription& scene, const ExerciseDescription& exercise,
                            const PersonLimits& person) {
  PersonLimits lowered = person;
  double& stiffness = scene.parameters.force.stiffness;
  stiffness = std::min({stiffness, exercise.limits.stiffness.value_or(stiffness), person.stiffness_cap,
                        person.stable_stiffness.value_or(stiffness)});
  lowered.stiffness_cap = std::min(lowered.stiffness_cap, stiffness);
  lowered.detects_slips = scene.parameters.contact.mode == ContactMode::kSliding;

  LimitParameters& limits = scene.parameters.limits;
  const double force = std::min(person.force_cap, exercise.limits.force.value_or(person.force_cap));
  limits.fingertip_force = limits.fingertip_force_enabled ? std::min(limits.fingertip_force, force) : force;
  limits.fingertip_force_enabled = true;
  lowered.force_cap = std::min(lowered.force_cap, limits.fingertip_force);

  if (exercise.limits.torque) {
    limits.joint_torque = limits.joint_torque_enabled ? std::min(limits.joint_torque, *exercise.limits.torque)
                                                      : *exercise.limits.torque;
    limits.joint_torque_enabled = true;
  }
  return lowered;
}

}  // namespace phalanx

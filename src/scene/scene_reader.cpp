// SPDX-License-Identifier: Apache-2.0
#include "scene/scene_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "phalanx/core/nearest_name.h"
#include "phalanx/scene/data_paths.h"
#include "phalanx/scene/device_file.h"
#include "phalanx/scene/patient_file.h"
#include "phalanx/scene/scene_file.h"
#include "phalanx/scene/scene_keys.h"
#include "scene/keys/unknown_keys.h"
#include "scene/text_file.h"

namespace phalanx {
namespace {

namespace fs = std::filesystem;

/// Reads and checks single values.
class Reader {
 public:
  Reader(const SceneTree& tree, fs::path folder) : tree_(tree), folder_(std::move(folder)) {}

  /// Stores the value of a key: the tree's if it states one, else the default.
  /// @param kind  of the object, for a key of objects[]
  void apply(const SceneKey& key, const std::string& path, const KeyTarget& target,
             const std::string& kind = "") const {
    const std::optional<KeyValue>& fallback = key.default_for(kind);
    if (const toml::node* node = tree_.find(path))
      key.store(target, read(key, path, *node, fallback));
    else if (fallback)
      key.store(target, *fallback);
  }

 private:
  /// Reads and checks the value of one key.
  [[nodiscard]] KeyValue read(const SceneKey& key, const std::string& path, const toml::node& node,
                              const std::optional<KeyValue>& fallback) const {
    KeyValue value;
    const auto wants = [&](std::string_view form) {
      tree_.fail(path, fmt::format("is {}; write {}{}{}", type_name(node), form, range_in_brackets(key),
                                   remedy(key, fallback)));
    };
    switch (key.type) {
      case KeyType::kNumberOrOff:
        if (node.is_string() && *node.value<std::string>() == "off") {
          value.off = true;
          return value;
        }
        [[fallthrough]];
      case KeyType::kNumber:
        if (!node.is_number()) wants("a number");
        value.number = checked(key, path, node, fallback);
        return value;
      case KeyType::kInteger:
        if (!node.is_integer()) wants("a whole number");
        static_cast<void>(checked(key, path, node, fallback));
        value.integer = *node.value<std::int64_t>();
        return value;
      case KeyType::kFlag:
        if (!node.is_boolean()) wants("true or false");
        value.flag = *node.value<bool>();
        return value;
      case KeyType::kVector: {
        const toml::array* array = node.as_array();
        if (array == nullptr || array->size() != 3) wants("three numbers: [x, y, z]");
        for (std::size_t i = 0; i < 3; ++i) {
          if (!(*array)[i].is_number()) wants("three numbers: [x, y, z]");
          value.vector[static_cast<Eigen::Index>(i)] = checked(key, path, (*array)[i], fallback);
        }
        return value;
      }
      case KeyType::kChoice: {
        if (!node.is_string()) wants("one of the words");
        value.text = *node.value<std::string>();
        const auto it = std::find(key.choices.begin(), key.choices.end(), value.text);
        if (it == key.choices.end()) {
          tree_.fail(path,
                     fmt::format("{}Known: {}", did_you_mean(value.text, key.choices), range_text(key)));
        }
        value.integer = it - key.choices.begin();
        return value;
      }
      case KeyType::kText:
      case KeyType::kFile:
      case KeyType::kName:
        if (!node.is_string()) wants("a string in quotes");
        value.text = *node.value<std::string>();
        if (value.text.find('\0') != std::string::npos) tree_.fail(path, "holds a zero byte; remove it");
        value.text = resolved(key, value.text);
        return value;
    }
    return value;
  }

  [[nodiscard]] double checked(const SceneKey& key, const std::string& path, const toml::node& node,
                               const std::optional<KeyValue>& fallback) const {
    const double number = number_of(node);
    if (!key.range.contains(number)) {
      tree_.fail(path, fmt::format("must be {}{}{}{}", range_text(key), key.unit.empty() ? "" : " ", key.unit,
                                   remedy(key, fallback)));
    }
    return number;
  }

  static std::string remedy(const SceneKey& key, const std::optional<KeyValue>& fallback) {
    return fallback ? fmt::format("; the default is {}", value_text(key, *fallback)) : "; or leave it out";
  }

  static std::string range_in_brackets(const SceneKey& key) {
    const std::string range = range_text(key);
    return range.empty() ? "" : fmt::format(" ({})", range);
  }

  /// Resolves a relative path in a scene file, which is relative to that file.
  [[nodiscard]] std::string resolved(const SceneKey& key, const std::string& text) const {
    return key.is_path(text) ? (folder_ / text).lexically_normal().string() : text;
  }

  const SceneTree& tree_;
  fs::path folder_;
};

/// Sets the value of an object's key, if it belongs to the object's kind.
void apply_object_key(const SceneTree& tree, const Reader& reader, const SceneKey& key,
                      const std::string& prefix, const KeyTarget& target) {
  const std::string path = prefix + key.path.substr(key.path.find("[].") + 2);
  const std::string& kind = target.object.kind;
  if (key.belongs_to(kind)) {
    reader.apply(key, path, target, kind);
  } else if (tree.find(path) != nullptr) {
    std::string kinds;
    for (const KindWithKey& having : key.kinds) kinds += (kinds.empty() ? "" : " ") + having.kind;
    tree.fail(path, fmt::format(
                        "a {} has no such key; the kinds that have it are: {}. Remove it, or change {}.kind",
                        kind, kinds, prefix));
  }
}

void check_object(const SceneTree& tree, const ObjectDescription& object, const std::string& prefix) {
  if (object.kind == "teapot" && object.size <= 0.0)
    tree.fail(prefix + ".size_mm", "must be > 0 for a teapot; state its length");
  if (object.kind == "file" && object.file.empty())
    tree.fail(prefix + ".file", "is missing; name the mesh file");
  if (object.kind == "file" && object.unit != 1.0 && object.size > 0.0)
    tree.fail(
        prefix + ".unit",
        "has no effect with size_mm > 0, which scales the file; state size_mm = 0, or leave the unit out");
  if (object.kind == "torus" && object.tube_diameter >= object.ring_diameter) {
    tree.fail(prefix + ".tube_diameter_mm", "must be less than ring_diameter_mm; make the tube thinner");
  }
}

ObjectDescription read_object(const SceneTree& tree, const Reader& reader, std::size_t index,
                              SceneDescription& scene, SceneProblems& problems) {
  ObjectDescription object;
  const std::string prefix = fmt::format("objects.{}", index);
  bool good = true;
  for (const SceneKey& key : scene_keys()) {
    if (!key.is_of_objects()) continue;
    const bool read = problems.run([&] { apply_object_key(tree, reader, key, prefix, {scene, object}); });
    if (!read && key.path == "objects[].kind") return object;  // the first key; the others depend on it
    good = good && read;
  }
  if (good) problems.run([&] { check_object(tree, object, prefix); });
  return object;
}

void refuse_both_smoothing_forms(const SceneTree& tree) {
  for (const char* per_step : {"smoothing.min_n", "smoothing.max_n"}) {
    for (const char* per_second : {"smoothing.min_n_per_s", "smoothing.max_n_per_s"}) {
      if (tree.find(per_step) == nullptr || tree.find(per_second) == nullptr) continue;
      tree.fail(
          per_step,
          fmt::format("{} is stated too ({}); state both bounds per tick (_n) or both per second (_n_per_s)",
                      per_second, tree.place(per_second)));
    }
  }
}

void refuse_what_the_profile_states(const SceneTree& tree) {
  if (tree.find("hand.profile") == nullptr) return;
  for (const char* key : {"hand.file", "hand.side", "mirror"}) {
    if (tree.find(key) == nullptr) continue;
    tree.fail(key, fmt::format("the profile states this ({}); remove it, or remove hand.profile",
                               tree.statement("hand.profile")));
  }
}

/// @returns true if the scene has its grasp planned
bool has_grasp_type(const SceneTree& tree) {
  const toml::node* type = tree.find("grasp.type");
  return type != nullptr && type->is_string() && *type->value<std::string>() != "none";
}

void refuse_another_motion_than_the_grasp(const SceneTree& tree) {
  const toml::node* name = tree.find("motion.name");
  if (!has_grasp_type(tree) || name == nullptr || !name->is_string() ||
      *name->value<std::string>() == "posture")
    return;
  tree.fail(
      "motion.name",
      fmt::format("the motion of a planned grasp is \"posture\" ({}); state that, or grasp.type = \"none\"",
                  tree.statement("grasp.type")));
}

void check_tree(const SceneTree& tree, SceneProblems& problems) {
  refuse_unknown_keys(tree, problems);
  for (const auto& check :
       {refuse_both_smoothing_forms, refuse_what_the_profile_states, refuse_another_motion_than_the_grasp})
    problems.run([&] { check(tree); });
}

/// Stores the scene's overrides of a file that it names, and the place that names the file.
void read_overlay(const SceneTree& tree, const std::string& table, FileWithOverlay& file,
                  SceneProblems& problems) {
  problems.run([&] {
    file.overlay = tree.values_over_file(table);
    const std::string key = table + ".file";
    if (tree.find(key) != nullptr) file.stated_at = tree.statement(key);
  });
}

/// Reads the files of device and patient where the scene states something about them, which checks it.
void check_files_with_overlay(const SceneDescription& scene, SceneProblems& problems) {
  const auto stated = [](const FileWithOverlay& file) {
    return !file.stated_at.empty() || !file.overlay.empty();
  };
  if (stated(scene.device)) problems.run([&] { static_cast<void>(load_device(scene)); });
  if (stated(scene.patient)) problems.run([&] { static_cast<void>(load_patient(scene)); });
}

}  // namespace

SceneDescription read_scene(const SceneTree& tree, const std::string& origin, const fs::path& folder,
                            SceneProblems& problems) {
  check_tree(tree, problems);
  SceneDescription scene;
  scene.name = fs::path(origin).stem().string();
  const Reader reader(tree, folder);
  ObjectDescription unused;
  for (const SceneKey& key : scene_keys()) {
    if (!key.is_of_objects()) problems.run([&] { reader.apply(key, key.path, {scene, unused}); });
  }
  if (tree.find("hand.triangles") != nullptr)
    scene.hand.triangles_stated_at = tree.statement("hand.triangles");
  if (scene.grasp.type) {
    scene.grasp.stated_at = tree.statement("grasp.type");
    scene.motion.script.name = "posture";
    if (tree.find("motion.closure") == nullptr) scene.motion.script.closure = 1.0;
  }
  if (scene.mirror) {
    Handedness& side = scene.hand.handedness;
    side = side == Handedness::kRight ? Handedness::kLeft : Handedness::kRight;
  }
  const toml::node* objects = tree.find("objects");
  const toml::array* array = objects != nullptr ? objects->as_array() : nullptr;
  for (std::size_t i = 0; array != nullptr && i < array->size(); ++i)
    scene.objects.push_back(read_object(tree, reader, i, scene, problems));
  read_overlay(tree, "device", scene.device, problems);
  read_overlay(tree, "patient", scene.patient, problems);
  return scene;
}

SceneDescription parse_scene(const std::string& text, const std::string& origin, const fs::path& folder,
                             const Overrides& overrides) {
  SceneDescription scene = SceneFile(text, origin, folder).scene(overrides);
  SceneProblems first(nullptr);
  check_files_with_overlay(scene, first);
  return scene;
}

std::vector<std::string> problems_of_scene(const std::string& scene) {
  std::vector<std::string> all;
  SceneProblems problems(&all);
  problems.run([&] {
    const fs::path file = find_data_file("scene", scene, "scenes", ".toml", fs::current_path());
    const SceneTree tree(read_text_file(file.string(), "scene"), file.string(), {});
    const SceneDescription read = read_scene(tree, file.string(), file.parent_path(), problems);
    check_files_with_overlay(read, problems);
  });
  return all;
}

SceneDescription load_scene(const std::string& scene, const Overrides& overrides) {
  SceneDescription read = SceneFile(scene).scene(overrides);
  SceneProblems first(nullptr);
  check_files_with_overlay(read, first);
  return read;
}

std::pair<std::string, std::string> parse_override(const std::string& key_and_value) {
  const std::size_t equals = key_and_value.find('=');
  if (equals == std::string::npos || equals == 0) {
    throw SceneError(
        fmt::format("--set {}: is not KEY=VALUE; write e.g. force.stiffness_n_per_mm=0.9", key_and_value));
  }
  const auto trim = [](std::string text) {
    const std::size_t begin = text.find_first_not_of(" \t");
    if (begin == std::string::npos) return std::string();
    return text.substr(begin, text.find_last_not_of(" \t") - begin + 1);
  };
  return {trim(key_and_value.substr(0, equals)), trim(key_and_value.substr(equals + 1))};
}

std::vector<SceneInfo> list_scenes() {
  std::vector<SceneInfo> scenes;
  for (const std::string& name : names_in_folder(data_folder() / "scenes", ".toml")) {
    try {
      const SceneDescription scene = load_scene(name);
      const bool in_free_air = scene.motion.file.empty() && scene.motion.script.name == "wave";
      const bool has_object = !scene.objects.empty();
      scenes.push_back({.name = name,
                        .description = scene.description,
                        .readable = true,
                        .touches = !in_free_air,
                        .purpose = scene.purpose,
                        .object_kind = has_object ? scene.objects.front().kind : "",
                        .grasp = scene.grasp.type});
    } catch (const SceneError& error) {
      scenes.push_back({.name = name,
                        .description = error.what(),
                        .readable = false,
                        .touches = false,
                        .purpose = ScenePurpose::kExercise,
                        .object_kind = "",
                        .grasp = std::nullopt});
    }
  }
  return scenes;
}

}  // namespace phalanx

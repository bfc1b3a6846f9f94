// SPDX-License-Identifier: Apache-2.0
// The one checker: every key of the tree against the table of keys, then what concerns several keys at once.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "phalanx/core/nearest_name.h"
#include "phalanx/scene/data_paths.h"
#include "phalanx/scene/device_file.h"
#include "phalanx/scene/patient_file.h"
#include "scene/folder_names.h"
#include "scene/key_table.h"
#include "scene/scene_tree.h"
#include "scene/unknown_keys.h"

namespace phalanx {
namespace {

namespace fs = std::filesystem;

class Reader {
 public:
  Reader(const SceneTree& tree, fs::path folder) : tree_(tree), folder_(std::move(folder)) {}

  /// The value of one key, checked.
  [[nodiscard]] KeyValue read(const KeySpec& key, const std::string& path, const toml::node& node) const {
    KeyValue value;
    const auto wants = [&](std::string_view form) {
      tree_.fail(path, fmt::format("is {}; write {}{}", type_name(node), form, help(key)));
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
        value.number = checked(key, path, node);
        return value;
      case KeyType::kInteger:
        if (!node.is_integer()) wants("a whole number");
        static_cast<void>(checked(key, path, node));
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
          value.vector[static_cast<Eigen::Index>(i)] = checked(key, path, (*array)[i]);
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
        if (key.type != KeyType::kText) value.text = resolved(key, value.text);
        return value;
    }
    return value;
  }

 private:
  [[nodiscard]] double checked(const KeySpec& key, const std::string& path, const toml::node& node) const {
    const double number = *node.value<double>();
    if (!key.range.contains(number)) {
      tree_.fail(path, fmt::format("must be {}{}{}{}", range_text(key), key.unit.empty() ? "" : " ", key.unit,
                                   fallback(key)));
    }
    return number;
  }

  static std::string fallback(const KeySpec& key) {
    return key.default_toml.empty() ? "; or leave it out"
                                    : fmt::format("; the default is {}", key.default_toml);
  }

  static std::string help(const KeySpec& key) {
    const std::string range = range_text(key);
    return (range.empty() ? "" : fmt::format(" ({})", range)) + fallback(key);
  }

  /// A relative path in a scene file is relative to that file.
  [[nodiscard]] std::string resolved(const KeySpec& key, const std::string& text) const {
    const bool is_path = key.type == KeyType::kFile || text.find('/') != std::string::npos ||
                         fs::path(text).extension() == ".toml";
    return text.empty() || !is_path ? text : (folder_ / text).lexically_normal().string();
  }

  const SceneTree& tree_;
  fs::path folder_;
};

bool has_word(const std::string& words, const std::string& word) {
  return fmt::format(" {} ", words).find(fmt::format(" {} ", word)) != std::string::npos;
}

constexpr std::string_view kObjectPrefix = "objects[].";
bool is_object_key(const KeySpec& key) {
  return std::string_view(key.path).substr(0, kObjectPrefix.size()) == kObjectPrefix;
}

/// The value of a key: from the tree if it is there, else the table's default.
void apply_key(const SceneTree& tree, const Reader& reader, const KeySpec& key, const std::string& path,
               const KeyTarget& target) {
  if (const toml::node* node = tree.find(path)) {
    key.store(target, reader.read(key, path, *node));
  } else if (!key.default_toml.empty()) {
    const toml::table fallback = toml::parse("v = " + key.default_toml);
    key.store(target, reader.read(key, path, *fallback.get("v")));
  }
}

/// The value of an object's key, if it belongs to the object's kind.
void apply_object_key(const SceneTree& tree, const Reader& reader, const KeySpec& key,
                      const std::string& prefix, const KeyTarget& target) {
  const std::string path = fmt::format("{}.{}", prefix, key.path.substr(kObjectPrefix.size()));
  const std::string& kind = target.object.kind;
  if (key.kinds.empty() || has_word(key.kinds, kind)) {
    KeySpec of_kind = key;
    of_kind.default_toml = key.default_for(kind);
    apply_key(tree, reader, of_kind, path, target);
  } else if (tree.find(path) != nullptr) {
    tree.fail(path, fmt::format("means nothing for a {}; it belongs to: {}. Remove it or change {}.kind",
                                kind, key.kinds, prefix));
  }
}

void check_object(const SceneTree& tree, const ObjectDescription& object, const std::string& prefix) {
  if (object.kind == "teapot" && object.size <= 0.0)
    tree.fail(prefix + ".size_mm", "must be > 0 for a teapot; give its length");
  if (object.kind == "file" && object.file.empty())
    tree.fail(prefix + ".file", "is missing; name the mesh file");
  if (object.kind == "file" && object.unit != 1.0 && object.size > 0.0)
    tree.fail(prefix + ".unit",
              "size_mm scales the file whatever its unit; give size_mm = 0 or leave the unit out");
  if (object.kind == "torus" && object.tube_diameter >= object.ring_diameter) {
    tree.fail(prefix + ".tube_diameter_mm", "the tube is as thick as its ring is wide; make it thinner");
  }
}

ObjectDescription read_object(const SceneTree& tree, const Reader& reader, std::size_t index,
                              SceneDescription& scene, SceneProblems& problems) {
  ObjectDescription object;
  const std::string prefix = fmt::format("objects.{}", index);
  bool good = true;
  for (const KeySpec& key : key_table()) {
    if (!is_object_key(key)) continue;
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

/// smoothing.enabled is the older short form of the stabilisers "smoothing" and "none".
void refuse_two_stabilisers(const SceneTree& tree) {
  const toml::node* enabled = tree.find("smoothing.enabled");
  const toml::node* method = tree.find("stabiliser.method");
  if (enabled == nullptr || method == nullptr) return;
  const auto on = enabled->value_exact<bool>();
  const auto name = method->value_exact<std::string>();
  if (!on || !name) return;  // refused where they are read
  const bool agree = *on ? *name != "none" : *name == "none" || *name == "smoothing";
  if (agree) return;
  tree.fail("smoothing.enabled",
            fmt::format("the stabiliser is stated too ({}), and they say different things; remove "
                        "smoothing.enabled, which is the older form of stabiliser.method = \"{}\"",
                        tree.statement("stabiliser.method"), *on ? "smoothing" : "none"));
}

void refuse_what_the_profile_says(const SceneTree& tree) {
  if (tree.find("hand.profile") == nullptr) return;
  for (const char* key : {"hand.file", "hand.side", "mirror"}) {
    if (tree.find(key) == nullptr) continue;
    tree.fail(key, fmt::format("the profile says this ({}); remove it, or remove hand.profile",
                               tree.statement("hand.profile")));
  }
}

/// What the scene says about device and patient is checked here already, by reading their files.
void read_files_with_overlay(const SceneTree& tree, SceneDescription& scene, SceneProblems& problems) {
  problems.run([&] {
    scene.device.overlay = tree.values_over_file("device");
    if (tree.find("device.file") != nullptr) scene.device.stated_at = tree.statement("device.file");
    if (tree.find("device") != nullptr) static_cast<void>(load_device(scene));
  });
  problems.run([&] {
    scene.patient.overlay = tree.values_over_file("patient");
    if (tree.find("patient.file") != nullptr) scene.patient.stated_at = tree.statement("patient.file");
    if (tree.find("patient") != nullptr) static_cast<void>(load_patient(scene));
  });
}

SceneDescription read_scene(const std::string& text, const std::string& origin, const fs::path& folder,
                            const Overrides& overrides, SceneProblems& problems) {
  const SceneTree tree(text, origin, overrides);
  refuse_unknown_keys(tree, problems);
  for (const auto& check :
       {refuse_both_smoothing_forms, refuse_two_stabilisers, refuse_what_the_profile_says})
    problems.run([&] { check(tree); });

  SceneDescription scene;
  scene.name = fs::path(origin).stem().string();
  const Reader reader(tree, folder);
  ObjectDescription unused;
  for (const KeySpec& key : key_table()) {
    if (!is_object_key(key)) problems.run([&] { apply_key(tree, reader, key, key.path, {scene, unused}); });
  }
  if (tree.find("hand.triangles") != nullptr)
    scene.hand.triangles_stated_at = tree.statement("hand.triangles");
  if (scene.mirror) {
    Handedness& side = scene.hand.handedness;
    side = side == Handedness::kRight ? Handedness::kLeft : Handedness::kRight;
  }
  const toml::node* objects = tree.find("objects");
  const toml::array* array = objects != nullptr ? objects->as_array() : nullptr;
  for (std::size_t i = 0; array != nullptr && i < array->size(); ++i)
    scene.objects.push_back(read_object(tree, reader, i, scene, problems));
  read_files_with_overlay(tree, scene, problems);
  return scene;
}

}  // namespace

SceneDescription parse_scene(const std::string& text, const std::string& origin, const fs::path& folder,
                             const Overrides& overrides) {
  SceneProblems first(nullptr);
  return read_scene(text, origin, folder, overrides, first);
}

std::vector<std::string> problems_of_scene(const std::string& scene) {
  std::vector<std::string> all;
  SceneProblems problems(&all);
  problems.run([&] {
    const fs::path file = find_data_file("scene", scene, "scenes", ".toml", fs::current_path());
    static_cast<void>(
        read_scene(read_text_file(file.string(), "scene"), file.string(), file.parent_path(), {}, problems));
  });
  return all;
}

SceneDescription load_scene(const std::string& scene, const Overrides& overrides) {
  const fs::path file = find_data_file("scene", scene, "scenes", ".toml", fs::current_path());
  return parse_scene(read_text_file(file.string(), "scene"), file.string(), file.parent_path(), overrides);
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
      scenes.push_back({name, scene.description, true, !in_free_air});
    } catch (const SceneError& error) {
      scenes.push_back({name, error.what(), false, false});
    }
  }
  return scenes;
}

}  // namespace phalanx

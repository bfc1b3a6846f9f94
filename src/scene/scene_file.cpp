// SPDX-License-Identifier: Apache-2.0
#include "phalanx/scene/scene_file.h"

#include <fmt/format.h>

#include <sstream>
#include <utility>

#include "phalanx/scene/data_paths.h"
#include "scene/scene_reader.h"
#include "scene/scene_tree.h"
#include "scene/text_file.h"
#include "scene/toml/toml_reader.h"

namespace phalanx {
namespace {

bool holds_tables(const toml::array& array) {
  return !array.empty() && array.is_homogeneous(toml::node_type::table);
}

void add(const toml::node& node, const std::string& path, Overrides& values) {
  const auto below = [&](std::string_view name) {
    return path.empty() ? std::string(name) : fmt::format("{}.{}", path, name);
  };
  if (const toml::table* table = node.as_table()) {
    for (const auto& [key, child] : *table) add(child, below(key.str()), values);
  } else if (const toml::array* array = node.as_array(); array != nullptr && holds_tables(*array)) {
    for (std::size_t i = 0; i < array->size(); ++i) add(*array->get(i), below(std::to_string(i)), values);
  } else {
    values.emplace_back(path, toml_text(node));
  }
}

}  // namespace

std::string toml_string(const std::string& text) {
  std::ostringstream out;
  out << toml::toml_formatter{toml::value<std::string>(text), toml::format_flags::none};
  return out.str();
}

SceneFile::SceneFile(const std::string& scene) {
  const std::filesystem::path file =
      find_data_file("scene", scene, "scenes", ".toml", std::filesystem::current_path());
  text_ = read_text_file(file.string(), "scene");
  origin_ = file.string();
  folder_ = file.parent_path();
}

SceneFile::SceneFile(std::string text, std::string origin, std::filesystem::path folder)
    : text_(std::move(text)), origin_(std::move(origin)), folder_(std::move(folder)) {}

SceneDescription SceneFile::scene(const Overrides& overrides) const {
  SceneProblems first(nullptr);
  return read_scene(SceneTree(text_, origin_, overrides), origin_, folder_, first);
}

SceneWithValues SceneFile::with_values(const Overrides& overrides) const {
  const SceneTree tree(text_, origin_, overrides);
  SceneProblems first(nullptr);
  SceneWithValues read{.scene = read_scene(tree, origin_, folder_, first), .values = {}};
  add(tree.root(), "", read.values);
  return read;
}

}  // namespace phalanx

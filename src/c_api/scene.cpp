// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <utility>

#include "c_api/objects.h"
#include "phalanx/core/nearest_name.h"
#include "phalanx/scene/scene_keys.h"
#include "station/station_build.h"

namespace phalanx::c_api {
namespace {

Scene scene_of(SceneFile file, std::string name) {
  SceneWithValues read = file.with_values({});
  return {.file = std::move(file), .overrides = {}, .read = std::move(read), .name = std::move(name)};
}

/// @returns the kind of the object that a path names; "" if it names none. @throws SceneError if there is
/// no such object
std::string kind_in(const std::string& key, const SceneDescription& scene) {
  constexpr std::string_view kObjects = "objects.";
  if (!key.starts_with(kObjects)) return {};
  std::size_t index = 0;
  for (std::size_t i = kObjects.size(); i < key.size() && key[i] != '.'; ++i)
    index = std::min<std::size_t>(10 * index + static_cast<std::size_t>(key[i] - '0'), 1'000'000);
  if (index >= scene.objects.size())
    throw SceneError(
        fmt::format("{}: the scene has {} objects; the first is objects.0", key, scene.objects.size()));
  return scene.objects[index].kind;
}

}  // namespace

void Scene::set(const Overrides& changes) {
  Overrides next = laid_over(overrides, changes);
  SceneWithValues with = file.with_values(next);
  overrides = std::move(next);
  read = std::move(with);
}

std::string Scene::value(const std::string& key) const {
  const auto stated = std::find_if(read.values.begin(), read.values.end(),
                                   [&](const auto& value) { return value.first == key; });
  if (stated != read.values.end()) return stated->second;
  const SceneKey* row = find_scene_key(pattern_of(key));
  if (row == nullptr) {
    std::vector<std::string> known;
    for (const SceneKey& one : scene_keys()) known.push_back(one.path);
    throw SceneError(fmt::format("{}: no scene has this key; {}`phalanx scene keys` lists all", key,
                                 did_you_mean(pattern_of(key), known)));
  }
  const auto& value = row->is_of_objects() ? row->default_for(kind_in(key, read.scene)) : row->default_value;
  return value ? value_text(*row, *value) : std::string();
}

Scene default_scene() { return scene_of(SceneFile("", "scene", std::filesystem::path()), ""); }

}  // namespace phalanx::c_api

using namespace phalanx::c_api;

phalanx_result phalanx_scene_load(const char* name, phalanx_scene** scene) {
  if (name == nullptr) return null_argument("name");
  if (scene == nullptr) return null_argument("scene");
  return guarded([&] {
    make_handle(std::make_unique<Scene>(scene_of(phalanx::SceneFile(name), name)), scene);
    return PHALANX_OK;
  });
}

phalanx_result phalanx_scene_parse(const char* text, const char* folder, phalanx_scene** scene) {
  if (text == nullptr) return null_argument("text");
  if (scene == nullptr) return null_argument("scene");
  return guarded([&] {
    const std::filesystem::path of_files =
        folder == nullptr ? std::filesystem::current_path() : std::filesystem::path(folder);
    make_handle(std::make_unique<Scene>(scene_of(phalanx::SceneFile(text, "scene", of_files), "")), scene);
    return PHALANX_OK;
  });
}

phalanx_result phalanx_scene_set(phalanx_scene* scene, const char* key, const char* value) {
  auto* const object = object_of<Scene>(scene);
  if (object == nullptr) return wrong_handle("scene");
  if (key == nullptr) return null_argument("key");
  if (value == nullptr) return null_argument("value");
  return guarded([&] {
    object->set({{key, value}});
    return PHALANX_OK;
  });
}

phalanx_result phalanx_scene_get(const phalanx_scene* scene, const char* key, char* text, size_t size,
                                 size_t* needed) {
  const auto* const object = object_of<Scene>(scene);
  if (object == nullptr) return wrong_handle("scene");
  if (key == nullptr) return null_argument("key");
  return guarded([&] { return copy_text(object->value(key), text, size, needed); });
}

phalanx_result phalanx_scene_destroy(phalanx_scene* scene) { return destroy<Scene>(scene, "scene"); }

// SPDX-License-Identifier: Apache-2.0
// phalanx scene list|check|keys
#include <fmt/format.h>

#include <memory>
#include <string>
#include <vector>

#include "commands.h"
#include "phalanx/scene/build_model.h"
#include "phalanx/scene/scene.h"
#include "phalanx/scene/scene_keys.h"

namespace phalanx {
namespace {

int print_scenes() {
  for (const SceneInfo& scene : list_scenes()) fmt::print("{:<20} {}\n", scene.name, scene.description);
  return kDone;
}

/// Everything that `simulate` would refuse before its first step.
int check_scenes(const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    const SceneDescription scene = load_scene(name);
    const auto model = std::make_unique<HapticModel>(build_model(scene));
    const Motion motion = build_motion(scene);
    const HapticState state(*model);
    fmt::print("{}: good; triangles: hand {}, object {}; {:.6g} s at {:.6g} Hz\n", name,
               model->hand.triangle_count(), model->object.triangle_count(),
               simulation_seconds(scene, motion), scene.rate_hz);
  }
  return kDone;
}

int print_keys(bool markdown) {
  if (markdown) {
    fmt::print("{}", scene_keys_markdown());
    return kDone;
  }
  for (const SceneKey& key : scene_keys()) {
    std::string value = key.type;
    if (!key.unit.empty()) value += fmt::format(" [{}]", key.unit);
    if (!key.range.empty()) value += ", " + key.range;
    if (!key.default_value.empty()) value += ", default " + key.default_value;
    fmt::print("{:<40} {}\n{:<40} {}\n", key.path, key.meaning, "", value);
  }
  return kDone;
}

}  // namespace

void add_scene_command(CLI::App& app, Job& job) {
  CLI::App* scene = app.add_subcommand("scene", "What scenes there are and what they may say");
  scene->require_subcommand(1);
  scene->add_subcommand("list", "Name the scenes in scenes/")->callback([&job] { job = print_scenes; });

  auto names = std::make_shared<std::vector<std::string>>();
  CLI::App* check =
      scene->add_subcommand("check", "Read scenes and build their models, without running them");
  check->add_option("SCENE", *names, "names in scenes/ or .toml files")->required();
  check->callback([names, &job] { job = [names] { return check_scenes(*names); }; });

  auto markdown = std::make_shared<bool>(false);
  CLI::App* keys =
      scene->add_subcommand("keys", "List every key of a scene file with unit, range and default");
  keys->add_flag("--markdown", *markdown, "as the table of docs/scenes.md");
  keys->callback([markdown, &job] { job = [markdown] { return print_keys(*markdown); }; });
}

}  // namespace phalanx

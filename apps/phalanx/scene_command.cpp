// SPDX-License-Identifier: Apache-2.0
// phalanx scene list|check|keys|grasps|pictures
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "commands.h"
#include "phalanx/scene/build_model.h"
#include "phalanx/scene/resolved_scene.h"
#include "phalanx/scene/scene.h"
#include "phalanx/scene/scene_keys.h"
#include "scene_grasps.h"
#include "scene_pictures.h"
#include "terminal/error_line.h"
#include "usage.h"

namespace phalanx {
namespace {

int print_scenes() {
  const std::vector<SceneInfo> scenes = list_scenes();
  std::size_t width = 0;
  for (const SceneInfo& scene : scenes) width = std::max(width, scene.name.size());
  for (const SceneInfo& scene : scenes) fmt::print("{:<{}}  {}\n", scene.name, width, scene.description);
  return kDone;
}

void build_and_print(const std::string& name) {
  const SceneDescription scene = load_scene(name);
  ResolvedScene resolved = resolve(scene, {.motion = true});
  const Motion motion = resolved.motion.value();
  const auto model = std::make_unique<HapticModel>(build_model(std::move(resolved)));
  const HapticState state(*model, scene.parameters);
  fmt::print("{}: good; triangles: hand {}, object {}; {:.6g} s at {:.6g} Hz\n", name,
             model->hand.triangle_count(), model->object.triangle_count(), simulation_seconds(scene, motion),
             scene.parameters.rate_hz);
}

/// Checks scenes: reports everything that `simulate` would refuse before its first step, a line each.
int check_scenes(const std::vector<std::string>& names) {
  int code = kDone;
  for (const std::string& name : names) {
    std::vector<std::string> problems;
    try {
      problems = problems_of_scene(name);
      if (problems.empty()) build_and_print(name);
    } catch (const std::invalid_argument& refused) {
      problems.emplace_back(refused.what());
    }
    for (const std::string& problem : problems) print_error_line(fmt::format("phalanx: {}", problem));
    if (!problems.empty()) code = kWrongInput;
  }
  return code;
}

int print_keys(bool markdown) {
  if (markdown) {
    fmt::print("{}", scene_keys_markdown());
    return kDone;
  }
  for (const SceneKey& key : scene_keys()) {
    const SceneKeyText row = text_of(key);
    std::string value = row.type;
    if (!key.unit.empty()) value += fmt::format(" [{}]", key.unit);
    if (!row.range.empty()) value += ", " + row.range;
    if (!row.default_value.empty()) value += ", default " + row.default_value;
    value += ", change " + row.change;
    fmt::print("{:<40} {}\n{:<40} {}\n", key.path, row.meaning, "", value);
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
  CLI::App* keys = scene->add_subcommand(
      "keys", "List every key of a scene file with unit, range, default and what a change of it needs");
  keys->add_flag("--markdown", *markdown, "as the table of docs/scenes.md");
  keys->callback([markdown, &job] { job = [markdown] { return print_keys(*markdown); }; });

  auto grasps = std::make_shared<SceneGraspsOptions>();
  CLI::App* held = scene->add_subcommand(
      "grasps", "Plan and play the grasps of scenes with hands of several profiles, and print a table");
  held->footer(
      "Cells: T thumb, I M R L fingers that press with a palmar side (small: another side), P palm; closure "
      "margin.\n"
      "Exit codes: 0 all hands hold all objects, 1 some do not, 2 wrong usage or input.");
  held->add_option("SCENE", grasps->scenes,
                   "names in scenes/ or .toml files [all in scenes/ with grasp.type]");
  held->add_option("--profile", grasps->profiles,
                   "a name in assets/profiles or a file; repeatable [the scene's own hand]")
      ->type_name("NAME")
      ->allow_extra_args(false);
  held->add_option("--out", grasps->out, "the table as CSV too")->type_name("FILE.csv");
  held->callback([grasps, held, &job] {
    refuse_empty_values(*held);
    job = [grasps] { return tabulate_grasps(*grasps); };
  });

  auto pictures = std::make_shared<ScenePicturesOptions>();
  CLI::App* draw = scene->add_subcommand(
      "pictures", "Draw scenes at the moment of their largest force, one by one and on one sheet");
  draw->add_option("SCENE", pictures->scenes, "names in scenes/ or .toml files [all in scenes/ but bench_*]");
  draw->add_option("--out", pictures->folder,
                   "writes NAME.png for each scene and scenes.png into this folder")
      ->required()
      ->type_name("DIR");
  draw->add_option("--profile", pictures->profile,
                   "the hand of all scenes: a name in assets/profiles or a file")
      ->type_name("NAME");
  draw->add_option("--width", pictures->width, "of one picture in pixels; its height is 3/4 of it")
      ->check(CLI::Range(64, 4096))
      ->capture_default_str();
  draw->add_option("--columns", pictures->columns, "pictures in a row of the sheet")
      ->check(CLI::Range(1, 100))
      ->capture_default_str();
  draw->callback([pictures, draw, &job] {
    refuse_empty_values(*draw);
    job = [pictures] { return draw_scenes(*pictures); };
  });
}

}  // namespace phalanx

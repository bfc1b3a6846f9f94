// SPDX-License-Identifier: Apache-2.0
// phalanx grasp: plans a grasp of an object and writes it as a scene.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "commands.h"
#include "option_text.h"
#include "phalanx/core/constants.h"
#include "phalanx/core/nearest_name.h"
#include "phalanx/grasp/plan_grasp.h"
#include "phalanx/record/output_file.h"
#include "phalanx/scene/build_model.h"
#include "phalanx/scene/resolved_scene.h"
#include "phalanx/scene/scene_file.h"
#include "phalanx/scene/scene_grasp.h"
#include "phalanx/scene/scene_keys.h"
#include "terminal/error_line.h"
#include "terminal/progress.h"

namespace phalanx {
namespace {

namespace fs = std::filesystem;

constexpr double kHoldSeconds = 2.0;   // of the scene's motion
constexpr double kLeastSize_mm = 0.1;  // of an object
constexpr double kMostSize = 2.0;      // [m]

struct GraspCommand {
  std::string object;
  std::string type;
  std::string profile;
  std::optional<double> object_size_mm;
  std::uint64_t seed = 1;
  std::vector<std::string> set;
  std::string out;
  bool quiet = false;
};

/// @returns the kinds of object that the program makes.
std::vector<std::string> made_kinds() {
  std::vector<std::string> kinds = find_scene_key("objects[].kind")->choices;
  std::erase(kinds, "file");
  return kinds;
}

bool is_made_kind(const std::string& name) {
  const std::vector<std::string> kinds = made_kinds();
  return std::find(kinds.begin(), kinds.end(), name) != kinds.end();
}

/// Refuses what looks like a mistyped kind, before it is looked for as a file.
void check_object(const std::string& name) {
  if (is_made_kind(name) || fs::path(name).has_extension() || name.find('/') != std::string::npos) return;
  const std::vector<std::string> kinds = made_kinds();
  throw std::invalid_argument(
      fmt::format("--object {}: neither a mesh file nor a kind of object; {}Known: {}", name,
                  did_you_mean(name, kinds), fmt::join(kinds, ", ")));
}

/// @returns the scene's overrides, without wrist and motion.
Overrides scene_overrides(const GraspCommand& command) {
  Overrides out;
  if (!command.profile.empty())
    out.emplace_back("hand.profile", option_as_toml("--profile", command.profile));
  if (command.object_size_mm && !(*command.object_size_mm >= kLeastSize_mm))
    throw std::invalid_argument(
        fmt::format("--object-size-mm {}: must be at least {}", *command.object_size_mm, kLeastSize_mm));
  if (is_made_kind(command.object)) {
    if (command.object_size_mm)
      throw std::invalid_argument(
          fmt::format("--object-size-mm {}: {} is made by the program; state its sizes with --set, as "
                      "--set objects.0.diameter_mm=60",
                      *command.object_size_mm, command.object));
    out.emplace_back("objects", fmt::format("[{{ kind = {} }}]", toml_string(command.object)));
  } else {
    out.emplace_back("objects", fmt::format("[{{ kind = \"file\", size_mm = {:.6f} }}]",
                                            command.object_size_mm.value_or(0.0)));
    out.emplace_back("objects.0.file", option_as_toml("--object", fs::absolute(command.object).string()));
  }
  for (const std::string& pair : command.set) {
    out.push_back(parse_override(pair));
    const std::string& key = out.back().first;
    if (key.starts_with("motion") ||
        (key.starts_with("grasp") && key != "grasp.forearm" && key != "grasp.palm") ||
        key == "hand.position_mm" || key == "hand.rotation_deg")
      throw std::invalid_argument(fmt::format(
          "--set {}: wrist, motion and grasp are what is searched for; leave {} out, and edit the scene",
          pair, key));
  }
  return out;
}

/// Writes a scene file: one table for each first part of the keys, `objects` as an array of tables.
std::string scene_text(const Overrides& values) {
  std::map<std::string, std::string> tables;
  std::string top = "# SPDX-License-Identifier: Apache-2.0\n";
  for (const auto& [path, value] : values) {
    const std::size_t dot = path.find('.');
    if (dot == std::string::npos) {
      top += fmt::format("{} = {}\n", path, value);
      continue;
    }
    std::string table = fmt::format("[{}]", path.substr(0, dot));
    std::string key = path.substr(dot + 1);
    if (path.starts_with("objects.")) {
      const std::size_t second = key.find('.');
      table = fmt::format("[[objects]]  # {}", key.substr(0, second));
      key = key.substr(second + 1);
    } else if (path.starts_with("motion.angle_deg.")) {
      table = "[motion.angle_deg]  # where the hand presses";
      key = path.substr(std::string("motion.angle_deg.").size());
    }
    tables[table] += fmt::format("{} = {}\n", key, value);
  }
  for (const auto& [table, keys] : tables) top += fmt::format("\n{}\n{}", table, keys);
  return top;
}

void print_grasp(const PlannedGrasp& grasp, const GraspRule& rule, const std::string& hand) {
  fmt::print("{} grasp by {}\n", rule.name, hand);
  fmt::print("  wrench ball  {:.3f}{}\n", grasp.wrench_ball,
             rule.closure ? "" : ": a hook needs no force closure, it holds a pull towards the fingertips");
  fmt::print("  comfort      {:.2f} (0: all joints at the end of their range, 1: all in its middle)\n",
             grasp.comfort);
  for (const PlannedContact& contact : grasp.contact)
    fmt::print("  contact      {:<36}{}\n", segment_name(contact.segment),
               contact.segment == kPalm ? "palm"
               : contact.pad            ? "palmar side"
                                        : "side");
}

int plan_and_write(const GraspCommand& command) {
  const auto type = find_grasp_type(command.type);
  if (!type)
    throw std::invalid_argument(fmt::format("--type {}: not a type of grasp; {}Known: {}", command.type,
                                            did_you_mean(command.type, grasp_type_names()),
                                            fmt::join(grasp_type_names(), ", ")));
  check_object(command.object);
  Overrides overrides = scene_overrides(command);
  const std::string object = fs::path(command.object).stem().string();
  overrides.emplace(
      overrides.begin(), "description",
      option_as_toml("--object", fmt::format("{} grasp of {}, seed {}", command.type, object, command.seed)));
  const SceneFile base("", "--object", fs::current_path());
  ResolvedScene scene = resolve(base.scene(overrides), {});
  scene.description.grasp.type = type;
  scene.description.grasp.seed = command.seed;
  const Bounds box = bounds(scene.world);
  if (!scene.world.triangles.empty() && (box.max - box.min).maxCoeff() > kMostSize)
    throw std::invalid_argument(
        fmt::format("--object {}: {:.4g} m large, too large for a hand; state --object-size-mm, or the unit "
                    "of the file's "
                    "numbers with --set objects.0.unit=mm",
                    command.object, (box.max - box.min).maxCoeff()));
  GraspSearch search;
  {
    ProgressBar bar("planning", !command.quiet);
    search = search_grasp(scene, *type, [&](double done) {
      bar.show(static_cast<std::uint64_t>(1000.0 * done), 1000);
      return true;
    });
  }
  if (!search.grasp)
    throw std::runtime_error(
        fmt::format("{}: {}", command.object, no_grasp_text(search, *type, scene.hand.parameters.name)));
  for (auto& value :
       grasp_values(*search.grasp, scene.mirrored,
                    grasp_checksum(scene.description.grasp, scene.hand, scene.world, scene.mirrored)))
    overrides.push_back(std::move(value));
  overrides.emplace_back("grasp.type", toml_string(command.type));
  overrides.emplace_back("grasp.seed", std::to_string(command.seed));
  overrides.emplace_back("motion.closure", "1.0");
  overrides.emplace_back("motion.close_s", fmt::format("{:.1f}", PlannedGrasp::kCloseSeconds));
  overrides.emplace_back("motion.hold_s", fmt::format("{:.1f}", kHoldSeconds));
  const SceneWithValues written = base.with_values(overrides);
  const fs::path out = command.out.empty()
                           ? fs::path("out/grasps") / fmt::format("{}_{}.toml", object, command.type)
                           : fs::path(command.out);
  if (out.has_parent_path()) prepare_output_folder(out.parent_path());
  OutputFile file(out);
  file.text(scene_text(written.values));
  file.commit();
  if (command.quiet) return kDone;
  print_grasp(*search.grasp, grasp_rule(*type), scene.hand.parameters.name);
  fmt::print("wrote    {}: try phalanx simulate {} --picture out/grasp.png, or phalanx run {}\n",
             out.string(), out.string(), out.string());
  return kDone;
}

}  // namespace

void add_grasp_command(CLI::App& app, Job& job) {
  auto command = std::make_shared<GraspCommand>();
  CLI::App* sub =
      app.add_subcommand("grasp", "Plan a grasp of any object by any hand, and write it as a scene");
  sub->footer(
      "The same seed gives the same grasp. Without force closure, or if another condition fails, it says "
      "which.\n"
      "Conditions and types: docs/grasps.md.\n"
      "Exit codes: 0 done, 1 no grasp was found, 2 wrong usage or input.");
  sub->add_option(
         "--object", command->object,
         "a mesh (.obj .3ds .stl .ply .glb), or a kind of object that the program makes: mug, pen, ...")
      ->type_name("FILE|KIND")
      ->required();
  sub->add_option("--type", command->type, fmt::format("{}", fmt::join(grasp_type_names(), ", ")))
      ->type_name("TYPE")
      ->required();
  sub->add_option("--object-size-mm", command->object_size_mm,
                  "a file's largest extent; without it the file's numbers are metres")
      ->type_name("MM");
  sub->add_option("--profile", command->profile,
                  "the patient's profile: a name in assets/profiles or a file [adult hand]")
      ->type_name("NAME");
  sub->add_option("--seed", command->seed, "of the candidates [1]")->type_name("N");
  sub->add_option("--set", command->set, "a scene key: KEY=VALUE, as objects.0.diameter_mm=60; repeatable")
      ->type_name("KEY=VALUE")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  sub->add_option("--out", command->out, "the scene [out/grasps/OBJECT_TYPE.toml]")->type_name("FILE.toml");
  sub->add_flag("--quiet", command->quiet, "print nothing but errors");
  sub->callback([command, &job] { job = [command] { return plan_and_write(*command); }; });
}

}  // namespace phalanx

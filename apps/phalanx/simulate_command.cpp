// SPDX-License-Identifier: Apache-2.0
// phalanx simulate [SCENE]: a motion through the step, as fast as the machine allows.
#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "commands.h"
#include "nearest_approach.h"
#include "option_text.h"
#include "parameters_text.h"
#include "patient/registry_options.h"
#include "phalanx/device/motion.h"
#include "phalanx/record/recordings.h"
#include "phalanx/scene/build_model.h"
#include "phalanx/scene/resolved_scene.h"
#include "phalanx/scene/scene.h"
#include "phalanx/simulation/simulate.h"
#include "run_outputs.h"
#include "summary_table.h"
#include "terminal/error_line.h"
#include "terminal/progress.h"
#include "usage.h"

namespace phalanx {
namespace {

namespace fs = std::filesystem;

constexpr double kPictureSeconds = 15.0;  // time of one core for 1280 x 960

struct SimulateOptions {
  std::string scene = "grasp_teapot";
  std::vector<std::string> set;
  std::string object, motion, mapping, profile;
  std::optional<int> trial;
  std::optional<double> object_size_mm, seconds, rate_hz, lead_in, at;
  std::optional<std::int64_t> seed;
  std::string out, plot, picture;
  CLI::Option* plot_asked = nullptr;
  bool poses = false;
  bool contacts = false;
  bool quiet = false;
  RegistryOptions registry;  ///< --keys
};

/// A command-line option that sets a scene key.
struct KeyOption {
  std::string option;  ///< as typed: "--seconds -1"
  std::string key;
  std::string value;  ///< TOML
};

KeyOption text_option(const std::string& option, const std::string& key, const std::string& text) {
  return {fmt::format("{} {}", option, text), key, option_as_toml(option, text)};
}

/// Makes a TOML float: without a point or exponent, the number would be an integer.
KeyOption number_option(const std::string& option, const std::string& key, double number) {
  const std::string text = fmt::format("{}", number);
  const bool is_float = text.find_first_of(".en") != std::string::npos;  // true for inf and nan, too
  return {fmt::format("{} {}", option, text), key, is_float ? text : text + ".0"};
}

KeyOption integer_option(const std::string& option, const std::string& key, std::int64_t number) {
  return {fmt::format("{} {}", option, number), key, std::to_string(number)};
}

/// @returns true for a recording of `phalanx run`, whose samples are played as the motion
bool is_recording(const std::string& motion) { return has_recording_name(motion); }

std::vector<KeyOption> key_options(const SimulateOptions& o) {
  std::vector<KeyOption> result;
  if (!o.profile.empty()) result.push_back(text_option("--profile", "hand.profile", o.profile));
  if (!o.motion.empty() && !is_recording(o.motion))
    result.push_back(text_option("--motion", "motion.file", o.motion));
  if (!o.mapping.empty()) result.push_back(text_option("--mapping", "motion.mapping", o.mapping));
  if (o.trial) result.push_back(integer_option("--trial", "motion.trial", *o.trial));
  if (o.lead_in && !is_recording(o.motion))
    result.push_back(number_option("--lead-in", "motion.lead_in_s", *o.lead_in));
  if (o.seconds) result.push_back(number_option("--seconds", "seconds", *o.seconds));
  if (o.rate_hz) result.push_back(number_option("--rate-hz", "rate_hz", *o.rate_hz));
  if (o.seed) result.push_back(integer_option("--seed", "seed", *o.seed));
  return result;
}

/// Calls `read` with the overrides. A refusal names the typed option, not the --set that it stands for.
template <typename Read>
SceneDescription read_with(Overrides overrides, const std::vector<KeyOption>& options, const Read& read) {
  for (const KeyOption& option : options) overrides.emplace_back(option.key, option.value);
  try {
    return read(overrides);
  } catch (const SceneError& error) {
    const std::string message = error.what();
    for (const KeyOption& option : options) {
      const std::string stands_for = fmt::format("--set {}={}: ", option.key, option.value);
      if (message.starts_with(stands_for))
        throw SceneError(fmt::format("{}: {}", option.option, message.substr(stands_for.size())));
    }
    throw;
  }
}

/// Replaces the scene's objects by the file, at the pose of the first object. --set of a key of objects.0
/// then concerns the file and its pose.
SceneDescription with_object(const SimulateOptions& options, const Overrides& set) {
  Overrides of_scene;
  for (const auto& [key, value] : set) {
    const bool of_file =
        key.starts_with("objects.") && key != "objects.0.position_mm" && key != "objects.0.rotation_deg";
    if (!of_file) of_scene.emplace_back(key, value);
  }
  const SceneDescription scene = read_with(
      of_scene, key_options(options), [&](const Overrides& all) { return load_scene(options.scene, all); });
  Overrides of_file = {{"objects", "[{ kind = \"file\", size_mm = 0 }]"}};
  of_file.insert(of_file.end(), set.begin(), set.end());
  std::vector<KeyOption> keys = key_options(options);
  keys.push_back(text_option("--object", "objects.0.file", options.object));
  if (options.object_size_mm)
    keys.push_back(number_option("--object-size-mm", "objects.0.size_mm", *options.object_size_mm));
  SceneDescription replaced =
      read_with(of_file, keys, [&](const Overrides& all) { return load_scene(options.scene, all); });
  if (!scene.objects.empty()) replaced.objects.front().pose = scene.objects.front().pose;
  return replaced;
}

SceneDescription described(const SimulateOptions& options) {
  Overrides set;
  for (const std::string& pair : options.set) set.push_back(parse_override(pair));
  if (options.object.empty() && options.object_size_mm)
    throw std::invalid_argument("--object-size-mm needs --object FILE");
  SceneDescription scene = !options.object.empty()
                               ? with_object(options, set)
                               : read_with(set, key_options(options), [&](const Overrides& all) {
                                   return load_scene(options.scene, all);
                                 });
  if (scene.motion.file.empty() || is_recording(options.motion)) {
    const auto refuse = [](const std::string& option) {
      throw std::invalid_argument(
          fmt::format("{}: the scene plays no motion file; add --motion FILE or leave it out", option));
    };
    if (options.trial) refuse(fmt::format("--trial {}", *options.trial));
    if (options.lead_in && !is_recording(options.motion))
      refuse(fmt::format("--lead-in {}", *options.lead_in));
    if (!options.mapping.empty()) refuse(fmt::format("--mapping {}", options.mapping));
  }
  return scene;
}

OutputPlan plan(const SimulateOptions& options) {
  OutputPlan result{.folder = options.out,
                    .poses = options.poses,
                    .contacts = options.contacts,
                    .plot = options.plot,
                    .picture = options.picture};
  if (options.plot_asked->count() > 0 && options.plot.empty()) {
    if (options.out.empty())
      throw std::invalid_argument("--plot needs a FILE.svg, or --out DIR to put plot.svg into");
    result.plot = result.folder / "plot.svg";
  }
  const auto must_end = [](const char* option, const fs::path& file, const char* extension) {
    if (!file.empty() && file.extension() != extension) {
      throw std::invalid_argument(
          fmt::format("{} '{}': the file's name must end in {}", option, file.string(), extension));
    }
  };
  must_end("--plot", result.plot, ".svg");
  must_end("--picture", result.picture, ".png");
  if (options.at && options.picture.empty())
    throw std::invalid_argument("--at needs --picture FILE.png, whose moment it names");
  if (options.poses && options.out.empty()) throw std::invalid_argument("--poses needs --out DIR");
  if (options.contacts && options.out.empty()) throw std::invalid_argument("--contacts needs --out DIR");
  return result;
}

/// @returns the number of the tick at a time, from 0.
std::uint64_t tick_at(double seconds, std::uint64_t ticks, double rate_hz) {
  const double last = static_cast<double>(ticks - 1);
  const double tick = std::round(seconds * rate_hz);
  if (tick >= 0.0 && tick <= last) return static_cast<std::uint64_t>(tick);
  throw std::invalid_argument(fmt::format(
      "--at {}: the motion is played from 0 to {} s; name a time within it", seconds, last / rate_hz));
}

/// @returns a sentence for each --set of a key that only the closed loop reads.
std::vector<std::string> notes_on_overrides(const std::vector<std::string>& set) {
  std::vector<std::string> notes;
  for (const std::string& typed : set) {
    const std::string key = parse_override(typed).first;
    const std::string table = key.substr(0, key.find('.'));
    if (table == "device" || table == "patient")
      notes.push_back(
          fmt::format("--set {}: {} has no effect in simulate; use `phalanx run` or a study", typed, key));
  }
  return notes;
}

/// @returns a sentence if a mesh file is among the objects and their surface is not closed, else none.
std::vector<std::string> notes_on_meshes(const SceneDescription& scene, const TriangleMesh& world) {
  std::string files;
  for (const ObjectDescription& object : scene.objects)
    if (object.kind == "file") files += " " + object.file.string();
  if (files.empty() || is_closed(world)) return {};
  return {
      fmt::format("the mesh is open, or has edges of more than two triangles: a finger may go through a "
                  "hole; see `phalanx mesh check{}`",
                  files)};
}

int simulate_scene(const SimulateOptions& options) {
  OutputPlan output_plan = plan(options);
  SceneDescription scene = described(options);
  if (options.contacts && scene.parameters.contact.mode != ContactMode::kSliding)
    throw std::invalid_argument(
        "--contacts: the scene has contact.mode = \"static\", and ticks.csv holds its one contact point a "
        "segment; leave --contacts out or add --set contact.mode=sliding");
  // The scene's description of its own motion and objects does not hold for others.
  if (!options.motion.empty() || !options.object.empty()) scene.description.clear();
  const bool draws = !output_plan.picture.empty();
  ResolvedScene resolved =
      resolve(scene, {.hand = draws ? HandDetail::kDrawn : HandDetail::kCollision, .motion = true});
  const JointArray& open = resolved.hand.parameters.open_angle;
  const Motion motion = is_recording(options.motion)
                            ? led_in(recorded_motion(options.motion, recording_keys_of(options.registry)),
                                     open, options.lead_in.value_or(0.0))
                            : resolved.motion.value();
  DrawnHand drawn = draws ? drawn_hand(resolved.hand) : DrawnHand();
  std::vector<std::string> notes = notes_on_overrides(options.set);
  for (std::string& note : notes_on_meshes(scene, resolved.world)) notes.push_back(std::move(note));
  if (resolved.planned_type && resolved.planned_type != scene.grasp.type)
    notes.push_back(fmt::format("no {} grasp was found: a {} grasp holds the object",
                                grasp_rule(*scene.grasp.type).name, grasp_rule(*resolved.planned_type).name));
  const auto model = std::make_unique<HapticModel>(build_model(std::move(resolved)));
  const double seconds = is_recording(options.motion) ? options.seconds.value_or(motion.duration())
                                                      : simulation_seconds(scene, motion);
  const std::uint64_t ticks = tick_count(seconds, scene.parameters.rate_hz);
  if (options.at) output_plan.picture_at = tick_at(*options.at, ticks, scene.parameters.rate_hz);

  Summary summary;
  summary.scene = scene.name;
  summary.notes = std::move(notes);
  summary.rate_hz = scene.parameters.rate_hz;
  summary.seconds = static_cast<double>(ticks) / scene.parameters.rate_hz;
  summary.hand_triangles = model->hand.triangle_count();
  summary.object_triangles = model->object.triangle_count();
  {
    const HapticState checked(*model, scene.parameters);
  }  // a hand that starts inside is reported before any file is written
  RunOutputs outputs(output_plan, *model, scene.parameters.contact.margin, std::move(drawn), ticks);
  NearestApproach approach(ticks);
  if (draws && !options.quiet)
    print_aside(fmt::format("the picture takes about {}\n", duration_text(on_all_cores(kPictureSeconds))));
  {
    ProgressBar bar("simulating", !options.quiet);
    summary.step_us =
        simulate(*model, scene.parameters, motion, ticks,
                 {.tick =
                      [&](const Snapshot& snapshot) {
                        add_tick(summary, snapshot);
                        outputs.add(snapshot);
                        approach.add(snapshot);
                      },
                  .progress = [&](std::uint64_t done, std::uint64_t total) { bar.show(done, total); }});
    if (!output_plan.picture.empty()) bar.show("rendering");
    summary.made = made_here();
    outputs.finish(
        summary,
        {.title = scene.name, .subtitle = scene.description, .parameters = parameters_text(scene, ticks)});
  }
  if (options.quiet) return kDone;
  if (options.out.empty()) {
    fmt::print("{}", summary_table(summary, touched(summary) ? "" : approach.text(*model, scene)));
  } else {
    fmt::print("{}", warning_lines(summary));
    fmt::print("wrote    {} ({} ticks, peak {:.2f} N in all at {:.3f} s)\n", options.out, ticks,
               summary.peak_total_force, summary.peak_total_force_time_s);
  }
  if (!output_plan.plot.empty()) fmt::print("wrote    {}\n", output_plan.plot.string());
  if (!output_plan.picture.empty())
    fmt::print("wrote    {} (at {:.3f} s)\n", output_plan.picture.string(), outputs.picture_time());
  return kDone;
}

}  // namespace

void add_simulate_command(CLI::App& app, Job& job) {
  auto options = std::make_shared<SimulateOptions>();
  CLI::App* command = app.add_subcommand(
      "simulate", "Run a motion of the hand against the scene's object and report forces and torques");
  command->footer(
      "Without --out a table of peak forces and torques is printed. Outputs: docs/outputs.md.\n"
      "Exit codes: 0 done, 1 failed, 2 wrong usage or input.");
  command->add_option("SCENE", options->scene,
                      "a name in scenes/ (see `phalanx scene list`) or a .toml file [grasp_teapot]");
  command
      ->add_option("--out", options->out,
                   "write summary.json, ticks.csv, object.obj and hand/*.obj into this folder")
      ->type_name("DIR");
  command->add_flag("--poses", options->poses, "with --out: poses.csv too");
  command->add_flag("--contacts", options->contacts,
                    "with --out: contacts.csv too, the contact points of sliding mode");
  options->plot_asked =
      command->add_option("--plot", options->plot, "draw forces, torques and angles [DIR/plot.svg]")
          ->expected(0, 1)
          ->type_name("FILE.svg");
  command
      ->add_option("--picture", options->picture,
                   "render hand and object at peak force; without contact, in the middle of the motion")
      ->type_name("FILE.png");
  command->add_option("--at", options->at, "with --picture: the time that it shows")->type_name("SECONDS");
  command
      ->add_option("--set", options->set,
                   "override a scene key, e.g. force.stiffness_n_per_mm=0.9; repeatable")
      ->type_name("KEY=VALUE")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  command
      ->add_option("--object", options->object,
                   "a mesh in place of the scene's objects: .obj .3ds .stl .ply .glb")
      ->type_name("FILE");
  command
      ->add_option("--object-size-mm", options->object_size_mm,
                   "its largest extent; without it the file's numbers are metres")
      ->type_name("MM");
  command
      ->add_option("--profile", options->profile,
                   "the patient's profile: a name in assets/profiles or a file")
      ->type_name("NAME");
  command
      ->add_option("--motion", options->motion,
                   "a CSV of joint angles, or a recording (.mcap, .mcap.enc), in place of the scene's motion")
      ->type_name("FILE");
  command
      ->add_option("--mapping", options->mapping,
                   "how its columns become joint angles: a name in assets/mappings or a file")
      ->type_name("NAME");
  command
      ->add_option("--trial", options->trial,
                   "which trial of a motion file whose time runs backwards, from 1")
      ->type_name("N");
  command
      ->add_option(
          "--lead-in", options->lead_in,
          "bring the hand from the open hand to the motion file's first sample in this time, before it [0]")
      ->type_name("S");
  command->add_option("--seconds", options->seconds, "how long [the motion's length]")->type_name("S");
  command->add_option("--rate-hz", options->rate_hz, "steps per second [the scene's]")->type_name("HZ");
  command->add_option("--seed", options->seed, "of everything random in the motion")->type_name("N");
  command->add_flag("--quiet", options->quiet, "print nothing but errors");
  add_registry_options(*command, options->registry);
  command->callback([options, command, &job] {
    refuse_empty_values(*command);
    job = [options] { return with_registry_errors([&] { return simulate_scene(*options); }); };
  });
}

}  // namespace phalanx

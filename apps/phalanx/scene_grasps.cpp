// SPDX-License-Identifier: Apache-2.0
#include "scene_grasps.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <stdexcept>
#include <utility>

#include "commands.h"
#include "option_text.h"
#include "phalanx/core/index.h"
#include "phalanx/grasp/held_grasp.h"
#include "phalanx/record/output_file.h"
#include "phalanx/scene/build_model.h"
#include "phalanx/scene/resolved_scene.h"
#include "phalanx/scene/scene_file.h"
#include "phalanx/simulation/simulate.h"
#include "terminal/progress.h"

namespace phalanx {
namespace {

constexpr double kAtHold = 0.9;  // of the hold, at which the grasp is looked at
constexpr std::string_view kDigitLetters = "TIMRL";

/// One hand on one scene.
struct Row {
  std::string scene;
  std::string hand;
  std::string type;
  std::string digits;  ///< letters of the digits that press with a palmar side; small: with another side
  bool palm = false;
  double margin = 0.0;
  bool holds = false;   ///< as holds(); of a scene without a type: a digit presses
  std::string problem;  ///< why there is no grasp; empty: there is one
};

/// @returns true if thumb, enough fingers and the palm press, where the type has them, with force closure where it asks
/// for it
bool holds(const GraspRule& rule, const Row& row) {
  const auto is_thumb = [](char c) { return c == 'T' || c == 't'; };
  const auto thumbs = std::count_if(row.digits.begin(), row.digits.end(), is_thumb);
  const auto fingers = std::ssize(row.digits) - thumbs;
  return (!rule.digit[0] || thumbs > 0) && fingers >= rule.least_fingers && (!rule.palm || row.palm) &&
         (!rule.closure || row.margin >= PlannedGrasp::kLeastBall);
}

HandDescription hand_of(const std::string& profile) {
  HandDescription hand;
  hand.profile = profile;
  return hand;
}

/// @returns the hand of a profile, for the table's head
std::string heading(const std::string& profile) {
  if (profile.empty()) return "the scene's own hand";
  const HandNumbers hand = load_hand_numbers(hand_of(profile));
  return fmt::format("{}, {}", hand.parameters.name, hand.handedness == Handedness::kLeft ? "left" : "right");
}

/// Plays a scene up to the end of its hold.
HeldGrasp play(const HapticModel& model, const SceneDescription& scene, const Motion& motion) {
  const ScriptedMotion& script = scene.motion.script;
  const double end = scene.motion.file.empty() ? script.start_s + script.close_s + kAtHold * script.hold_s
                                               : motion.duration();
  const auto ticks = static_cast<std::uint64_t>(std::ceil(end * scene.parameters.rate_hz));
  Snapshot last;
  simulate(model, scene.parameters, motion, std::max<std::uint64_t>(1, ticks),
           {.tick = [&](const Snapshot& snapshot) { last = snapshot; }, .progress = {}});
  return held_grasp(model, scene.parameters, last);
}

Row row_of(const SceneFile& file, const std::string& name, const std::string& profile) {
  Row row;
  row.scene = name;
  row.hand = heading(profile);
  Overrides overrides;
  if (!profile.empty()) overrides.emplace_back("hand.profile", option_as_toml("--profile", profile));
  const SceneDescription stated = file.scene(overrides);
  try {
    ResolvedScene resolved = resolve(stated, {.motion = true});
    const SceneDescription scene = resolved.description;
    const std::optional<GraspType> type = resolved.planned_type ? resolved.planned_type : scene.grasp.type;
    const Motion motion = resolved.motion.value();
    const auto model = std::make_unique<HapticModel>(build_model(std::move(resolved)));
    const HeldGrasp held = play(*model, scene, motion);
    for (int digit = 0; digit < kDigits; ++digit) {
      const auto presses = [&](bool pad) {
        return std::any_of(held.contact.begin(), held.contact.end(), [&](const PlannedContact& contact) {
          return contact.segment != kPalm && digit_of_segment(contact.segment) == digit && contact.pad == pad;
        });
      };
      const char letter = kDigitLetters[idx(digit)];
      if (presses(true))
        row.digits += letter;
      else if (presses(false))
        row.digits += static_cast<char>(letter - 'A' + 'a');
    }
    row.palm = std::any_of(held.contact.begin(), held.contact.end(),
                           [](const PlannedContact& contact) { return contact.segment == kPalm; });
    row.margin = held.closure_margin;
    if (type) {
      row.type = grasp_rule(*type).name;
      row.holds = holds(grasp_rule(*type), row);
    } else {
      row.holds = !row.digits.empty();
    }
  } catch (const std::invalid_argument& error) {
    row.problem = error.what();
  }
  return row;
}

std::string cell(const Row& row) {
  if (!row.problem.empty()) return "no grasp";
  return fmt::format("{}{}{} {:.3f}", row.holds ? "" : "not held: ", row.digits, row.palm ? "+P" : "",
                     row.margin);
}

void write_csv(const std::filesystem::path& out, const std::vector<Row>& rows) {
  if (out.has_parent_path()) prepare_output_folder(out.parent_path());
  OutputFile file(out);
  file.text("scene,hand,type,digits,palm,closure_margin,holds,problem\n");
  for (const Row& row : rows) {
    std::string problem = row.problem;
    std::replace(problem.begin(), problem.end(), '"', '\'');
    file.text(fmt::format("{},\"{}\",{},{},{},{:.6f},{},\"{}\"\n", row.scene, row.hand, row.type, row.digits,
                          row.palm ? 1 : 0, row.margin, row.holds ? 1 : 0, problem));
  }
  file.commit();
}

}  // namespace

int tabulate_grasps(const SceneGraspsOptions& options) {
  std::vector<std::string> scenes = options.scenes;
  if (scenes.empty())
    for (const SceneInfo& info : list_scenes())
      if (info.readable && load_scene(info.name).grasp.type) scenes.push_back(info.name);
  std::vector<std::string> profiles = options.profiles;
  for (const std::string& profile : profiles)  // a mistyped one is no missing grasp
    static_cast<void>(heading(profile));
  if (profiles.empty()) profiles.emplace_back();
  std::vector<Row> rows;
  {
    ProgressBar bar("planning and playing", true);
    for (const std::string& scene : scenes) {
      const SceneFile file(scene);
      for (const std::string& profile : profiles) {
        bar.show(rows.size(), scenes.size() * profiles.size());
        rows.push_back(row_of(file, scene, profile));
      }
    }
    bar.show(rows.size(), rows.size());
  }
  std::string head = "| scene | type |";
  std::string line = "| --- | --- |";
  for (const std::string& profile : profiles) {
    head += fmt::format(" {} |", heading(profile));
    line += " --- |";
  }
  fmt::print("{}\n{}\n", head, line);
  for (std::size_t i = 0; i < rows.size(); i += profiles.size()) {
    std::string text = fmt::format("| `{}` | {} |", rows[i].scene, rows[i].type);
    for (std::size_t k = 0; k < profiles.size(); ++k) text += fmt::format(" {} |", cell(rows[i + k]));
    fmt::print("{}\n", text);
  }
  bool all = true;
  for (const Row& row : rows) {
    all = all && row.holds && row.problem.empty();
    if (!row.problem.empty()) fmt::print("\n{}, {}: {}\n", row.scene, row.hand, row.problem);
  }
  if (!options.out.empty()) write_csv(options.out, rows);
  return all ? kDone : kFailed;
}

}  // namespace phalanx

// SPDX-License-Identifier: Apache-2.0
// S2 fig. 5: a power grasp at 1.4 N/mm with +-0.1 N a step, the force of every touching phalanx.
#include <fmt/format.h>

#include <algorithm>

#include "papers/s2_experiments.h"
#include "papers/s2_loop_figures.h"
#include "phalanx/figures/human_names.h"
#include "phalanx/scene/patient_file.h"
#include "record/made_json.h"

namespace phalanx {

namespace {

/// Describes the torque that the motors cannot exert: "up to 0.21 Nm, on the ring MCP flexion".
std::string unrendered_text(const LoopRun& run) {
  const auto most = std::max_element(run.unrendered.begin(), run.unrendered.end());
  return fmt::format("up to {:.2f} Nm, on the {}", *most,
                     human_joint_name(static_cast<int>(most - run.unrendered.begin())));
}

}  // namespace

LoopRun run_s2_fig5(int seeds) { return run_loop("smoothing, 0.1 N a step", "stability_grasp", {}, seeds); }

LoopRun run_s2_fig5_driven(const Overrides& set, int seeds) {
  Overrides driven = {{"device.file", "five_digits"},
                      {"device.copy.middle.of", "\"none\""},
                      {"device.copy.ring.of", "\"none\""},
                      {"device.copy.little.of", "\"none\""}};
  driven.insert(driven.end(), set.begin(), set.end());
  return run_loop("all five digits driven", "stability_grasp", driven, seeds);
}

ExperimentReport s2_fig5() {
  const LoopRun run = run_s2_fig5(kLoopSeeds);
  const LoopRun driven = run_s2_fig5_driven({}, kLoopSeeds);
  const LoopRun press =
      run_loop("index alone, 0.1 N a step", "stability_press",
               {{"force.stiffness_n_per_mm", "1.4"}, {"smoothing.min_n", "-0.1"}, {"smoothing.max_n", "0.1"}},
               kLoopSeeds);
  std::string touching;
  for (const int segment : run.curves.touching)
    touching += (touching.empty() ? "" : ", ") + human_segment_name(segment);
  ExperimentReport report;
  nlohmann::ordered_json json;
  json["experiment"] = "s2-fig5";
  json["paper"] = "S2 fig. 5: a grasp at 1.4 N/mm with +-0.1 N a step is steady";
  json["paper_values"] = "not printed";
  json["grasp"] = loop_json(run);
  json["index_alone"] = loop_json(press);
  json["touching"] = touching;
  json["all_driven"] = loop_json(driven);
  json["made"] = made_json(made_here());
  report.json = json.dump(2) + "\n";
  report.csv = curves_csv({run});
  report.svg = line_chart_svg(
      {.title = "A power grasp of the teapot at 1.4 N/mm",
       .subtitles = {"S2 fig. 5; at most 0.1 N a step; index and thumb move the device, the other "
                     "fingers copy the index; seed 1"},
       .x_label = "time [s]",
       .panels = {force_panel(run, "force of every touching phalanx"),
                  position_panel(run, "way of the contact points")},
       .windows = trial_windows(load_patient(load_scene("stability_grasp")))});
  report.rows = {stability_row("s2-fig5", "power grasp at 1.4 N/mm with +-0.1 N a step", run, true),
                 stability_row("s2-fig5", "the index alone at 1.4 N/mm with +-0.1 N a step", press, true)};
  report.text = fmt::format(
      "S2 fig. 5: a power grasp of the teapot at 1.4 N/mm with +-0.1 N a step, in closed loop.\n"
      "touching: {}\n{}\nunrendered, since no motor drives those joints: {}\nall five digits driven: "
      "{}\nthe index alone: {}\n",
      touching, verdict_text(run), unrendered_text(run), verdict_text(driven), verdict_text(press));
  report.sections = {
      {.title = "S2 fig. 5: a power grasp",
       .text = {"In contact: " + touching +
                    ". Every one of them must pass the criterion: " + verdict_text(run) + ".",
                "One contact on each driven digit and three copied ones: several contacts on one driven "
                "digit, as in S2's figure, "
                "are not reached by this grasp. The torque on the copied fingers' joints is unrendered: " +
                    unrendered_text(run) + ".",
                "The same grasp on a device that drives all five digits: " + verdict_text(driven) + ".",
                "The index finger alone at the same stiffness: " + verdict_text(press) + "."},
       .svg = {report.svg},
       .table = {}}};
  return report;
}

}  // namespace phalanx

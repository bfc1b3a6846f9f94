// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "figures/chart/svg.h"
#include "figures/html.h"
#include "phalanx/simulation/closed_loop/stability_criterion.h"
#include "phalanx/study/laboratory/report.h"
#include "study/report/study_pictures.h"
#include "study/report/study_view.h"
#include "study/report/study_warnings.h"

namespace phalanx {
namespace {

std::string settings(const Overrides& set) {
  std::string text;
  for (const auto& [key, toml] : set) text += fmt::format("{}{} = {}", text.empty() ? "" : ", ", key, toml);
  return text.empty() ? "the scene as it is" : text;
}

std::string values(const StudyAxis& axis) {
  constexpr std::size_t kMost = 30;
  std::string text;
  for (std::size_t i = 0; i < axis.values.size(); ++i) {
    const bool hidden = axis.values.size() > kMost && i >= kMost - 1 && i + 1 < axis.values.size();
    if (hidden && i != kMost - 1) continue;
    text += fmt::format("{}{}", text.empty() ? "" : ", ", hidden ? "\u2026" : axis.values[i].shown);
  }
  return axis.values.size() > kMost ? fmt::format("{} ({} values)", text, axis.values.size()) : text;
}

std::string seeds(const Study& study) {
  if (study.seeds == 1) return fmt::format("{}", study.first_seed);
  return fmt::format("{} to {}", study.first_seed,
                     study.first_seed + static_cast<std::uint64_t>(study.seeds) - 1);
}

void add_what_was_swept(HtmlPage& page, const Study& study) {
  page.heading("What was swept");
  std::vector<std::vector<std::string>> rows = {{"scene", "", study.scene}};
  if (!study.set.empty()) rows.push_back({"everywhere", "", settings(study.set)});
  if (study.has_variants()) {
    for (const StudyVariant& variant : study.variants)
      rows.push_back({"variant", variant.name, settings(variant.set)});
  }
  for (const StudyAxis& axis : study.axes)
    rows.push_back({"axis", axis.label == axis.key ? axis.key : fmt::format("{} ({})", axis.label, axis.key),
                    values(axis)});
  if (study.stiffness) {
    const StiffnessGrid& grid = *study.stiffness;
    rows.push_back({"stiffness", "wall",
                    fmt::format("{:.12g} to {:.12g} N/mm in steps of {:.12g}{}", grid.min_n_per_mm,
                                grid.max_n_per_mm, grid.step_n_per_mm, study.traces() ? ", traced" : "")});
  }
  rows.push_back({"seeds", "", fmt::format("{} ({} a point)", seeds(study), study.seeds)});
  page.table({}, rows);
}

void add_what_stable_means(HtmlPage& page, const Study& study) {
  page.heading("What stable means");
  page.paragraph(
      fmt::format("A run is stable if, in the window after the bump, no contact's sent force swings by more "
                  "than {} N from peak to "
                  "peak and no measured position along its normal by more than {} mm. A run is invalid if a "
                  "limiter other than the "
                  "one under study acted or nothing was touched: it proves nothing, and never counts for "
                  "stability. A stiffness is "
                  "stable if all {} seeds are stable and valid.",
                  StabilityCriterion{}.force_swing, 1e3 * StabilityCriterion{}.position_swing, study.seeds));
  if (!study.stiffness) {
    page.paragraph("This study looks for no limit: everything is measured at the stiffness of the scene.");
    return;
  }
  page.paragraph(
      "k_lim is the largest stiffness of the grid that is stable and has only stable ones below it, as far "
      "as "
      "they were tried. All other numbers are measured at k_lim.");
  if (study.traces())
    page.paragraph(
        "The limit is traced: it is the least of the seeds' own limits. All seeds ran at k_lim; below it one "
        "seed ran at every fourth stiffness. k_eff is not measured.");
}

void add_what_is_measured(HtmlPage& page, const Study& study) {
  if (!study.traces())
    page.paragraph(
        "k_eff is the stiffness that is felt: the difference of the forces of a 4 N and a 2 N press over "
        "that of their depths, mean over the seeds for which both are stable.");
  page.paragraph(
      "Ghost time is how long a force is sent after the finger has left the wall, "
      "ghost energy the work that this force does on the finger. Swings are from peak to peak in the window. "
      "Peak "
      "penetration and swings are the largest over the seeds.");
}

std::string limit_text(const Study& study, const PointResult& result) {
  if (std::isnan(result.k_lim)) return number_text(result.k_lim);
  if (result.k_lim == 0.0) return fmt::format("< {:.12g}", study.stiffness->min_n_per_mm);
  return fmt::format("{}{:.12g}", result.at_least ? "\u2265 " : "", 1e-3 * result.k_lim);
}

std::string notes(const Study& study, const PointResult& result) {
  std::string text;
  const auto add = [&](bool is, const std::string& what) {
    if (is) text += (text.empty() ? "" : ", ") + what;
  };
  add(!study.stiffness, result.stable ? "stable" : "not stable");
  add(result.non_monotone, "not monotone");
  add(result.ends_in_invalid, "ends in an invalid run");
  add(result.k_eff_seeds > 0 && result.k_eff_seeds < study.seeds,
      fmt::format("k_eff of {} seeds", result.k_eff_seeds));
  add(result.invalid_trials > 0, fmt::format("invalid: {}", result.invalid_trials));
  return text;
}

std::vector<std::string> row_of(const StudyView& view, const std::vector<Quantity>& quantities, int index) {
  const Study& study = view.study();
  const StudyPoint point = study_point(study, index);
  std::vector<std::string> row;
  if (study.has_variants()) row.push_back(study.variants[static_cast<std::size_t>(point.variant)].name);
  for (std::size_t axis = 0; axis < study.axes.size(); ++axis)
    row.push_back(study.axes[axis].values[static_cast<std::size_t>(point.value[axis])].shown);
  const PointResult* result = view.result(index);
  if (result == nullptr) {
    row.resize(row.size() + quantities.size() + 1);
    row.emplace_back("missing");
    return row;
  }
  for (const Quantity& quantity : quantities) {
    std::string cell = is_k_lim(quantity) ? limit_text(study, *result) : number_text(quantity.value(*result));
    if (quantity.largest != nullptr && std::isfinite(quantity.largest(*result)))
      cell += fmt::format(" ({})", number_text(quantity.largest(*result)));
    row.push_back(std::move(cell));
  }
  row.push_back(fmt::format("{}", result->trials));
  row.push_back(notes(study, *result));
  return row;
}

void add_all_points(HtmlPage& page, const StudyView& view) {
  const Study& study = view.study();
  const std::vector<Quantity> quantities = view.quantities();
  std::vector<std::string> header;
  if (study.has_variants()) header.emplace_back("variant");
  for (const StudyAxis& axis : study.axes) header.push_back(axis.label);
  for (const Quantity& quantity : quantities)
    header.push_back(quantity.label() + (quantity.largest != nullptr ? " mean (largest)" : ""));
  header.emplace_back("runs");
  header.emplace_back("notes");
  constexpr int kMostRows = 5000;  // more make a page that browsers open slowly
  const int shown = std::min(point_count(study), kMostRows);
  std::vector<std::vector<std::string>> rows;
  for (int i = 0; i < shown; ++i) rows.push_back(row_of(view, quantities, i));
  page.heading("All points");
  if (shown < point_count(study))
    page.paragraph(fmt::format("The first {} of {} points; study.csv has all.", shown, point_count(study)));
  page.table(header, rows);
}

}  // namespace

std::string study_report_html(const Study& study, const std::vector<PointResult>& results, const Made& made,
                              const std::string& running) {
  constexpr int kReloadSeconds = 10;
  const StudyView view(study, results);
  HtmlPage page(fmt::format("Study: {}", study.name));
  if (!study.title.empty()) page.paragraph(study.title);
  if (running.empty()) {
    page.paragraph(fmt::format("{} of {} points are finished.", results.size(), point_count(study)));
  } else {
    page.paragraph(fmt::format("It runs: {} (at {}).", running, made.date));
    page.reload_every(kReloadSeconds);
  }
  page.warnings(study_warnings(view));
  add_what_was_swept(page, study);
  add_what_stable_means(page, study);
  add_what_is_measured(page, study);
  // A short table comes before the charts, a long one after them.
  constexpr int kShort = 40;
  if (point_count(study) <= kShort) add_all_points(page, view);
  add_result_pictures(page, view);
  add_verdict_maps(page, view);
  if (point_count(study) > kShort) add_all_points(page, view);
  page.made(made, fmt::format("{} ({} a point)", seeds(study), study.seeds));
  return page.document();
}

}  // namespace phalanx

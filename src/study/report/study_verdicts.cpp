// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "phalanx/figures/chart.h"
#include "study/report/study_pictures.h"

namespace phalanx {
namespace {

constexpr std::size_t kMostColumns = 60;  // in one map
constexpr std::size_t kMostMaps = 40;
constexpr std::size_t kColumnsOfHalfVerdictMap = 8;  // up to here two maps fit beside each other

CellVerdict cell_of(const StiffnessVerdict& checked, int seeds) {
  switch (checked.verdict) {
    case Verdict::kStable:
      return checked.seeds_run < seeds ? CellVerdict::kSomeStable : CellVerdict::kStable;
    case Verdict::kUnstable:
      return CellVerdict::kUnstable;
    case Verdict::kInvalid:
      return CellVerdict::kInvalid;
  }
  return CellVerdict::kNotChecked;
}

VerdictMap::Column column_of(const PointResult* result, const std::string& name, const Study& study) {
  const StiffnessGrid& grid = *study.stiffness;
  const int size = grid.size();
  VerdictMap::Column column{.name = name, .cell = std::vector<CellVerdict>(static_cast<std::size_t>(size))};
  if (result == nullptr) return column;
  column.k_lim = 1e-3 * result->k_lim;
  column.at_least = result->at_least;
  for (const StiffnessVerdict& checked : result->checked) {
    const double row = std::round((checked.n_per_mm - grid.min_n_per_mm) / grid.step_n_per_mm);
    if (row >= 0.0 && row < size) column.cell[static_cast<std::size_t>(row)] = cell_of(checked, study.seeds);
  }
  return column;
}

/// Makes the maps of one slice: several if a single one would have too many columns.
std::vector<VerdictMap> maps_of(const StudyView& view, const Dimension* along, const Slice& slice) {
  const StiffnessGrid& grid = *view.study().stiffness;
  VerdictMap empty;
  empty.title = slice.text;
  for (int i = 0; i < grid.size(); ++i) empty.stiffness.push_back(grid.n_per_mm(i));
  if (along == nullptr) {
    empty.columns.push_back(column_of(view.result(slice.offset), "", view.study()));
    empty.width_mm = 88.0;
    return {empty};
  }
  empty.x_label = along->label;
  empty.width_mm = along->names.size() <= kColumnsOfHalfVerdictMap ? 88.0 : 180.0;
  std::vector<VerdictMap> maps;
  for (std::size_t i = 0; i < along->order.size(); ++i) {
    if (i % kMostColumns == 0) maps.push_back(empty);
    const std::size_t value = along->order[i];
    const int index = slice.offset + static_cast<int>(value) * along->stride;
    maps.back().columns.push_back(column_of(view.result(index), along->names[value], view.study()));
  }
  return maps;
}

/// Describes a limit that is not monotone: "stable again at 2.1, 2.2 N/mm above the first unstable
/// one, 1.3 N/mm".
std::string where_not_monotone(const PointResult& result) {
  const auto first =
      std::find_if(result.checked.begin(), result.checked.end(),
                   [](const StiffnessVerdict& checked) { return checked.verdict != Verdict::kStable; });
  std::string again;
  for (auto checked = first; checked != result.checked.end(); ++checked) {
    if (checked->verdict == Verdict::kStable)
      again += fmt::format("{}{:.12g}", again.empty() ? "" : ", ", checked->n_per_mm);
  }
  if (again.empty()) return "stable again somewhere above the limit";
  return fmt::format("stable again at {} N/mm, above {:.12g} N/mm, which is {}", again, first->n_per_mm,
                     verdict_name(first->verdict));
}

void add_not_monotone(HtmlPage& page, const StudyView& view) {
  constexpr std::size_t kMost = 50;
  const bool traces = view.study().traces();
  std::vector<std::string> items;
  std::size_t all = 0;
  for (int i = 0; i < point_count(view.study()); ++i) {
    const PointResult* result = view.result(i);
    if (result == nullptr || !result->non_monotone || ++all > kMost) continue;
    items.push_back(traces ? view.name(i) : fmt::format("{}: {}", view.name(i), where_not_monotone(*result)));
  }
  if (items.empty()) {
    page.paragraph(traces ? "At no point was a seed stable above a stiffness at which it was not."
                          : "At no point was a stiffness above the limit found to be stable again.");
    return;
  }
  page.paragraph(
      traces ? "Not monotone: at these points a seed was stable above a stiffness at which it was not."
             : "Not monotone: at these points something stiffer than the limit was stable again. k_lim is "
               "the limit below which everything that was tried is stable.");
  if (all > kMost) items.push_back(fmt::format("and {} more", all - kMost));
  page.list(items);
}

}  // namespace

void add_verdict_maps(HtmlPage& page, const StudyView& view) {
  if (!view.study().stiffness) return;
  const int last = static_cast<int>(view.dimensions().size()) - 1;
  const int along = view.main_axis() >= 0 ? view.main_axis() : last;
  const std::vector<Slice> slices = along < 0 ? std::vector<Slice>{Slice{}} : view.slices({along});
  page.heading("Which stiffness was tried, and what came of it");
  page.paragraph(
      view.study().traces()
          ? "Each seed was tried where the search for its limit needed it; at k_lim all seeds are "
            "stable. At a pale blue stiffness the seeds that ran are stable, and others did not run."
          : "Every stiffness was tried with one seed after the other until one of them was not stable.");
  page.paragraph(
      "The thick line stands above k_lim, the largest stiffness below which nothing that was tried was "
      "unstable.");
  std::vector<std::string> svgs;
  std::size_t all = 0;
  for (const Slice& slice : slices) {
    const Dimension* dimension = along < 0 ? nullptr : &view.dimensions()[static_cast<std::size_t>(along)];
    for (const VerdictMap& map : maps_of(view, dimension, slice)) {
      if (++all <= kMostMaps) svgs.push_back(verdict_map_svg(map));
    }
  }
  page.figures(svgs, all > svgs.size() ? fmt::format("{} of {} maps are drawn; {} are left out.", svgs.size(),
                                                     all, all - svgs.size())
                                       : "");
  add_not_monotone(page, view);
}

}  // namespace phalanx

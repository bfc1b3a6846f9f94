// SPDX-License-Identifier: Apache-2.0
#include "study/report/study_view.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <stdexcept>

#include "phalanx/simulation/closed_loop/stability_criterion.h"

namespace phalanx {
namespace {

std::vector<std::size_t> in_order(std::size_t size, const std::vector<double>& numbers) {
  std::vector<std::size_t> order(size);
  std::iota(order.begin(), order.end(), std::size_t{0});
  if (!numbers.empty())
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return numbers[a] < numbers[b]; });
  return order;
}

Dimension dimension_of(const StudyAxis& axis) {
  Dimension dimension;
  dimension.label = axis.label;
  for (const StudyValue& value : axis.values) {
    dimension.names.push_back(value.shown);
    if (axis.numeric()) dimension.numbers.push_back(value.number);
  }
  return dimension;
}

Dimension dimension_of(const std::vector<StudyVariant>& variants) {
  Dimension dimension;
  dimension.label = "variant";
  dimension.variants = true;
  for (const StudyVariant& variant : variants) dimension.names.push_back(variant.name);
  return dimension;
}

}  // namespace

std::string Quantity::label() const { return fmt::format("{} [{}]", name, unit); }

std::string Dimension::choice(std::size_t i) const {
  if (variants) return names[i];
  const std::size_t unit = label.ends_with(']') ? label.rfind(" [") : std::string::npos;
  if (unit == std::string::npos) return fmt::format("{} {}", label, names[i]);
  return fmt::format("{} {} {}", label.substr(0, unit), names[i],
                     label.substr(unit + 2, label.size() - unit - 3));
}

StudyView::StudyView(const Study& study, const std::vector<PointResult>& results) : study_(study) {
  const int count = point_count(study);
  for (const PointResult& result : results) {
    if (result.index < 0 || result.index >= count)
      throw std::invalid_argument(fmt::format(
          "study report: result of point {}; the study has points 0 to {}", result.index, count - 1));
    if (!results_.emplace(result.index, &result).second)
      throw std::invalid_argument(
          fmt::format("study report: point {} has two results; give one", result.index));
  }
  int stride = count;
  const auto add = [&](Dimension dimension) {
    const std::size_t size = dimension.names.size();
    if (size == 0) return;
    stride /= static_cast<int>(size);
    if (size == 1) return;
    dimension.stride = stride;
    dimension.order = in_order(size, dimension.numbers);
    dimensions_.push_back(std::move(dimension));
  };
  add(dimension_of(study.variants));
  for (const StudyAxis& axis : study.axes) add(dimension_of(axis));
}

const PointResult* StudyView::result(int index) const {
  const auto found = results_.find(index);
  return found == results_.end() ? nullptr : found->second;
}

std::string StudyView::name(int index) const {
  std::string text;
  for (const Dimension& dimension : dimensions_) {
    const auto value = static_cast<std::size_t>(index / dimension.stride) % dimension.names.size();
    text += (text.empty() ? "" : ", ") + dimension.choice(value);
  }
  return text.empty() ? point_text(study_, study_point(study_, index)) : text;
}

int StudyView::main_axis() const {
  int best = -1;
  for (std::size_t d = 0; d < dimensions_.size(); ++d) {
    if (dimensions_[d].numbers.empty()) continue;
    if (best < 0 || dimensions_[d].names.size() > dimensions_[static_cast<std::size_t>(best)].names.size())
      best = static_cast<int>(d);
  }
  return best;
}

std::vector<Slice> StudyView::slices(const std::vector<int>& without) const {
  std::vector<Slice> result = {Slice{}};
  for (std::size_t d = 0; d < dimensions_.size(); ++d) {
    if (std::find(without.begin(), without.end(), static_cast<int>(d)) != without.end()) continue;
    const Dimension& dimension = dimensions_[d];
    std::vector<Slice> finer;
    for (const Slice& slice : result) {
      for (const std::size_t i : dimension.order) {
        const std::string name = dimension.choice(i);
        finer.push_back({slice.offset + static_cast<int>(i) * dimension.stride,
                         slice.text.empty() ? name : slice.text + ", " + name});
      }
    }
    result = std::move(finer);
  }
  return result;
}

std::vector<Quantity> StudyView::quantities() const {
  using R = PointResult;
  constexpr double kNone = R::kNone;
  std::vector<Quantity> result;
  if (study_.stiffness)
    result.push_back({"k_lim", "N/mm", [](const R& r) { return 1e-3 * r.k_lim; }, nullptr, kNone});
  if (!study_.traces())
    result.push_back({"k_eff", "N/mm", [](const R& r) { return 1e-3 * r.k_eff; }, nullptr, kNone});
  result.push_back({"peak penetration", "mm", [](const R& r) { return 1e3 * r.peak_depth; }, nullptr, kNone});
  result.push_back({"ghost time", "ms", [](const R& r) { return 1e3 * r.ghost_s.mean; },
                    [](const R& r) { return 1e3 * r.ghost_s.largest; }, kNone});
  result.push_back({"ghost energy", "mJ", [](const R& r) { return 1e3 * r.ghost_energy.mean; },
                    [](const R& r) { return 1e3 * r.ghost_energy.largest; }, kNone});
  result.push_back({"force swing", "N", [](const R& r) { return r.force_swing; }, nullptr,
                    StabilityCriterion{}.force_swing});
  result.push_back({"position swing", "mm", [](const R& r) { return 1e3 * r.position_swing; }, nullptr,
                    1e3 * StabilityCriterion{}.position_swing});
  return result;
}

}  // namespace phalanx

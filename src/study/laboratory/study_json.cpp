// SPDX-License-Identifier: Apache-2.0
#include "study/laboratory/study_json.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>
#include <string>

#include "study/laboratory/study_limits.h"

namespace phalanx {
namespace {

/// Deepest nesting that is read. The journal's own is less deep, and a line of brackets must not
/// take all memory.
constexpr int kDeepest = 16;

/// Reads a whole number from the file, which may contain anything.
template <class Integer>
Integer whole_from(const OrderedJson& json, const char* key, double least, double most) {
  const OrderedJson& number = json.at(key);
  const double value = number.is_number_integer() ? number.get<double>() : PointResult::kNone;
  if (!(value >= least && value <= most))
    throw std::out_of_range(fmt::format("\"{}\" is no whole number from {} to {}", key, least, most));
  return number.get<Integer>();
}

int count_from(const OrderedJson& json, const char* key) {
  constexpr double kMost = 2e9;
  return whole_from<int>(json, key, 0.0, kMost);
}

double number_from(const OrderedJson& json) {
  return json.is_null() ? PointResult::kNone : json.get<double>();
}

OrderedJson overrides_to_json(const Overrides& overrides) {
  OrderedJson json = OrderedJson::array();
  for (const auto& [key, value] : overrides) json.push_back({key, value});
  return json;
}

Overrides overrides_from_json(const OrderedJson& json) {
  Overrides overrides;
  for (const OrderedJson& pair : json)
    overrides.emplace_back(pair.at(0).get<std::string>(), pair.at(1).get<std::string>());
  return overrides;
}

OrderedJson axis_to_json(const StudyAxis& axis) {
  OrderedJson values = OrderedJson::array();
  for (const StudyValue& value : axis.values)
    values.push_back(
        {{"toml", value.toml}, {"shown", value.shown}, {"number", number_or_null(value.number)}});
  return {{"key", axis.key}, {"label", axis.label}, {"values", values}};
}

StudyAxis axis_from_json(const OrderedJson& json) {
  StudyAxis axis{.key = json.at("key"), .label = json.at("label"), .values = {}};
  for (const OrderedJson& value : json.at("values")) {
    axis.values.push_back(
        {.toml = value.at("toml"), .shown = value.at("shown"), .number = number_from(value.at("number"))});
  }
  return axis;
}

Verdict verdict_from(const std::string& name) {
  for (const Verdict verdict : {Verdict::kStable, Verdict::kUnstable, Verdict::kInvalid}) {
    if (name == verdict_name(verdict)) return verdict;
  }
  throw std::out_of_range("'" + name + "' is no verdict");
}

OrderedJson pair_to_json(const MeanAndLargest& value) {
  return {{"mean", number_or_null(value.mean)}, {"largest", number_or_null(value.largest)}};
}

MeanAndLargest pair_from_json(const OrderedJson& json) {
  return {.mean = number_from(json.at("mean")), .largest = number_from(json.at("largest"))};
}

OrderedJson verdict_to_json(const StiffnessVerdict& checked) {
  return {{"n_per_mm", number_or_null(checked.n_per_mm)},
          {"verdict", verdict_name(checked.verdict)},
          {"seeds_run", checked.seeds_run},
          {"force_swing_n", number_or_null(checked.force_swing)},
          {"position_swing_m", number_or_null(checked.position_swing)}};
}

StiffnessVerdict verdict_from_json(const OrderedJson& json) {
  return {.n_per_mm = number_from(json.at("n_per_mm")),
          .verdict = verdict_from(json.at("verdict")),
          .seeds_run = count_from(json, "seeds_run"),
          .force_swing = number_from(json.at("force_swing_n")),
          .position_swing = number_from(json.at("position_swing_m"))};
}

StiffnessGrid grid_from_json(const OrderedJson& json) {
  StiffnessGrid grid{.min_n_per_mm = json.at("min_n_per_mm"),
                     .max_n_per_mm = json.at("max_n_per_mm"),
                     .step_n_per_mm = json.at("step_n_per_mm")};
  if (json.contains("search")) {
    if (json.at("search") != "trace") throw std::out_of_range("\"search\" is not \"trace\"");
    grid.search = StiffnessSearch::kTrace;
  }
  if (!(grid.min_n_per_mm > 0.0 && grid.max_n_per_mm >= grid.min_n_per_mm &&
        grid.max_n_per_mm <= kLargestStiffness && grid.step_n_per_mm > 0.0 &&
        (grid.max_n_per_mm - grid.min_n_per_mm) / grid.step_n_per_mm < kMostValues))
    throw std::out_of_range("\"stiffness\" is no grid");
  return grid;
}

/// Checks the sizes on which all readers of a study rely; a study file is checked in the same way.
void refuse_sizes(const Study& study) {
  auto points = static_cast<double>(study.variants.size());
  for (const StudyAxis& axis : study.axes) points *= static_cast<double>(axis.values.size());
  if (points < 1.0 || points > kMostPoints) throw std::out_of_range(fmt::format("it has {} points", points));
}

}  // namespace

OrderedJson parse_json(const std::string& text) {
  return OrderedJson::parse(text, [](int depth, OrderedJson::parse_event_t, const OrderedJson&) {
    if (depth > kDeepest) throw std::out_of_range("it is nested too deeply");
    return true;
  });
}

OrderedJson number_or_null(double value) {
  return std::isfinite(value) ? OrderedJson(value) : OrderedJson(nullptr);
}

OrderedJson study_to_json(const Study& study) {
  OrderedJson json = OrderedJson::object();
  json["name"] = study.name;
  json["title"] = study.title;
  json["scene"] = study.scene;
  json["seeds"] = study.seeds;
  json["first_seed"] = study.first_seed;
  if (study.stiffness) {
    json["stiffness"] = {{"min_n_per_mm", study.stiffness->min_n_per_mm},
                         {"max_n_per_mm", study.stiffness->max_n_per_mm},
                         {"step_n_per_mm", study.stiffness->step_n_per_mm}};
    if (study.traces()) json["stiffness"]["search"] = "trace";
  }
  json["set"] = overrides_to_json(study.set);
  json["variants"] = OrderedJson::array();
  for (const StudyVariant& variant : study.variants)
    json["variants"].push_back({{"name", variant.name}, {"set", overrides_to_json(variant.set)}});
  json["axes"] = OrderedJson::array();
  for (const StudyAxis& axis : study.axes) json["axes"].push_back(axis_to_json(axis));
  return json;
}

Study study_from_json(const OrderedJson& json) {
  Study study;
  study.name = json.at("name");
  study.title = json.at("title");
  study.scene = json.at("scene");
  study.seeds = whole_from<int>(json, "seeds", 1.0, kMostValues);
  study.first_seed = whole_from<std::uint64_t>(json, "first_seed", 0.0, kLargestFirstSeed);
  if (json.contains("stiffness")) study.stiffness = grid_from_json(json["stiffness"]);
  study.set = overrides_from_json(json.at("set"));
  for (const OrderedJson& variant : json.at("variants"))
    study.variants.push_back({.name = variant.at("name"), .set = overrides_from_json(variant.at("set"))});
  for (const OrderedJson& axis : json.at("axes")) study.axes.push_back(axis_from_json(axis));
  refuse_sizes(study);
  return study;
}

OrderedJson result_to_json(const PointResult& result) {
  OrderedJson json = OrderedJson::object();
  json["point"] = result.index;
  json["k_lim_n_per_m"] = number_or_null(result.k_lim);
  json["at_least"] = result.at_least;
  json["non_monotone"] = result.non_monotone;
  json["ends_in_invalid"] = result.ends_in_invalid;
  json["stable"] = result.stable;
  json["measured_at_n_per_m"] = number_or_null(result.measured_at);
  json["k_eff_n_per_m"] = number_or_null(result.k_eff);
  json["k_eff_seeds"] = result.k_eff_seeds;
  json["peak_depth_m"] = number_or_null(result.peak_depth);
  json["force_swing_n"] = number_or_null(result.force_swing);
  json["position_swing_m"] = number_or_null(result.position_swing);
  json["ghost_s"] = pair_to_json(result.ghost_s);
  json["ghost_energy_j"] = pair_to_json(result.ghost_energy);
  json["trials"] = result.trials;
  json["invalid_trials"] = result.invalid_trials;
  json["why_invalid"] = result.why_invalid;
  json["checked"] = OrderedJson::array();
  for (const StiffnessVerdict& checked : result.checked) json["checked"].push_back(verdict_to_json(checked));
  return json;
}

PointResult result_from_json(const OrderedJson& json) {
  PointResult result;
  result.index = count_from(json, "point");
  result.k_lim = number_from(json.at("k_lim_n_per_m"));
  result.at_least = json.at("at_least");
  result.non_monotone = json.at("non_monotone");
  result.ends_in_invalid = json.at("ends_in_invalid");
  result.stable = json.at("stable");
  result.measured_at = number_from(json.at("measured_at_n_per_m"));
  result.k_eff = number_from(json.at("k_eff_n_per_m"));
  result.k_eff_seeds = count_from(json, "k_eff_seeds");
  result.peak_depth = number_from(json.at("peak_depth_m"));
  result.force_swing = number_from(json.at("force_swing_n"));
  result.position_swing = number_from(json.at("position_swing_m"));
  result.ghost_s = pair_from_json(json.at("ghost_s"));
  result.ghost_energy = pair_from_json(json.at("ghost_energy_j"));
  result.trials = count_from(json, "trials");
  result.invalid_trials = count_from(json, "invalid_trials");
  result.why_invalid = json.at("why_invalid");
  for (const OrderedJson& checked : json.at("checked")) result.checked.push_back(verdict_from_json(checked));
  return result;
}

}  // namespace phalanx

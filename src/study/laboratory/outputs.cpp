// SPDX-License-Identifier: Apache-2.0
#include "phalanx/study/laboratory/outputs.h"

#include <cmath>
#include <string_view>
#include <utility>

#include "phalanx/record/output_file.h"
#include "record/made_json.h"
#include "study/laboratory/study_json.h"
#include "study/laboratory/study_values.h"

namespace phalanx {
namespace {

/// Converts to the unit of a column, without digits that only the conversion produced.
OrderedJson in_unit(double value, double units) {
  return std::isfinite(value) ? OrderedJson(short_number(value * units)) : OrderedJson(nullptr);
}

struct Column {
  const char* name;
  OrderedJson (*value)(const PointResult& result);
};

constexpr double kToMilli = 1e3;  // m to mm, s to ms, J to mJ
constexpr double kNPerMm = 1e-3;  // factor from N/m
constexpr Column kColumns[] = {
    {"k_lim_n_per_mm", [](const PointResult& r) { return in_unit(r.k_lim, kNPerMm); }},
    {"at_least", [](const PointResult& r) { return OrderedJson(r.at_least); }},
    {"non_monotone", [](const PointResult& r) { return OrderedJson(r.non_monotone); }},
    {"ends_in_invalid", [](const PointResult& r) { return OrderedJson(r.ends_in_invalid); }},
    {"stable", [](const PointResult& r) { return OrderedJson(r.stable); }},
    {"measured_at_n_per_mm", [](const PointResult& r) { return in_unit(r.measured_at, kNPerMm); }},
    {"k_eff_n_per_mm", [](const PointResult& r) { return in_unit(r.k_eff, kNPerMm); }},
    {"k_eff_seeds", [](const PointResult& r) { return OrderedJson(r.k_eff_seeds); }},
    {"peak_depth_mm", [](const PointResult& r) { return in_unit(r.peak_depth, kToMilli); }},
    {"force_swing_n", [](const PointResult& r) { return in_unit(r.force_swing, 1.0); }},
    {"position_swing_mm", [](const PointResult& r) { return in_unit(r.position_swing, kToMilli); }},
    {"ghost_mean_ms", [](const PointResult& r) { return in_unit(r.ghost_s.mean, kToMilli); }},
    {"ghost_largest_ms", [](const PointResult& r) { return in_unit(r.ghost_s.largest, kToMilli); }},
    {"ghost_energy_mean_mj", [](const PointResult& r) { return in_unit(r.ghost_energy.mean, kToMilli); }},
    {"ghost_energy_largest_mj",
     [](const PointResult& r) { return in_unit(r.ghost_energy.largest, kToMilli); }},
    {"trials", [](const PointResult& r) { return OrderedJson(r.trials); }},
    {"invalid_trials", [](const PointResult& r) { return OrderedJson(r.invalid_trials); }},
    {"why_invalid", [](const PointResult& r) { return OrderedJson(r.why_invalid); }},
};

std::string csv_field(const OrderedJson& value) {
  if (value.is_null()) return "";
  return value.is_string() ? csv_text(value.get<std::string>()) : value.dump();
}

void add_field(std::string& row, std::string_view field) {
  row += ',';
  row += field;
}

const StudyVariant& variant_of(const Study& study, const StudyPoint& point) {
  return study.variants[static_cast<std::size_t>(point.variant)];
}

const StudyValue& value_of(const Study& study, const StudyPoint& point, std::size_t axis) {
  return study.axes[axis].values[static_cast<std::size_t>(point.value[axis])];
}

OrderedJson checked_json(const StiffnessVerdict& checked) {
  return {{"n_per_mm", number_or_null(checked.n_per_mm)},
          {"verdict", verdict_name(checked.verdict)},
          {"seeds_run", checked.seeds_run},
          {"force_swing_n", number_or_null(checked.force_swing)},
          {"position_swing_mm", in_unit(checked.position_swing, kToMilli)}};
}

/// The text of a value within a document that is indented by 2. @param margin  of the value's lines after the first
std::string indented(const OrderedJson& json, std::string_view margin) {
  std::string text;
  for (const char c : json.dump(2, ' ', false, OrderedJson::error_handler_t::replace)) {
    text += c;
    if (c == '\n') text += margin;  // no string holds one: JSON escapes it
  }
  return text;
}

OrderedJson point_json(const Study& study, const PointResult& result) {
  const StudyPoint point = study_point(study, result.index);
  OrderedJson json = OrderedJson::object();
  json["point"] = result.index;
  if (study.has_variants()) json["variant"] = variant_of(study, point).name;
  OrderedJson values = OrderedJson::object();
  for (std::size_t axis = 0; axis < study.axes.size(); ++axis) {
    const StudyValue& value = value_of(study, point, axis);
    values[study.axes[axis].key] =
        std::isnan(value.number) ? OrderedJson(value.shown) : OrderedJson(value.number);
  }
  if (!values.empty()) json["values"] = std::move(values);
  for (const Column& column : kColumns) json[column.name] = column.value(result);
  OrderedJson checked = OrderedJson::array();
  for (const StiffnessVerdict& verdict : result.checked) checked.push_back(checked_json(verdict));
  if (!checked.empty()) json["checked"] = std::move(checked);
  return json;
}

}  // namespace

std::string csv_text(std::string_view text) {
  if (text.find_first_of(",\"\r\n") == std::string_view::npos) return std::string(text);
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + '"';
}

std::string study_csv(const Study& study, const std::vector<PointResult>& results) {
  std::string text = "point";
  if (study.has_variants()) text += ",variant";
  for (const StudyAxis& axis : study.axes) add_field(text, csv_text(axis.key));
  for (const Column& column : kColumns) add_field(text, column.name);
  text += "\n";
  for (const PointResult& result : results) {
    const StudyPoint point = study_point(study, result.index);
    text += std::to_string(result.index);
    if (study.has_variants()) add_field(text, csv_text(variant_of(study, point).name));
    for (std::size_t axis = 0; axis < study.axes.size(); ++axis)
      add_field(text, csv_text(value_of(study, point, axis).shown));
    for (const Column& column : kColumns) add_field(text, csv_field(column.value(result)));
    text += "\n";
  }
  return text;
}

std::string study_summary_json(const Study& study, const std::vector<PointResult>& results,
                               const Made& made) {
  std::string text = "{\n  \"study\": " + indented(study_to_json(study), "  ") + ",\n  \"points\": [";
  const char* before = "\n    ";
  for (const PointResult& result : results) {  // one after the other: a study has up to a million
    text += before;
    text += indented(point_json(study, result), "    ");
    before = ",\n    ";
  }
  text += results.empty() ? "]" : "\n  ]";
  return text + ",\n  \"made\": " + indented(made_json(made), "  ") + "\n}\n";
}

void remove_study_outputs(const std::filesystem::path& out) {
  for (const char* name : {"summary.json", "study.csv", "report.html"}) std::filesystem::remove(out / name);
}

void write_study_outputs(const std::filesystem::path& out, const Study& study,
                         const std::vector<PointResult>& results, const Made& made) {
  write_text_file(out / "study.csv", study_csv(study, results));
  write_text_file(out / "summary.json", study_summary_json(study, results, made));
}

}  // namespace phalanx

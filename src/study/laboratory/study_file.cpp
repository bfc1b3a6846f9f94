// SPDX-License-Identifier: Apache-2.0
#include "phalanx/study/laboratory/study_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "phalanx/scene/scene.h"
#include "phalanx/study/laboratory/limit_search.h"
#include "scene/text_file.h"
#include "scene/toml/toml_reader.h"
#include "study/laboratory/study_limits.h"
#include "study/laboratory/study_values.h"

namespace phalanx {
namespace {

constexpr const char* kStiffnessKey = "force.stiffness_n_per_mm";

double whole_number(TomlTable& table, std::string_view key, const NumberRange& range, double fallback) {
  const double value = table.number_or(key, range, fallback);
  if (value != std::floor(value)) table.fail(key, "is no whole number; write one");
  return value;
}

/// Writes a node as SceneTree reads it from an override. Arrays keep their form.
std::string as_toml(const toml::node& node) {
  if (const auto* text = node.as_string()) return toml_quoted(text->get());
  if (const auto* flag = node.as_boolean()) return flag->get() ? "true" : "false";
  if (const auto* integer = node.as_integer()) return fmt::format("{}", integer->get());
  if (const auto* number = node.as_floating_point()) return fmt::format("{}", number->get());
  std::string elements;
  for (const toml::node& element : *node.as_array())
    elements += (elements.empty() ? "" : ", ") + as_toml(element);
  return "[" + elements + "]";
}

bool can_be_a_value(const toml::node& node) {
  if (node.is_date() || node.is_time() || node.is_date_time() || node.is_table()) return false;
  const toml::array* array = node.as_array();
  return array == nullptr || std::all_of(array->begin(), array->end(),
                                         [](const toml::node& element) { return can_be_a_value(element); });
}

StudyValue study_value(const toml::node& node) {
  StudyValue value{.toml = as_toml(node), .shown = ""};
  value.shown = node.is_string() ? *node.value<std::string>() : value.toml;
  if (node.is_number()) value.number = number_of(node);
  return value;
}

/// Flattens nested tables. A dotted key in quotes ("device.scale.x" = 1) and tables within tables are equal.
void flatten(const toml::table& table, const std::string& prefix, const TomlTable& place,
             std::string_view key, Overrides& out) {
  for (const auto& [name, node] : table) {
    const std::string path =
        prefix.empty() ? std::string(name.str()) : fmt::format("{}.{}", prefix, name.str());
    if (const toml::table* inner = node.as_table()) {
      flatten(*inner, path, place, key, out);
    } else if (can_be_a_value(node)) {
      out.emplace_back(path, as_toml(node));
    } else {
      place.fail(
          key, fmt::format("{} is {}; write a number, a string or an array of them", path, type_name(node)));
    }
  }
}

/// Refuses a path that occurs twice. TOML refuses a repeated key, but not one path both dotted and in quotes.
void refuse_twice(const Overrides& overrides, const TomlTable& place, std::string_view key) {
  std::set<std::string_view> seen;
  for (const auto& [path, value] : overrides) {
    if (!seen.insert(path).second)
      place.fail(key, fmt::format("{} stands there twice, in quotes and without; remove one", path));
  }
}

/// Reads the overrides of a key. `raw` is the table that `table` reads.
Overrides overrides_in(TomlTable& table, const toml::table& raw, std::string_view key) {
  Overrides overrides;
  if (!table.has(key)) return overrides;
  static_cast<void>(table.table(key));  // refuses a value that is not a table
  flatten(*raw.get(key)->as_table(), "", table, key, overrides);
  refuse_twice(overrides, table, key);
  return overrides;
}

std::vector<StudyValue> listed_values(TomlTable& table, const toml::table& raw) {
  const toml::array* array = table.has("values") ? raw.get("values")->as_array() : nullptr;
  if (array == nullptr || array->empty())
    table.fail("values", "write an array of at least one number or string");
  std::vector<StudyValue> values;
  for (const toml::node& node : *array) {
    if (!can_be_a_value(node))
      table.fail("values", fmt::format("an element is {}; write numbers or strings", type_name(node)));
    values.push_back(study_value(node));
  }
  return values;
}

/// @returns the number of steps from one end to the other. @throws if it is not a whole number.
int whole_steps(const TomlTable& table, double from, double to, double step, std::string_view step_key) {
  const double steps = (to - from) / step;
  const double nearest = std::round(steps);
  const bool divides = std::abs(steps - nearest) <= 1e-6;
  const double values = (divides ? nearest : std::floor(steps)) + 1.0;
  if (values > kMostValues)
    table.fail(step_key, fmt::format("makes {:.0f} values; {} are the most", values, kMostValues));
  if (!divides)
    table.fail(step_key,
               fmt::format("does not divide the way from {} to {}; choose ends a whole number of steps apart",
                           from, to));
  return static_cast<int>(nearest);
}

std::vector<StudyValue> stepped_values(TomlTable& table) {
  const double from = table.number("from", {});
  const double to = table.number("to", {.min = from});
  const double step = table.number("step", {.min = 0.0, .min_open = true});
  const int steps = whole_steps(table, from, to, step, "step");
  std::vector<StudyValue> values;
  for (int i = 0; i <= steps; ++i) {
    const double number = short_number(from + i * step);
    values.push_back(
        {.toml = fmt::format("{}", number), .shown = fmt::format("{}", number), .number = number});
  }
  return values;
}

StudyAxis study_axis(TomlTable table, const toml::table& raw) {
  StudyAxis axis;
  axis.key = table.text("key");
  axis.label = table.has("label") ? table.text("label") : axis.key;
  const bool listed = table.has("values");
  if (listed && (table.has("from") || table.has("to") || table.has("step")))
    table.fail("values", "stands beside from, to or step; keep one of the two forms");
  axis.values = listed ? listed_values(table, raw) : stepped_values(table);
  std::set<std::string> seen;
  for (const StudyValue& value : axis.values) {
    if (!seen.insert(value.toml).second)
      table.fail("values", fmt::format("{} stands there twice; remove one", value.shown));
  }
  table.finish();
  return axis;
}

StudyVariant study_variant(TomlTable table, const toml::table& raw) {
  StudyVariant variant;
  variant.name = table.text("name");
  if (variant.name.empty()) table.fail("name", "is empty; give the variant a name");
  variant.set = overrides_in(table, raw, "set");
  table.finish();
  return variant;
}

StiffnessGrid stiffness_grid(TomlTable table) {
  const NumberRange positive{.min = 0.0, .max = kLargestStiffness, .min_open = true};
  StiffnessGrid grid;
  grid.min_n_per_mm = table.number("min_n_per_mm", positive);
  grid.max_n_per_mm = table.number("max_n_per_mm", {.min = grid.min_n_per_mm, .max = kLargestStiffness});
  grid.step_n_per_mm = table.number("step_n_per_mm", positive);
  static_cast<void>(
      whole_steps(table, grid.min_n_per_mm, grid.max_n_per_mm, grid.step_n_per_mm, "step_n_per_mm"));
  if (table.has("search")) {
    const std::string search = table.text("search");
    if (search != "scan" && search != "trace")
      table.fail("search", fmt::format("is \"{}\"; write \"scan\" or \"trace\"", search));
    grid.search = search == "trace" ? StiffnessSearch::kTrace : StiffnessSearch::kScan;
  }
  table.finish();
  return grid;
}

/// Checks that concern several parts of the file at once.
class Conflicts {
 public:
  Conflicts(const Study& study, const std::string& origin) : study_(study), origin_(origin) {}

  void refuse() const {
    for (const auto& [key, value] : study_.set) refuse_key(key, "set");
    std::set<std::string> names, axes;
    for (const StudyVariant& variant : study_.variants) {
      if (!names.insert(variant.name).second)
        fail("two variants are called \"{}\"; rename one", variant.name);
      for (const auto& [key, value] : variant.set) refuse_key(key, "variant");
    }
    for (const StudyAxis& axis : study_.axes) {
      refuse_key(axis.key, "axis");
      if (!axes.insert(axis.key).second) fail("two axes sweep {}; remove one", axis.key);
      for (const StudyVariant& variant : study_.variants) {
        for (const auto& [key, value] : variant.set) {
          if (key == axis.key)
            fail(
                "{} is swept by an axis and set by variant \"{}\", which would have no effect; remove one of "
                "them",
                key, variant.name);
        }
      }
    }
    double points = static_cast<double>(study_.variants.size());
    for (const StudyAxis& axis : study_.axes) points *= static_cast<double>(axis.values.size());
    if (points > kMostPoints)
      fail("makes {:.0f} points; {:.0f} are the most: use fewer values", points, kMostPoints);
  }

 private:
  template <class... Args>
  [[noreturn]] void fail(fmt::format_string<Args...> format, Args&&... args) const {
    throw SceneError(fmt::format("{}: {}", origin_, fmt::format(format, std::forward<Args>(args)...)));
  }
  void refuse_key(const std::string& key, const char* where) const {
    if (key == "seed")
      fail("{}: seed: the seeds are first_seed and seeds of the study; remove the key", where);
    if (key == kStiffnessKey && study_.stiffness)
      fail("{}: {}: is what [stiffness] searches; remove one of the two", where, key);
  }

  const Study& study_;
  const std::string& origin_;
};

}  // namespace

Study parse_study(const std::string& text, const std::string& origin, const std::filesystem::path& folder) {
  const toml::table raw = parse_toml(text, origin);
  TomlTable root(raw, origin, "");
  Study study;
  study.name = std::filesystem::path(origin).stem().string();
  study.folder = folder;
  study.scene = root.text("scene");
  if (root.has("description")) study.title = root.text("description");
  study.seeds = static_cast<int>(whole_number(root, "seeds", {.min = 1.0, .max = kMostValues}, 20.0));
  study.first_seed = static_cast<std::uint64_t>(
      whole_number(root, "first_seed", {.min = 0.0, .max = kLargestFirstSeed}, 1.0));
  study.set = overrides_in(root, raw, "set");
  if (root.has("stiffness")) study.stiffness = stiffness_grid(root.table("stiffness"));
  const auto raw_table = [&](std::string_view key, std::size_t i) -> const toml::table& {
    return *(*raw.get(key)->as_array())[i].as_table();
  };
  if (root.has("variant")) {
    const auto tables = root.tables("variant", -1);
    for (std::size_t i = 0; i < tables.size(); ++i)
      study.variants.push_back(study_variant(tables[i], raw_table("variant", i)));
  }
  if (root.has("axis")) {
    const auto tables = root.tables("axis", -1);
    for (std::size_t i = 0; i < tables.size(); ++i)
      study.axes.push_back(study_axis(tables[i], raw_table("axis", i)));
  }
  root.finish();
  if (study.variants.empty()) study.variants.emplace_back();
  Conflicts(study, origin).refuse();
  return study;
}

Study load_study(const std::filesystem::path& file) {
  const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
  return parse_study(read_text_file(file.string(), "study"), file.string(), folder);
}

std::string scene_of(const Study& study) {
  const bool is_path = study.scene.find('/') != std::string::npos || study.scene.ends_with(".toml");
  return is_path ? std::filesystem::absolute(study.folder / study.scene).lexically_normal().string()
                 : study.scene;
}

TrialEstimate most_trials(const Study& study) {
  constexpr int kPresses = 2;
  int per_point = (1 + kPresses) * study.seeds;
  if (study.stiffness) {
    const int size = study.stiffness->size();
    per_point = study.traces() ? most_traced_if_monotone(size, study.seeds)
                               : (most_checked_if_monotone(size) + kPresses) * study.seeds;
  }
  return {.per_point = per_point, .all = static_cast<long long>(per_point) * point_count(study)};
}

}  // namespace phalanx

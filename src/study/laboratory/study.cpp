// SPDX-License-Identifier: Apache-2.0
#include "phalanx/study/laboratory/study.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "phalanx/scene/scene_keys.h"
#include "study/laboratory/study_values.h"

namespace phalanx {
namespace {

/// Makes a relative path absolute. It is relative to the study file, as one in a scene file is to that file.
std::string resolved(const Study& study, const std::string& key, const std::string& toml) {
  if (toml.size() < 3 || toml.front() != '"' || toml[1] == '/') return toml;
  const std::string text = toml.substr(1, toml.size() - 2);  // escapes in it stay unchanged
  const SceneKey* known = find_scene_key(pattern_of(key));
  if (known == nullptr || !known->is_path(text)) return toml;
  std::string path = toml_quoted(std::filesystem::absolute(study.folder).lexically_normal().string());
  path.back() = '/';
  return path + text + '"';
}

}  // namespace

double short_number(double value) { return std::strtod(fmt::format("{:.12g}", value).c_str(), nullptr); }

std::string toml_quoted(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (static_cast<unsigned char>(c) < 32 || c == 127) {
      quoted += fmt::format("\\u{:04X}", static_cast<unsigned>(static_cast<unsigned char>(c)));
    } else {
      if (c == '"' || c == '\\') quoted += '\\';
      quoted += c;
    }
  }
  return quoted + '"';
}

bool StudyAxis::numeric() const noexcept {
  return std::none_of(values.begin(), values.end(),
                      [](const StudyValue& value) { return std::isnan(value.number); });
}

int StiffnessGrid::size() const noexcept {
  return 1 + static_cast<int>(std::lround((max_n_per_mm - min_n_per_mm) / step_n_per_mm));
}

double StiffnessGrid::n_per_mm(int index) const { return short_number(min_n_per_mm + index * step_n_per_mm); }

double StiffnessGrid::at(int index) const { return short_number(1000.0 * n_per_mm(index)); }

bool Study::has_variants() const noexcept { return variants.size() > 1 || !variants.front().name.empty(); }

int point_count(const Study& study) {
  std::size_t count = study.variants.size();
  for (const StudyAxis& axis : study.axes) count *= axis.values.size();
  return static_cast<int>(count);
}

StudyPoint study_point(const Study& study, int index) {
  StudyPoint point{.index = index, .variant = 0, .value = std::vector<int>(study.axes.size())};
  for (std::size_t axis = study.axes.size(); axis-- > 0;) {
    const int size = static_cast<int>(study.axes[axis].values.size());
    point.value[axis] = index % size;
    index /= size;
  }
  point.variant = index;
  return point;
}

Overrides point_overrides(const Study& study, const StudyPoint& point) {
  Overrides overrides;
  const auto add = [&](const std::string& key, const std::string& toml) {
    overrides.emplace_back(key, resolved(study, key, toml));
  };
  for (const auto& [key, toml] : study.set) add(key, toml);
  for (const auto& [key, toml] : study.variants[static_cast<std::size_t>(point.variant)].set) add(key, toml);
  for (std::size_t axis = 0; axis < study.axes.size(); ++axis) {
    const StudyAxis& swept = study.axes[axis];
    add(swept.key, swept.values[static_cast<std::size_t>(point.value[axis])].toml);
  }
  return overrides;
}

std::string point_text(const Study& study, const StudyPoint& point) {
  std::string text = study.variants[static_cast<std::size_t>(point.variant)].name;
  for (std::size_t axis = 0; axis < study.axes.size(); ++axis) {
    const StudyAxis& swept = study.axes[axis];
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", swept.label,
                        swept.values[static_cast<std::size_t>(point.value[axis])].shown);
  }
  return text.empty() ? "the scene as it is" : text;
}

const char* verdict_name(Verdict verdict) noexcept {
  switch (verdict) {
    case Verdict::kStable:
      return "stable";
    case Verdict::kUnstable:
      return "unstable";
    case Verdict::kInvalid:
      return "invalid";
  }
  return "";
}

}  // namespace phalanx

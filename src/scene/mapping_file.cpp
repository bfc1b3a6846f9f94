// SPDX-License-Identifier: Apache-2.0
#include "phalanx/scene/mapping_file.h"

#include <fmt/format.h>

#include "phalanx/core/constants.h"
#include "phalanx/scene/data_paths.h"
#include "scene/joint_key.h"
#include "scene/text_file.h"
#include "scene/toml/toml_reader.h"

namespace phalanx {
namespace {

constexpr NumberRange kAny = {.min = -1e9, .max = 1e9};

/// Reads a number that is stated either in rad or in deg [rad].
double angle_or(TomlTable& table, const std::string& key, double fallback) {
  const bool rad = table.has(key + "_rad");
  const bool deg = table.has(key + "_deg");
  if (rad && deg) table.fail(key + "_rad", fmt::format("{}_deg is stated too; keep one", key));
  if (rad) return table.number(key + "_rad", kAny);
  return deg ? table.number(key + "_deg", kAny) * kDeg : fallback;
}

void read_clamp(TomlTable& table, const std::string& key, double unit, JointMapping& entry) {
  if (!table.has(key)) return;
  if (entry.clamped) table.fail(key, "the clamp is stated in rad and in deg; keep one");
  const auto [low, high] = table.pair(key, kAny);
  if (!(low < high)) table.fail(key, "write [smallest, largest]");
  entry.clamped = true;
  entry.clamp_min = low * unit;
  entry.clamp_max = high * unit;
}

JointMapping read_joint(TomlTable table, int joint) {
  JointMapping entry;
  entry.joint = joint;
  if (table.has("completed_from")) {
    if (table.has("source")) table.fail("completed_from", "the joint has a source, too; keep one");
    if (table.has("computed")) table.fail("computed", "belongs to a source; leave it out");
    entry.completed_from = read_joint_name(table, "completed_from");
  } else {
    if (!table.has("source"))
      table.fail("source", "is missing; name a column or a sensor, or use completed_from");
    entry.source = table.text("source");
    if (entry.source.empty()) table.fail("source", "name a column or a sensor");
    if (table.has("computed")) entry.computed = table.flag("computed");
  }
  entry.sign = table.number_or("sign", {.min = -1.0, .max = 1.0}, 1.0);
  if (entry.sign != 1.0 && entry.sign != -1.0) table.fail("sign", "must be 1 or -1");
  entry.gain = table.number_or("gain", {.min = 0.0, .max = 1e6, .min_open = true}, 1.0);
  entry.offset = angle_or(table, "offset", 0.0);
  read_clamp(table, "clamp_rad", 1.0, entry);
  read_clamp(table, "clamp_deg", kDeg, entry);
  table.finish();
  return entry;
}

}  // namespace

SensorMapping parse_mapping(const std::string& text, const std::string& origin) {
  const toml::table root = parse_toml(text, origin);
  TomlTable table(root, origin, "");
  SensorMapping mapping;
  mapping.name = std::filesystem::path(origin).stem().string();
  if (table.has("description")) static_cast<void>(table.text("description"));
  for (int joint = 0; joint < kJoints; ++joint) {
    if (table.has(joint_name(joint)))
      mapping.joints.push_back(read_joint(table.table(joint_name(joint)), joint));
  }
  table.finish();
  if (mapping.joints.empty())
    table.fail("index_mcp_flexion", "no joint is mapped; add at least one table such as this");
  for (const JointMapping& entry : mapping.joints) {
    const std::string problem = entry.completed_from ? completion_problem(mapping, entry) : "";
    if (!problem.empty()) table.table(joint_name(entry.joint)).fail("completed_from", problem);
  }
  return mapping;
}

SensorMapping load_mapping_file(const std::string& name_or_path, const std::filesystem::path& base) {
  const auto file = find_data_file("mapping", name_or_path, "assets/mappings", ".toml", base);
  return parse_mapping(read_text_file(file.string(), "mapping"), file.string());
}

}  // namespace phalanx

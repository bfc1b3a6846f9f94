// SPDX-License-Identifier: Apache-2.0
#include "phalanx/scene/range_file.h"

#include <fmt/format.h>

#include "phalanx/core/constants.h"
#include "phalanx/core/index.h"
#include "phalanx/scene/calibration_file.h"
#include "phalanx/scene/scene_file.h"
#include "scene/joint_key.h"
#include "scene/text_file.h"
#include "scene/toml/toml_reader.h"

namespace phalanx {
namespace {

constexpr NumberRange kAngleDeg = {.min = -180.0, .max = 180.0};

std::string read_date(TomlTable& table, std::string_view key) {
  const std::string date = table.text(key);
  if (!is_calibration_date(date)) table.fail(key, "write UTC as \"2026-05-04T09:30:00Z\"");
  return date;
}

void read_joints(TomlTable table, JointRanges& joints) {
  bool any = false;
  for (int joint = 0; joint < kJoints; ++joint) {
    const std::string_view name = joint_name(joint);
    if (!table.has(name)) continue;
    const auto [min, max] = table.pair(name, kAngleDeg);
    if (min > max) table.fail(name, "the smallest angle is above the largest; swap them, or measure again");
    joints[idx(joint)] = AngleRange{.min = min * kDeg, .max = max * kDeg};
    any = true;
  }
  table.finish();
  if (!any) throw SceneError(table.place() + " states no joint; measure the range again");
}

}  // namespace

std::string range_text(const MeasuredRange& range) {
  std::string text = fmt::format(
      "# Written by `phalanx device range`: the smallest and the largest angle that the patient held, in "
      "degrees.\n"
      "format = {}\ndevice = {}\nserial = {}\ncalibration = {}\npatient = {}\ndate = {}\nphalanx = "
      "{}\n\n[joints]\n",
      kRangeFormat, toml_string(range.device), toml_string(range.serial), toml_string(range.calibration),
      toml_string(range.patient), toml_string(range.date), toml_string(range.phalanx));
  for (int joint = 0; joint < kJoints; ++joint)
    if (const auto& reached = range.joint[idx(joint)])
      text +=
          fmt::format("{} = [{:.2f}, {:.2f}]\n", joint_name(joint), reached->min / kDeg, reached->max / kDeg);
  return text;
}

MeasuredRange parse_range(const std::string& text, const std::string& origin) {
  const toml::table root = parse_toml(text, origin);
  TomlTable table(root, origin, "");
  if (table.number("format", {}) != kRangeFormat)
    table.fail("format", fmt::format("this program reads format {}; measure the range again", kRangeFormat));
  MeasuredRange range;
  range.device = table.text("device");
  range.serial = table.text("serial");
  range.calibration = read_date(table, "calibration");
  range.patient = table.text("patient");
  range.date = read_date(table, "date");
  range.phalanx = table.text("phalanx");
  read_joints(table.table("joints"), range.joint);
  table.finish();
  return range;
}

MeasuredRange load_range(const std::filesystem::path& file) {
  return parse_range(read_text_file(file.string(), "patient's range"), file.string());
}

}  // namespace phalanx

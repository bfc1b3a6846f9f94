// SPDX-License-Identifier: Apache-2.0
#include "phalanx/scene/motion_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>

#include "phalanx/core/nearest_name.h"
#include "phalanx/scene/scene.h"
#include "scene/csv_lines.h"
#include "scene/text_file.h"

namespace phalanx {
namespace {

/// A column of the file from which a joint is read.
struct Column {
  std::size_t place = 0;
  JointMapping mapping;
};

struct Header {
  std::vector<std::string> names;
  std::size_t time = 0;
  std::vector<Column> columns;
  std::vector<JointMapping> completed;  ///< joints that are completed from those of `columns`
};

std::optional<std::size_t> find_name(const std::vector<std::string>& names, std::string_view name) {
  const auto it = std::find(names.begin(), names.end(), name);
  if (it == names.end()) return std::nullopt;
  return static_cast<std::size_t>(it - names.begin());
}

void refuse_unknown_columns(const CsvLines& lines, const Header& header) {
  std::vector<std::string> known;
  for (int joint = 0; joint < kJoints; ++joint) known.emplace_back(joint_name(joint));
  for (const std::string& name : header.names) {
    if (name == "time_s" || find_joint(name)) continue;
    lines.fail(
        fmt::format("column \"{}\" is not a joint; did you mean \"{}\"? For a recording with its own columns "
                    "state a mapping (--mapping, motion.mapping)",
                    show_cell(name), nearest_name(name, known)));
  }
}

Header read_header(CsvLines& lines, const std::optional<SensorMapping>& mapping) {
  std::string_view line;
  if (!lines.next(line))
    lines.fail("the file is empty; the first line names the columns: time_s and joint names");
  std::vector<std::string_view> cells;
  split_cells(line, cells);
  Header header;
  header.names.assign(cells.begin(), cells.end());
  auto sorted = header.names;
  std::sort(sorted.begin(), sorted.end());
  const auto twice = std::adjacent_find(sorted.begin(), sorted.end());
  if (twice != sorted.end())
    lines.fail(fmt::format("column \"{}\" appears twice; rename or remove one", show_cell(*twice)));

  const auto time = find_name(header.names, "time_s");
  if (!time) {
    lines.fail(fmt::format(
        "column \"time_s\" is missing; the header begins \"{}\"; name the columns, separated by commas, "
        "the time [s] time_s",
        show_cell(line)));
  }
  header.time = *time;
  if (!mapping) refuse_unknown_columns(lines, header);
  const SensorMapping wanted = mapping ? *mapping : identity_mapping();
  for (const JointMapping& entry : wanted.joints) {
    if (entry.completed_from) {
      header.completed.push_back(entry);
      continue;
    }
    const auto place = find_name(header.names, entry.source);
    if (place) {
      header.columns.push_back({*place, entry});
    } else if (mapping) {
      lines.fail(fmt::format(
          "column \"{}\", which mapping \"{}\" needs for {}, is missing; the nearest column is \"{}\"; "
          "choose another mapping or correct it",
          entry.source, mapping->name, joint_name(entry.joint),
          show_cell(nearest_name(entry.source, header.names))));
    }
  }
  if (header.columns.empty()) lines.fail("no column is a joint; add at least one, e.g. index_mcp_flexion");
  return header;
}

double read_cell(const CsvLines& lines, const Header& header, const std::vector<std::string_view>& cells,
                 std::size_t place) {
  const auto value = parse_number(cells[place]);
  if (!value) {
    lines.fail(fmt::format("column \"{}\": \"{}\" is not a number; correct it, or remove the row",
                           header.names[place], show_cell(cells[place])));
  }
  if (!std::isfinite(*value)) {
    lines.fail(fmt::format("column \"{}\": {} is not a finite number; interpolate it, or remove the row",
                           header.names[place], show_cell(cells[place])));
  }
  return *value;
}

double read_angle(const CsvLines& lines, const Header& header, const std::vector<std::string_view>& cells,
                  const Column& column) {
  const double raw = read_cell(lines, header, cells, column.place);
  const double angle = mapped_angle(column.mapping, raw);
  if (std::abs(angle) <= 2.0 * std::numbers::pi) return angle;
  lines.fail(fmt::format(
      "column \"{}\": {} gives {} = {} rad, more than a full turn; if the file is in degrees, give a "
      "mapping with gain = 0.017453292519943295",
      header.names[column.place], show_cell(cells[column.place]), joint_name(column.mapping.joint), angle));
}

/// Returns the angle of a joint that is completed from those of `angle` [rad].
double completed_angle(const CsvLines& lines, const JointMapping& entry, const JointArray& angle) {
  const int from = *entry.completed_from;
  const double of = angle[static_cast<std::size_t>(from)];
  const double completed = mapped_angle(entry, of);
  if (std::abs(completed) <= 2.0 * std::numbers::pi) return completed;
  lines.fail(fmt::format(
      "{} = {} rad gives {} = {} rad, more than a full turn; correct gain and offset of its completion",
      joint_name(from), of, joint_name(entry.joint), completed));
}

/// Returns the origin of each joint's angle in a motion with this header.
AngleOrigins angle_origins(const Header& header) {
  AngleOrigins origin;
  origin.fill(AngleOrigin::kFixed);
  for (const Column& column : header.columns)
    origin[static_cast<std::size_t>(column.mapping.joint)] =
        column.mapping.computed ? AngleOrigin::kCompleted : AngleOrigin::kMeasured;
  for (const JointMapping& entry : header.completed)
    origin[static_cast<std::size_t>(entry.joint)] = AngleOrigin::kCompleted;
  return origin;
}

}  // namespace

Motion parse_motion(std::string_view text, const std::string& origin,
                    const std::optional<SensorMapping>& mapping, std::optional<int> trial,
                    const JointArray& open_angle) {
  if (mapping) check_mapping(*mapping);
  if (trial && *trial < 1)
    throw SceneError(fmt::format("{}: trial {}: trials are counted from 1", origin, *trial));
  CsvLines lines(text, origin);
  const Header header = read_header(lines, mapping);

  Motion motion;
  motion.angle_origin = angle_origins(header);
  int trials = 1;
  double last_time = -std::numeric_limits<double>::infinity();
  struct {
    std::size_t line = 0;
    double from = 0.0;
    double to = 0.0;
  } first_reset;
  std::string_view line;
  std::vector<std::string_view> cells;
  while (lines.next(line)) {
    split_cells(line, cells);
    if (cells.size() != header.names.size()) {
      lines.fail(fmt::format("the row has {} cells, the header {}; give every row one cell a column",
                             cells.size(), header.names.size()));
    }
    const double time = read_cell(lines, header, cells, header.time);
    if (time < last_time) {
      if (trials == 1) first_reset = {lines.number(), last_time, time};
      ++trials;
    }
    const bool wanted = trials == trial.value_or(1);
    if (wanted && time == last_time) {
      lines.fail(fmt::format(
          "column \"time_s\": {} s appears twice; time must increase: remove one of the rows", time));
    }
    last_time = time;
    if (!wanted) continue;
    JointArray angle = open_angle;
    for (const Column& column : header.columns) {
      angle[static_cast<std::size_t>(column.mapping.joint)] = read_angle(lines, header, cells, column);
    }
    for (const JointMapping& entry : header.completed)
      angle[static_cast<std::size_t>(entry.joint)] = completed_angle(lines, entry, angle);
    motion.time_s.push_back(time);
    motion.angle.push_back(angle);
  }
  if (trials == 1 && motion.time_s.empty() && !trial)
    lines.fail("the file has a header but no rows; add at least one");
  if (!trial && trials > 1) {
    throw SceneError(fmt::format(
        "{}:{}: column \"time_s\": time runs backwards, from {} s to {} s; the file seems to hold {} trials: "
        "choose one with --trial N (motion.trial), N from 1 to {}",
        origin, first_reset.line, first_reset.from, first_reset.to, trials, trials));
  }
  if (motion.time_s.empty()) {
    throw SceneError(fmt::format("{}: there is no trial {}; the file holds {}: choose one from 1 to {}",
                                 origin, *trial, trials, trials));
  }
  return motion;
}

Motion load_motion(const std::filesystem::path& file, const std::optional<SensorMapping>& mapping,
                   std::optional<int> trial, const JointArray& open_angle) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(file, ignored)) {
    throw SceneError("motion file: " + why_no_file(file));
  }
  std::ifstream stream(file, std::ios::binary);
  std::string text(static_cast<std::size_t>(std::filesystem::file_size(file, ignored)), '\0');
  stream.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (!stream)
    throw SceneError(fmt::format("motion file {}: cannot be read; check its permissions", file.string()));
  return parse_motion(text, file.string(), mapping, trial, open_angle);
}

}  // namespace phalanx

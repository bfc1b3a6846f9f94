// SPDX-License-Identifier: Apache-2.0
#include "phalanx/scene/posture_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <unordered_set>

#include "phalanx/core/constants.h"
#include "phalanx/scene/data_paths.h"
#include "phalanx/scene/motion_file.h"
#include "scene/csv_lines.h"
#include "scene/text_file.h"

namespace phalanx {
namespace {

constexpr std::string_view kNameColumn = "posture";
constexpr std::size_t kLongestName = 64;

SensorMapping degrees() {
  SensorMapping mapping = identity_mapping();
  for (JointMapping& entry : mapping.joints) entry.gain = kDeg;
  return mapping;
}

void check_name(const CsvLines& lines, std::string_view name) {
  const auto allowed = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  };
  if (!name.empty() && name.size() <= kLongestName && std::all_of(name.begin(), name.end(), allowed)) return;
  lines.fail(
      fmt::format("column \"{}\": \"{}\" is not a posture's name; write 1 to {} small letters, digits, "
                  "'_' and '-'",
                  kNameColumn, show_cell(name), kLongestName));
}

constexpr std::string_view kTimeColumn = "time_s";
constexpr double kFullTurn = 360.0;  // [deg]

/// Refuses what parse_motion() would explain with words for a recording.
void check_numbers(const CsvLines& lines, const std::vector<std::string_view>& names,
                   const std::vector<std::string_view>& cells, double& latest) {
  for (std::size_t i = 0; i < std::min(names.size(), cells.size()); ++i) {
    const std::optional<double> value = parse_number(cells[i]);
    if (!value) continue;
    if (names[i] == kTimeColumn) {
      if (*value <= latest)
        lines.fail(fmt::format("{} = {} does not increase; number the postures in order", kTimeColumn,
                               show_cell(cells[i])));
      latest = *value;
    } else if (find_joint(names[i]) && std::abs(*value) > kFullTurn) {
      lines.fail(fmt::format("{} = {} is beyond a full turn; write degrees", names[i], show_cell(cells[i])));
    }
  }
}

}  // namespace

std::vector<Posture> parse_postures(std::string_view text, const std::string& origin) {
  CsvLines lines(text, origin);
  std::string_view line;
  std::vector<std::string_view> header;
  std::vector<std::string_view> cells;
  if (lines.next(line)) split_cells(line, header);
  const auto column = std::find(header.begin(), header.end(), kNameColumn);
  if (column == header.end())
    lines.fail(
        fmt::format("column \"{}\" is missing; the first line names the columns: {}, {} and the joints",
                    kNameColumn, kTimeColumn, kNameColumn));
  const auto place = static_cast<std::size_t>(column - header.begin());
  double latest = -std::numeric_limits<double>::infinity();
  while (lines.next(line)) {
    split_cells(line, cells);
    check_numbers(lines, header, cells, latest);
  }
  const Motion motion = parse_motion(text, origin, degrees());
  lines = CsvLines(text, origin);
  static_cast<void>(lines.next(line));

  std::vector<Posture> postures;
  std::unordered_set<std::string> names;
  for (const JointArray& angle : motion.angle) {
    static_cast<void>(lines.next(line));
    split_cells(line, cells);
    check_name(lines, cells[place]);
    postures.push_back({.name = std::string(cells[place]), .angle = angle});
    if (!names.insert(postures.back().name).second)
      lines.fail(fmt::format("posture \"{}\" appears twice; rename one", postures.back().name));
  }
  return postures;
}

std::vector<Posture> load_postures(const std::string& name_or_path, const std::filesystem::path& base) {
  const auto file = find_data_file("posture", name_or_path, "assets/postures", ".csv", base);
  return parse_postures(read_text_file(file.string(), "posture file"), file.string());
}

}  // namespace phalanx

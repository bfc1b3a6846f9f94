// SPDX-License-Identifier: Apache-2.0
// A file with the table of observations as the export writes it, for scores.py.
#pragma once

#include <fmt/format.h>

#include <cctype>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "phalanx/exercise/observation_table.h"

namespace phalanx::test {

/// Names of the file's columns: of the recording, then of an observation.
/// tests/apps/exercise/exercise_command_test.cpp lets scores.py read the export itself.
inline std::vector<std::string> observation_file_columns() {
  std::vector<std::string> names = {"time_s", "station", "tick", "host_time_s"};
  for (const ObservationColumn& column : observation_columns()) {
    std::string name = column.name;
    if (!column.unit.empty()) name.push_back('_');
    for (const char c : column.unit)
      if (c == '/') {
        name.append("_per_");
      } else {
        name.push_back(static_cast<char>(std::tolower(static_cast<unsigned char>(c))));
      }
    if (column.labels.empty()) names.push_back(name);
    for (const std::string& label : column.labels) names.push_back(fmt::format("{}_{}", name, label));
  }
  return names;
}

inline void write_observations(const std::filesystem::path& file, const std::vector<Observation>& steps) {
  std::ofstream out(file);
  std::string line;
  for (const std::string& name : observation_file_columns())
    line.append(line.empty() ? "" : ",").append(name);
  out << line << '\n';
  std::vector<double> row;
  for (const Observation& step : steps) {
    row = {step.time, 1.0, static_cast<double>(step.tick), step.time};
    append_observation(step, row);
    line.clear();
    for (std::size_t i = 0; i < row.size(); ++i) {
      if (i > 0) line.push_back(',');
      if (!std::isnan(row[i])) fmt::format_to(std::back_inserter(line), "{:.17g}", row[i]);
    }
    out << line << '\n';
  }
}

}  // namespace phalanx::test

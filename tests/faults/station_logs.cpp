// SPDX-License-Identifier: Apache-2.0
#include "faults/station_logs.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <stdexcept>

namespace phalanx::testing {
namespace {

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> cells;
  std::size_t from = 0;
  for (std::size_t comma = line.find(','); comma != std::string::npos; comma = line.find(',', from)) {
    cells.push_back(line.substr(from, comma - from));
    from = comma + 1;
  }
  cells.push_back(line.substr(from));
  return cells;
}

/// A CSV file with a header line, row by row.
class CsvReader {
 public:
  explicit CsvReader(const std::filesystem::path& path) : path_(path), file_(path) {
    std::string line;
    if (!std::getline(file_, line)) return;
    header_ = split(line);
    for (std::size_t i = 0; i < header_.size(); ++i) column_[header_[i]] = i;
  }

  /// The last line of a program that was killed may be incomplete: that ends the file.
  bool next() {
    std::string line;
    if (!std::getline(file_, line)) return false;
    cells_ = split(line);
    return cells_.size() == header_.size();
  }

  [[nodiscard]] const std::vector<std::string>& header() const { return header_; }
  [[nodiscard]] const std::string& text(const std::string& name) const {
    const auto found = column_.find(name);
    if (found == column_.end()) throw std::runtime_error(path_.string() + ": no column " + name);
    return cells_[found->second];
  }
  [[nodiscard]] double number(const std::string& name) const { return std::stod(text(name)); }
  [[nodiscard]] std::uint64_t count(const std::string& name) const { return std::stoull(text(name)); }

 private:
  std::filesystem::path path_;
  std::ifstream file_;
  std::vector<std::string> header_;
  std::map<std::string, std::size_t> column_;
  std::vector<std::string> cells_;
};

/// NaN stays NaN: a torque that is none must not be overlooked.
double largest_of(const std::vector<double>& torques) {
  double largest = 0.0;
  for (const double torque : torques) {
    if (!std::isfinite(torque)) return torque;
    largest = std::max(largest, std::abs(torque));
  }
  return largest;
}

/// "index_mcp_flexion" of "torque_index_mcp_flexion_nm", for each joint of the device.
std::vector<std::string> joints_of(const CsvReader& csv) {
  const std::string before = "torque_";
  const std::string after = "_nm";
  std::vector<std::string> joints;
  for (const std::string& name : csv.header()) {
    if (name.starts_with(before) && name.ends_with(after))
      joints.push_back(name.substr(before.size(), name.size() - before.size() - after.size()));
  }
  return joints;
}

std::vector<double> torques(const CsvReader& csv, const std::vector<std::string>& joints,
                            const std::string& before, const std::string& after) {
  std::vector<double> out;
  for (const std::string& joint : joints) out.push_back(csv.number(before + joint + after));
  return out;
}

ControllerRow controller_row(const CsvReader& csv, const std::vector<std::string>& joints) {
  ControllerRow row;
  row.tick = csv.count("tick");
  row.time_us = std::llround(1e6 * csv.number("time_s"));
  row.state = csv.text("state");
  row.fault = csv.text("fault");
  row.acted_tick = csv.count("acted_tick");
  row.age_us = std::stoll(csv.text("acted_age_us"));
  row.factor = csv.number("factor");
  row.corrupt = csv.count("corrupt");
  row.refused = csv.count("refused");
  row.outdated = csv.count("outdated");
  row.torque = torques(csv, joints, "torque_", "_nm");
  row.largest = largest_of(row.torque);
  return row;
}

HostRow host_row(const CsvReader& csv, const std::vector<std::string>& joints) {
  HostRow row;
  row.tick = csv.count("tick");
  row.sample_time_us = std::stoll(csv.text("sample_time_us"));
  row.samples = csv.count("samples");
  row.overrun = csv.text("overrun") == "1";
  row.state = csv.text("state");
  row.fault = csv.text("fault");
  row.factor = csv.number("factor");
  row.stiffness = csv.number("stiffness_n_per_m");
  row.torque = torques(csv, joints, "torque_nm_", "");
  row.largest = largest_of(row.torque);
  return row;
}

}  // namespace

StationLogs read_logs(const std::filesystem::path& folder) {
  StationLogs logs;
  CsvReader device(folder / "controller.csv");
  const std::vector<std::string> joints = joints_of(device);
  while (device.next()) logs.controller.push_back(controller_row(device, joints));
  CsvReader station(folder / "host.csv");
  while (station.next()) logs.host.push_back(host_row(station, joints));
  CsvReader glove(folder / "glove.csv");
  while (glove.next()) logs.glove.push_back({.time = glove.number("time_s"), .held = glove.text("held")});
  return logs;
}

}  // namespace phalanx::testing

// SPDX-License-Identifier: Apache-2.0
// The two logs that a scenario leaves: a row a tick of the controller, a row a step of the host.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace phalanx::testing {

/// `phalanx device simulate --log`
struct ControllerRow {
  std::uint64_t tick = 0;    ///< of the plant: counts executed ticks
  std::int64_t time_us = 0;  ///< the controller's clock
  std::string state;
  std::string fault;
  std::uint64_t acted_tick = 0;
  std::int64_t age_us = 0;  ///< of the step acted on
  double factor = 0.0;
  double largest = 0.0;  ///< |torque| over all joints [Nm]
  std::uint64_t corrupt = 0, refused = 0, outdated = 0;
  std::vector<double> torque;  ///< of the device's joints [Nm]
};

/// `phalanx run --log`
struct HostRow {
  std::uint64_t tick = 0;
  std::int64_t sample_time_us = 0;  ///< of the newest sample that it had, the controller's clock
  std::uint64_t samples = 0;        ///< new ones
  bool overrun = false;
  std::string state;
  std::string fault;
  double factor = 0.0;
  double stiffness = 0.0;      ///< [N/m]
  double largest = 0.0;        ///< |torque| over all joints [Nm]
  std::vector<double> torque;  ///< of the device's joints, in the order of the controller's log [Nm]
};

/// `glove_program`
struct GloveRow {
  double time = 0.0;  ///< [s]
  std::string held;   ///< "A0B812C0D0E0": what the servos hold
};

struct StationLogs {
  std::vector<ControllerRow> controller;
  std::vector<HostRow> host;
  std::vector<GloveRow> glove;
};

/// "controller.csv", "host.csv" and "glove.csv". One that is not there is empty. @throws std::runtime_error
/// where a column is missing
[[nodiscard]] StationLogs read_logs(const std::filesystem::path& folder);

/// Index of the first row from `from` on that `is`; the number of rows if there is none.
template <class Row, class Is>
[[nodiscard]] std::size_t first_row(const std::vector<Row>& rows, std::size_t from, Is is) {
  std::size_t i = from;
  while (i < rows.size() && !is(rows[i])) ++i;
  return i;
}

}  // namespace phalanx::testing

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace phalanx {

/// What `phalanx run` was told on its command line.
struct RunOptions {
  std::string scene = "grasp_teapot";
  std::string device = "simulated";
  std::string calibration;
  std::string clinician;
  std::string profile;
  std::string log;
  std::string summary;
  std::string faults = "out/faults";
  std::vector<std::string> set;
  std::optional<double> seconds;
  std::optional<double> rate_hz;
  double slow_motion = 1.0;
  int priority = 80;
  int cpu = -1;
  bool no_realtime = false;
  bool headless = false;
  bool quiet = false;
};

}  // namespace phalanx

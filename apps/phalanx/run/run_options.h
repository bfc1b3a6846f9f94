// SPDX-License-Identifier: Apache-2.0
// `phalanx run`. run_command.cpp has the command and its main loop. These options give it a session, RunConsole
// its messages, RunPage the cockpit, and RunRecorder the files. terminate.h removes the torque if the program
// fails.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "phalanx/record/session_recorder.h"
#include "phalanx/station/session.h"

namespace phalanx {

/// Options of `phalanx run` on its command line.
struct RunOptions {
  static constexpr const char* kDemonstration = "first_touch";
  static constexpr const char* kGrasp = "grasp_teapot";

  std::string scene;  ///< empty: kDemonstration with a simulated device, else kGrasp
  std::string device = "simulated";
  std::string calibration;
  std::string range;
  std::string clinician;
  std::optional<double> watchdog_ms;  ///< watchdog of a glove's firmware [ms]
  bool no_force_feedback = false;     ///< a glove that only senses
  std::string object;                 ///< mesh file in place of the scene's objects
  std::optional<double> object_size_mm;
  std::string profile;
  std::string recordings = "out/recordings";  ///< folder; "off": nothing is recorded
  bool no_foxglove = false;
  std::optional<double> record_quota_gb;
  std::optional<double> record_keep_days;
  std::optional<double> record_keep_gb;
  std::optional<int> marker_port;  ///< UDP port of markers; none: closed
  std::string marker_address = "127.0.0.1";
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
  std::string listen = "127.0.0.1";
  int port = 8480;
  bool port_stated = false;  ///< --port was given: use that port or none
  std::string certificate;
  std::string key;
  std::string data;  ///< data folder of the registry of patients; empty: the page keeps none
  std::string keys;  ///< file with the patients' keys, with `data`; empty: the default one
  std::optional<double>
      stable_n_per_mm;  ///< largest stiffness at which the device is stable, as measured [N/mm]
  std::string audit = "out/cockpit/changes.jsonl";
  std::string uploads = "out/cockpit/meshes";
  std::string calibrations = "out/calibrations";
  std::string ranges = "out/ranges";
  bool quiet = false;
};

/// Makes the station's settings from the command line of `phalanx run`.
/// @throws SceneError or std::invalid_argument if options contradict each other
[[nodiscard]] SessionSettings session_settings(const RunOptions& options);

/// @returns the settings of the recording; none with `--record off`
[[nodiscard]] std::optional<RecorderSettings> recorder_settings(const RunOptions& options);

/// @returns a warning if the scene replaces copies that the user's own device file states, with the options
/// that keep the file's; empty if it replaces none
/// @throws SceneError if the scene or the device file cannot be read
[[nodiscard]] std::string replaced_copies(const SessionSettings& settings);

}  // namespace phalanx

// SPDX-License-Identifier: Apache-2.0
#include "run_host.h"

#include <fmt/format.h>

#include <filesystem>
#include <stdexcept>

#include "phalanx/record/made.h"
#include "phalanx/record/output_file.h"
#include "phalanx/scene/calibration_file.h"
#include "phalanx/station/station.h"

namespace phalanx {
namespace {

bool is_simulated(const RunOptions& o) { return o.device == "simulated" || o.device == "sliders"; }

/// A controller that does not slow down with us would be judged by time limits that are too long.
void refuse_slow_motion(const RunOptions& o) {
  const bool ours = is_simulated(o) || o.device.starts_with("udp:127.") ||
                    o.device.starts_with("udp:localhost:") || o.device.starts_with("serial:/dev/pts/");
  if (o.slow_motion == 1.0 || ours) return;
  throw std::invalid_argument(
      fmt::format("--slow-motion {}: {} may be a real device, whose time goes on as ever; leave it out",
                  o.slow_motion, o.device));
}

Overrides overrides_of(const RunOptions& o) {
  Overrides overrides;
  for (const std::string& text : o.set) overrides.push_back(parse_override(text));
  if (!o.profile.empty()) overrides.emplace_back("hand.profile", fmt::format("\"{}\"", o.profile));
  if (o.rate_hz) check_station_rate(*o.rate_hz);
  if (o.rate_hz) overrides.emplace_back("rate_hz", fmt::format("{:.17g}", *o.rate_hz));
  return overrides;
}

/// Where the page's calibrations go: a file a device, named after its serial number.
std::string write_calibration(const std::string& folder, Calibration calibration) {
  calibration.date = made_here().date;
  calibration.phalanx = PHALANX_VERSION;
  std::string name = calibration.serial;
  for (char& c : name) {
    const bool plain = (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '-';
    if (!plain) c = '_';
  }
  prepare_output_folder(folder);
  const std::filesystem::path file =
      std::filesystem::absolute(std::filesystem::path(folder) / ((name.empty() ? "device" : name) + ".toml"));
  const std::string text = calibration_text(calibration);
  // A device's name may hold bytes that no TOML file can: better said here than when the file is read.
  static_cast<void>(parse_calibration(text, file.string()));
  write_text_file(file, text);
  return file.string();
}

}  // namespace

StationHostSettings host_settings(const RunOptions& o) {
  refuse_slow_motion(o);
  if (is_simulated(o) && !o.calibration.empty())
    throw std::invalid_argument("--calibration: the simulated device needs none; leave it out");
  StationHostSettings settings;
  settings.scene = !o.scene.empty()  ? o.scene
                   : is_simulated(o) ? RunOptions::kDemonstration
                                     : RunOptions::kGrasp;
  settings.overrides = overrides_of(o);
  settings.device = o.device;
  settings.calibration = o.calibration;
  settings.clinician = o.clinician;
  settings.realtime = {.priority = o.priority, .cpu = o.cpu, .lock_memory = true};
  settings.ask_for_realtime = !o.no_realtime;
  settings.write_calibration = [folder = o.calibrations](const Calibration& found) {
    return write_calibration(folder, found);
  };
  return settings;
}

}  // namespace phalanx

// SPDX-License-Identifier: Apache-2.0
#include "run/run_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <stdexcept>

#include "option_text.h"
#include "phalanx/core/index.h"
#include "phalanx/record/made.h"
#include "phalanx/record/output_file.h"
#include "phalanx/scene/calibration_file.h"
#include "phalanx/scene/device_file.h"
#include "phalanx/scene/range_file.h"
#include "phalanx/scene/scene_file.h"
#include "phalanx/station/station.h"

namespace phalanx {
namespace {

bool is_simulated(const RunOptions& o) { return o.device == "simulated" || o.device == "sliders"; }

/// Refuses slow motion for a controller whose clock is not slowed: its time limits would be judged too long.
void refuse_slow_motion(const RunOptions& o) {
  const bool ours = is_simulated(o) || o.device.starts_with("udp:127.") ||
                    o.device.starts_with("udp:localhost:") || o.device.starts_with("serial:/dev/pts/");
  if (o.slow_motion == 1.0 || ours) return;
  throw std::invalid_argument(
      fmt::format("--slow-motion {}: {} may be a real device, whose time goes on as ever; leave it out",
                  o.slow_motion, o.device));
}

/// Checks the options of gloves. A glove's protocol does not report these values; other devices report them.
void check_glove_options(const RunOptions& o) {
  if (o.watchdog_ms && !(*o.watchdog_ms >= 1.0 && *o.watchdog_ms <= 1000.0))
    throw std::invalid_argument(fmt::format(
        "--watchdog-ms {}: must be 1 to 1000 ms; state after which time the glove's firmware ends its forces",
        *o.watchdog_ms));
  if (o.device.starts_with("opengloves:")) return;
  const char* stated = o.watchdog_ms         ? "--watchdog-ms"
                       : o.no_force_feedback ? "--no-force-feedback"
                                             : nullptr;
  if (stated == nullptr) return;
  throw std::invalid_argument(
      fmt::format("{}: it is for a glove (--device opengloves:PORT), and the device is {}; leave it out",
                  stated, o.device));
}

/// Makes the value of `objects` that replaces the scene's objects by --object, at the pose of the first.
std::string own_object(const RunOptions& o, const std::string& scene) {
  std::string keys = fmt::format("kind = \"file\", file = {}, size_mm = {}",
                                 option_as_toml("--object", o.object), o.object_size_mm.value_or(0.0));
  const SceneWithValues read = SceneFile(scene).with_values({});
  for (const auto& [key, value] : read.values) {
    if (key == "objects.0.position_mm") keys += ", position_mm = " + value;
    if (key == "objects.0.rotation_deg") keys += ", rotation_deg = " + value;
  }
  return fmt::format("[{{ {} }}]", keys);
}

Overrides overrides_of(const RunOptions& o, const std::string& scene) {
  Overrides overrides;
  if (o.object.empty() && o.object_size_mm)
    throw std::invalid_argument("--object-size-mm needs --object FILE");
  if (!o.object.empty()) overrides.emplace_back("objects", own_object(o, scene));
  for (const std::string& text : o.set) overrides.push_back(parse_override(text));
  if (!o.profile.empty()) overrides.emplace_back("hand.profile", option_as_toml("--profile", o.profile));
  if (o.rate_hz) check_station_rate(*o.rate_hz);
  if (o.rate_hz) overrides.emplace_back("rate_hz", fmt::format("{:.17g}", *o.rate_hz));
  return overrides;
}

/// @returns the path of a file in the folder, which is made if needed
std::filesystem::path file_in(const std::string& folder, std::string name) {
  for (char& c : name) {
    const bool plain = (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '-';
    if (!plain) c = '_';
  }
  prepare_output_folder(folder);
  return std::filesystem::absolute(std::filesystem::path(folder) /
                                   ((name.empty() ? "device" : name) + ".toml"));
}

/// Writes the range that the page measured: one file for a device and a patient's label.
std::string write_range(const std::string& folder, MeasuredRange range) {
  range.date = made_here().date;
  range.phalanx = PHALANX_VERSION;
  const std::filesystem::path file =
      file_in(folder, range.patient.empty() ? range.serial : range.serial + "-" + range.patient);
  const std::string text = range_text(range);
  static_cast<void>(parse_range(text, file.string()));
  write_text_file(file, text);
  return file.string();
}

/// Writes the page's calibration: one file a device, named after its serial number.
std::string write_calibration(const std::string& folder, Calibration calibration) {
  calibration.date = made_here().date;
  calibration.phalanx = PHALANX_VERSION;
  const std::filesystem::path file = file_in(folder, calibration.serial);
  const std::string text = calibration_text(calibration);
  // A device's name may contain bytes that a TOML file cannot: refuse it now, not when the file is read.
  static_cast<void>(parse_calibration(text, file.string()));
  write_text_file(file, text);
  return file.string();
}

}  // namespace

SessionSettings session_settings(const RunOptions& o) {
  refuse_slow_motion(o);
  check_glove_options(o);
  if (is_simulated(o) && !o.calibration.empty())
    throw std::invalid_argument("--calibration: the simulated device needs none; leave it out");
  if (is_simulated(o) && !o.range.empty())
    throw std::invalid_argument(
        "--range: it limits a device on a wire, and this one is simulated; leave it out");
  if (!o.range.empty() && o.calibration.empty())
    throw std::invalid_argument(
        "--range: it holds for one calibration of the device; state it, too, with --calibration");
  SessionSettings settings;
  settings.scene = !o.scene.empty()  ? o.scene
                   : is_simulated(o) ? RunOptions::kDemonstration
                                     : RunOptions::kGrasp;
  settings.overrides = overrides_of(o, settings.scene);
  settings.device = o.device;
  settings.calibration = o.calibration;
  settings.range = o.range;
  settings.clinician = o.clinician;
  if (o.watchdog_ms) settings.watchdog = 1e-3 * *o.watchdog_ms;
  settings.force_feedback = !o.no_force_feedback;
  settings.realtime = {.priority = o.priority, .cpu = o.cpu, .lock_memory = true};
  settings.ask_for_realtime = !o.no_realtime;
  settings.keep_changes = o.recordings != "off";
  settings.write_calibration = [folder = o.calibrations](const Calibration& found) {
    return write_calibration(folder, found);
  };
  settings.write_range = [folder = o.ranges](const MeasuredRange& found) {
    return write_range(folder, found);
  };
  return settings;
}

std::optional<RecorderSettings> recorder_settings(const RunOptions& o) {
  if (o.recordings == "off") return std::nullopt;
  RecorderSettings settings;
  settings.folder = o.recordings;
  settings.foxglove = !o.no_foxglove;
  if (o.record_quota_gb) settings.quota = static_cast<std::uint64_t>(1e9 * *o.record_quota_gb);
  settings.metadata = recording_metadata(PHALANX_VERSION);
  return settings;
}

std::string replaced_copies(const SessionSettings& settings) {
  const auto typed = [&](const std::string& key) {
    return std::ranges::any_of(settings.overrides,
                               [&](const auto& set) { return set.first.starts_with(key); });
  };
  const auto whole_table = [](const auto& set) { return set.first == "device.copy"; };
  if (!typed("device.file") || std::ranges::any_of(settings.overrides, whole_table)) return "";
  const SceneDescription scene = load_scene(settings.scene, settings.overrides);
  if (!scene.device.file.ends_with(".toml")) return "";  // a shipped device, for which the scenes were made
  ExoController of_file;
  try {
    of_file = load_device_file(scene.device.file).controller;
  } catch (const SceneError&) {
    return "";  // a file that only the scene's values and --set complete: it has no copies of its own to keep
  }
  const ExoController in_scene = load_device(scene).controller;
  std::string options;
  for (int digit = 0; digit < kDigits; ++digit) {
    const DigitCopy& own = of_file.copy[idx(digit)];
    const DigitCopy& used = in_scene.copy[idx(digit)];
    const std::string key = fmt::format("device.copy.{}", digit_name(digit));
    if (own.of < 0 || (own.of == used.of && own.gain == used.gain) || typed(key)) continue;
    options += fmt::format(" --set {0}.of={1} --set {0}.gain={2}", key, digit_name(own.of), own.gain);
  }
  if (options.empty()) return "";
  return fmt::format("the scene replaces copies of {}; to keep the file's, type{}", scene.device.file,
                     options);
}

}  // namespace phalanx

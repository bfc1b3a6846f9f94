// SPDX-License-Identifier: Apache-2.0
#include "apps/month/calibrated_device.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <regex>
#include <sstream>
#include <stdexcept>

#include "apps/month/held_programs.h"
#include "phalanx/core/constants.h"
#include "phalanx/hand/joints.h"
#include "phalanx/scene/calibration_file.h"

namespace phalanx::testing {
namespace {

constexpr const char* kJoint = "index_mcp_flexion";
// A squeeze lasts 5.3 s of the device. Slowed down, both positions are held for longer than the second
// that is measured.
constexpr const char* kSlower = "3";
constexpr double kPressed = 7.5;    // time of the clock at which the finger lies on the object [s]
constexpr double kReleased = 14.7;  // and at which it is back [s]

/// Reads the device's own gains from the ranges that `phalanx device probe` prints: the calibration that the
/// device came with.
Calibration own_numbers(const std::string& probed) {
  Calibration own{.device = "simulated",
                  .serial = "simulated",
                  .date = "2026-02-01T09:00:00Z",
                  .phalanx = "0.1.0",
                  .channels = {}};
  const std::regex row(R"(angle\s+(\w+)\s+(-?\d+) \.\.\s+(-?\d+)\s+(-?[\d.]+) \.\.\s+(-?[\d.]+) deg)");
  std::istringstream lines(probed);
  for (std::string line; std::getline(lines, line);) {
    std::smatch part;
    if (!std::regex_search(line, part, row)) continue;
    const double least = std::stod(part[2]);
    const double largest = std::stod(part[3]);
    const double begin = kDeg * std::stod(part[4]);
    const double end = kDeg * std::stod(part[5]);
    CalibratedChannel channel;
    channel.channel.kind = ChannelKind::kAngle;
    channel.channel.index = find_joint(part[1].str()).value();
    channel.channel.gain = (end - begin) / (largest - least);
    channel.channel.offset = begin - channel.channel.gain * least;
    channel.poses = {{.pose = "smallest", .value = begin, .raw = least}};
    own.channels.push_back(channel);
  }
  return own;
}

/// @returns the controller's angle of the joint at a time of the clock, as read from a goniometer:
/// in whole degrees
double goniometer(const std::filesystem::path& log, double time) {
  std::istringstream lines(read_file(log));
  std::string line;
  std::getline(lines, line);
  const auto column = [&line](std::size_t index) {
    std::istringstream cells(line);
    std::string cell;
    for (std::size_t i = 0; i <= index; ++i) std::getline(cells, cell, ',');
    return cell;
  };
  std::size_t angle = 0;
  while (column(angle) != fmt::format("angle_{}_rad", kJoint)) ++angle;
  double degrees = 0.0;
  while (std::getline(lines, line) && std::stod(column(1)) * std::stod(kSlower) < time + 0.5)
    degrees = std::stod(column(angle)) / kDeg;
  return std::round(degrees);
}

const DeviceChannel& channel_of_joint(const Calibration& calibration) {
  const auto found = std::find_if(
      calibration.channels.begin(), calibration.channels.end(),
      [](const CalibratedChannel& channel) { return channel.channel.index == find_joint(kJoint).value(); });
  if (found == calibration.channels.end()) throw std::runtime_error(fmt::format("{} has no channel", kJoint));
  return found->channel;
}

/// Runs the device once alone, for what a goniometer shows at both positions, and for its own numbers.
struct KnownDevice {
  double pressed = 0.0;   ///< [deg]
  double released = 0.0;  ///< [deg]
  Calibration own;
};

KnownDevice known_device(const TemporaryFolder& folder, const std::vector<std::string>& environment) {
  HeldPrograms programs(folder.path(), environment);
  const auto device =
      programs.start_device("alone.txt", "0", {"--slow-motion", kSlower, "--log", "alone.csv"});
  const auto probe = programs.start({PHALANX_PROGRAM, "device", "probe", programs.address()}, "probe.txt");
  if (programs.wait(*probe, 10.0) != 0) throw std::runtime_error("probe: " + probe->errors());
  programs.pass(kReleased + 2.0 - programs.now());
  device->signal(SIGINT);
  if (programs.wait(*device, 10.0) != 0) throw std::runtime_error("device: " + device->errors());
  return {.pressed = goniometer(folder / "alone.csv", kPressed),
          .released = goniometer(folder / "alone.csv", kReleased),
          .own = own_numbers(probe->output())};
}

}  // namespace

CalibratedDevice calibrate_through_the_link(const TemporaryFolder& folder,
                                            const std::vector<std::string>& environment) {
  CalibratedDevice result;
  const KnownDevice known = known_device(folder, environment);
  std::ofstream(folder / "own.toml") << calibration_text(known.own);
  result.file = folder / "calibration.toml";
  HeldPrograms programs(folder.path(), environment);
  const auto device = programs.start_device("device.txt", "0", {"--slow-motion", kSlower});
  const double begin = programs.now();
  const auto calibrate =
      programs.start({PHALANX_PROGRAM, "device", "calibrate", programs.address(), "--method", "goniometer",
                      "--only", kJoint, "--calibration", "own.toml", "--out", result.file.string()},
                     "calibrate.txt");
  const auto at = [&](double time, const std::string& answer) {
    if (begin + time > programs.now()) programs.pass(begin + time - programs.now());
    calibrate->type(answer);
  };
  at(kPressed, fmt::format("{}", known.pressed));
  at(kReleased, fmt::format("{}", known.released));
  at(kReleased + 2.0, "s");
  result.exit_code = programs.wait(*calibrate, 10.0).value_or(-1);
  result.said = calibrate->output() + calibrate->errors();
  device->signal(SIGINT);
  static_cast<void>(programs.wait(*device, 10.0));
  if (result.exit_code != 0) return result;
  const DeviceChannel& own = channel_of_joint(known.own);
  const Calibration calibration = load_calibration(result.file);
  for (const double degrees : {known.pressed, known.released}) {
    const double raw = (kDeg * degrees - own.offset) / own.gain;
    const DeviceChannel& measured = channel_of_joint(calibration);
    result.largest_error =
        std::max(result.largest_error, std::abs(measured.gain * raw + measured.offset - kDeg * degrees));
  }
  return result;
}

}  // namespace phalanx::testing

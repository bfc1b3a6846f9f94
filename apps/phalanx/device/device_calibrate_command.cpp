// SPDX-License-Identifier: Apache-2.0
// phalanx device calibrate DEVICE --method METHOD --out FILE: gains and offsets of its channels, from known angles.
#include <fmt/format.h>

#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "commands.h"
#include "device/calibration_dialogue.h"
#include "device/calibration_terminal.h"
#include "device/device_text.h"
#include "phalanx/record/made.h"
#include "phalanx/record/output_file.h"
#include "phalanx/scene/calibration_file.h"
#include "phalanx/scene/device_file.h"
#include "phalanx/station/open_device.h"
#include "terminal/end_signals.h"
#include "usage.h"

namespace phalanx {
namespace {

struct CalibrateOptions {
  std::string spec, out, method, hand, profile, device_file, earlier;
  std::vector<std::string> only;
  bool force = false;
};

/// @returns the joints that a digit's or a joint's name stands for
std::vector<int> joints_named(const std::string& name) {
  if (const auto joint = find_joint(name)) return {*joint};
  std::vector<int> joints;
  for (int digit = 0; digit < kDigits; ++digit)
    for (int i = 0; i < kJointsPerDigit; ++i)
      if (name == digit_name(digit)) joints.push_back(joint_index(digit, i));
  if (joints.empty())
    throw std::invalid_argument(fmt::format(
        "--only {}: this is neither a digit (thumb, index, middle, ring, little) nor a joint such as {}",
        name, joint_name(joint_index(1, 2))));
  return joints;
}

std::vector<JointStops> stops_of_file(const std::string& name) {
  std::vector<JointStops> stops;
  for (const ExoJoint& joint : load_device_file(name).joints)
    if (joint.stop_min && joint.stop_max)
      stops.push_back({.joint = joint.joint, .min = *joint.stop_min, .max = *joint.stop_max});
  return stops;
}

CalibrationPlan plan_of(const CalibrateOptions& options) {
  CalibrationPlan plan;
  if (options.method == "stops") plan.method = CalibrationMethod::kStops;
  if (options.method == "goniometer") plan.method = CalibrationMethod::kGoniometer;
  const bool stops = plan.method == CalibrationMethod::kStops;
  if (stops != !options.device_file.empty())
    throw std::invalid_argument(
        stops ? "--method stops needs --device-file FILE, which states the angles of the device's stops"
              : "--device-file is for --method stops; leave it out");
  for (const std::string& name : options.only)
    for (const int joint : joints_named(name)) plan.joints.push_back(joint);
  if (stops) plan.stops = stops_of_file(options.device_file);
  return plan;
}

int calibrate(const CalibrateOptions& options) {
  check_out(options.out, options.force);
  const CalibrationPlan plan = plan_of(options);
  const HandParameters hand = hand_of_options(options.hand, options.profile);
  std::optional<Calibration> earlier;
  if (!options.earlier.empty()) earlier = load_calibration(options.earlier);
  const Clock clock;
  const auto device = open_to_measure(options.spec, hand, clock);
  end_on_interrupt();
  CalibrationTerminal terminal;
  Calibration calibration =
      calibrate_by_poses(*device, clock, hand, terminal, {.plan = plan, .earlier = std::move(earlier)});
  device->close();
  calibration.date = made_here().date;
  calibration.phalanx = PHALANX_VERSION;
  const std::string text = calibration_text(calibration);
  // A device's name may contain bytes that a TOML file cannot: refuse it now, not when the file is read.
  static_cast<void>(parse_calibration(text, options.out));
  write_text_file(options.out, text);
  fmt::print("{} ({} channels of {} {})\n", options.out, calibration.channels.size(), calibration.device,
             calibration.serial);
  return kDone;
}

}  // namespace

void add_device_calibrate(CLI::App& device, Job& job) {
  auto options = std::make_shared<CalibrateOptions>();
  CLI::App* command =
      device.add_subcommand("calibrate", "Find the gains and offsets of a device's channels at known angles");
  command->footer(
      std::string("DEVICE is one of\n") + kDeviceSpecs +
      "\nMETHOD is one of\n"
      "  jig         the device is on a jig or a dummy hand; its angles are those of --hand or --profile, or "
      "typed\n"
      "  stops       without a hand in it, the device is moved to its stops; --device-file states their "
      "angles\n"
      "  goniometer  a hand is held where it can be held; each angle is measured and typed\n"
      "None of them needs to know how far a patient can move: `phalanx device range` measures that.\n"
      "Nothing implausible is written. Motors stay off.\n"
      "Exit codes: 0 done, 1 refused or failed, 2 wrong usage.");
  command->add_option("DEVICE", options->spec, "its address")->required()->type_name("");
  command->add_option("--method", options->method, "jig, stops or goniometer")
      ->required()
      ->check(CLI::IsMember({"jig", "stops", "goniometer"}))
      ->type_name("METHOD");
  command->add_option("--out", options->out, "the calibration file")->required()->type_name("FILE");
  command->add_option("--only", options->only, "a digit or a joint; may be repeated [all]")
      ->allow_extra_args(false)
      ->type_name("NAME");
  command
      ->add_option("--calibration", options->earlier,
                   "an earlier file of this device: channels that are not measured keep its numbers")
      ->type_name("FILE");
  command->add_option("--device-file", options->device_file, "for stops: a name in assets/devices, or a path")
      ->type_name("FILE");
  command->add_option("--hand", options->hand, "hand file with the jig's angles [adult]")->type_name("HAND");
  command->add_option("--profile", options->profile, "the same, by a profile")->type_name("PROFILE");
  command->add_flag("--force", options->force, "replace FILE if it is there");
  command->callback([options, command, &job] {
    refuse_empty_values(*command);
    job = [options] { return calibrate(*options); };
  });
}

}  // namespace phalanx

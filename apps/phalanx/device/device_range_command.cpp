// SPDX-License-Identifier: Apache-2.0
// phalanx device range DEVICE --calibration FILE --out FILE: how far a patient moves each digit.
#include <fmt/format.h>

#include <memory>
#include <string>

#include "commands.h"
#include "device/calibration_terminal.h"
#include "device/device_text.h"
#include "device/range_dialogue.h"
#include "phalanx/record/made.h"
#include "phalanx/record/output_file.h"
#include "phalanx/scene/calibration_file.h"
#include "phalanx/scene/range_file.h"
#include "phalanx/station/open_device.h"
#include "terminal/end_signals.h"
#include "usage.h"

namespace phalanx {
namespace {

struct RangeOptions {
  std::string spec, out, calibration, hand, profile, patient;
  bool force = false;
};

int measure_range(const RangeOptions& options) {
  check_out(options.out, options.force);
  const HandParameters hand = hand_of_options(options.hand, options.profile);
  const Calibration calibration = load_calibration(options.calibration);
  const Clock clock;
  const auto device = open_to_measure(options.spec, hand, clock);
  end_on_interrupt();
  CalibrationTerminal terminal;
  MeasuredRange range = measure_range_of_patient(*device, apply_calibration(calibration, device->info()),
                                                 clock, hand, terminal);
  device->close();
  range.calibration = calibration.date;
  range.patient = options.patient;
  range.date = made_here().date;
  range.phalanx = PHALANX_VERSION;
  const std::string text = range_text(range);
  static_cast<void>(parse_range(text, options.out));
  write_text_file(options.out, text);
  fmt::print("{}\n", options.out);
  return kDone;
}

}  // namespace

void add_device_range(CLI::App& device, Job& job) {
  auto options = std::make_shared<RangeOptions>();
  CLI::App* command =
      device.add_subcommand("range", "Measure how far a patient moves each digit without help");
  command->footer(
      std::string("DEVICE is one of\n") + kDeviceSpecs +
      "\nThe patient moves one digit after the other as far as possible and holds each end for a moment.\n"
      "`phalanx run --range FILE` then pushes no joint beyond these angles, nor beyond the profile's.\n"
      "Motors stay off.\n"
      "Exit codes: 0 done, 1 refused or failed, 2 wrong usage.");
  command->add_option("DEVICE", options->spec, "its address")->required()->type_name("");
  command->add_option("--calibration", options->calibration, "the device's calibration file")
      ->required()
      ->type_name("FILE");
  command->add_option("--out", options->out, "the range file")->required()->type_name("FILE");
  command->add_option("--patient", options->patient, "a label of the patient, not a name")
      ->type_name("LABEL");
  command->add_option("--hand", options->hand, "hand file [adult]")->type_name("HAND");
  command->add_option("--profile", options->profile, "the patient's profile")->type_name("PROFILE");
  command->add_flag("--force", options->force, "replace FILE if it is there");
  command->callback([options, command, &job] {
    refuse_empty_values(*command);
    job = [options] { return measure_range(*options); };
  });
}

}  // namespace phalanx

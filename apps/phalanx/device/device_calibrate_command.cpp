// SPDX-License-Identifier: Apache-2.0
// phalanx device calibrate DEVICE --out FILE: gains and offsets of its channels, from poses of the wearer.
#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>

#include "commands.h"
#include "device/calibration_dialogue.h"
#include "device/device_text.h"
#include "phalanx/device/opengloves/opengloves_device.h"
#include "phalanx/record/made.h"
#include "phalanx/record/output_file.h"
#include "phalanx/scene/calibration_file.h"
#include "phalanx/scene/hand_meshes.h"
#include "phalanx/station/open_device.h"
#include "terminal/end_signals.h"
#include "usage.h"

namespace phalanx {
namespace {

namespace fs = std::filesystem;

struct CalibrateOptions {
  std::string spec, out, hand, profile;
  bool force = false;
};

/// Standard input and output. On a terminal, the line of live values is overwritten repeatedly.
class Terminal final : public CalibrationConsole {
 public:
  void say(const std::string& line) override {
    wipe();
    fmt::print("{}\n", line);
    std::fflush(stdout);
  }

  std::optional<std::string> answer(const std::function<std::string()>& live) override {
    while (true) {
      if (auto line = take_line()) {
        shown_ = 0;  // the typed line end has moved on
        return line;
      }
      if (ended_ || asked_to_end != 0) return std::nullopt;
      const std::string values = live();
      if (shows_live_ && !values.empty()) show(values);
      read_more();
    }
  }

 private:
  std::optional<std::string> take_line() {
    const std::size_t end = typed_.find('\n');
    if (end == std::string::npos) return std::nullopt;
    std::string line = typed_.substr(0, end);
    typed_.erase(0, end + 1);
    return line;
  }

  void read_more() {
    pollfd input{.fd = STDIN_FILENO, .events = POLLIN, .revents = 0};
    if (::poll(&input, 1, 100) <= 0) return;
    std::array<char, 256> bytes{};
    const ssize_t count = ::read(STDIN_FILENO, bytes.data(), bytes.size());
    if (count > 0) typed_.append(bytes.data(), static_cast<std::size_t>(count));
    if (count == 0 || (count < 0 && errno != EINTR && errno != EAGAIN)) ended_ = true;
  }

  void show(const std::string& values) {
    fmt::print("\r{:<{}}", values, shown_);
    shown_ = values.size();
    std::fflush(stdout);
  }

  void wipe() {
    if (shown_ > 0) fmt::print("\r{:<{}}\r", "", shown_);
    shown_ = 0;
  }

  const bool shows_live_ = ::isatty(STDOUT_FILENO) != 0;
  std::string typed_;
  bool ended_ = false;
  std::size_t shown_ = 0;  ///< characters of the live line
};

void check_out(const CalibrateOptions& options) {
  const fs::path out = options.out;
  if (fs::is_directory(out))
    throw std::invalid_argument(fmt::format("--out '{}' is a folder; name a file in it", options.out));
  if (fs::exists(out) && !options.force) {
    throw std::invalid_argument(fmt::format(
        "--out '{}' is there already; name another file, or say --force to replace it", options.out));
  }
  const fs::path folder = out.has_parent_path() ? out.parent_path() : fs::path(".");
  if (::access(folder.c_str(), W_OK | X_OK) != 0) {
    throw std::invalid_argument(
        fmt::format("--out '{}': no file can be made in '{}'; name one in a folder of yours", options.out,
                    folder.string()));
  }
}

HandParameters hand_of(const CalibrateOptions& options) {
  if (!options.hand.empty() && !options.profile.empty())
    throw std::invalid_argument("--hand and --profile: the profile says which hand; leave out --hand");
  HandDescription hand;
  hand.profile = options.profile;
  if (!options.hand.empty()) hand.file = options.hand;
  return load_hand_numbers(hand).parameters;
}

int calibrate(const CalibrateOptions& options) {
  check_out(options);
  const HandParameters hand = hand_of(options);
  const Clock clock;
  const auto device = open_device(options.spec, clock);
  if (auto* glove = dynamic_cast<OpenGlovesDevice*>(device.get())) glove->set_hand(hand);
  device->open();
  end_on_interrupt();
  Terminal terminal;
  Calibration calibration = calibrate_by_poses(*device, clock, hand, terminal);
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
      device.add_subcommand("calibrate", "Find the gains and offsets of a device's channels by poses");
  command->footer(
      std::string("DEVICE is one of\n") + kDeviceSpecs +
      "\nThe wearer goes through open hand, fist, spread and each joint's end stops; the angles there are "
      "those of\n--hand or --profile. Nothing implausible is written. Motors stay off.\n"
      "Exit codes: 0 done, 1 refused or failed, 2 wrong usage.");
  command->add_option("DEVICE", options->spec, "its address")->required()->type_name("");
  command->add_option("--out", options->out, "the calibration file")->required()->type_name("FILE");
  command->add_option("--hand", options->hand, "hand file with the wearer's range of motion [adult]")
      ->type_name("HAND");
  command->add_option("--profile", options->profile, "the wearer's profile")->type_name("PROFILE");
  command->add_flag("--force", options->force, "replace FILE if it is there");
  command->callback([options, command, &job] {
    refuse_empty_values(*command);
    job = [options] { return calibrate(*options); };
  });
}

}  // namespace phalanx

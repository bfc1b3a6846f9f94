// SPDX-License-Identifier: Apache-2.0
#include "device/calibration_dialogue.h"

#include <fmt/format.h>

#include <cstdlib>
#include <optional>
#include <sstream>
#include <vector>

#include "phalanx/core/constants.h"
#include "phalanx/device/calibration_session.h"

namespace phalanx {
namespace {

class Dialogue {
 public:
  Dialogue(Device& device, const Clock& clock, const HandParameters& hand, CalibrationConsole& console,
           const CalibrationDialogue& settings)
      : info_(device.info()),
        clock_(clock),
        console_(console),
        measure_for_(settings.measure_for),
        session_(device, hand, settings.measure_for, settings.limits, settings.plan, settings.earlier) {}

  Calibration run() {
    introduce();
    while (!session_.at_end()) ask();
    while (!session_.calibration()) again(session_.view().problems);
    say_table(*session_.calibration());
    return *session_.calibration();
  }

 private:
  void introduce() {
    console_.say(fmt::format("{} {}: {} poses, {:g} s each. Motors stay off.", info_.name, info_.serial,
                             session_.poses().size(), measure_for_));
    console_.say(
        "Press Enter in each pose and hold still. A number is the angle of its joint in degrees, "
        "NAME=DEGREES that of one of several. s: skip, b: back by one, q: end.");
  }

  // Handles one answer to the current pose.
  void ask() {
    const CalibrationSession::View view = session_.view();
    console_.say(fmt::format("[{}/{}] {}: {}", view.pose + 1, view.names.size(), view.names[view.pose],
                             view.instruction));
    for (const CalibrationSession::JointView& joint : view.joints)
      if (joint.target)
        console_.say(fmt::format("  {} {:.1f} deg", joint_name(joint.joint), *joint.target / kDeg));
    const auto answer = console_.answer([&] { return live(); });
    if (!answer || *answer == "q") throw CalibrationError("ended before all poses; nothing was written");
    if (*answer == "b") {
      session_.back();
    } else if (*answer == "s") {
      session_.skip();
      console_.say("skipped");
    } else {
      try {
        enter(*answer, view);
        measure();
      } catch (const CalibrationError& error) {
        console_.say(fmt::format("refused: {}", error.what()));
      }
    }
  }

  // Takes the angles that were typed: "40", or "index_pip_flexion=40 index_dip_flexion=25".
  void enter(const std::string& typed, const CalibrationSession::View& view) {
    std::istringstream words(typed);
    for (std::string word; words >> word;) {
      const std::size_t equals = word.find('=');
      if (equals == std::string::npos && view.joints.size() != 1)
        throw CalibrationError(
            fmt::format("{}: the pose has {} joints; write NAME=DEGREES", word, view.joints.size()));
      const auto joint = equals == std::string::npos ? std::optional(view.joints.front().joint)
                                                     : find_joint(word.substr(0, equals));
      const std::string number = equals == std::string::npos ? word : word.substr(equals + 1);
      char* end = nullptr;
      const double degrees = std::strtod(number.c_str(), &end);
      if (!joint || number.empty() || *end != '\0')
        throw CalibrationError(
            fmt::format("'{}' is no angle; write degrees such as 40, or NAME=DEGREES, or press Enter", word));
      session_.enter(view.pose, *joint, degrees * kDeg);
    }
  }

  // Shows the channels that this pose concerns.
  std::string live() {
    session_.update(clock_.now());
    std::string text = "raw";
    for (const std::int32_t raw : session_.view().raw) text += fmt::format(" {:5d}", raw);
    return text;
  }

  void measure() {
    session_.measure(clock_.now());
    while (session_.measuring()) {
      clock_.sleep_until(clock_.now() + 0.005);
      session_.update(clock_.now());
    }
    console_.say(fmt::format("measured, {} samples", session_.samples()));
  }

  void say_table(const Calibration& calibration) {
    console_.say(fmt::format("{:<32} {:>12} {:>10} {:>6} {:>13}", "channel", "gain [1/count]", "offset",
                             "poses", "residual [deg]"));
    for (const CalibratedChannel& c : calibration.channels) {
      console_.say(fmt::format("{:<32} {:>12.4e} {:>12.4f} {:>6} {:>13.2f}",
                               channel_label(c.channel.kind, c.channel.index), c.channel.gain,
                               c.channel.offset, c.poses.size(), c.residual / kDeg));
    }
  }

  // Lists the problems and measures the poses that are asked for.
  void again(const std::vector<std::string>& problems) {
    for (const std::string& problem : problems) console_.say("refused: " + problem);
    console_.say("Type the numbers of poses to measure again (\"2 5\"), or Enter to give up.");
    const auto answer = console_.answer([] { return std::string(); });
    std::istringstream numbers(answer.value_or(""));
    std::vector<std::size_t> chosen;
    for (std::size_t number = 0; numbers >> number;)
      if (number >= 1 && number <= session_.poses().size()) chosen.push_back(number - 1);
    if (chosen.empty()) {
      throw CalibrationError(
          fmt::format("{} of the channels were refused, nothing was written; the first: {}", problems.size(),
                      problems.front()));
    }
    for (const std::size_t p : chosen) {
      session_.go_to(p);
      while (!session_.at_end()) ask();
    }
  }

  const DeviceInfo& info_;
  const Clock& clock_;
  CalibrationConsole& console_;
  double measure_for_;
  CalibrationSession session_;
};

}  // namespace

Calibration calibrate_by_poses(Device& device, const Clock& clock, const HandParameters& hand,
                               CalibrationConsole& console, const CalibrationDialogue& settings) {
  return Dialogue(device, clock, hand, console, settings).run();
}

}  // namespace phalanx

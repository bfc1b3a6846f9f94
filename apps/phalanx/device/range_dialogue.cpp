// SPDX-License-Identifier: Apache-2.0
#include "device/range_dialogue.h"

#include <fmt/format.h>

#include <optional>
#include <string>
#include <utility>

#include "phalanx/core/constants.h"
#include "phalanx/core/index.h"
#include "phalanx/device/range_session.h"

namespace phalanx {
namespace {

class RangeDialogue {
 public:
  RangeDialogue(Device& device, std::vector<DeviceChannel> channels, const Clock& clock,
                const HandParameters& hand, CalibrationConsole& console)
      : device_(device), clock_(clock), console_(console), session_(device, std::move(channels), hand) {}

  MeasuredRange run() {
    console_.say(fmt::format("{} {}: the torque is zero. The patient moves without help.",
                             device_.info().name, device_.info().serial));
    console_.say("Enter: begin, then accept. r: repeat, s: leave the digit out, b: back by one, q: end.");
    while (!session_.at_end()) ask();
    const auto range = session_.range();
    if (!range) throw CalibrationError("every digit was left out; nothing was written");
    for (const RangeSession::JointView& joint : session_.view().joints) console_.say(line_of(joint));
    return *range;
  }

 private:
  void ask() {
    const RangeSession::View view = session_.view();
    const std::string digit{digit_name(view.digits[view.digit])};
    console_.say(view.measuring
                     ? fmt::format("{}: bend, stretch and spread as far as possible; hold each end for a "
                                   "second. Enter accepts.",
                                   digit)
                     : fmt::format("[{}/{}] {}: Enter begins.", view.digit + 1, view.digits.size(), digit));
    const auto answer = console_.answer([&] { return live(); });
    if (!answer || *answer == "q") throw CalibrationError("ended before all digits; nothing was written");
    try {
      take(*answer, view.measuring);
    } catch (const CalibrationError& error) {
      console_.say(fmt::format("refused: {}", error.what()));
    }
  }

  void take(const std::string& answer, bool measuring) {
    if (answer == "s") return session_.skip();
    if (answer == "b") return session_.back();
    if (answer == "r" || (answer.empty() && !measuring)) return session_.measure(clock_.now());
    if (!answer.empty())
      return console_.say(
          fmt::format("'{}' is not known, and nothing was done: Enter, r, s, b or q", answer));
    const auto joints = session_.view().joints;
    session_.accept();
    for (const RangeSession::JointView& joint : joints) console_.say(line_of(joint));
  }

  std::string live() {
    session_.update(clock_.now());
    std::string text;
    for (const RangeSession::JointView& joint : session_.view().joints)
      if (joint.present) text += fmt::format(" {} {:6.1f}", joint_name(joint.joint), *joint.present / kDeg);
    return text;
  }

  static std::string line_of(const RangeSession::JointView& joint) {
    const std::string profile =
        fmt::format("{:.0f} .. {:.0f}", joint.limit.min / kDeg, joint.limit.max / kDeg);
    if (!joint.reached)
      return fmt::format("{:<24} not measured (profile {} deg)", joint_name(joint.joint), profile);
    return fmt::format("{:<24} {:6.1f} .. {:6.1f} deg (profile {})", joint_name(joint.joint),
                       joint.reached->min / kDeg, joint.reached->max / kDeg, profile);
  }

  Device& device_;
  const Clock& clock_;
  CalibrationConsole& console_;
  RangeSession session_;
};

}  // namespace

MeasuredRange measure_range_of_patient(Device& device, std::vector<DeviceChannel> channels,
                                       const Clock& clock, const HandParameters& hand,
                                       CalibrationConsole& console) {
  return RangeDialogue(device, std::move(channels), clock, hand, console).run();
}

}  // namespace phalanx

// SPDX-License-Identifier: Apache-2.0
#include "calibration_dialogue.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numbers>
#include <sstream>
#include <vector>

#include "phalanx/device/calibration_poses.h"

namespace phalanx {
namespace {

constexpr double kDeg = std::numbers::pi / 180.0;

class Dialogue {
 public:
  Dialogue(Device& device, const Clock& clock, const HandParameters& hand, CalibrationConsole& console,
           const CalibrationDialogue& settings)
      : device_(device),
        clock_(clock),
        hand_(hand),
        console_(console),
        settings_(settings),
        channels_(device.info().channels),
        poses_(calibration_poses(channels_, hand)),
        averages_(poses_.size()) {}

  Calibration run() {
    if (poses_.empty())
      throw CalibrationError(
          "the device has no angle, curl or splay: there is nothing to calibrate by poses");
    introduce();
    for (std::size_t p = 0; p < poses_.size();) p = ask(p);
    while (true) {
      std::vector<std::string> problems;
      Calibration calibration = fit(problems);
      if (problems.empty()) {
        say_table(calibration);
        return calibration;
      }
      again(problems);
    }
  }

 private:
  using Averages = std::vector<RawAverage>;  // of each channel; empty: the pose was skipped

  void introduce() {
    console_.say(fmt::format("{} {}: {} poses, {:g} s each. Motors stay off.", device_.info().name,
                             device_.info().serial, poses_.size(), settings_.measure_for));
    console_.say("Go into the pose, then press Enter and hold still. s: skip, b: back by one, q: end.");
  }

  // @returns the pose that comes next
  std::size_t ask(std::size_t p) {
    console_.say(fmt::format("[{}/{}] {}: {}", p + 1, poses_.size(), poses_[p].name, poses_[p].instruction));
    const auto answer = console_.answer([&] { return live(p); });
    if (!answer || *answer == "q") throw CalibrationError("ended before all poses; nothing was written");
    if (*answer == "b") return p == 0 ? 0 : p - 1;
    if (*answer == "s") {
      averages_[p].clear();
      console_.say("skipped");
    } else {
      measure(p);
    }
    return p + 1;
  }

  // The channels that this pose is about.
  std::string live(std::size_t p) {
    fetch([](const DeviceSample&) {});
    std::string text;
    for (std::size_t c = 0; c < channels_.size(); ++c)
      if (poses_[p].value[c]) text += fmt::format(" {:5d}", newest_.raw[c]);
    return "raw" + text;
  }

  template <class Use>
  void fetch(Use&& use) {
    std::array<DeviceSample, 64> inbox;
    const std::size_t count = device_.receive(clock_.now(), inbox);
    for (std::size_t i = 0; i < count; ++i) use(inbox[i]);
    if (count > 0) newest_ = inbox[count - 1];
    if (const Fault fault = device_.connection_fault(); fault != Fault::kNone)
      throw DeviceError(fmt::format("{} {}", fault_meaning(fault), fault_remedy(fault)));
  }

  void measure(std::size_t p) {
    fetch([](const DeviceSample&) {});  // what came in before Enter is not the pose
    Averages averages(channels_.size());
    const double end = clock_.now() + settings_.measure_for;
    while (clock_.now() < end) {
      clock_.sleep_until(clock_.now() + 0.005);
      fetch([&](const DeviceSample& sample) {
        for (std::size_t c = 0; c < channels_.size(); ++c) averages[c].add(sample.raw[c]);
      });
    }
    if (averages.front().count() == 0)
      throw DeviceError("no sample came while the pose was measured; see `phalanx device test-link`");
    console_.say(fmt::format("measured, {} samples", averages.front().count()));
    averages_[p] = std::move(averages);
  }

  std::vector<PoseReading> readings(std::size_t channel) const {
    std::vector<PoseReading> readings;
    for (std::size_t p = 0; p < poses_.size(); ++p) {
      if (!poses_[p].value[channel] || averages_[p].empty()) continue;
      const RawAverage& average = averages_[p][channel];
      readings.push_back({.pose = poses_[p].name,
                          .value = *poses_[p].value[channel],
                          .raw = average.mean(),
                          .noise = average.noise(),
                          .drift = average.drift()});
    }
    return readings;
  }

  Calibration fit(std::vector<std::string>& problems) const {
    Calibration calibration;
    calibration.device = device_.info().name;
    calibration.serial = device_.info().serial;
    for (std::size_t c = 0; c < channels_.size(); ++c) {
      if (!is_posable(channels_[c].kind)) continue;
      CalibratedChannel done{.channel = channels_[c], .residual = 0.0, .poses = readings(c)};
      try {
        const ChannelFit fit = fit_channel(channels_[c], done.poses, hand_, settings_.limits);
        done.channel.gain = fit.gain;
        done.channel.offset = fit.offset;
        done.residual = fit.worst;
        calibration.channels.push_back(std::move(done));
      } catch (const CalibrationError& error) {
        problems.emplace_back(error.what());
      }
    }
    return calibration;
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

  // Says what is wrong and measures the poses that are asked for.
  void again(const std::vector<std::string>& problems) {
    for (const std::string& problem : problems) console_.say("refused: " + problem);
    console_.say("Type the numbers of poses to measure again (\"2 5\"), or Enter to give up.");
    const auto answer = console_.answer([] { return std::string(); });
    std::istringstream numbers(answer.value_or(""));
    std::vector<std::size_t> chosen;
    for (std::size_t number = 0; numbers >> number;)
      if (number >= 1 && number <= poses_.size()) chosen.push_back(number - 1);
    if (chosen.empty()) {
      throw CalibrationError(
          fmt::format("{} of the channels were refused, nothing was written; the first: {}", problems.size(),
                      problems.front()));
    }
    for (const std::size_t p : chosen) static_cast<void>(ask(p));
  }

  Device& device_;
  const Clock& clock_;
  const HandParameters& hand_;
  CalibrationConsole& console_;
  const CalibrationDialogue& settings_;
  const std::vector<DeviceChannel> channels_;
  const std::vector<CalibrationPose> poses_;
  std::vector<Averages> averages_;  ///< of each pose
  DeviceSample newest_;
};

}  // namespace

Calibration calibrate_by_poses(Device& device, const Clock& clock, const HandParameters& hand,
                               CalibrationConsole& console, const CalibrationDialogue& settings) {
  return Dialogue(device, clock, hand, console, settings).run();
}

}  // namespace phalanx

// SPDX-License-Identifier: Apache-2.0
#include "serve/page_requests.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <stdexcept>

#include "serve/foreign_files.h"
#include "serve/settings_text.h"

namespace phalanx {
namespace {

constexpr int kMostSettings = 64;
constexpr std::size_t kLongestKey = 200;     ///< [bytes]
constexpr std::size_t kLongestValue = 4096;  ///< [bytes]

PageRequest set(const wire::Set& message, StationHost& host, const std::filesystem::path& uploads,
                StationHost::Done done) {
  if (message.setting_size() == 0 || message.setting_size() > kMostSettings)
    throw std::invalid_argument(
        fmt::format("{} settings at once; send 1 to {}", message.setting_size(), kMostSettings));
  Overrides changes;
  PageRequest request{.code = "set", .text = {}, .keys = {}, .dragging = message.dragging()};
  for (const wire::Setting& setting : message.setting()) {
    if (setting.key().empty() || setting.key().size() > kLongestKey)
      throw std::invalid_argument(fmt::format("a setting's key of {} bytes; a scene's key has 1 to {}",
                                              setting.key().size(), kLongestKey));
    if (setting.value().size() > kLongestValue)
      throw std::invalid_argument(fmt::format("{}: a value of {} bytes; send at most {}", setting.key(),
                                              setting.value().size(), kLongestValue));
    if (names_foreign_file(setting.key(), setting.value(), uploads))
      throw std::invalid_argument(
          fmt::format("{} = {}: a page may name what is shipped, or a mesh that it has sent; other files are "
                      "named where the station is started",
                      setting.key(), setting.value()));
    changes.emplace_back(setting.key(), setting.value());
    request.keys += setting.key() + "\n";
  }
  request.text = settings_text(changes);
  host.set(std::move(changes), std::move(done));
  return request;
}

PageRequest load(const std::string& name, StationHost& host, const wire::Welcome& choices,
                 StationHost::Done done) {
  const auto& shipped = choices.scene();
  if (std::none_of(shipped.begin(), shipped.end(), [&](const auto& scene) { return scene.name() == name; }))
    throw std::invalid_argument(
        fmt::format("scene {}: is not among those shipped; choose one of the list", name));
  host.load_scene(name, std::move(done));
  return {.code = "scene", .text = name};
}

PageRequest source(wire::HandSource wanted, StationHost& host, StationHost::Done done) {
  const bool sliders = wanted == wire::HAND_SLIDERS;
  if (!sliders && wanted != wire::HAND_PATIENT)
    throw std::invalid_argument("a page switches between the simulated patient and the sliders only");
  host.set_source(sliders ? HandSource::kSliders : HandSource::kPatient, std::move(done));
  return {.code = "source",
          .text = sliders ? "the sliders move the hand" : "the simulated patient moves the hand"};
}

void pose(const wire::Sliders& sliders, StationHost& host) {
  JointArray angle{};
  if (sliders.angle_size() != kJoints)
    throw std::invalid_argument(
        fmt::format("{} angles; send one a joint, {}", sliders.angle_size(), kJoints));
  for (int j = 0; j < kJoints; ++j)
    angle[static_cast<std::size_t>(j)] = static_cast<double>(sliders.angle(j));
  if (!host.set_sliders(angle))
    throw std::invalid_argument("the sliders do not move the hand now; let them move it first");
}

PageRequest calibrate(const wire::Calibrate& message, StationHost& host, StationHost::Done done) {
  using Step = CalibrationSession::Step;
  struct Known {
    Step step;
    const char* words;
  };
  constexpr std::array<Known, 7> kSteps = {{{Step::kBegin, "begins"},
                                            {Step::kMeasure, "measures the pose"},
                                            {Step::kSkip, "leaves the pose out"},
                                            {Step::kBack, "goes a pose back"},
                                            {Step::kGoTo, "goes to pose"},
                                            {Step::kAbandon, "is given up"},
                                            {Step::kWrite, "is written and used"}}};
  const auto index = static_cast<std::size_t>(message.step());
  if (index >= kSteps.size())
    throw std::invalid_argument(fmt::format("step {} of a calibration: there are 0 to {}; reload the page",
                                            index, kSteps.size() - 1));
  const Known& known = kSteps[index];
  host.calibrate(known.step, message.pose(), std::move(done));
  std::string text = fmt::format("calibration: {}", known.words);
  if (known.step == Step::kGoTo) text += fmt::format(" {}", message.pose() + 1);
  return {.code = "calibrate", .text = std::move(text)};
}

}  // namespace

PageRequest hand_over(const wire::ToHost& message, StationHost& host, const wire::Welcome& choices,
                      const std::filesystem::path& uploads, StationHost::Done done) {
  switch (message.what_case()) {
    case wire::ToHost::kResume:
      if (!host.resume(message.resume().stops()))
        throw std::invalid_argument("another stop or fault has come since; look, then resume again");
      return {.code = "resumed", .text = "resumed", .at_once = true};
    case wire::ToHost::kReset:
      if (!host.reset(message.reset().fault_time()))
        throw std::invalid_argument("another fault has come since; look, then reset again");
      return {.code = "reset", .text = "asked for a reset", .at_once = true};
    case wire::ToHost::kSet:
      return set(message.set(), host, uploads, std::move(done));
    case wire::ToHost::kScene:
      return load(message.scene().name(), host, choices, std::move(done));
    case wire::ToHost::kSource:
      return source(message.source().source(), host, std::move(done));
    case wire::ToHost::kSliders:
      pose(message.sliders(), host);
      return {.code = "sliders", .text = "moves the hand with the sliders", .at_once = true};
    case wire::ToHost::kCalibrate:
      return calibrate(message.calibrate(), host, std::move(done));
    default:
      throw std::invalid_argument("this message asks for nothing that is known; reload the page");
  }
}

}  // namespace phalanx

// SPDX-License-Identifier: Apache-2.0
#include "serve/page_requests.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string_view>

#include "phalanx/core/constants.h"
#include "phalanx/hand/joints.h"
#include "phalanx/scene/scene_keys.h"
#include "record/plain_text.h"
#include "scene/toml/toml_reader.h"
#include "serve/settings_text.h"

namespace phalanx {

// ---- names of files ----

namespace {

namespace fs = std::filesystem;

/// @returns true if the key takes paths only, not names of shipped files
bool is_for_paths(const std::string& pattern) {
  const SceneKey* key = find_scene_key(pattern);
  return key != nullptr ? key->type == KeyType::kFile : pattern.ends_with(".file");
}

/// @returns true if the text is a path that take_upload() could have made: a file in the folder of uploads,
/// with a name of letters, digits, - and _, and one ending
bool is_own_upload(const std::string& text, const fs::path& uploads) {
  const std::string own = (fs::absolute(uploads).lexically_normal() / "").string();
  if (!text.starts_with(own)) return false;
  const std::string_view name = std::string_view(text).substr(own.size());
  const std::size_t dot = name.find('.');
  return dot != std::string_view::npos && dot > 0 &&
         std::all_of(name.begin(), name.begin() + dot, is_plain) &&
         std::all_of(name.begin() + dot + 1, name.end(), is_plain);
}

bool is_foreign(const std::string& text, const std::string& pattern, const fs::path& uploads) {
  if (text.empty() || is_own_upload(text, uploads)) return false;
  const bool path = text.find('/') != std::string::npos || text.find('\0') != std::string::npos ||
                    text.find(".toml") != std::string::npos;
  return path || is_for_paths(pattern);
}

bool holds_foreign(const toml::node& node, const std::string& pattern, const fs::path& uploads) {
  if (const toml::table* table = node.as_table())
    return std::any_of(table->begin(), table->end(), [&](const auto& entry) {
      return holds_foreign(entry.second, pattern + "." + std::string(entry.first.str()), uploads);
    });
  if (const toml::array* array = node.as_array())
    return std::any_of(array->begin(), array->end(), [&](const toml::node& child) {
      return holds_foreign(child, pattern + "[]", uploads);
    });
  const toml::value<std::string>* text = node.as_string();
  return text != nullptr && is_foreign(text->get(), pattern, uploads);
}

}  // namespace

bool names_foreign_file(const std::string& key, const std::string& value, const fs::path& uploads) {
  const std::string pattern = pattern_of(key);
  try {
    const toml::table parsed = parse_bounded_toml("v = " + value, key);
    if (parsed.size() == 1) return holds_foreign(*parsed.get("v"), pattern, uploads);
  } catch (const toml::parse_error&) {  // the value is plain text
  }
  return is_foreign(value, pattern, uploads);
}

// ---- requests ----

namespace {

constexpr int kMostSettings = 64;
constexpr std::size_t kLongestKey = 200;     ///< [bytes]
constexpr std::size_t kLongestValue = 4096;  ///< [bytes]

PageRequest set(const wire::Set& message, Session& session, const std::filesystem::path& uploads,
                Session::Done done) {
  if (message.setting_size() == 0 || message.setting_size() > kMostSettings)
    throw std::invalid_argument(
        fmt::format("{} settings at once; send 1 to {}", message.setting_size(), kMostSettings));
  Overrides changes;
  PageRequest request{.code = "set", .text = {}, .keys = {}, .dragging = message.dragging()};
  for (const wire::Setting& setting : message.setting()) {
    if (setting.key().empty() || setting.key().size() > kLongestKey)
      throw std::invalid_argument(fmt::format("a setting's key has {} bytes; a scene's key has 1 to {}",
                                              setting.key().size(), kLongestKey));
    if (setting.value().size() > kLongestValue)
      throw std::invalid_argument(fmt::format("{}: the value has {} bytes; send at most {}", setting.key(),
                                              setting.value().size(), kLongestValue));
    if (names_foreign_file(setting.key(), setting.value(), uploads))
      throw std::invalid_argument(fmt::format(
          "{} = {}: a page may name shipped files and meshes that pages have sent; name other files "
          "when you start the station",
          setting.key(), setting.value()));
    changes.emplace_back(setting.key(), setting.value());
    request.keys += setting.key() + "\n";
  }
  request.text = settings_text(changes);
  session.set(std::move(changes), std::move(done));
  return request;
}

PageRequest load(const std::string& name, Session& session, const wire::Welcome& choices,
                 Session::Done done) {
  const auto& shipped = choices.scene();
  if (std::none_of(shipped.begin(), shipped.end(), [&](const auto& scene) { return scene.name() == name; }))
    throw std::invalid_argument(
        fmt::format("scene {}: this is no shipped scene; choose one of the list", name));
  session.load_scene(name, std::move(done));
  return {.code = "scene", .text = name};
}

PageRequest source(wire::HandSource wanted, Session& session, Session::Done done) {
  const bool sliders = wanted == wire::HAND_SLIDERS;
  if (!sliders && wanted != wire::HAND_PATIENT)
    throw std::invalid_argument("a page can switch between the simulated patient and the sliders only");
  session.set_source(sliders ? HandSource::kSliders : HandSource::kPatient, std::move(done));
  return {.code = "source",
          .text = sliders ? "the sliders move the hand" : "the simulated patient moves the hand"};
}

void pose(const wire::Sliders& sliders, Session& session) {
  JointArray angle{};
  if (sliders.angle_size() != kJoints)
    throw std::invalid_argument(
        fmt::format("{} angles; send one for each joint, {}", sliders.angle_size(), kJoints));
  for (int j = 0; j < kJoints; ++j)
    angle[static_cast<std::size_t>(j)] = static_cast<double>(sliders.angle(j));
  if (!session.set_sliders(angle))
    throw std::invalid_argument("the sliders do not move the hand now; choose them as its source first");
}

PageRequest open_digit(const wire::OpenDigit& message, Session& session) {
  const int digit = static_cast<int>(std::min(message.digit(), 1000U));
  session.open_digit(digit, static_cast<double>(message.way()), message.running());
  return {.code = "opened",
          .text = fmt::format("asked to open the digit {}, {:.0f} mm", digit_name(digit),
                              1e3 * static_cast<double>(message.way())),
          .done_at_once = true};
}

constexpr std::size_t kLongestLabel = 40;  ///< of a patient [bytes]

/// Makes the step that a page asks for. @throws std::invalid_argument for values out of range
WizardStep wizard_step(const wire::Calibrate& message, WizardStep::Kind kind) {
  if (message.method() < 0 || message.method() > wire::Wizard::GONIOMETER)
    throw std::invalid_argument(fmt::format("method {} of a calibration: there are 0 to {}; reload the page",
                                            static_cast<int>(message.method()),
                                            static_cast<int>(wire::Wizard::GONIOMETER)));
  if (message.patient().size() > kLongestLabel)
    throw std::invalid_argument(
        fmt::format("the patient's label has {} bytes; use at most {}, such as a number",
                    message.patient().size(), kLongestLabel));
  WizardStep step{.kind = kind,
                  .pose = message.pose(),
                  .patient = message.patient(),
                  .joint = static_cast<int>(std::min(message.joint(), 1000U)),
                  .angle = static_cast<double>(message.angle())};
  step.plan.method = static_cast<CalibrationMethod>(message.method());
  for (const std::uint32_t digit : message.digit()) {
    if (digit >= kDigits)
      throw std::invalid_argument(
          fmt::format("digit {}: a hand has 0 to {}; reload the page", digit, kDigits - 1));
    for (int i = 0; i < kJointsPerDigit; ++i)
      step.plan.joints.push_back(joint_index(static_cast<int>(digit), i));
  }
  return step;
}

PageRequest calibrate(const wire::Calibrate& message, Session& session, Session::Done done) {
  using Kind = WizardStep::Kind;
  struct Known {
    Kind kind;
    const char* words;
  };
  constexpr std::array<Known, 11> kSteps = {{{Kind::kBegin, "begins"},
                                             {Kind::kMeasure, "measures the pose"},
                                             {Kind::kSkip, "leaves the pose out"},
                                             {Kind::kBack, "goes a pose back"},
                                             {Kind::kGoTo, "goes to pose"},
                                             {Kind::kAbandon, "is given up"},
                                             {Kind::kWrite, "is written and used"},
                                             {Kind::kBeginRange, "begins to measure the patient's range"},
                                             {Kind::kAccept, "accepts the digit's range"},
                                             {Kind::kEnter, "takes an angle that was entered"},
                                             {Kind::kDropRange, "the patient's range is no longer used"}}};
  const auto index = static_cast<std::size_t>(message.step());
  if (index >= kSteps.size())
    throw std::invalid_argument(fmt::format("step {} of a calibration: there are 0 to {}; reload the page",
                                            index, kSteps.size() - 1));
  const Known& known = kSteps[index];
  session.calibrate(wizard_step(message, known.kind), std::move(done));
  std::string text = fmt::format("calibration: {}", known.words);
  if (known.kind == Kind::kBegin)
    text += fmt::format(" ({})", calibration_method_name(static_cast<CalibrationMethod>(message.method())));
  if (known.kind == Kind::kGoTo) text += fmt::format(" {}", message.pose() + 1);
  if (known.kind == Kind::kEnter)
    text += fmt::format(", {:.1f} deg for pose {}", static_cast<double>(message.angle()) / kDeg,
                        message.pose() + 1);
  return {.code = "calibrate", .text = std::move(text)};
}

}  // namespace

PageRequest apply_request(const wire::ToHost& message, Session& session, const wire::Welcome& choices,
                          const std::filesystem::path& uploads, Session::Done done) {
  switch (message.what_case()) {
    case wire::ToHost::kResume:
      if (!session.resume(message.resume().stops()))
        throw std::invalid_argument("another stop or fault has come since; look, then resume again");
      return {.code = "resumed", .text = "resumed", .done_at_once = true};
    case wire::ToHost::kReset:
      if (!session.reset(message.reset().fault_time()))
        throw std::invalid_argument("another fault has come since; look, then reset again");
      return {.code = "reset", .text = "asked for a reset", .done_at_once = true};
    case wire::ToHost::kOpen:
      return open_digit(message.open(), session);
    case wire::ToHost::kSet:
      return set(message.set(), session, uploads, std::move(done));
    case wire::ToHost::kScene:
      return load(message.scene().name(), session, choices, std::move(done));
    case wire::ToHost::kSource:
      return source(message.source().source(), session, std::move(done));
    case wire::ToHost::kSliders:
      pose(message.sliders(), session);
      return {.code = "sliders", .text = "moves the hand with the sliders", .done_at_once = true};
    case wire::ToHost::kCalibrate:
      return calibrate(message.calibrate(), session, std::move(done));
    default:
      throw std::invalid_argument("the station does not know this message; reload the page");
  }
}

}  // namespace phalanx

// SPDX-License-Identifier: Apache-2.0
#include "phalanx/scene/calibration_file.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>
#include <string_view>

#include "phalanx/core/nearest_name.h"
#include "phalanx/scene/scene_file.h"
#include "scene/text_file.h"
#include "scene/toml/toml_reader.h"

namespace phalanx {
namespace {

constexpr NumberRange kRaw = {.min = -2147483648.0, .max = 2147483647.0};
constexpr NumberRange kValue = {.min = -100.0, .max = 100.0};
constexpr NumberRange kOffset = {.min = -1e6, .max = 1e6};
constexpr NumberRange kGain = {.min = -100.0, .max = 100.0};
constexpr NumberRange kResidual = {.min = 0.0, .max = 10.0};
constexpr NumberRange kPoseResidual = {.min = -10.0, .max = 10.0};

constexpr const char* kWriteDate = "write UTC as \"2026-05-04T09:30:00Z\"";

const std::vector<std::string>& kind_names() {
  static const std::vector<std::string> names = {"angle", "curl", "splay"};
  return names;
}

std::string_view kind_name(ChannelKind kind) {
  if (kind == ChannelKind::kAngle) return "angle";
  return kind == ChannelKind::kCurl ? "curl" : "splay";
}

// ---- writing ----

std::string place_of(const DeviceChannel& channel) {
  if (!is_posable(channel.kind) || channel.index < 0 ||
      channel.index >= (channel.kind == ChannelKind::kAngle ? kJoints : kDigits)) {
    throw std::invalid_argument(
        fmt::format("{} cannot be calibrated by poses", channel_label(channel.kind, channel.index)));
  }
  return channel.kind == ChannelKind::kAngle ? fmt::format("joint = \"{}\"", joint_name(channel.index))
                                             : fmt::format("digit = \"{}\"", digit_name(channel.index));
}

// ---- reading ----

ChannelKind read_kind(TomlTable& table) {
  const std::string text = table.text("kind");
  if (text == "angle") return ChannelKind::kAngle;
  if (text == "curl") return ChannelKind::kCurl;
  if (text != "splay")
    table.fail("kind", fmt::format("did you mean \"{}\"?", nearest_name(text, kind_names())));
  return ChannelKind::kSplay;
}

template <class Name>
int read_name(TomlTable& table, std::string_view key, int count, Name name_of) {
  const std::string text = table.text(key);
  std::vector<std::string> known;
  for (int i = 0; i < count; ++i) {
    known.emplace_back(name_of(i));
    if (known.back() == text) return i;
  }
  table.fail(key, fmt::format("did you mean \"{}\"?", nearest_name(text, known)));
}

CalibrationMethod read_method(TomlTable& table) {
  const std::string text = table.text("method");
  static const std::vector<std::string> names = {"jig", "stops", "goniometer"};
  for (const CalibrationMethod method :
       {CalibrationMethod::kJig, CalibrationMethod::kStops, CalibrationMethod::kGoniometer})
    if (text == calibration_method_name(method)) return method;
  table.fail("method", fmt::format("did you mean \"{}\"?", nearest_name(text, names)));
}

double read_gain(TomlTable& table) {
  const double gain = table.number("gain", kGain);
  if (gain == 0.0) table.fail("gain", "gives every count the same value; calibrate again");
  return gain;
}

PoseReading read_pose(TomlTable table) {
  PoseReading pose;
  pose.pose = table.text("name");
  pose.raw = table.number("raw", kRaw);
  pose.value = table.number("value", kValue);
  pose.residual = table.number("residual_rad", kPoseResidual);
  table.finish();
  return pose;
}

CalibratedChannel read_channel(TomlTable table) {
  CalibratedChannel read;
  DeviceChannel& channel = read.channel;
  channel.kind = read_kind(table);
  channel.index = channel.kind == ChannelKind::kAngle ? read_name(table, "joint", kJoints, joint_name)
                                                      : read_name(table, "digit", kDigits, digit_name);
  channel.gain = read_gain(table);
  channel.offset = table.number("offset", kOffset);
  read.residual = table.number("residual_rad", kResidual);
  read.method = read_method(table);
  if (table.has("date")) read.date = table.text("date");
  if (!read.date.empty() && !is_calibration_date(read.date)) table.fail("date", kWriteDate);
  for (TomlTable& pose : table.tables("poses", -1)) read.poses.push_back(read_pose(std::move(pose)));
  table.finish();
  return read;
}

void read_head(TomlTable& table, Calibration& calibration) {
  if (table.number("format", {}) != kCalibrationFormat) {
    table.fail("format", fmt::format("this program reads format {}; use the program that wrote the file, or "
                                     "calibrate the device again",
                                     kCalibrationFormat));
  }
  calibration.device = table.text("device");
  calibration.serial = table.text("serial");
  calibration.date = table.text("date");
  if (!is_calibration_date(calibration.date)) table.fail("date", kWriteDate);
  calibration.phalanx = table.text("phalanx");
}

bool has_channel(const Calibration& calibration, const DeviceChannel& channel) {
  for (const CalibratedChannel& c : calibration.channels)
    if (c.channel.kind == channel.kind && c.channel.index == channel.index) return true;
  return false;
}

}  // namespace

bool is_calibration_date(std::string_view text) {
  constexpr std::string_view kShape = "0000-00-00T00:00:00Z";
  if (text.size() != kShape.size()) return false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool digit = text[i] >= '0' && text[i] <= '9';
    if (kShape[i] == '0' ? !digit : text[i] != kShape[i]) return false;
  }
  return true;
}

std::string calibration_text(const Calibration& calibration) {
  std::string text = fmt::format(
      "# Written by `phalanx device calibrate`: value = gain raw + offset, angles in rad.\n"
      "format = {}\ndevice = {}\nserial = {}\ndate = {}\nphalanx = {}\n",
      kCalibrationFormat, toml_string(calibration.device), toml_string(calibration.serial),
      toml_string(calibration.date), toml_string(calibration.phalanx));
  for (const CalibratedChannel& c : calibration.channels) {
    text += fmt::format(
        "\n[[channel]]\nkind = \"{}\"\n{}\ngain = {}\noffset = {}\nresidual_rad = {}\nmethod = \"{}\"\n",
        kind_name(c.channel.kind), place_of(c.channel), c.channel.gain, c.channel.offset, c.residual,
        calibration_method_name(c.method));
    if (!c.date.empty()) text += fmt::format("date = {}\n", toml_string(c.date));
    text += "poses = [\n";
    for (const PoseReading& pose : c.poses)
      text += fmt::format("  {{ name = {}, raw = {}, value = {}, residual_rad = {} }},\n",
                          toml_string(pose.pose), pose.raw, pose.value, pose.residual);
    text += "]\n";
  }
  return text;
}

Calibration parse_calibration(const std::string& text, const std::string& origin) {
  const toml::table root = parse_toml(text, origin);
  TomlTable table(root, origin, "");
  Calibration calibration;
  read_head(table, calibration);
  for (TomlTable& entry : table.tables("channel", -1)) {
    CalibratedChannel channel = read_channel(entry);
    if (has_channel(calibration, channel.channel)) {
      table.fail("channel", fmt::format("{} appears twice; calibrate again",
                                        channel_label(channel.channel.kind, channel.channel.index)));
    }
    calibration.channels.push_back(std::move(channel));
  }
  table.finish();
  if (calibration.channels.empty() || calibration.channels.size() > kMaxChannels) {
    table.fail("channel", fmt::format("{} channels; a device has 1 .. {}; calibrate again",
                                      calibration.channels.size(), kMaxChannels));
  }
  return calibration;
}

Calibration load_calibration(const std::filesystem::path& file) {
  return parse_calibration(read_text_file(file.string(), "calibration"), file.string());
}

}  // namespace phalanx

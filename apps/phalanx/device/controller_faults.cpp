// SPDX-License-Identifier: Apache-2.0
#include "device/controller_faults.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <utility>

namespace phalanx {
namespace {

using Kind = ControllerFaultKind;

enum class Takes { kNothing, kProbability, kSeconds, kFactor, kChannel, kMotor };

struct Entry {
  Kind kind;
  std::string_view name;
  Takes takes;
  std::string_view meaning;
};

constexpr double kNoiseCounts = 20.0;
constexpr double kLongestDelay = 1.0;  ///< [s]

constexpr std::array kEntries{
    Entry{Kind::kDrop, "drop", Takes::kProbability, "a packet is lost with this probability"},
    Entry{Kind::kDuplicate, "duplicate", Takes::kProbability, "a packet comes twice with this probability"},
    Entry{Kind::kReorder, "reorder", Takes::kProbability,
          "a packet is held back behind the next with this probability"},
    Entry{Kind::kDelay, "delay", Takes::kSeconds, "each packet comes so much later"},
    Entry{Kind::kJitter, "jitter", Takes::kSeconds, "each packet comes later by a random time up to this"},
    Entry{Kind::kCorrupt, "corrupt", Takes::kProbability,
          "a random bit of a packet flips with this probability"},
    Entry{Kind::kNoiseBytes, "noise-bytes", Takes::kNothing,
          "a packet of random bytes each tick, beside the others"},
    Entry{Kind::kSilence, "silence", Takes::kNothing, "nothing is sent, nothing is heard"},
    Entry{Kind::kRestart, "restart", Takes::kNothing, "the controller restarts once, at START"},
    Entry{Kind::kStuck, "stuck", Takes::kChannel, "the sensor stands still"},
    Entry{Kind::kOpen, "open", Takes::kChannel, "the sensor's wire is open: 1000 counts above its range"},
    Entry{Kind::kShort, "short", Takes::kChannel, "the sensor is shorted: 1000 counts below its range"},
    Entry{Kind::kJump, "jump", Takes::kChannel, "the sensor reads 50 degrees more"},
    Entry{Kind::kNoise, "noise", Takes::kChannel, "the sensor gets normal noise of 20 counts rms"},
    Entry{Kind::kDeadMotor, "dead-motor", Takes::kMotor, "the motor does nothing"},
    Entry{Kind::kEmergencyStop, "estop", Takes::kNothing, "the emergency stop is pressed"},
    Entry{Kind::kDrive, "drive", Takes::kNothing, "the device's electronics report a fault"},
    Entry{Kind::kClockBackwards, "clock-backwards", Takes::kNothing, "the controller's clock runs backwards"},
    Entry{Kind::kSlow, "slow", Takes::kFactor,
          "the controller makes so many times fewer ticks than it promises"},
    Entry{Kind::kSlowClock, "slow-clock", Takes::kFactor, "likewise, and its clock is as slow"},
};

std::string_view value_text(Takes takes) {
  switch (takes) {
    case Takes::kProbability:
      return "=PROBABILITY";
    case Takes::kSeconds:
      return "=SECONDS";
    case Takes::kFactor:
      return "=FACTOR";
    case Takes::kChannel:
      return "=CHANNEL";
    case Takes::kMotor:
      return "=MOTOR";
    case Takes::kNothing:
      break;
  }
  return "";
}

const Entry& entry(Kind kind) {
  return *std::find_if(kEntries.begin(), kEntries.end(), [kind](const Entry& e) { return e.kind == kind; });
}

[[noreturn]] void refuse(const std::string& text, const std::string& what) {
  throw std::invalid_argument(fmt::format("--fault {}: {}", text, what));
}

const Entry& entry_named(const std::string& text, std::string_view name) {
  const auto* const found =
      std::find_if(kEntries.begin(), kEntries.end(), [name](const Entry& e) { return e.name == name; });
  if (found != kEntries.end()) return *found;
  std::string names;
  for (const Entry& e : kEntries) names += fmt::format("{}{}", names.empty() ? "" : ", ", e.name);
  refuse(text, fmt::format("no such fault; there are {}; `--fault list` explains them", names));
}

/// Parses a whole text as a finite number.
std::optional<double> number(std::string_view text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

double value_of(const std::string& text, const Entry& entry, std::optional<std::string_view> given) {
  if (entry.takes == Takes::kNothing) {
    if (given)
      refuse(text, fmt::format("'{}' takes no value; write {}[@START[+LENGTH]]", entry.name, entry.name));
    return 0.0;
  }
  const std::optional<double> value = given ? number(*given) : std::nullopt;
  const auto is = [&](bool in_range, std::string_view wanted) {
    if (!value || !in_range)
      refuse(text, fmt::format("'{}' needs {}; write {}{}[@START[+LENGTH]]", entry.name, wanted, entry.name,
                               value_text(entry.takes)));
    return *value;
  };
  const double v = value.value_or(0.0);
  switch (entry.takes) {
    case Takes::kProbability:
      return is(v >= 0.0 && v <= 1.0, "a probability from 0 to 1");
    case Takes::kSeconds:
      return is(v >= 0.0 && v <= kLongestDelay, "seconds from 0 to 1");
    case Takes::kFactor:
      return is(v >= 1.0 && v <= 255.0 && v == std::floor(v), "a whole number from 1 to 255");
    case Takes::kChannel:
    case Takes::kMotor:
    case Takes::kNothing:
      break;
  }
  return is(v >= 0.0 && v <= 255.0 && v == std::floor(v), "a whole number from 0");
}

/// Parses "START[+LENGTH]".
void read_times(const std::string& text, std::string_view times, ControllerFault& fault) {
  const std::size_t plus = times.find('+');
  const std::optional<double> start = number(times.substr(0, plus));
  const std::optional<double> length = plus == std::string_view::npos
                                           ? std::optional(std::numeric_limits<double>::infinity())
                                           : number(times.substr(plus + 1));
  if (!start || *start < 0.0 || !length || !(*length > 0.0))
    refuse(text, "after @ stand the start and, behind a +, the length, in seconds: @2.5+0.1");
  fault.start = *start;
  fault.end = *start + *length;
}

void check_index(const ControllerFault& fault, std::size_t channels, std::size_t motors) {
  const Takes takes = entry(fault.kind).takes;
  if (takes != Takes::kChannel && takes != Takes::kMotor) return;
  const std::size_t there = takes == Takes::kChannel ? channels : motors;
  const std::string_view what = takes == Takes::kChannel ? "channels" : "motors";
  if (there == 0) refuse(fault.text, fmt::format("the device has no {}", what));
  if (fault.value >= static_cast<double>(there))
    refuse(fault.text, fmt::format("the device's {} are 0 to {}", what, there - 1));
}

void apply(const ControllerFault& fault, SimulatedBreakage& breakage) noexcept {
  const int index = static_cast<int>(fault.value);
  switch (fault.kind) {
    case Kind::kStuck:
      breakage.stuck_channel = index;
      break;
    case Kind::kOpen:
      breakage.open_channel = index;
      break;
    case Kind::kShort:
      breakage.shorted_channel = index;
      break;
    case Kind::kJump:
      breakage.jump_channel = index;
      break;
    case Kind::kNoise:
      breakage.noise_channel = index;
      breakage.noise_counts = kNoiseCounts;
      break;
    case Kind::kDeadMotor:
      breakage.dead_motor = index;
      break;
    case Kind::kEmergencyStop:
      breakage.estop = true;
      break;
    case Kind::kDrive:
      breakage.drive_fault = true;
      break;
    case Kind::kClockBackwards:
      breakage.clock_backwards = true;
      break;
    default:  // faults of packets
      break;
  }
}

void apply(const ControllerFault& fault, PacketFaults& packets) noexcept {
  switch (fault.kind) {
    case Kind::kDrop:
      packets.drop = fault.value;
      break;
    case Kind::kDuplicate:
      packets.duplicate = fault.value;
      break;
    case Kind::kReorder:
      packets.reorder = fault.value;
      break;
    case Kind::kDelay:
      packets.delay = fault.value;
      break;
    case Kind::kJitter:
      packets.jitter = fault.value;
      break;
    case Kind::kCorrupt:
      packets.corrupt = fault.value;
      break;
    case Kind::kNoiseBytes:
      packets.noise_bytes = true;
      break;
    case Kind::kSilence:
      packets.silence = true;
      break;
    default:  // faults of the controller
      break;
  }
}

bool in_force(const ControllerFault& fault, double t) noexcept { return t >= fault.start && t < fault.end; }

}  // namespace

ControllerFault parse_controller_fault(const std::string& text) {
  const std::string_view whole = text;
  const std::size_t at = whole.find('@');
  const std::string_view what = whole.substr(0, at);
  const std::size_t equals = what.find('=');
  const Entry& found = entry_named(text, what.substr(0, equals));
  ControllerFault fault{.kind = found.kind, .text = text};
  fault.value = value_of(
      text, found, equals == std::string_view::npos ? std::nullopt : std::optional(what.substr(equals + 1)));
  if (at != std::string_view::npos) read_times(text, whole.substr(at + 1), fault);
  return fault;
}

std::string controller_fault_list() {
  std::string out;
  for (const Entry& e : kEntries)
    out += fmt::format("{:<24}  {}\n", fmt::format("{}{}", e.name, value_text(e.takes)), e.meaning);
  return out + "Each may end in @START or @START+LENGTH [s]; without them it is always in force.\n";
}

ControllerFaultPlan::ControllerFaultPlan(std::vector<ControllerFault> faults, std::size_t channels,
                                         std::size_t motors)
    : faults_(std::move(faults)) {
  for (const ControllerFault& fault : faults_) check_index(fault, channels, motors);
}

PacketFaults ControllerFaultPlan::packets(double t) const noexcept {
  PacketFaults packets;
  for (const ControllerFault& fault : faults_)
    if (in_force(fault, t)) apply(fault, packets);
  return packets;
}

SimulatedBreakage ControllerFaultPlan::breakage(double t) const noexcept {
  SimulatedBreakage breakage;
  for (const ControllerFault& fault : faults_)
    if (in_force(fault, t)) apply(fault, breakage);
  return breakage;
}

ControllerSlowness ControllerFaultPlan::slowness(double t) const noexcept {
  ControllerSlowness slowness;
  for (const ControllerFault& fault : faults_) {
    if (!in_force(fault, t) || (fault.kind != Kind::kSlow && fault.kind != Kind::kSlowClock)) continue;
    slowness = {.every = static_cast<int>(fault.value), .clock = fault.kind == Kind::kSlowClock};
  }
  return slowness;
}

bool ControllerFaultPlan::restarts(double t) noexcept {
  bool due = false;
  for (const ControllerFault& fault : faults_)
    due = due || (fault.kind == Kind::kRestart && fault.start > asked_ && fault.start <= t);
  asked_ = t;
  return due;
}

}  // namespace phalanx

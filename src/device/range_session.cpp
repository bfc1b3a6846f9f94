// SPDX-License-Identifier: Apache-2.0
#include "phalanx/device/range_session.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "phalanx/core/constants.h"
#include "phalanx/core/index.h"
#include "phalanx/device/channel_map.h"

namespace phalanx {
namespace {

/// @returns the joints that a channel sets.
std::vector<int> joints_of(const DeviceChannel& channel) {
  if (!is_posable(channel.kind)) return {};
  if (channel.kind == ChannelKind::kCurl)
    return {joint_index(channel.index, 0), joint_index(channel.index, 2), joint_index(channel.index, 3)};
  return {leading_joint(channel)};
}

}  // namespace

RangeSession::RangeSession(Device& device, std::vector<DeviceChannel> channels, const HandParameters& hand)
    : device_(device), channels_(std::move(channels)), hand_(hand), angle_(hand.open_angle) {
  std::vector<int> joints;
  for (const DeviceChannel& channel : channels_)
    for (const int joint : joints_of(channel)) joints.push_back(joint);
  if (joints.empty())
    throw CalibrationError("the device has no angle, curl or splay: there is no range to measure");
  std::sort(joints.begin(), joints.end());
  for (const int joint : joints) {
    joints_.push_back({.joint = joint});
    if (digits_.empty() || digits_.back() != digit_of_joint(joint)) digits_.push_back(digit_of_joint(joint));
  }
  done_.assign(digits_.size(), false);
}

bool RangeSession::of_digit(const Joint& joint, std::size_t digit) const {
  return digit < digits_.size() && digit_of_joint(joint.joint) == digits_[digit];
}

// ---- samples of the device ----

void RangeSession::take(const DeviceSample& sample, double now) {
  for (std::size_t c = 0; c < channels_.size(); ++c)
    put_angles(channels_[c], channels_[c].gain * sample.raw[c] + channels_[c].offset, hand_.min_angle,
               hand_.max_angle, angle_);
  for (Joint& joint : joints_) {
    joint.present = angle_[idx(joint.joint)];
    joint.still.add(*joint.present, now);
    if (!measuring_ || !of_digit(joint, digit_) || joint.still.held_for() < kHold) continue;
    const double mean = joint.still.mean();
    if (!joint.reached) joint.reached = AngleRange{.min = mean, .max = mean};
    joint.reached->min = std::min(joint.reached->min, mean);
    joint.reached->max = std::max(joint.reached->max, mean);
  }
}

void RangeSession::update(double now) {
  std::array<DeviceSample, 64> inbox;
  const std::size_t count = device_.receive(now, inbox);
  if (const Fault fault = device_.connection_fault(); fault != Fault::kNone) {
    measuring_ = false;
    throw DeviceError(fmt::format("{} {}", fault_meaning(fault), fault_remedy(fault)));
  }
  for (std::size_t i = 0; i < count; ++i) take(inbox[i], now);
}

// ---- digits ----

void RangeSession::measure(double now) {
  if (at_end()) return;
  update(now);
  for (Joint& joint : joints_) {
    if (!of_digit(joint, digit_)) continue;
    joint.reached.reset();
    joint.still = Stillness(kBand);
  }
  done_[digit_] = false;
  measuring_ = true;
}

void RangeSession::accept() {
  if (!measuring_)
    throw CalibrationError(
        "no range is being measured; begin with Measure, then let the patient move the digit");
  for (const Joint& joint : joints_)
    if (of_digit(joint, digit_) && !joint.reached)
      throw CalibrationError(fmt::format(
          "{}: no position was held still for {:.1f} s within {:.0f} deg; let the patient hold the end of "
          "the motion for a moment, or support the hand",
          joint_name(joint.joint), kHold, kBand / kDeg));
  done_[digit_] = true;
  leave_digit();
}

void RangeSession::skip() {
  if (at_end()) return;
  done_[digit_] = false;
  for (Joint& joint : joints_)
    if (of_digit(joint, digit_)) joint.reached.reset();
  leave_digit();
}

void RangeSession::leave_digit() {
  measuring_ = false;
  digit_ = walked_ ? digits_.size() : digit_ + 1;
  walked_ = walked_ || at_end();
}

void RangeSession::back() {
  measuring_ = false;
  if (digit_ > 0) --digit_;
}

void RangeSession::go_to(std::size_t digit) {
  if (digit >= digits_.size())
    throw CalibrationError(
        fmt::format("digit {}: the device measures only {}; choose one of them", digit + 1, digits_.size()));
  measuring_ = false;
  digit_ = digit;
}

bool RangeSession::is_accepted(const Joint& joint) const {
  for (std::size_t d = 0; d < digits_.size(); ++d)
    if (done_[d] && of_digit(joint, d)) return true;
  return false;
}

RangeSession::View RangeSession::view() const {
  View view;
  view.digits = digits_;
  view.done = done_;
  view.digit = digit_;
  view.measuring = measuring_;
  view.hand = angle_;
  double still = std::numeric_limits<double>::infinity();
  for (const Joint& joint : joints_) {
    if (!(at_end() ? is_accepted(joint) : of_digit(joint, digit_))) continue;
    const auto j = idx(joint.joint);
    view.joints.push_back({.joint = joint.joint,
                           .present = joint.present,
                           .reached = joint.reached,
                           .limit = {.min = hand_.min_angle[j], .max = hand_.max_angle[j]}});
    still = std::min(still, joint.still.held_for());
  }
  view.still_for = view.joints.empty() ? 0.0 : still;
  view.finished = range().has_value();
  return view;
}

std::optional<MeasuredRange> RangeSession::range() const {
  if (!at_end() || std::find(done_.begin(), done_.end(), true) == done_.end()) return std::nullopt;
  MeasuredRange range;
  range.device = device_.info().name;
  range.serial = device_.info().serial;
  for (const Joint& joint : joints_)
    if (is_accepted(joint)) range.joint[idx(joint.joint)] = joint.reached;
  return range;
}

}  // namespace phalanx

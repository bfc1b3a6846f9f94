// SPDX-License-Identifier: Apache-2.0
#include "phalanx/device/calibration_session.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "phalanx/core/constants.h"
#include "phalanx/device/channel_map.h"
#include "phalanx/hand/anthropometry.h"

namespace phalanx {
namespace {

/// Largest motion of a joint that is still [rad].
constexpr double kStillAngle = 3.0 * kDeg;
/// Part of a sensor's range of counts within which it is still, if the maker's gain does not tell what a count is [-].
constexpr double kStillPart = 0.02;
/// Fewer counts than this for kStillAngle: the maker's gain is not believable [counts].
constexpr double kLeastCounts = 1.0;
/// Least difference of the angles that a goniometer measures: it errs by some degrees [rad].
constexpr double kGoniometerApart = 20.0 * kDeg;

std::string result_line(const CalibratedChannel& done) {
  const std::string label = channel_label(done.channel.kind, done.channel.index);
  if (!done.date.empty())
    return fmt::format("{}: kept from {} ({})", label, done.date, calibration_method_name(done.method));
  return fmt::format("{}: {:.4e} a count, offset {:.4f}, from {} poses, at most {:.2f} deg off", label,
                     done.channel.gain, done.channel.offset, done.poses.size(), done.residual / kDeg);
}

std::string no_poses(const CalibrationPlan& plan) {
  if (plan.method == CalibrationMethod::kStops)
    return "none of the chosen joints has stops: state stop_min_deg and stop_max_deg of the joints in the "
           "device file, "
           "or calibrate with a jig or a goniometer";
  if (!plan.joints.empty()) return "the device measures none of the chosen joints; choose others, or all";
  return "the device has no angle, curl or splay: there is nothing to calibrate by poses";
}

CalibrationLimits limits_of(CalibrationLimits limits, CalibrationMethod method) {
  if (method == CalibrationMethod::kGoniometer) limits.apart = std::max(limits.apart, kGoniometerApart);
  return limits;
}

/// @returns the band within which counts of this channel are still.
double still_band(const DeviceChannel& channel, const HandParameters& hand) {
  const double counts =
      kStillAngle / std::abs(channel.gain * radians_per_unit(channel.kind, channel.index, hand));
  const double part =
      kStillPart * (static_cast<double>(channel.raw_max) - static_cast<double>(channel.raw_min));
  return counts >= kLeastCounts ? std::min(counts, part) : part;
}

}  // namespace

CalibrationSession::CalibrationSession(Device& device, const HandParameters& hand, double measure_for,
                                       const CalibrationLimits& limits, const CalibrationPlan& plan,
                                       std::optional<Calibration> earlier)
    : device_(device),
      hand_(hand),
      measure_for_(measure_for),
      limits_(limits_of(limits, plan.method)),
      method_(plan.method),
      earlier_(std::move(earlier)),
      channels_(device.info().channels),
      estimated_(channels_),
      poses_(calibration_poses(channels_, hand, plan)),
      averages_(poses_.size()) {
  if (poses_.empty()) throw CalibrationError(no_poses(plan));
  if (!(measure_for > 0.0) || !std::isfinite(measure_for))
    throw std::invalid_argument(
        fmt::format("calibration: a pose measured for {} s; it must be a number above 0", measure_for));
  if (earlier_) static_cast<void>(apply_calibration(*earlier_, device.info()));
  for (const DeviceChannel& channel : channels_) still_.emplace_back(still_band(channel, hand_));
  estimate();
}

// ---- samples of the device ----

void CalibrationSession::fetch(double now) {
  now_ = now;
  std::array<DeviceSample, 64> inbox;
  const std::size_t count = device_.receive(now, inbox);
  if (count > 0) newest_ = inbox[count - 1];
  if (const Fault fault = device_.connection_fault(); fault != Fault::kNone) {
    measuring_since_.reset();
    throw DeviceError(fmt::format("{} {}", fault_meaning(fault), fault_remedy(fault)));
  }
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t c = 0; c < channels_.size(); ++c) {
      still_[c].add(static_cast<double>(inbox[i].raw[c]), now);
      if (measuring()) measuring_[c].add(inbox[i].raw[c]);
    }
  }
}

void CalibrationSession::update(double now) {
  fetch(now);
  if (measuring() && now - *measuring_since_ >= measure_for_) end_measurement();
}

void CalibrationSession::end_measurement() {
  measuring_since_.reset();
  if (measuring_.front().count() == 0)
    throw DeviceError("no sample came while the pose was measured; see `phalanx device test-link`");
  check_still();
  samples_ = measuring_.front().count();
  averages_[pose_] = std::move(measuring_);
  estimate();
  leave_pose();
}

/// Refuses a measurement during which the counts moved by more than they may when they are still.
void CalibrationSession::check_still() const {
  for (std::size_t c = 0; c < channels_.size(); ++c) {
    if (!concerned(c) || std::abs(measuring_[c].drift()) <= still_band(channels_[c], hand_)) continue;
    throw CalibrationError(fmt::format(
        "{}: {} moved by {:.0f} counts while it was measured, at most {:.0f} are allowed; hold still and "
        "measure this pose again",
        poses_[pose_].name, channel_label(channels_[c].kind, channels_[c].index),
        std::abs(measuring_[c].drift()), still_band(channels_[c], hand_)));
  }
}

// ---- poses ----

void CalibrationSession::measure(double now) {
  if (at_end() || measuring()) return;
  for (std::size_t c = 0; c < channels_.size(); ++c)
    if (concerned(c) && !poses_[pose_].value[c])
      throw CalibrationError(
          fmt::format("{}: the angle of {} is not entered; measure it with the goniometer and enter it",
                      poses_[pose_].name, joint_name(leading_joint(channels_[c]))));
  fetch(now);  // drops earlier samples, which do not show the pose
  measuring_.assign(channels_.size(), RawAverage{});
  measuring_since_ = now;
}

void CalibrationSession::enter(std::size_t pose, int joint, double angle) {
  if (pose >= poses_.size())
    throw CalibrationError(
        fmt::format("pose {}: there are only {}; choose one of them", pose + 1, poses_.size()));
  for (std::size_t c = 0; c < channels_.size(); ++c) {
    if (!poses_[pose].concerns[c] || leading_joint(channels_[c]) != joint) continue;
    const PlausibleRange range = plausible_angle(joint);
    if (!(angle >= range.min && angle <= range.max))
      throw CalibrationError(fmt::format(
          "{}: {} at {:.1f} deg is beyond what a hand can do, {:.0f} .. {:.0f}; check the "
          "goniometer and its sign: bending is positive",
          poses_[pose].name, joint_name(joint), angle / kDeg, range.min / kDeg, range.max / kDeg));
    poses_[pose].value[c] = value_of_angle(channels_[c], angle, hand_);
    calibration_.reset();
    estimate();
    if (at_end()) fit();
    return;
  }
  const bool known = joint >= 0 && joint < kJoints;
  throw CalibrationError(fmt::format("{}: it does not measure {}; enter the angle of a joint that is shown",
                                     poses_[pose].name, known ? joint_name(joint) : "this joint"));
}

void CalibrationSession::skip() {
  if (at_end()) return;
  averages_[pose_].clear();
  estimate();
  leave_pose();
}

void CalibrationSession::back() { ask_for(pose_ > 0 ? pose_ - 1 : 0); }

void CalibrationSession::go_to(std::size_t pose) {
  if (pose >= poses_.size())
    throw CalibrationError(
        fmt::format("pose {}: there are only {}; choose one of them", pose + 1, poses_.size()));
  ask_for(pose);
}

/// Goes to a pose. The problems of the last fit stay readable; its calibration no longer covers all poses.
void CalibrationSession::ask_for(std::size_t pose) {
  measuring_since_.reset();
  calibration_.reset();
  pose_ = pose;
}

void CalibrationSession::leave_pose() {
  ask_for(walked_ ? poses_.size() : pose_ + 1);
  if (at_end()) fit();
}

// ---- fit ----

std::vector<PoseReading> CalibrationSession::readings(std::size_t channel) const {
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

const CalibratedChannel* CalibrationSession::earlier(std::size_t channel) const {
  if (!earlier_) return nullptr;
  for (const CalibratedChannel& kept : earlier_->channels)
    if (kept.channel.kind == channels_[channel].kind && kept.channel.index == channels_[channel].index)
      return &kept;
  return nullptr;
}

/// Fits one channel, or keeps the earlier one if no pose has measured it.
/// @throws CalibrationError if it is refused
void CalibrationSession::fit_channel_of(std::size_t channel, Calibration& calibration) {
  CalibratedChannel done{
      .channel = channels_[channel], .residual = 0.0, .poses = readings(channel), .method = method_};
  if (const CalibratedChannel* kept = earlier(channel); kept != nullptr && done.poses.empty()) {
    done = *kept;
    if (done.date.empty()) done.date = earlier_->date;
    return calibration.channels.push_back(std::move(done));
  }
  const ChannelFit fit = fit_channel(channels_[channel], done.poses, hand_, limits_);
  done.channel.gain = fit.gain;
  done.channel.offset = fit.offset;
  done.residual = fit.worst;
  for (std::size_t r = 0; r < done.poses.size(); ++r) done.poses[r].residual = fit.residual[r];
  calibration.channels.push_back(std::move(done));
}

void CalibrationSession::fit() {
  walked_ = true;
  problems_.clear();
  Calibration calibration;
  calibration.device = device_.info().name;
  calibration.serial = device_.info().serial;
  for (std::size_t c = 0; c < channels_.size(); ++c) {
    if (!is_posable(channels_[c].kind)) continue;
    try {
      fit_channel_of(c, calibration);
    } catch (const CalibrationError& error) {
      problems_.emplace_back(error.what());
    }
  }
  if (problems_.empty()) calibration_ = std::move(calibration);
}

/// Estimates the gains and offsets for display. Two poses give both, one pose gives the offset. Without a pose the
/// earlier calibration counts, or else the maker's numbers.
void CalibrationSession::estimate() {
  for (std::size_t c = 0; c < channels_.size(); ++c) {
    DeviceChannel& now = estimated_[c];
    now = channels_[c];
    if (!is_posable(now.kind)) continue;
    const CalibratedChannel* kept = earlier(c);
    if (kept != nullptr) now = kept->channel;
    const std::vector<PoseReading> known = readings(c);
    if (known.empty()) continue;
    try {
      const ChannelFit fit = fit_channel(channels_[c], known, hand_, limits_);
      now.gain = fit.gain;
      now.offset = fit.offset;
    } catch (const CalibrationError&) {
      now.offset = known.back().value - now.gain * known.back().raw;
    }
  }
}

void CalibrationSession::view_pose(View& view) const {
  const CalibrationPose& pose = poses_[pose_];
  view.instruction = pose.instruction;
  double still = std::numeric_limits<double>::infinity();
  for (std::size_t c = 0; c < channels_.size(); ++c) {
    if (!pose.concerns[c]) continue;
    const DeviceChannel& channel = estimated_[c];
    JointView joint{.joint = leading_joint(channel), .may_enter = method_ != CalibrationMethod::kStops};
    if (pose.value[c]) {
      joint.target = angle_of_value(channel, *pose.value[c], hand_);
      put_angles(channel, *pose.value[c], hand_.min_angle, hand_.max_angle, view.target);
    }
    if (newest_) {
      view.raw.push_back(newest_->raw[c]);
      joint.present = angle_of_value(channel, channel.gain * newest_->raw[c] + channel.offset, hand_);
    }
    view.joints.push_back(joint);
    still = std::min(still, still_[c].held_for());
  }
  view.still_for = std::isfinite(still) ? still : 0.0;
}

CalibrationSession::View CalibrationSession::view() const {
  View view;
  view.method = method_;
  for (std::size_t p = 0; p < poses_.size(); ++p) {
    view.names.push_back(poses_[p].name);
    view.done.push_back(!averages_[p].empty());
  }
  view.pose = pose_;
  view.measuring = measuring();
  if (measuring()) view.measured = std::clamp((now_ - *measuring_since_) / measure_for_, 0.0, 1.0);
  view.problems = problems_;
  view.finished = calibration_.has_value();
  if (calibration_)
    for (const CalibratedChannel& done : calibration_->channels) view.results.push_back(result_line(done));
  view.hand = hand_.open_angle;
  for (std::size_t c = 0; newest_ && c < channels_.size(); ++c)
    put_angles(estimated_[c], estimated_[c].gain * newest_->raw[c] + estimated_[c].offset, hand_.min_angle,
               hand_.max_angle, view.hand);
  view.target = view.hand;
  if (!at_end()) view_pose(view);
  return view;
}

}  // namespace phalanx

// SPDX-License-Identifier: Apache-2.0
#include "phalanx/device/calibration_session.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "phalanx/core/constants.h"

namespace phalanx {
namespace {

std::string result_line(const CalibratedChannel& done) {
  return fmt::format("{}: {:.4e} a count, offset {:.4f}, from {} poses, at most {:.2f} deg off",
                     channel_label(done.channel.kind, done.channel.index), done.channel.gain,
                     done.channel.offset, done.poses.size(), done.residual / kDeg);
}

}  // namespace

CalibrationSession::CalibrationSession(Device& device, const HandParameters& hand, double measure_for,
                                       const CalibrationLimits& limits)
    : device_(device),
      hand_(hand),
      measure_for_(measure_for),
      limits_(limits),
      channels_(device.info().channels),
      poses_(calibration_poses(channels_, hand)),
      averages_(poses_.size()) {
  if (poses_.empty())
    throw CalibrationError("the device has no angle, curl or splay: there is nothing to calibrate by poses");
  if (!(measure_for > 0.0) || !std::isfinite(measure_for))
    throw std::invalid_argument(
        fmt::format("calibration: a pose measured for {} s; it must be a number above 0", measure_for));
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
  if (!measuring()) return;
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t c = 0; c < channels_.size(); ++c) measuring_[c].add(inbox[i].raw[c]);
}

void CalibrationSession::update(double now) {
  fetch(now);
  if (measuring() && now - *measuring_since_ >= measure_for_) end_measurement();
}

void CalibrationSession::end_measurement() {
  measuring_since_.reset();
  if (measuring_.front().count() == 0)
    throw DeviceError("no sample came while the pose was measured; see `phalanx device test-link`");
  samples_ = measuring_.front().count();
  averages_[pose_] = std::move(measuring_);
  leave_pose();
}

// ---- poses ----

void CalibrationSession::measure(double now) {
  if (at_end() || measuring()) return;
  fetch(now);  // drops earlier samples, which do not show the pose
  measuring_.assign(channels_.size(), RawAverage{});
  measuring_since_ = now;
}

void CalibrationSession::skip() {
  if (at_end()) return;
  averages_[pose_].clear();
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

void CalibrationSession::fit() {
  walked_ = true;
  problems_.clear();
  Calibration calibration;
  calibration.device = device_.info().name;
  calibration.serial = device_.info().serial;
  for (std::size_t c = 0; c < channels_.size(); ++c) {
    if (!is_posable(channels_[c].kind)) continue;
    CalibratedChannel done{.channel = channels_[c], .residual = 0.0, .poses = readings(c)};
    try {
      const ChannelFit fit = fit_channel(channels_[c], done.poses, hand_, limits_);
      done.channel.gain = fit.gain;
      done.channel.offset = fit.offset;
      done.residual = fit.worst;
      calibration.channels.push_back(std::move(done));
    } catch (const CalibrationError& error) {
      problems_.emplace_back(error.what());
    }
  }
  if (problems_.empty()) calibration_ = std::move(calibration);
}

CalibrationSession::View CalibrationSession::view() const {
  View view;
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
  if (at_end()) return view;
  view.instruction = poses_[pose_].instruction;
  for (std::size_t c = 0; newest_ && c < channels_.size(); ++c)
    if (poses_[pose_].value[c]) view.raw.push_back(newest_->raw[c]);
  return view;
}

}  // namespace phalanx

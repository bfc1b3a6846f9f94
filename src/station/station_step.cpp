// SPDX-License-Identifier: Apache-2.0
#include "station/station_step.h"

#include <algorithm>
#include <atomic>
#include <limits>
#include <utility>

#include "phalanx/core/bit_hash.h"
#include "phalanx/core/index.h"
#include "phalanx/hand/pad.h"

namespace phalanx {
namespace {

/// Writes forces and contacts of one digit.
void describe_digit(const Snapshot& shown, int digit, StepRecord& out) noexcept {
  double force = 0.0;
  bool touching = false;
  bool slips = false;
  const SegmentSnapshot* deepest = nullptr;
  for (int k = 0; k < kSegmentsPerDigit; ++k) {
    const SegmentSnapshot& segment = shown.segment[idx(segment_index(digit, k))];
    force += segment.force;
    if (!segment.contact) continue;
    touching = true;
    slips = slips || segment.slips;
    if (segment.depth >= StepRecord::kLeastDepth && (deepest == nullptr || segment.depth > deepest->depth))
      deepest = &segment;
  }
  out.force[idx(digit)] = force;
  out.touching[idx(digit)] = touching;
  out.slips[idx(digit)] = slips;
  out.depth[idx(digit)] = deepest == nullptr ? std::numeric_limits<double>::quiet_NaN() : deepest->depth;
  out.sent_stiffness[idx(digit)] = deepest == nullptr
                                       ? std::numeric_limits<double>::quiet_NaN()
                                       : out.sent_share[idx(digit)] * deepest->force / deepest->depth;
}

/// Returns the torques of the digits' forces before any limit, from the shown hand; friction's couples are
/// left out [Nm].
JointArray unlimited_torques(const HandModel& hand, const Snapshot& shown) noexcept {
  HandPoses poses;
  hand.poses(shown.gdp_angle, poses);
  JointArray torque{};
  for (int digit = 0; digit < kDigits; ++digit)
    for (int k = 0; k < kSegmentsPerDigit; ++k) {
      const SegmentSnapshot& segment = shown.segment[idx(segment_index(digit, k))];
      if (segment.force > 0.0)
        add_torques(poses.digit[idx(digit)], digit, k, segment.point, segment.force * segment.normal, torque);
    }
  return torque;
}

/// Returns StepRecord::sent_share of a digit.
/// @param wanted  torques of the digit's forces before any limit [Nm]
/// @param sent    torques in the command [Nm]
double share_sent(const JointArray& wanted, const JointArray& sent, int digit, double factor) noexcept {
  bool whole = true;
  double product = 0.0;
  double square = 0.0;
  for (int i = 0; i < kJointsPerDigit; ++i) {
    const std::size_t j = idx(joint_index(digit, i));
    whole = whole && sent[j] == factor * wanted[j];
    product += wanted[j] * sent[j];
    square += wanted[j] * wanted[j];
  }
  if (whole || !(square > 0.0)) return factor;
  return std::clamp(product / square, 0.0, 1.0);
}

}  // namespace

void describe_rendering(const Rendering& rendering, Status status, const JointArray& sent,
                        StepRecord& out) noexcept {
  const Snapshot& shown = rendering.state.snapshot();
  out.status = status;
  out.stiffness = rendering.ramp.parameters().force.stiffness;
  out.angle = shown.hcp_angle;
  out.angle_origin = shown.angle_origin;
  out.measured_force = shown.measured_force;
  const bool limited = has(status, Status::kTorqueLimited) || has(status, Status::kTorqueRateLimited);
  const JointArray wanted = limited ? unlimited_torques(rendering.model->hand, shown) : shown.torque;
  for (int digit = 0; digit < kDigits; ++digit) {
    out.sent_share[idx(digit)] = share_sent(wanted, sent, digit, out.factor);
    describe_digit(shown, digit, out);
  }
  const HandParameters& hand = rendering.model->hand.parameters();
  for (int digit = 0; digit < kDigits; ++digit) {
    const Vec3 pad = pad_in_world(hand, digit, shown.hcp_pose[idx(segment_index(digit, 2))]);
    out.pad[idx(digit)] = {pad.x(), pad.y(), pad.z()};
  }
}

StationStep::StationStep(std::unique_ptr<Rendering> first, ChannelMap map, const DeviceInfo& device,
                         const SafetySettings& safety, std::vector<MotorWitness> witnesses, double period)
    : channels_(std::move(map)),
      rendering_(std::move(first)),
      safety_(safety, channels_, device, rendering_->model->hand.parameters(), std::move(witnesses), period) {
}

bool StationStep::serve(unsigned requests, Fault connection, double now) noexcept {
  if ((requests & StepRequest::kWithdraw) != 0) end_running();
  ending_ = ending_ || (requests & StepRequest::kEnd) != 0;
  if ((requests & StepRequest::kStop) != 0 || ending_) {
    safety_.stop();
    resume_after_exchange_ = false;
  }
  if (ending_) return false;
  if ((requests & StepRequest::kResume) != 0) safety_.start();
  return (requests & StepRequest::kReset) != 0 && reset(connection, now);
}

bool StationStep::reset(Fault connection, double now) noexcept {
  if (safety_.state() != SafetyState::kFault) return false;
  if (!safety_.reset(connection, now)) {
    ++resets_refused_;
    return false;
  }
  heard_ = false;
  return true;
}

void StationStep::confirm_openings(unsigned digits) noexcept {
  if (safety_.state() != SafetyState::kRunning) end_running();
  if (running_ == 0) return;
  for (int digit = 0; digit < kDigits; ++digit)
    if ((digits >> static_cast<unsigned>(digit) & 1U) != 0) rendering_->state.confirm_opening(digit);
}

bool StationStep::wait_for_exchange() noexcept {
  const SafetyState state = safety_.state();
  if (state == SafetyState::kStarting || state == SafetyState::kRunning) {
    safety_.stop();
    resume_after_exchange_ = true;
  }
  return safety_.at_rest() && safety_.state() != SafetyState::kStopping;
}

std::unique_ptr<Rendering> StationStep::exchange(std::unique_ptr<Rendering> next) noexcept {
  std::unique_ptr<Rendering> before = std::exchange(rendering_, std::move(next));
  if (std::exchange(resume_after_exchange_, false)) safety_.start();
  return before;
}

const DeviceCommand& StationStep::step(std::span<const DeviceSample> samples, Fault connection, bool late,
                                       double now) noexcept {
  safety_.observe(samples, connection, late, now);
  if (!samples.empty()) {
    newest_sample_ = samples.back();
    heard_ = true;
  }
  if (heard_) {
    channels_.convert(newest_sample_, sample_);
    rendering_->ramp.advance();
    status_ = phalanx::step(*rendering_->model, rendering_->ramp.parameters(), sample_, rendering_->state);
  }
  safety_.command(snapshot(), newest_sample_, now, command_);
  number_running();
  return command_;
}

/// Numbers the periods of kRunning, over all stations.
void StationStep::number_running() noexcept {
  static std::atomic<std::uint64_t> last{0};
  if (safety_.state() != SafetyState::kRunning) return end_running();
  if (running_ == 0) running_ = last.fetch_add(1, std::memory_order_relaxed) + 1;
}

void StationStep::end_running() noexcept {
  running_ = 0;
  rendering_->state.withdraw_openings();
}

void StationStep::describe(StepRecord& out) const noexcept {
  out.sample_sequence = newest_sample_.sequence;
  out.sample_time_us = newest_sample_.time_us;
  out.state = safety_.state();
  out.fault = safety_.fault().fault;
  out.factor = safety_.factor();
  describe_rendering(*rendering_, status_, command_.torque, out);
}

std::uint64_t StationStep::hash() const noexcept {
  BitHash hash;
  const Snapshot& shown = snapshot();
  for (const double angle : shown.hcp_angle) hash.add(angle);
  for (const double angle : shown.gdp_angle) hash.add(angle);
  for (const double torque : shown.torque) hash.add(torque);
  for (const SegmentSnapshot& segment : shown.segment) {
    hash.add(segment.force_raw);
    hash.add(segment.force);
    if (!(segment.force > 0.0)) continue;
    for (int i = 0; i < 3; ++i) {
      hash.add(segment.point[i]);
      hash.add(segment.normal[i]);
    }
  }
  hash.add(static_cast<std::uint64_t>(status_));
  hash.add(static_cast<std::uint64_t>(safety_.state()) << 16U |
           static_cast<std::uint64_t>(safety_.fault().fault));
  hash.add(command_.tick);
  hash.add(command_.sample_time_us);
  std::uint64_t bits =
      static_cast<std::uint64_t>(command_.enable) << 1U | static_cast<std::uint64_t>(command_.fault);
  for (const bool stopped : command_.stopped) bits = bits << 1U | static_cast<std::uint64_t>(stopped);
  hash.add(bits);
  for (const double torque : command_.torque) hash.add(torque);
  for (std::size_t s = 0; s < command_.wall.size(); ++s) {
    const LocalWall& wall = command_.wall[s];
    if (!wall.active) continue;
    hash.add(std::uint64_t{s});
    for (const double g : wall.g) hash.add(g);
    for (const double value : {wall.d_ref, wall.stiffness, wall.force_max, wall.host_force}) hash.add(value);
  }
  hash.add(command_.wall_valid_for);
  return hash.value();
}

}  // namespace phalanx

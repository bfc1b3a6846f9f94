// SPDX-License-Identifier: Apache-2.0
#include "station/station_step.h"

#include <atomic>
#include <utility>

#include "phalanx/core/bit_hash.h"

namespace phalanx {

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

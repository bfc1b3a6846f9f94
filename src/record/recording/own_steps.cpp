// SPDX-License-Identifier: Apache-2.0
#include "record/recording/own_steps.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "phalanx/core/bit_hash.h"
#include "phalanx/core/index.h"

namespace phalanx {
namespace {

/// Writes measured values. Leaves the field empty if the program has none of these sensors.
template <class Array, class Field>
void put_own(const Array& values, Field& field) {
  if (std::all_of(values.begin(), values.end(), [](double value) { return std::isnan(value); })) return;
  field.Add(values.begin(), values.end());
}

template <class Field, class Array>
void take_own(const Field& field, Array& values) {
  if (field.empty()) return;
  if (field.size() != static_cast<int>(values.size()))
    throw std::invalid_argument(
        fmt::format("a step has {} numbers of a sample where {} belong", field.size(), values.size()));
  std::copy(field.begin(), field.end(), values.begin());
}

bool stops(const Snapshot& snapshot, int digit) noexcept {
  for (int k = 0; k < kSegmentsPerDigit; ++k)
    if (snapshot.segment[idx(segment_index(digit, k))].contact) return true;
  return false;
}

}  // namespace

std::uint64_t own_step_hash(const Snapshot& snapshot) noexcept {
  BitHash hash;
  hash.add(snapshot.tick);
  hash.add(snapshot.time_s);
  hash.add(static_cast<std::uint64_t>(snapshot.status));
  for (const JointArray* numbers : {&snapshot.hcp_angle, &snapshot.gdp_angle, &snapshot.torque})
    for (const double number : *numbers) hash.add(number);
  for (const SegmentSnapshot& segment : snapshot.segment) {
    hash.add(segment.force_raw);
    hash.add(segment.force);
    for (int i = 0; i < 3; ++i) {
      hash.add(segment.point[i]);
      hash.add(segment.normal[i]);
      hash.add(segment.friction[i]);
    }
  }
  return hash.value();
}

void write_own_step(const OwnStep& step, bool with_angles, wire::Step& out) {
  out.Clear();
  const Snapshot& snapshot = step.snapshot;
  out.set_tick(snapshot.tick);
  out.set_station(1);
  out.set_time(step.sample.time_s);
  wire::OwnSample& sample = *out.mutable_own_sample();
  sample.set_time(step.sample.time_s);
  sample.mutable_angle()->Add(step.sample.angle.begin(), step.sample.angle.end());
  put_own(step.sample.measured_torque, *sample.mutable_measured_torque());
  put_own(step.sample.measured_force, *sample.mutable_measured_force());
  for (const AngleOrigin origin : step.sample.angle_origin)
    sample.mutable_angle_origin()->push_back(static_cast<char>(origin));
  out.set_requests(step.withdrawn ? StepRequest::kWithdraw : 0U);
  out.set_openings(step.confirmed);
  out.set_changed(step.changed);
  out.set_state(wire::SAFETY_RUNNING);
  out.set_status(static_cast<std::uint32_t>(snapshot.status));
  out.set_factor(1.0);
  out.set_stiffness(step.stiffness);
  out.set_enable(true);
  if (std::any_of(snapshot.torque.begin(), snapshot.torque.end(),
                  [](double torque) { return torque != 0.0; }))
    out.mutable_torque()->Add(snapshot.torque.begin(), snapshot.torque.end());
  unsigned stopped = 0;
  for (int digit = 0; digit < kDigits; ++digit)
    stopped |= stops(snapshot, digit) ? 1U << static_cast<unsigned>(digit) : 0U;
  out.set_stopped(stopped);
  out.set_hash(own_step_hash(snapshot));
  if (!with_angles) return;
  out.mutable_hcp_angle()->Add(snapshot.hcp_angle.begin(), snapshot.hcp_angle.end());
  out.mutable_gdp_angle()->Add(snapshot.gdp_angle.begin(), snapshot.gdp_angle.end());
}

void read_own_sample(const wire::Step& step, Sample& out) {
  out = Sample{};
  const wire::OwnSample& from = step.own_sample();
  out.time_s = from.time();
  if (from.angle_size() != kJoints) throw std::invalid_argument("a step has no sample");
  take_own(from.angle(), out.angle);
  take_own(from.measured_torque(), out.measured_torque);
  take_own(from.measured_force(), out.measured_force);
  const std::string& origins = from.angle_origin();
  for (std::size_t j = 0; j < std::min(origins.size(), out.angle_origin.size()); ++j)
    if (static_cast<std::uint8_t>(origins[j]) <= static_cast<std::uint8_t>(AngleOrigin::kScripted))
      out.angle_origin[j] = static_cast<AngleOrigin>(origins[j]);
}

void OwnSteps::make(const wire::Step& recorded) {
  read_own_sample(recorded, sample_);
  if ((recorded.requests() & StepRequest::kWithdraw) != 0) rendering_->state.withdraw_openings();
  for (int digit = 0; digit < kDigits; ++digit)
    if ((recorded.openings() >> static_cast<unsigned>(digit) & 1U) != 0)
      rendering_->state.confirm_opening(digit);
  rendering_->ramp.advance();
  static_cast<void>(step(*rendering_->model, rendering_->ramp.parameters(), sample_, rendering_->state));
}

void OwnSteps::describe(StepRecord& out) const noexcept {
  const Snapshot& shown = snapshot();
  out.command.tick = shown.tick;
  out.command.enable = true;
  out.command.torque = shown.torque;
  out.command.gdp_angle = shown.gdp_angle;
  for (int digit = 0; digit < kDigits; ++digit) out.command.stopped[idx(digit)] = stops(shown, digit);
  out.hash = own_step_hash(shown);
  out.state = SafetyState::kRunning;
  out.factor = 1.0;
  describe_rendering(*rendering_, shown.status, shown.torque, out);
}

}  // namespace phalanx

// SPDX-License-Identifier: Apache-2.0
#include "record/recording/view_message.h"

#include <algorithm>
#include <cmath>

#include "phalanx/core/index.h"

namespace phalanx {
namespace {

template <class Array, class Field>
void put(const Array& values, Field& field) {
  field.Reserve(static_cast<int>(values.size()));
  for (const double value : values) field.AddAlreadyReserved(static_cast<float>(value));
}

template <class Field>
void put(const Vec3& v, Field& field) {
  for (int i = 0; i < 3; ++i) field.Add(static_cast<float>(v[i]));
}

template <class Field>
void put_poses(const std::array<Pose, kSegments>& poses, Field& field) {
  field.Reserve(7 * kSegments);
  for (const Pose& X : poses) {
    const Eigen::Quaterniond q(X.R);
    put(X.p, field);
    for (const double value : {q.x(), q.y(), q.z(), q.w()}) field.Add(static_cast<float>(value));
  }
}

/// Writes measured values. Leaves the field empty if the device has none of these sensors.
template <class Array, class Field>
void put_measured(const Array& values, Field& field) {
  const bool any = std::any_of(values.begin(), values.end(), [](double v) { return !std::isnan(v); });
  if (any) put(values, field);
}

void put_contact(int number, const SegmentSnapshot& segment, wire::Contact& out) {
  out.set_segment(static_cast<std::uint32_t>(number));
  out.set_touching(segment.contact);
  out.set_depth(static_cast<float>(segment.depth));
  out.set_force_raw(static_cast<float>(segment.force_raw));
  out.set_force(static_cast<float>(segment.force));
  put(segment.point, *out.mutable_point());
  put(segment.normal, *out.mutable_normal());
  out.set_slid(static_cast<float>(segment.slid));
  out.set_oscillating(segment.oscillating);
  out.set_frequency(static_cast<float>(segment.oscillation_frequency));
  out.set_swing(static_cast<float>(segment.oscillation_swing));
  out.set_slips(segment.slips);
}

void put_point(const ContactPoint& point, wire::ContactPoint& out) {
  out.set_segment(static_cast<std::uint32_t>(point.segment));
  put(point.point, *out.mutable_point());
  put(point.normal, *out.mutable_normal());
  out.set_force(static_cast<float>(point.force));
  put(point.friction, *out.mutable_friction());
  out.set_spin(static_cast<float>(point.spin));
  out.set_coefficient(static_cast<float>(point.coefficient));
  out.set_slips(point.slips);
}

wire::Opening::Phase wire_phase(OpeningPhase phase) noexcept {
  switch (phase) {
    case OpeningPhase::kNone:
    case OpeningPhase::kUnconfirmed:
      return wire::Opening::UNCONFIRMED;
    case OpeningPhase::kConfirmed:
      return wire::Opening::CONFIRMED;
    case OpeningPhase::kNotFollowed:
      return wire::Opening::NOT_FOLLOWED;
  }
  return wire::Opening::UNCONFIRMED;
}

void put_durations(const Histogram& histogram, wire::Durations& out) {
  out.set_p50_us(static_cast<float>(histogram.percentile_us(50.0)));
  out.set_p99_us(static_cast<float>(histogram.percentile_us(99.0)));
  out.set_p999_us(static_cast<float>(histogram.percentile_us(99.9)));
  out.set_max_us(static_cast<float>(histogram.max_us()));
  for (std::size_t k = 0; k < Histogram::kOctaves; ++k) out.add_octave(histogram.in_octave(k));
}

void put_opening(int digit, const DigitOpening& opening, std::uint64_t running, wire::Opening& out) {
  out.set_digit(static_cast<std::uint32_t>(digit));
  out.set_phase(wire_phase(opening.phase));
  out.set_way(static_cast<float>(opening.way));
  out.set_running(running);
}

}  // namespace

wire::SafetyState wire_state(SafetyState state) noexcept {
  switch (state) {
    case SafetyState::kWaiting:
      return wire::SAFETY_WAITING;
    case SafetyState::kStarting:
      return wire::SAFETY_STARTING;
    case SafetyState::kRunning:
      return wire::SAFETY_RUNNING;
    case SafetyState::kStopping:
      return wire::SAFETY_STOPPING;
    case SafetyState::kStopped:
      return wire::SAFETY_STOPPED;
    case SafetyState::kFault:
      return wire::SAFETY_FAULT;
  }
  return wire::SAFETY_FAULT;
}

wire::HandSource wire_source(HandSource source) noexcept {
  if (source == HandSource::kDevice) return wire::HAND_DEVICE;
  return source == HandSource::kPatient ? wire::HAND_PATIENT : wire::HAND_SLIDERS;
}

void write_loop(const DeadlineStatistics& deadlines, wire::Loop& out) {
  out.set_period(deadlines.period);
  out.set_steps(deadlines.steps);
  out.set_overruns(deadlines.overruns);
  out.set_skipped(deadlines.skipped);
  put_durations(deadlines.lateness, *out.mutable_lateness());
  put_durations(deadlines.step, *out.mutable_step());
}

void write_tick(const StationView& view, wire::Tick& out) {
  out.Clear();
  const Snapshot& snapshot = view.snapshot;
  out.set_tick(snapshot.tick);
  out.set_time(view.time);
  out.set_status(static_cast<std::uint32_t>(snapshot.status));
  put(snapshot.hcp_angle, *out.mutable_hcp_angle());
  put(snapshot.gdp_angle, *out.mutable_gdp_angle());
  put(view.sent, *out.mutable_torque());
  put_poses(snapshot.hcp_pose, *out.mutable_hcp_pose());
  put_poses(snapshot.gdp_pose, *out.mutable_gdp_pose());
  for (int s = 0; s < kSegments; ++s) {
    const SegmentSnapshot& segment = snapshot.segment[static_cast<std::size_t>(s)];
    if (segment.contact || segment.force > 0.0 || segment.oscillating)
      put_contact(s, segment, *out.add_contact());
  }
  for (const ContactPoint& point : snapshot.contact_points) put_point(point, *out.add_contact_point());
  for (int d = 0; d < kDigits; ++d) {
    const DigitOpening& opening = snapshot.opening[idx(d)];
    if (opening.phase != OpeningPhase::kNone) put_opening(d, opening, view.running, *out.add_opening());
  }
  put_measured(snapshot.measured_torque, *out.mutable_measured_torque());
  put_measured(snapshot.measured_force, *out.mutable_measured_force());
  out.set_stiffness(static_cast<float>(view.stiffness));
  out.set_stiffness_factor(static_cast<float>(snapshot.stiffness_factor));
  out.set_state(wire_state(view.state));
  out.set_factor(static_cast<float>(view.factor));
  out.set_at_rest(view.at_rest);
  out.set_step_us(static_cast<float>(1e6 * view.duration));
}

DigitArray digit_forces(const wire::Tick& tick) noexcept {
  DigitArray force{};
  for (const wire::Contact& contact : tick.contact())
    if (const std::uint32_t digit = contact.segment() / kSegmentsPerDigit; digit < kDigits)
      force[digit] += static_cast<double>(tick.factor() * contact.force());
  return force;
}

}  // namespace phalanx

// SPDX-License-Identifier: Apache-2.0
#include "record/recording/step_message.h"

#include <algorithm>

#include "phalanx/core/bit_hash.h"
#include "phalanx/core/index.h"
#include "record/recording/view_message.h"

namespace phalanx {
namespace {

void write_sample(const DeviceSample& sample, std::size_t channels, wire::Sample& out) {
  out.set_sequence(sample.sequence);
  out.set_time_us(sample.time_us);
  out.set_received(sample.received);
  out.mutable_raw()->Reserve(static_cast<int>(channels));
  for (std::size_t c = 0; c < channels; ++c) out.add_raw(sample.raw[c]);
  out.set_state(static_cast<std::uint32_t>(sample.state));
  out.set_fault(static_cast<std::uint32_t>(sample.fault));
  out.set_fault_channel(sample.fault_channel);
  out.set_estop(sample.estop);
  out.set_factor(sample.factor);
  out.set_acted_tick(sample.acted_tick);
}

void write_wall(int segment, const LocalWall& wall, wire::Wall& out) {
  out.set_segment(static_cast<std::uint32_t>(segment));
  for (const double g : wall.g) out.add_g(g);
  out.set_d_ref(wall.d_ref);
  out.set_stiffness(wall.stiffness);
  out.set_force_max(wall.force_max);
  out.set_host_force(wall.host_force);
}

}  // namespace

void write_step(const StepRecord& record, std::span<const DeviceSample> samples, std::size_t channels,
                bool with_angles, wire::Step& out) {
  out.Clear();
  const StepInput& input = record.input;
  const DeviceCommand& command = record.command;
  out.set_tick(command.tick);
  out.set_station(record.station);
  out.set_time(input.time);
  out.set_late(input.late);
  for (const DeviceSample& sample : samples) write_sample(sample, channels, *out.add_sample());
  out.set_requests(input.requests);
  out.set_fault_at_requests(static_cast<std::uint32_t>(input.connection_at_requests));
  out.set_openings(input.openings);
  out.set_waits(input.waits);
  out.set_exchanged(input.exchanged);
  out.set_changed(input.changed);
  out.set_connection_fault(static_cast<std::uint32_t>(input.connection));
  out.set_state(wire_state(record.state));
  out.set_fault(static_cast<std::uint32_t>(record.fault));
  out.set_status(static_cast<std::uint32_t>(record.status));
  out.set_factor(record.factor);
  out.set_stiffness(record.stiffness);
  out.set_enable(command.enable);
  out.set_fault_sent(command.fault);
  if (std::any_of(command.torque.begin(), command.torque.end(), [](double torque) { return torque != 0.0; }))
    for (const double torque : command.torque) out.add_torque(torque);
  unsigned stopped = 0;
  for (std::size_t d = 0; d < command.stopped.size(); ++d) stopped |= command.stopped[d] ? 1U << d : 0U;
  out.set_stopped(stopped);
  for (int s = 0; s < kSegments; ++s)
    if (const LocalWall& wall = command.wall[idx(s)]; wall.active) write_wall(s, wall, *out.add_wall());
  out.set_wall_valid_for(command.wall_valid_for);
  out.set_hash(record.hash);
  out.set_channel_check(channel_check(samples, channels));
  out.set_lateness_us(static_cast<float>(1e6 * record.lateness));
  out.set_duration_us(static_cast<float>(1e6 * record.duration));
  if (!with_angles) return;
  for (const double angle : record.angle) out.add_hcp_angle(angle);
  for (const double angle : command.gdp_angle) out.add_gdp_angle(angle);
}

StepInput read_input(const wire::Step& step) {
  return {.time = step.time(),
          .late = step.late(),
          .requests = step.requests(),
          .connection_at_requests = static_cast<Fault>(step.fault_at_requests()),
          .openings = step.openings(),
          .waits = step.waits(),
          .exchanged = step.exchanged(),
          .changed = step.changed(),
          .connection = static_cast<Fault>(step.connection_fault())};
}

void read_samples(const wire::Step& step, std::vector<DeviceSample>& out) {
  out.clear();
  for (const wire::Sample& from : step.sample()) {
    DeviceSample& sample = out.emplace_back();
    sample.sequence = from.sequence();
    sample.time_us = from.time_us();
    sample.received = from.received();
    const auto count = std::min<std::size_t>(static_cast<std::size_t>(from.raw_size()), sample.raw.size());
    for (std::size_t c = 0; c < count; ++c) sample.raw[c] = from.raw(static_cast<int>(c));
    sample.state =
        static_cast<DeviceState>(std::min(from.state(), static_cast<std::uint32_t>(DeviceState::kLatched)));
    sample.fault = static_cast<Fault>(from.fault());
    sample.fault_channel = from.fault_channel();
    sample.estop = from.estop();
    sample.factor = from.factor();
    sample.acted_tick = from.acted_tick();
  }
}

std::string channel_check(std::span<const DeviceSample> samples, std::size_t channels) {
  std::string check;
  if (samples.empty()) return check;
  for (std::size_t c = 0; c < channels; ++c) {
    BitHash hash;
    for (const DeviceSample& sample : samples)
      hash.add(static_cast<std::uint64_t>(static_cast<std::uint32_t>(sample.raw[c])));
    const std::uint64_t value = hash.value();
    check.push_back(static_cast<char>(value & 0xffU));
    check.push_back(static_cast<char>(value >> 8U & 0xffU));
  }
  return check;
}

}  // namespace phalanx

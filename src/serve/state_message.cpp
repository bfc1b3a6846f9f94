// SPDX-License-Identifier: Apache-2.0
#include "serve/state_message.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "phalanx/scene/data_paths.h"
#include "phalanx/scene/scene_keys.h"
#include "serve/plain_text.h"
#include "serve/tick_message.h"

namespace phalanx {
namespace {

constexpr std::size_t kBusyLength = 200;  ///< [bytes]

const char* device_state_name(DeviceState state) noexcept {
  constexpr std::array<const char*, 6> kNames = {"connecting", "ready",  "starting",
                                                 "active",     "fading", "latched"};
  const auto number = static_cast<std::size_t>(state);
  return number < kNames.size() ? kNames[number] : "unknown";
}

void put(const Overrides& from, google::protobuf::RepeatedPtrField<wire::Setting>& to) {
  for (const auto& [key, value] : from) {
    wire::Setting& setting = *to.Add();
    setting.set_key(as_utf8(key));
    setting.set_value(as_utf8(value));
  }
}

void put(const FaultEvent& event, wire::Fault& out) {
  out.set_name(std::string(fault_name(event.fault)));
  out.set_meaning(std::string(fault_meaning(event.fault)));
  out.set_remedy(std::string(fault_remedy(event.fault)));
  out.set_channel(event.channel);
  out.set_time(event.time);
  out.set_tick(event.tick);
  out.set_from_device(event.from_device);
}

void put(const Histogram& histogram, wire::Durations& out) {
  out.set_p50_us(static_cast<float>(histogram.percentile_us(50.0)));
  out.set_p99_us(static_cast<float>(histogram.percentile_us(99.0)));
  out.set_p999_us(static_cast<float>(histogram.percentile_us(99.9)));
  out.set_max_us(static_cast<float>(histogram.max_us()));
  for (std::size_t k = 0; k < Histogram::kOctaves; ++k) out.add_octave(histogram.in_octave(k));
}

void put(const DeadlineStatistics& deadlines, wire::Loop& out) {
  out.set_period(deadlines.period);
  out.set_steps(deadlines.steps);
  out.set_overruns(deadlines.overruns);
  out.set_skipped(deadlines.skipped);
  put(deadlines.lateness, *out.mutable_lateness());
  put(deadlines.step, *out.mutable_step());
}

void put(const CalibrationSession::View& view, wire::Wizard& out) {
  out.set_pose(static_cast<std::uint32_t>(view.pose));
  for (const std::string& name : view.names) out.add_name(name);
  out.set_instruction(view.instruction);
  out.set_measuring(view.measuring);
  out.set_measured(static_cast<float>(view.measured));
  for (const bool done : view.done) out.add_done(done);
  for (const std::int32_t raw : view.raw) out.add_raw(raw);
  for (const std::string& problem : view.problems) out.add_problem(as_utf8(problem));
  for (const std::string& result : view.results) out.add_result(result);
  out.set_finished(view.finished);
}

wire::HandSource wire_source(HandSource source) noexcept {
  if (source == HandSource::kDevice) return wire::HAND_DEVICE;
  return source == HandSource::kPatient ? wire::HAND_PATIENT : wire::HAND_SLIDERS;
}

void put_host(const HostState& state, wire::State& out) {
  out.set_scene(as_utf8(state.scene));
  out.set_scene_description(as_utf8(state.description));
  put(state.overrides, *out.mutable_changed());
  put(state.values, *out.mutable_value());
  if (state.geometry) out.set_geometry(state.geometry->revision);
  out.set_busy(shortened(as_utf8(state.busy), kBusyLength));
  out.set_station_gone(!state.running);
  out.set_trouble(as_utf8(state.trouble));
  out.set_realtime(as_utf8(state.realtime));
  out.set_source(wire_source(state.source));
  out.set_device_spec(as_utf8(state.device_spec));
  out.set_device_name(as_utf8(state.device.name));
  out.set_device_serial(as_utf8(state.device.serial));
  out.set_device_simulated(state.device.simulated);
  out.set_renders_torque(state.device.renders_torque);
  out.set_calibration(as_utf8(state.calibration));
  for (const int joint : state.sensed_joints) out.add_sensed_joint(static_cast<std::uint32_t>(joint));
  if (state.wizard) put(*state.wizard, *out.mutable_wizard());
}

/// File names without their ending, sorted.
void put_names(const std::filesystem::path& folder, google::protobuf::RepeatedPtrField<wire::Choice>& to) {
  std::vector<std::string> names;
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(folder, ignored))
    if (entry.path().extension() == ".toml") names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  for (const std::string& name : names) to.Add()->set_name(name);
}

/// A key of an array's element stands for all of them.
wire::ChangeKind wire_change(const std::string& path) {
  switch (change_kind(path.substr(0, path.find('[')) == "objects" ? "objects" : path)) {
    case ChangeKind::kInContact:
      return wire::CHANGE_IN_CONTACT;
    case ChangeKind::kAtZeroTorque:
      return wire::CHANGE_AT_ZERO_TORQUE;
    case ChangeKind::kNewStation:
      return wire::CHANGE_NEW_STATION;
  }
  return wire::CHANGE_NEW_STATION;
}

}  // namespace

void write_link(const LinkStatistics& link, wire::Link& out) {
  out.set_received(link.received);
  out.set_lost(link.lost);
  out.set_corrupt(link.corrupt);
  out.set_refused(link.refused);
  out.set_outdated(link.outdated);
  out.set_sent(link.sent);
}

void write_state(const StationHost& host, wire::State& out) {
  const auto state = host.state();
  const StationView view = host.view();
  put_host(*state, out);
  out.set_time(host.now());
  out.set_safety(wire_state(view.state));
  out.set_stops(host.stops());
  out.set_held_stopped(host.held_stopped());
  // While a calibration is on there is no station: the fault is that of the one before.
  if (view.fault.fault != Fault::kNone && !state->wizard) put(view.fault, *out.mutable_fault());
  out.set_degraded(view.degraded);
  out.set_device_state(device_state_name(view.device));
  out.set_estop(view.estop);
  write_link(view.link, *out.mutable_link());
  put(host.deadlines(), *out.mutable_loop());
  if (state->source == HandSource::kSliders)
    for (const double angle : host.sliders()) out.add_slider(static_cast<float>(angle));
}

void write_seats(const Seats& seats, double now, wire::State& out) {
  if (const Seat* seat = seats.operating(now)) {
    out.set_operator_page(seat->number);
    out.set_operator_name(seat->name);
  }
  out.set_pages(static_cast<std::uint32_t>(seats.here()));
}

void write_choices(wire::Welcome& out) {
  for (const SceneKey& key : scene_keys()) {
    wire::KeyInfo& info = *out.add_key();
    info.set_path(key.path);
    info.set_type(key.type);
    info.set_unit(key.unit);
    info.set_range(key.range);
    info.set_default_value(key.default_value);
    info.set_meaning(key.meaning);
    info.set_change(wire_change(key.path));
  }
  for (const SceneInfo& scene : list_scenes()) {
    if (!scene.readable || !scene.touches) continue;
    wire::Choice& choice = *out.add_scene();
    choice.set_name(scene.name);
    choice.set_meaning(scene.description);
  }
  put_names(data_folder() / "assets/profiles", *out.mutable_profile());
}

}  // namespace phalanx

// SPDX-License-Identifier: Apache-2.0
#include "serve/state_message.h"

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "phalanx/core/index.h"
#include "phalanx/hand/hand_model.h"
#include "phalanx/scene/data_paths.h"
#include "phalanx/scene/scene_keys.h"
#include "phalanx/step/haptic_step.h"
#include "record/plain_text.h"
#include "record/recording/view_message.h"

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
  out.set_meaning(fault_words(event));
  out.set_remedy(std::string(fault_remedy(event.fault)));
  out.set_channel(event.channel);
  out.set_time(event.time);
  out.set_tick(event.tick);
  out.set_from_device(event.from_device);
}

/// Writes the poses of all segments, as those of a Tick.
void put_hand(const HandModel& hand, const JointArray& angle, google::protobuf::RepeatedField<float>& out) {
  HandPoses poses;
  hand.poses(angle, poses);
  for (int s = 0; s < kSegments; ++s) {
    const bool palm = s == kPalm;
    const Pose& X =
        palm ? hand.palm_pose() : poses.digit[idx(digit_of_segment(s))].segment[idx(s % kSegmentsPerDigit)];
    const Eigen::Quaterniond q(X.R);
    for (const double value : {X.p.x(), X.p.y(), X.p.z(), q.x(), q.y(), q.z(), q.w()})
      out.Add(static_cast<float>(value));
  }
}

/// @param hand  null: it is not known yet
void put(const CalibrationSession::View& view, const HandModel* hand, wire::Wizard& out) {
  out.set_pose(static_cast<std::uint32_t>(view.pose));
  for (const std::string& name : view.names) out.add_name(name);
  out.set_instruction(view.instruction);
  out.set_measuring(view.measuring);
  out.set_measured(static_cast<float>(view.measured));
  for (const bool done : view.done) out.add_done(done);
  for (const std::int32_t raw : view.raw) out.add_raw(raw);
  for (const std::string& problem : view.problems) *out.add_problem() = as_utf8(problem);
  for (const std::string& result : view.results) out.add_result(result);
  out.set_finished(view.finished);
  out.set_method(static_cast<wire::Wizard::Method>(view.method));
  for (const CalibrationSession::JointView& joint : view.joints) {
    wire::Wizard::Joint& to = *out.add_joint();
    to.set_joint(static_cast<std::uint32_t>(joint.joint));
    if (joint.target) to.set_target(static_cast<float>(*joint.target));
    if (joint.present) to.set_present(static_cast<float>(*joint.present));
    to.set_may_enter(joint.may_enter);
  }
  out.set_still_for(static_cast<float>(view.still_for));
  if (hand == nullptr) return;
  put_hand(*hand, view.hand, *out.mutable_hand());
  put_hand(*hand, view.target, *out.mutable_target());
}

void put(const RangeSession::View& view, const HandModel* hand, wire::Wizard& out) {
  out.set_of_range(true);
  out.set_pose(static_cast<std::uint32_t>(view.digit));
  for (const int digit : view.digits) out.add_digit(static_cast<std::uint32_t>(digit));
  for (const bool done : view.done) out.add_done(done);
  out.set_measuring(view.measuring);
  out.set_finished(view.finished);
  for (const RangeSession::JointView& joint : view.joints) {
    wire::Wizard::Joint& to = *out.add_joint();
    to.set_joint(static_cast<std::uint32_t>(joint.joint));
    if (joint.present) to.set_present(static_cast<float>(*joint.present));
    if (joint.reached) {
      to.set_reached_min(static_cast<float>(joint.reached->min));
      to.set_reached_max(static_cast<float>(joint.reached->max));
    }
    to.set_limit_min(static_cast<float>(joint.limit.min));
    to.set_limit_max(static_cast<float>(joint.limit.max));
  }
  out.set_still_for(static_cast<float>(view.still_for));
  if (hand != nullptr) put_hand(*hand, view.hand, *out.mutable_hand());
}

void put_info(const SessionInfo& info, wire::State& out) {
  out.set_scene(as_utf8(info.scene));
  out.set_scene_description(as_utf8(info.description));
  put(info.overrides, *out.mutable_changed());
  put(info.values, *out.mutable_value());
  if (info.geometry) out.set_geometry(info.geometry->revision);
  out.set_busy(shortened(as_utf8(info.busy), kBusyLength));
  out.set_station_gone(!info.running);
  out.set_trouble(as_utf8(info.trouble));
  out.set_realtime(as_utf8(info.realtime));
  out.set_source(wire_source(info.source));
  out.set_device_spec(as_utf8(info.device_spec));
  out.set_device_name(as_utf8(info.device.name));
  out.set_device_serial(as_utf8(info.device.serial));
  out.set_device_simulated(info.device.simulated);
  out.set_renders_torque(info.device.renders_torque);
  out.set_holds_without_host(holds_without_host(info.device));
  out.set_calibration(as_utf8(info.calibration));
  for (const int joint : info.sensed_joints) out.add_sensed_joint(static_cast<std::uint32_t>(joint));
  out.set_range(as_utf8(info.range));
  const bool known = info.geometry && info.geometry->model;
  const HandModel* hand = known ? &info.geometry->model->hand : nullptr;
  if (info.wizard) put(*info.wizard, hand, *out.mutable_wizard());
  if (info.range_wizard) put(*info.range_wizard, hand, *out.mutable_wizard());
}

/// File names without their ending, sorted.
void put_names(const std::filesystem::path& folder, google::protobuf::RepeatedPtrField<wire::Choice>& to) {
  for (const std::string& name : names_in_folder(folder, ".toml")) to.Add()->set_name(name);
}

wire::ChangeKind wire_change(ChangeKind change) noexcept {
  switch (change) {
    case ChangeKind::kInContact:
      return wire::CHANGE_IN_CONTACT;
    case ChangeKind::kAtZeroTorque:
      return wire::CHANGE_AT_ZERO_TORQUE;
    case ChangeKind::kOtherObject:
      return wire::CHANGE_OTHER_OBJECT;
    case ChangeKind::kNewStation:
      return wire::CHANGE_NEW_STATION;
  }
  return wire::CHANGE_NEW_STATION;
}

wire::KeyType wire_type(KeyType type) noexcept {
  switch (type) {
    case KeyType::kNumber:
      return wire::KEY_NUMBER;
    case KeyType::kNumberOrOff:
      return wire::KEY_NUMBER_OR_OFF;
    case KeyType::kInteger:
      return wire::KEY_INTEGER;
    case KeyType::kFlag:
      return wire::KEY_FLAG;
    case KeyType::kText:
      return wire::KEY_TEXT;
    case KeyType::kChoice:
      return wire::KEY_CHOICE;
    case KeyType::kVector:
      return wire::KEY_VECTOR;
    case KeyType::kFile:
      return wire::KEY_FILE;
    case KeyType::kName:
      return wire::KEY_NAME;
  }
  return wire::KEY_TEXT;
}

bool is_numeric(KeyType type) noexcept {
  return type == KeyType::kNumber || type == KeyType::kNumberOrOff || type == KeyType::kInteger ||
         type == KeyType::kVector;
}

void put(const NumberRange& range, wire::NumberRange& out) {
  out.set_min(range.min);
  out.set_max(range.max);
  out.set_min_open(range.min_open);
  out.set_max_open(range.max_open);
  out.set_minus_infinity(range.allows_minus_infinity);
}

void put(const SceneKey& key, wire::KeyInfo& out) {
  const auto text = [&](const std::optional<KeyValue>& value) {
    return value ? value_text(key, *value) : std::string();
  };
  out.set_path(key.path);
  out.set_unit(key.unit);
  out.set_default_value(text(key.default_value));
  out.set_meaning(key.meaning);
  out.set_change(wire_change(key.change));
  out.set_type(wire_type(key.type));
  if (is_numeric(key.type)) put(key.range, *out.mutable_range());
  for (const std::string& choice : key.choices) out.add_choice(choice);
  for (const KindWithKey& having : key.kinds) {
    wire::KindWithKey& kind = *out.add_kind();
    kind.set_kind(having.kind);
    kind.set_default_value(text(key.default_for(having.kind)));
  }
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

void write_state(const Session& session, wire::State& out) {
  const auto info = session.info();
  const StationView view = session.view();
  put_info(*info, out);
  out.set_time(session.now());
  out.set_safety(wire_state(view.state));
  out.set_stops(session.stops());
  out.set_held_stopped(session.held_stopped());
  // There is no station during a calibration: the fault is that of the station before it.
  if (view.fault.fault != Fault::kNone && !info->calibrating()) put(view.fault, *out.mutable_fault());
  out.set_degraded(view.degraded);
  out.set_device_state(device_state_name(view.device));
  out.set_estop(view.estop);
  write_link(view.link, *out.mutable_link());
  write_loop(session.deadlines(), *out.mutable_loop());
  if (info->source == HandSource::kSliders)
    for (const double angle : session.sliders()) out.add_slider(static_cast<float>(angle));
}

void write_participants(const Participants& participants, double now, wire::State& out) {
  if (const Participant* participant = participants.current_operator(now)) {
    out.set_operator_page(participant->number);
    out.set_operator_name(participant->name);
  }
  out.set_pages(static_cast<std::uint32_t>(participants.count()));
}

void write_choices(wire::Welcome& out) {
  for (const SceneKey& key : scene_keys()) put(key, *out.add_key());
  for (const SceneInfo& scene : list_scenes()) {
    if (!scene.readable || !scene.touches) continue;
    wire::SceneChoice& choice = *out.add_scene();
    choice.set_name(scene.name);
    choice.set_meaning(scene.description);
    choice.set_purpose(scene_purpose_names()[static_cast<std::size_t>(scene.purpose)]);
    choice.set_object_kind(scene.object_kind);
    if (scene.grasp) choice.set_grasp(std::string(grasp_rule(*scene.grasp).name));
  }
  put_names(data_folder() / "assets/profiles", *out.mutable_profile());
}

}  // namespace phalanx

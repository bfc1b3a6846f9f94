// SPDX-License-Identifier: Apache-2.0
#include "record/recording/setup_message.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>
#include <vector>

#include "phalanx/core/index.h"
#include "phalanx/scene/scene_file.h"
#include "record/plain_text.h"
#include "record/recording/view_message.h"

namespace phalanx {
namespace {

/// Calls `number(x)` for each number of a hand, in the order of Model.hand_number: for each digit base, distal, dorsal,
/// four rows a, alpha, d, theta, the coupling's three ratios, the metacarpal's base and axis; for each segment but the palm
/// length and two radii; the palm's five lengths and offset; then smallest, largest, open and closed angles. A closed angle
/// that is not stated is NaN.
template <class Hand, class Number>
void for_each_number(Hand& hand, const Number& number) {
  const auto vector = [&](auto& v) {
    for (int i = 0; i < 3; ++i) number(v[i]);
  };
  for (auto& digit : hand.digits) {
    vector(digit.base);
    vector(digit.distal);
    vector(digit.dorsal);
    for (auto& row : digit.dh) {
      number(row.a);
      number(row.alpha);
      number(row.d);
      number(row.theta);
    }
    number(digit.coupling.pronation_per_flexion);
    number(digit.coupling.pronation_per_abduction);
    number(digit.coupling.metacarpal_per_flexion);
    vector(digit.metacarpal_base);
    vector(digit.metacarpal_axis);
  }
  for (auto& segment : hand.segments) {
    number(segment.length);
    number(segment.radius_base);
    number(segment.radius_tip);
  }
  number(hand.palm.length);
  number(hand.palm.wrist_breadth);
  number(hand.palm.wrist_thickness);
  number(hand.palm.knuckle_breadth);
  number(hand.palm.knuckle_thickness);
  vector(hand.palm.offset);
  for (auto& angle : hand.min_angle) number(angle);
  for (auto& angle : hand.max_angle) number(angle);
  for (auto& angle : hand.open_angle) number(angle);
}

/// Takes numbers one after the other. @throws std::invalid_argument if there are too few
class Numbers {
 public:
  explicit Numbers(const google::protobuf::RepeatedField<double>& values, const char* what)
      : values_(values), what_(what) {}
  [[nodiscard]] double next() {
    if (at_ == values_.size())
      throw std::invalid_argument(fmt::format("the recording has only {} numbers of {}", at_, what_));
    return values_[at_++];
  }
  template <class Array>
  void fill(Array& array) {
    for (auto& value : array) value = next();
  }

 private:
  const google::protobuf::RepeatedField<double>& values_;
  const char* what_;
  int at_ = 0;
};

void write_mesh(const TriangleMesh& mesh, wire::TriangleMesh& out) {
  out.mutable_position()->Reserve(3 * static_cast<int>(mesh.vertices.size()));
  for (const Vec3& vertex : mesh.vertices)
    for (int i = 0; i < 3; ++i) out.add_position(vertex[i]);
  out.mutable_index()->Reserve(3 * static_cast<int>(mesh.triangles.size()));
  for (const auto& triangle : mesh.triangles)
    for (const auto corner : triangle) out.add_index(static_cast<std::uint32_t>(corner));
}

TriangleMesh read_mesh(const wire::TriangleMesh& from) {
  TriangleMesh mesh;
  mesh.vertices.reserve(static_cast<std::size_t>(from.position_size() / 3));
  for (int i = 0; i + 2 < from.position_size(); i += 3)
    mesh.vertices.emplace_back(from.position(i), from.position(i + 1), from.position(i + 2));
  mesh.triangles.reserve(static_cast<std::size_t>(from.index_size() / 3));
  for (int i = 0; i + 2 < from.index_size(); i += 3) {
    auto& triangle = mesh.triangles.emplace_back();
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t corner = from.index(i + k);
      if (corner >= mesh.vertices.size())
        throw std::invalid_argument(fmt::format(
            "the recording has a triangle with corner {}, and {} vertices", corner, mesh.vertices.size()));
      triangle[static_cast<std::size_t>(k)] =
          static_cast<std::remove_reference_t<decltype(triangle[0])>>(corner);
    }
  }
  return mesh;
}

void write_model(const SessionGeometry& geometry, wire::Model& out) {
  out.set_hand_name(as_utf8(geometry.hand.name));
  out.set_left(geometry.handedness == Handedness::kLeft);
  for_each_number(geometry.hand, [&](const double& value) { out.add_hand_number(value); });
  for (const auto& closed : geometry.hand.closed_angle)
    out.add_hand_number(closed.value_or(std::numeric_limits<double>::quiet_NaN()));
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) out.add_pose(geometry.X_WH.R(row, column));
  for (int i = 0; i < 3; ++i) out.add_pose(geometry.X_WH.p[i]);
  for (const TriangleMesh& mesh : geometry.segment) write_mesh(mesh, *out.add_segment());
  write_mesh(geometry.object, *out.mutable_object());
  for (const ObjectFriction& friction : geometry.friction) {
    wire::Model::Friction& to = *out.add_friction();
    to.set_first_triangle(static_cast<std::uint32_t>(friction.first_triangle));
    if (friction.coefficient) to.set_coefficient(*friction.coefficient);
  }
}

HandParameters read_hand(const wire::Model& model) {
  HandParameters hand;
  hand.name = model.hand_name();
  Numbers numbers(model.hand_number(), "the hand");
  for_each_number(hand, [&](double& value) { value = numbers.next(); });
  for (auto& closed : hand.closed_angle)
    if (const double angle = numbers.next(); !std::isnan(angle)) closed = angle;
  return hand;
}

void write_channel(const DeviceChannel& channel, wire::DeviceChannel& out) {
  out.set_kind(static_cast<std::uint32_t>(channel.kind));
  out.set_index(static_cast<std::uint32_t>(channel.index));
  out.set_raw_min(channel.raw_min);
  out.set_raw_max(channel.raw_max);
  out.set_gain(channel.gain);
  out.set_offset(channel.offset);
}

std::vector<DeviceChannel> read_channels(
    const google::protobuf::RepeatedPtrField<wire::DeviceChannel>& from) {
  if (from.size() > static_cast<int>(kMaxChannels))
    throw std::invalid_argument(
        fmt::format("the recorded device has {} channels; at most {}", from.size(), kMaxChannels));
  std::vector<DeviceChannel> channels;
  for (const wire::DeviceChannel& channel : from)
    channels.push_back({.kind = static_cast<ChannelKind>(channel.kind()),
                        .index = static_cast<int>(channel.index()),
                        .raw_min = channel.raw_min(),
                        .raw_max = channel.raw_max(),
                        .gain = channel.gain(),
                        .offset = channel.offset()});
  return channels;
}

JointFollowers read_followers(const wire::Setup& setup) {
  JointFollowers followers;
  for (const wire::Setup::Coupled& coupled : setup.coupled())
    followers.coupled.push_back({.joint = static_cast<int>(coupled.joint()),
                                 .of = static_cast<int>(coupled.of()),
                                 .ratio = coupled.ratio(),
                                 .offset = coupled.offset()});
  if (setup.copy_size() != kDigits)
    throw std::invalid_argument("the recording does not state the copied digits");
  for (int digit = 0; digit < kDigits; ++digit) {
    const wire::Setup::Copy& from = setup.copy(digit);
    DigitCopy& copy = followers.copy[idx(digit)];
    copy.of = from.of();
    copy.gain = from.gain();
    Numbers(from.way(), "a copied digit's way").fill(copy.way);
    Numbers(from.way_of(), "a copied digit's way").fill(copy.way_of);
    copy.least_share = from.least_share();
    copy.most_share = from.most_share();
  }
  return followers;
}

void write_followers(const JointFollowers& followers, wire::Setup& out) {
  for (const CoupledJoint& coupled : followers.coupled) {
    wire::Setup::Coupled& to = *out.add_coupled();
    to.set_joint(static_cast<std::uint32_t>(coupled.joint));
    to.set_of(static_cast<std::uint32_t>(coupled.of));
    to.set_ratio(coupled.ratio);
    to.set_offset(coupled.offset);
  }
  for (const DigitCopy& copy : followers.copy) {
    wire::Setup::Copy& to = *out.add_copy();
    to.set_of(copy.of);
    to.set_gain(copy.gain);
    for (const double way : copy.way) to.add_way(way);
    for (const double way : copy.way_of) to.add_way_of(way);
    to.set_least_share(copy.least_share);
    to.set_most_share(copy.most_share);
  }
}

void write_linkage(const JointLinkage& linkage, wire::Setup::Linkage& out) {
  out.set_joint(static_cast<std::uint32_t>(linkage.joint));
  out.set_min_angle(linkage.min_angle);
  out.set_max_angle(linkage.max_angle);
  for (const double c : linkage.polynomial) out.add_polynomial(c);
  for (const ArmPoint& point : linkage.table) {
    out.add_table(point.angle);
    out.add_table(point.arm);
  }
  if (!linkage.four_bar) return;
  const FourBar& bar = *linkage.four_bar;
  wire::Setup::FourBar& to = *out.mutable_four_bar();
  to.set_ground(bar.ground);
  to.set_crank(bar.crank);
  to.set_coupler(bar.coupler);
  to.set_rocker(bar.rocker);
  to.set_rocker_angle(bar.rocker_angle);
  to.set_crossed(bar.crossed);
  to.set_drum(bar.drum);
}

/// @throws std::invalid_argument if the linkage cannot be that of a motor
JointLinkage read_linkage(const wire::Setup::Linkage& from) {
  if (from.joint() >= static_cast<std::uint32_t>(kJoints))
    throw std::invalid_argument(
        fmt::format("the recording has a linkage of joint {}; at most {}", from.joint(), kJoints - 1));
  JointLinkage linkage;
  linkage.joint = static_cast<int>(from.joint());
  linkage.min_angle = from.min_angle();
  linkage.max_angle = from.max_angle();
  linkage.polynomial.assign(from.polynomial().begin(), from.polynomial().end());
  if (from.table_size() % 2 != 0)
    throw std::invalid_argument("the recording has a table of moment arms with half a point");
  for (int i = 0; i < from.table_size(); i += 2)
    linkage.table.push_back({.angle = from.table(i), .arm = from.table(i + 1)});
  if (from.has_four_bar()) {
    const wire::Setup::FourBar& bar = from.four_bar();
    linkage.four_bar = FourBar{.ground = bar.ground(),
                               .crank = bar.crank(),
                               .coupler = bar.coupler(),
                               .rocker = bar.rocker(),
                               .rocker_angle = bar.rocker_angle(),
                               .crossed = bar.crossed(),
                               .drum = bar.drum()};
  }
  check_linkage(linkage, "the recording's linkage of " + std::string(joint_name(linkage.joint)));
  return linkage;
}

/// Reads a motor. Recordings of earlier versions have no linkages: each arm is constant.
MotorWitness read_witness(const wire::Setup::Witness& from, int channels) {
  MotorWitness witness;
  witness.channel = from.channel();
  if (witness.channel < 0 || witness.channel >= channels)
    throw std::invalid_argument("the recording has a motor of a channel that there is not");
  Numbers(from.arm(), "a motor's moment arms").fill(witness.arm);
  witness.slack = from.slack();
  for (const wire::Setup::Linkage& recorded : from.linkage()) {
    JointLinkage& linkage = witness.linkages.emplace_back(read_linkage(recorded));
    witness.least_arm[idx(linkage.joint)] = least_arm(linkage);
  }
  return witness;
}

}  // namespace

void write_change(const SessionChange& change, wire::Change& out) {
  out.Clear();
  out.set_number(change.number);
  out.set_model_of(change.model_of);
  out.set_scene(as_utf8(change.scene));
  for (const auto& [key, value] : change.values) {
    wire::Setting& setting = *out.add_value();
    setting.set_key(as_utf8(key));
    setting.set_value(as_utf8(value));
  }
  if (change.geometry) write_model(*change.geometry, *out.mutable_model());
}

void write_change(const SessionChange& change, const std::string& device_spec, wire::Setup& out) {
  out.Clear();
  out.set_station(change.station);
  write_change(change, *out.mutable_start());
  const StationSetup& setup = change.setup.value();
  out.set_device_spec(as_utf8(device_spec));
  out.set_device_name(as_utf8(setup.device.name));
  out.set_device_serial(as_utf8(setup.device.serial));
  out.set_device_rate_hz(setup.device.rate_hz);
  out.set_renders_torque(setup.device.renders_torque);
  out.set_actuated(setup.device.actuated);
  out.set_simulated(setup.device.simulated);
  out.set_own_clock(setup.device.own_clock);
  if (setup.device.watchdog) out.set_watchdog(*setup.device.watchdog);
  for (const DeviceChannel& channel : setup.device.channels)
    write_channel(channel, *out.add_factory_channel());
  for (const DeviceChannel& channel : setup.channels) write_channel(channel, *out.add_channel());
  out.set_calibration(as_utf8(setup.calibration));
  out.set_range(as_utf8(setup.range));
  write_followers(setup.followers, out);
  for (const MotorWitness& witness : setup.witnesses) {
    wire::Setup::Witness& to = *out.add_witness();
    to.set_channel(witness.channel);
    for (const double arm : witness.arm) to.add_arm(arm);
    to.set_slack(witness.slack);
    for (const JointLinkage& linkage : witness.linkages) write_linkage(linkage, *to.add_linkage());
  }
  out.set_clinician(as_utf8(setup.clinician));
  out.set_patient(as_utf8(setup.patient));
  out.set_source(wire_source(setup.source));
}

void write_own_setup(const SessionGeometry& geometry, const std::string& scene, const Overrides& values,
                     wire::Setup& out) {
  out.Clear();
  out.set_station(1);
  SessionChange start;
  start.scene = scene;
  start.values = values;
  write_change(start, *out.mutable_start());
  write_model(geometry, *out.mutable_start()->mutable_model());
  out.set_device_spec("program");
  out.set_device_name("program");
  out.set_device_rate_hz(geometry.rate_hz);
  write_followers({}, out);
  out.set_source(wire_source(HandSource::kDevice));
  out.set_own_steps(true);
}

std::shared_ptr<const HapticModel> read_model(const wire::Model& model) {
  Pose X_WH;
  Numbers pose(model.pose(), "the hand's pose");
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) X_WH.R(row, column) = pose.next();
  for (int i = 0; i < 3; ++i) X_WH.p[i] = pose.next();
  if (model.segment_size() != kSegments)
    throw std::invalid_argument(fmt::format("the recording has the meshes of {} segments; a hand has {}",
                                            model.segment_size(), kSegments));
  SegmentMeshes segments;
  for (int s = 0; s < kSegments; ++s) segments[idx(s)] = read_mesh(model.segment(s));
  TriangleMesh object = read_mesh(model.object());
  std::vector<ObjectFriction> friction;
  for (const wire::Model::Friction& from : model.friction())
    friction.push_back(
        {.first_triangle = static_cast<int>(from.first_triangle()),
         .coefficient = from.has_coefficient() ? std::optional(from.coefficient()) : std::nullopt});
  const bool empty = object.triangles.empty();
  return std::make_shared<const HapticModel>(
      HandModel(read_hand(model), model.left() ? Handedness::kLeft : Handedness::kRight, X_WH,
                std::move(segments)),
      empty ? ObjectModel()
            : ObjectModel(std::move(object), ObjectModel::kDefaultCreaseAngle, std::move(friction)));
}

HapticParameters read_parameters(const wire::Change& change) {
  Overrides values;
  for (const wire::Setting& value : change.value()) values.emplace_back(value.key(), value.value());
  return SceneFile("", fmt::format("recorded scene {}", change.scene()), {}).scene(values).parameters;
}

DeviceInfo read_device(const wire::Setup& setup) {
  DeviceInfo device;
  device.name = setup.device_name();
  device.serial = setup.device_serial();
  device.rate_hz = setup.device_rate_hz();
  device.channels = read_channels(setup.factory_channel());
  device.renders_torque = setup.renders_torque();
  device.actuated = setup.actuated();
  device.simulated = setup.simulated();
  device.own_clock = setup.own_clock();
  if (setup.has_watchdog()) device.watchdog = setup.watchdog();
  return device;
}

ChannelMap read_channel_map(const wire::Setup& setup) {
  return {read_channels(setup.channel()), read_followers(setup), read_hand(setup.start().model())};
}

std::vector<MotorWitness> read_witnesses(const wire::Setup& setup) {
  std::vector<MotorWitness> witnesses;
  for (const wire::Setup::Witness& from : setup.witness())
    witnesses.push_back(read_witness(from, setup.channel_size()));
  return witnesses;
}

std::unique_ptr<StationStep> read_station(const wire::Setup& setup,
                                          const std::shared_ptr<const HapticModel>& model) {
  const HapticParameters parameters = read_parameters(setup.start());
  SafetySettings safety = make_safety_settings(parameters.limits, setup.clinician());
  safety.patient = setup.patient();
  return std::make_unique<StationStep>(std::make_unique<Rendering>(model, parameters),
                                       read_channel_map(setup), read_device(setup), safety,
                                       read_witnesses(setup), parameters.period());
}

}  // namespace phalanx

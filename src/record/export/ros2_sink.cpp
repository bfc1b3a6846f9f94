// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "phalanx/device/channel_map.h"
#include "phalanx/hand/joints.h"
#include "phalanx/record/output_file.h"
#include "phalanx/recording.pb.h"
#include "phalanx/step/snapshot.h"
#include "record/export/cdr.h"
#include "record/export/export_sink.h"
#include "record/export/segment_wrench.h"
#include "record/mcap/mcap_file.h"
#include "record/recording/recording_messages.h"
#include "record/recording/setup_message.h"
#include "record/recording/step_message.h"

namespace phalanx {
namespace {

constexpr std::size_t kChunk = 1U << 20U;  ///< [bytes]
constexpr const char* kFile = "recording_0.mcap";
constexpr const char* kWorld = "world";  ///< frame W
constexpr const char* kLine =
    "================================================================================\n";

// ---- definitions of the messages, with those that they hold: https://docs.ros2.org, packages std_msgs, sensor_msgs,
// geometry_msgs and tf2_msgs

const std::string kTimeDefinition =
    std::string(kLine) + "MSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n";
const std::string kHeaderDefinition =
    std::string(kLine) + "MSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n" +
    kTimeDefinition;
const std::string kVectorDefinition =
    std::string(kLine) + "MSG: geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z\n";

struct MessageType {
  const char* name;
  std::string definition;
};
const std::vector<MessageType>& message_types() {
  static const std::vector<MessageType> kTypes = {
      {"sensor_msgs/msg/JointState",
       "std_msgs/Header header\nstring[] name\nfloat64[] position\nfloat64[] velocity\nfloat64[] effort\n" +
           kHeaderDefinition},
      {"geometry_msgs/msg/WrenchStamped",
       "std_msgs/Header header\ngeometry_msgs/Wrench wrench\n" + std::string(kLine) +
           "MSG: geometry_msgs/Wrench\ngeometry_msgs/Vector3 force\ngeometry_msgs/Vector3 torque\n" +
           kVectorDefinition + kHeaderDefinition},
      {"tf2_msgs/msg/TFMessage",
       "geometry_msgs/TransformStamped[] transforms\n" + std::string(kLine) +
           "MSG: geometry_msgs/TransformStamped\nstd_msgs/Header header\nstring child_frame_id\n"
           "geometry_msgs/Transform transform\n" +
           std::string(kLine) +
           "MSG: geometry_msgs/Transform\ngeometry_msgs/Vector3 translation\ngeometry_msgs/Quaternion "
           "rotation\n" +
           std::string(kLine) +
           "MSG: geometry_msgs/Quaternion\nfloat64 x\nfloat64 y\nfloat64 z\nfloat64 w\n" + kVectorDefinition +
           kHeaderDefinition},
      {"std_msgs/msg/String", "string data\n"}};
  return kTypes;
}

// ---- topics

/// Part "wrench" has a topic for each segment.
enum class Part { kJointStates, kShownJointStates, kWrench, kTransforms, kEvents };
struct RosTopic {
  std::string name;
  Part part;
  std::uint16_t type;  ///< number in message_types()
};

std::vector<RosTopic> topics() {
  std::vector<RosTopic> all = {{"/joint_states", Part::kJointStates, 0},
                               {"/shown/joint_states", Part::kShownJointStates, 0},
                               {"/tf", Part::kTransforms, 2},
                               {"/events", Part::kEvents, 3}};
  for (int s = 0; s < kSegments; ++s) all.push_back({"/wrench/" + segment_label(s), Part::kWrench, 1});
  return all;
}

class Ros2Sink final : public ExportSink {
 public:
  Ros2Sink(const std::filesystem::path& folder, const ExportOptions& options)
      : folder_(folder),
        topics_(topics()),
        disk_(folder / kFile),
        writer_(disk_, schemas(), channels(), {}, "ros2") {
    for (std::size_t i = 0; i < ros2_parts().size(); ++i)
      wanted_.push_back(options.parts.empty() || std::find(options.parts.begin(), options.parts.end(),
                                                           ros2_parts()[i].name) != options.parts.end());
  }

  void add(std::string_view schema, const mcap::Message& message, double /*time*/, bool in_range) override {
    if (schema == "phalanx.wire.Setup" && parsed(message, setup_)) map_ = channel_map_of(setup_);
    if (!in_range) return;
    time_ = message.time;
    if (schema == "phalanx.wire.Step" && wants(Part::kJointStates) && parsed(message, step_)) put_step();
    if (schema == "phalanx.wire.Tick" && parsed(message, tick_)) put_tick();
    if (schema == "phalanx.wire.Event" && wants(Part::kEvents) && parsed(message, event_)) put_event();
    if (writer_.open_bytes() > kChunk) to_disk([&] { writer_.write_chunk(); });
  }

  std::vector<ExportedPart> finish() override {
    to_disk([&] { writer_.finish(); });
    write_text_file(folder_ / "metadata.yaml", description());
    std::map<Part, std::uint64_t> messages;
    for (std::size_t i = 0; i < topics_.size(); ++i)
      messages[topics_[i].part] += writer_.summary().messages.at(channel_of(i));
    std::vector<ExportedPart> parts;
    for (std::size_t p = 0; p < ros2_parts().size(); ++p)
      if (wanted_[p])
        parts.push_back(
            {.file = folder_ / kFile, .part = ros2_parts()[p].name, .rows = messages[static_cast<Part>(p)]});
    return parts;
  }

 private:
  /// Runs what writes. @throws std::runtime_error naming the file if the disk refuses
  template <class Write>
  void to_disk(const Write& write) const {
    try {
      write();
    } catch (const std::system_error& error) {
      throw std::runtime_error(
          fmt::format("{}: cannot be written ({})", (folder_ / kFile).string(), error.code().message()));
    }
  }
  static std::uint16_t channel_of(std::size_t topic) { return static_cast<std::uint16_t>(topic + 1); }
  static std::vector<mcap::Schema> schemas() {
    std::vector<mcap::Schema> all;
    for (std::size_t i = 0; i < message_types().size(); ++i)
      all.push_back({.id = static_cast<std::uint16_t>(i + 1),
                     .name = message_types()[i].name,
                     .encoding = "ros2msg",
                     .data = message_types()[i].definition});
    return all;
  }
  [[nodiscard]] std::vector<mcap::Channel> channels() const {
    std::vector<mcap::Channel> all;
    for (std::size_t i = 0; i < topics_.size(); ++i)
      all.push_back({.id = channel_of(i),
                     .schema = static_cast<std::uint16_t>(topics_[i].type + 1),
                     .topic = topics_[i].name,
                     .message_encoding = "cdr"});
    return all;
  }
  [[nodiscard]] bool wants(Part part) const { return wanted_[static_cast<std::size_t>(part)]; }

  void put_header(const std::string& frame) {
    cdr_.number(static_cast<std::int32_t>(time_ / 1'000'000'000U));
    cdr_.number(static_cast<std::uint32_t>(time_ % 1'000'000'000U));
    cdr_.text(frame);
  }
  void put_vector(const Vec3& v) { cdr_.number(v.x()).number(v.y()).number(v.z()); }
  /// @param topic  number in topics_
  void write(std::size_t topic) {
    writer_.add(channel_of(topic), time_, cdr_.bytes());
    first_ = first_ == 0 ? time_ : std::min(first_, time_);
    last_ = std::max(last_, time_);
  }

  template <class Angles, class Torques>
  void put_joints(std::size_t topic, const Angles& angles, const Torques& torques) {
    cdr_.begin();
    put_header("");
    cdr_.length(kJoints);
    for (int j = 0; j < kJoints; ++j) cdr_.text(joint_name(j));
    cdr_.length(kJoints);
    for (int j = 0; j < kJoints; ++j) cdr_.number(angles(j));
    cdr_.length(0);
    cdr_.length(torques ? kJoints : 0);
    if (torques)
      for (int j = 0; j < kJoints; ++j) cdr_.number((*torques)(j));
    write(topic);
  }

  void put_step() {
    read_samples(step_, samples_);
    if (samples_.empty() || !map_ || step_.station() != setup_.station()) return;
    map_->convert(samples_.back(), sample_);
    const std::optional torque = [this](int j) { return j < step_.torque_size() ? step_.torque(j) : 0.0; };
    put_joints(0, [this](int j) { return sample_.angle[static_cast<std::size_t>(j)]; }, torque);
  }

  void put_tick() {
    using Torques = std::optional<double (*)(int)>;
    if (wants(Part::kShownJointStates) && tick_.gdp_angle_size() == kJoints)
      put_joints(1, [this](int j) { return static_cast<double>(tick_.gdp_angle(j)); }, Torques());
    const std::optional<SegmentPoses> X_WS = shown_poses(tick_);
    if (!X_WS) return;
    if (wants(Part::kTransforms)) put_transforms(*X_WS);
    if (wants(Part::kWrench)) put_wrenches(*X_WS);
  }

  void put_transforms(const SegmentPoses& X_WS) {
    cdr_.begin();
    cdr_.length(kSegments);
    for (int s = 0; s < kSegments; ++s) {
      const Pose& X = X_WS[static_cast<std::size_t>(s)];
      const Eigen::Quaterniond q(X.R);
      put_header(kWorld);
      cdr_.text(segment_label(s));
      put_vector(X.p);
      cdr_.number(q.x()).number(q.y()).number(q.z()).number(q.w());
    }
    write(2);
  }

  /// Writes the wrenches in the segments' frames, as a WrenchStamped acts at the origin of its frame.
  void put_wrenches(const SegmentPoses& X_WS) {
    const SegmentWrenches wrenches = segment_wrenches(tick_, X_WS);
    for (int s = 0; s < kSegments; ++s) {
      const auto i = static_cast<std::size_t>(s);
      cdr_.begin();
      put_header(segment_label(s));
      put_vector(X_WS[i].R.transpose() * wrenches[i].force);
      put_vector(X_WS[i].R.transpose() * wrenches[i].moment);
      write(4 + i);
    }
  }

  void put_event() {
    cdr_.begin();
    cdr_.text(fmt::format("{}: {}{}{}", event_.code(), event_.text(), event_.who().empty() ? "" : ", by ",
                          event_.who()));
    write(3);
  }

  /// @returns metadata.yaml of rosbag2, version 5 (ROS 2 Humble)
  [[nodiscard]] std::string description() const {
    std::uint64_t messages = 0;
    std::string topics;
    for (std::size_t i = 0; i < topics_.size(); ++i) {
      const std::uint64_t count = writer_.summary().messages.at(channel_of(i));
      messages += count;
      topics += fmt::format(
          "    - topic_metadata:\n        name: {}\n        type: {}\n        serialization_format: cdr\n"
          "        offered_qos_profiles: \"\"\n      message_count: {}\n",
          topics_[i].name, message_types()[topics_[i].type].name, count);
    }
    const std::uint64_t duration = last_ - first_;
    return fmt::format(
        "rosbag2_bagfile_information:\n  version: 5\n  storage_identifier: mcap\n  duration:\n    "
        "nanoseconds: {0}\n"
        "  starting_time:\n    nanoseconds_since_epoch: {1}\n  message_count: {2}\n  "
        "topics_with_message_count:\n{3}"
        "  compression_format: \"\"\n  compression_mode: \"\"\n  relative_file_paths:\n    - {4}\n  files:\n"
        "    - path: {4}\n      starting_time:\n        nanoseconds_since_epoch: {1}\n      duration:\n"
        "        nanoseconds: {0}\n      message_count: {2}\n",
        duration, first_, messages, topics, kFile);
  }

  const std::filesystem::path folder_;
  const std::vector<RosTopic> topics_;
  mcap::DiskFile disk_;
  mcap::McapWriter writer_;
  std::vector<bool> wanted_;  ///< by Part
  std::optional<ChannelMap> map_;
  std::uint64_t time_ = 0;  ///< of the message [ns since 1970]
  std::uint64_t first_ = 0;
  std::uint64_t last_ = 0;
  Cdr cdr_;
  std::vector<DeviceSample> samples_;
  Sample sample_;
  wire::Setup setup_;
  wire::Step step_;
  wire::Tick tick_;
  wire::Event event_;
};

}  // namespace

const std::vector<ExportPart>& ros2_parts() {
  static const std::vector<ExportPart> kParts = {
      {"joint_states",
       "/joint_states: each step's measured angles, and as effort the torques that were sent"},
      {"shown", "/shown/joint_states: about 60 a second, the angles of the shown hand"},
      {"wrench", "/wrench/SEGMENT: about 60 a second, force and moment on each segment, in its frame"},
      {"tf", "/tf: about 60 a second, the frames of the shown segments in the frame world"},
      {"events", "/events: what happened, in words"}};
  return kParts;
}

std::unique_ptr<ExportSink> ros2_sink(const std::filesystem::path& folder, const ExportOptions& options) {
  return std::make_unique<Ros2Sink>(folder, options);
}

}  // namespace phalanx

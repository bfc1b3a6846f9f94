// SPDX-License-Identifier: Apache-2.0
#include "record/export/bids_format.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <nlohmann/json.hpp>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "phalanx/core/index.h"
#include "phalanx/hand/joints.h"
#include "phalanx/record/output_file.h"

namespace phalanx {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kVersion = "1.9.0";       ///< of the specification
constexpr const char* kDevice = "exoskeleton";  ///< tracking system of the device's samples
constexpr double kPosesPerSecond = 60.0;
constexpr double kBetweenClocks =
    1e-6;  ///< least time between samples of two clocks: one more in the last decimal [s]
constexpr double kLongest = 5.0;  ///< time between rows of a continuous recording, in samples
constexpr double kDegrees = 180.0 / std::numbers::pi;

bool is_label(const std::string& text) { return !text.empty() && bids_label(text) == text; }

/// @returns a field of a table: without tabs and ends of lines, "n/a" if it is empty
std::string field(const std::string& text) {
  std::string out;
  for (const char c : text) out += c == '\t' || c == '\n' || c == '\r' ? ' ' : c;
  return out.empty() ? "n/a" : out;
}

const char* words(AngleOrigin origin) {
  switch (origin) {
    case AngleOrigin::kMeasured:
      return "measured by a sensor of this joint";
    case AngleOrigin::kCompleted:
      return "computed from sensors of other joints";
    case AngleOrigin::kFixed:
      return "constant: the device has no sensor for this joint";
    case AngleOrigin::kScripted:
      return "from a scripted motion";
    case AngleOrigin::kUnknown:
      break;
  }
  return "angle of the joint";
}

/// One channel: a line of _channels.tsv, a column of _motion.tsv.
struct Channel {
  std::string name;
  const char* type;
  std::string tracked_point;
  const char* units;
  std::string description;
};

/// Paths of a data set's files.
class Layout {
 public:
  Layout(fs::path folder, const BidsLabels& labels)
      : folder_(std::move(folder)),
        subject_(fmt::format("sub-{}", labels.subject)),
        stem_(fmt::format("{}_task-{}", subject_, labels.task)) {}
  [[nodiscard]] const fs::path& folder() const noexcept { return folder_; }
  [[nodiscard]] fs::path motion_folder() const { return folder_ / subject_ / "motion"; }
  /// @returns the path of a file of one tracking system: _motion.tsv, _motion.json, _channels.tsv
  [[nodiscard]] fs::path of_system(const std::string& system, const char* ending) const {
    return motion_folder() / fmt::format("{}_tracksys-{}_{}", stem_, system, ending);
  }
  [[nodiscard]] fs::path events(const char* ending) const {
    return motion_folder() / fmt::format("{}_events.{}", stem_, ending);
  }
  [[nodiscard]] fs::path scans() const { return folder_ / subject_ / (subject_ + "_scans.tsv"); }
  [[nodiscard]] std::string in_subject(const fs::path& file) const {
    return file.lexically_relative(folder_ / subject_).generic_string();
  }

 private:
  fs::path folder_;
  std::string subject_;
  std::string stem_;
};

/// One tracking system, as its files are written.
class MotionTable final : public TableWriter {
 public:
  /// @param first     number of the row's value that is the second channel; those of the others follow it
  /// @param channels  the first is the latency
  MotionTable(const Layout& layout, std::string part, std::string system, std::size_t first,
              std::vector<Channel> channels, const BidsLabels& labels, const ExportOrigin& origin)
      : layout_(layout),
        part_(std::move(part)),
        system_(std::move(system)),
        first_(first),
        channels_(std::move(channels)),
        labels_(labels),
        origin_(origin),
        out_(layout.of_system(system_, "motion.tsv")) {}

  void add(const ExportRow& row) override {
    const double time = (system_ == kDevice ? device_time(row) : row.numbers[0]) - labels_.from;
    std::string line = fmt::format("{:.6f}", time);
    for (std::size_t c = 1; c < channels_.size(); ++c) {
      const double value = row.numbers[first_ + c - 1];
      const bool angle = std::string_view(channels_[c].type) == "JNTANG";
      line += std::isnan(value) ? "\tn/a" : fmt::format("\t{:.6f}", angle ? kDegrees * value : value);
    }
    out_.text(line + "\n");
    if (rows_ == 0) begin_ = time;
    if (rows_ > 0) longest_ = std::max(longest_, time - end_);
    end_ = time;
    ++rows_;
  }

  ExportedPart finish() override {
    out_.commit();
    write_channels();
    write_description();
    return {.file = layout_.of_system(system_, "motion.tsv"), .part = part_, .rows = rows_};
  }

 private:
  /// @returns a sample's time since the beginning of the recording, by the device's clock, since several samples may belong to one
  /// step. The first sample of a station has the time of its step; so has the first one after the clock went back [s]
  [[nodiscard]] double device_time(const ExportRow& row) {
    const double station = row.numbers[1];
    const double clock = 1e-6 * row.numbers[3];
    if (station != station_ || clock < clock_)
      offset_ = std::max(row.numbers[0], end_ + labels_.from + kBetweenClocks) - clock;
    station_ = station;
    clock_ = clock;
    return clock + offset_;
  }
  [[nodiscard]] std::size_t count(std::string_view type) const {
    std::size_t n = 0;
    for (const Channel& channel : channels_) n += channel.type == type ? 1U : 0U;
    return n;
  }
  /// @returns samples a second, as they came; 0: fewer than two
  [[nodiscard]] double effective_rate() const {
    return end_ > begin_ ? static_cast<double>(rows_ - 1) / (end_ - begin_) : 0.0;
  }
  void write_channels() const {
    std::string text = "name\tcomponent\ttype\ttracked_point\tunits\tdescription\n";
    for (const Channel& channel : channels_)
      text += fmt::format("{}\tn/a\t{}\t{}\t{}\t{}\n", channel.name, channel.type, channel.tracked_point,
                          channel.units, field(channel.description));
    write_text_file(layout_.of_system(system_, "channels.tsv"), text);
  }
  void write_description() const {
    const bool of_device = system_ == kDevice;
    const double rate = of_device ? labels_.rate_hz : kPosesPerSecond;
    const double nominal = rate > 0.0 ? 1.0 / rate : 0.0;
    Json json = {{"TaskName", labels_.task},
                 {"SamplingFrequency", rate},
                 {"SamplingFrequencyEffective", effective_rate()},
                 {"TrackingSystemName", system_},
                 {"MotionChannelCount", channels_.size()},
                 {"JNTANGChannelCount", count("JNTANG")},
                 {"LATENCYChannelCount", count("LATENCY")},
                 {"MISCChannelCount", count("MISC")},
                 {"MissingValues", "n/a"},
                 {"RecordingDuration", end_ - begin_},
                 {"RecordingType", longest_ > kLongest * nominal ? "discontinuous" : "continuous"},
                 {"SoftwareVersions", "phalanx " + origin_.version}};
    if (of_device) {
      json["ManufacturersModelName"] = field(labels_.device);
      json["DeviceSerialNumber"] = field(labels_.serial);
    }
    write_text_file(layout_.of_system(system_, "motion.json"), json.dump(2) + "\n");
  }

  const Layout& layout_;
  const std::string part_;
  const std::string system_;
  const std::size_t first_;
  const std::vector<Channel> channels_;
  const BidsLabels& labels_;
  const ExportOrigin& origin_;
  OutputFile out_;
  double station_ = -1.0;  ///< of the newest row
  double clock_ = 0.0;     ///< of the device, likewise [s]
  double offset_ = 0.0;    ///< from the device's clock to the time since the beginning of the recording [s]
  double begin_ = 0.0;
  double end_ = 0.0;
  double longest_ = 0.0;  ///< time between two rows [s]
  std::uint64_t rows_ = 0;
};

/// The events: their onset, what happened, and who did it.
class EventTable final : public TableWriter {
 public:
  EventTable(const Layout& layout, double from) : layout_(layout), from_(from), out_(layout.events("tsv")) {
    out_.text("onset\tduration\ttrial_type\tvalue\tactor\n");
  }
  void add(const ExportRow& row) override {
    out_.text(fmt::format("{:.6f}\tn/a\t{}\t{}\t{}\n", row.numbers[0] - from_, field(row.texts[0]),
                          field(row.texts[2]), field(row.texts[1])));
    ++rows_;
  }
  ExportedPart finish() override {
    out_.commit();
    const Json json = {
        {"trial_type", {{"Description", "kind of the event: marker, stopped, fault, set ..."}}},
        {"value", {{"Description", "what happened, in words; a marker's text"}}},
        {"actor", {{"Description", "who or what caused it"}}}};
    write_text_file(layout_.events("json"), json.dump(2) + "\n");
    return {.file = layout_.events("tsv"), .part = "events", .rows = rows_};
  }

 private:
  const Layout& layout_;
  const double from_;  ///< [s]
  OutputFile out_;
  std::uint64_t rows_ = 0;
};

class BidsFormat final : public TableFormat {
 public:
  BidsFormat(const fs::path& folder, ExportOrigin origin, BidsLabels labels)
      : labels_(std::move(labels)), origin_(std::move(origin)), layout_(folder, labels_) {
    fs::create_directories(layout_.motion_folder());
  }

  std::unique_ptr<TableWriter> begin(const ExportTable& table) override {
    if (table.name == "events") return std::make_unique<EventTable>(layout_, labels_.from);
    std::vector<Channel> channels = {{"latency", "LATENCY", "n/a", "s", "time since acq_time"}};
    const bool of_device = table.name == "angles";
    for (int j = 0; j < kJoints; ++j)
      channels.push_back({std::string(joint_name(j)), "JNTANG", std::string(joint_name(j)), "deg",
                          of_device ? words(labels_.origin[idx(j)])
                                    : "of the shown hand, which does not penetrate the object"});
    if (!of_device)
      for (int d = 0; d < kDigits; ++d)
        channels.push_back({fmt::format("{}_force", digit_name(d)), "MISC", std::string(digit_name(d)), "N",
                            "sum of the magnitudes of the forces on the digit, as asked of the motors"});
    const char* system = of_device ? kDevice : "shown";
    systems_.emplace_back(system);
    // angles: time, station, tick, device_time, angle; hand: time, tick, angle_measured, angle_shown, force
    const std::size_t first = of_device ? 4 : 2 + kJoints;
    return std::make_unique<MotionTable>(layout_, table.name, system, first, std::move(channels), labels_,
                                         origin_);
  }

  void finish() override {
    const fs::path& folder = layout_.folder();
    const Json description = {
        {"Name", "Phalanx recording " + origin_.name},
        {"BIDSVersion", kVersion},
        {"DatasetType", "raw"},
        {"GeneratedBy", Json::array({{{"Name", "phalanx session export"}, {"Version", origin_.version}}})}};
    write_text_file(folder / "dataset_description.json", description.dump(2) + "\n");
    write_text_file(folder / "README",
                    "Motion of a hand in an exoskeleton, its joint angles and the forces that it felt. "
                    "`exoskeleton` holds the angles that the device measured, `shown` those of the hand that "
                    "was shown, with the force on each digit.\n");
    write_text_file(folder / "participants.tsv", fmt::format("participant_id\nsub-{}\n", labels_.subject));
    const auto begin =
        static_cast<std::int64_t>(origin_.begin_utc / 1000) + std::llround(1e6 * labels_.from);  // [us]
    const auto seconds = static_cast<std::time_t>(begin / 1'000'000);
    std::string scans = "filename\tacq_time\n";
    for (const std::string& system : systems_)
      scans += fmt::format("{}\t{:%Y-%m-%dT%H:%M:%S}.{:06}Z\n",
                           layout_.in_subject(layout_.of_system(system, "motion.tsv")), fmt::gmtime(seconds),
                           begin % 1'000'000);
    write_text_file(layout_.scans(), scans);
  }

 private:
  const BidsLabels labels_;
  const ExportOrigin origin_;
  const Layout layout_;
  std::vector<std::string> systems_;
};

}  // namespace

const std::vector<ExportPart>& bids_parts() {
  static const std::vector<ExportPart> kParts = {
      {"angles", "tracking system exoskeleton: each sample's joint angles"},
      {"hand", "tracking system shown: about 60 a second, angles of the shown hand, force on each digit"},
      {"events", "what happened, with who and when"}};
  return kParts;
}

std::string bids_label(const std::string& text) {
  std::string out;
  for (const char c : text)
    if ((c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z')) out += c;
  return out.empty() ? "recording" : out;
}

std::unique_ptr<TableFormat> bids_format(const fs::path& folder, const ExportOrigin& origin,
                                         const BidsLabels& labels) {
  for (const std::string& label : {labels.subject, labels.task})
    if (!is_label(label))
      throw std::invalid_argument(fmt::format(
          "'{}' is no label of the Brain Imaging Data Structure: it has letters and digits only", label));
  return std::make_unique<BidsFormat>(folder, origin, labels);
}

}  // namespace phalanx

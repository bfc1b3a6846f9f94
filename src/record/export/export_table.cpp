// SPDX-License-Identifier: Apache-2.0
#include "record/export/export_table.h"

#include "phalanx/core/index.h"
#include "phalanx/device/device.h"
#include "phalanx/exercise/observation_table.h"
#include "phalanx/hand/joints.h"

namespace phalanx {
namespace {

/// @returns a unit as part of a name: "n_per_m"
std::string unit_in_name(const std::string& unit) {
  std::string out;
  for (const char c : unit) {
    if (c == '/') {
      out += "_per_";
    } else {
      out += static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
    }
  }
  return out;
}

std::vector<std::string> joint_labels() {
  std::vector<std::string> labels;
  for (int joint = 0; joint < kJoints; ++joint) labels.emplace_back(joint_name(joint));
  return labels;
}

std::vector<std::string> digit_labels() {
  std::vector<std::string> labels;
  for (int digit = 0; digit < kDigits; ++digit) labels.emplace_back(digit_name(digit));
  return labels;
}

/// @returns the columns of the recording, then those of an observation
std::vector<ExportColumn> columns_of_observations() {
  std::vector<ExportColumn> columns = {{.name = "time", .unit = "s"},
                                       {.name = "station"},
                                       {.name = "tick"},
                                       {.name = "host_time", .unit = "s"}};
  for (const ObservationColumn& column : observation_columns())
    columns.push_back({.name = column.name, .unit = column.unit, .labels = column.labels});
  return columns;
}

/// @returns "index_finger_tip_x", and so on, segment by segment
std::vector<std::string> segment_labels(const std::vector<std::string>& components) {
  std::vector<std::string> labels;
  for (int segment = 0; segment < kSegments; ++segment)
    for (const std::string& component : components)
      labels.push_back(segment_label(segment) + "_" + component);
  return labels;
}

std::vector<std::string> channel_labels() {
  std::vector<std::string> labels;
  for (std::size_t c = 0; c < kMaxChannels; ++c) labels.push_back(std::to_string(c));
  return labels;
}

}  // namespace

std::string segment_label(int segment) {
  std::string label(segment_name(segment));
  for (char& c : label)
    if (c == '-') c = '_';
  return label;
}

std::string ExportColumn::full_name(std::size_t i) const {
  std::string out = name;
  if (!unit.empty()) out.append("_").append(unit_in_name(unit));
  if (!labels.empty()) out.append("_").append(labels[i]);
  return out;
}

const std::vector<ExportTable>& export_tables() {
  static const std::vector<ExportTable> kTables = {
      {.name = "steps",
       .meaning = "each step: state, times, and the torques that were sent",
       .columns = {{.name = "time", .unit = "s"},
                   {.name = "station"},
                   {.name = "tick"},
                   {.name = "host_time", .unit = "s"},
                   {.name = "state"},
                   {.name = "fault"},
                   {.name = "status"},
                   {.name = "factor"},
                   {.name = "stiffness", .unit = "N/m"},
                   {.name = "lateness", .unit = "us"},
                   {.name = "duration", .unit = "us"},
                   {.name = "torque", .unit = "Nm", .labels = joint_labels()}}},
      {.name = "samples",
       .meaning = "each sample of the device, in raw counts",
       .columns = {{.name = "time", .unit = "s"},
                   {.name = "station"},
                   {.name = "tick"},
                   {.name = "sequence"},
                   {.name = "device_time", .unit = "us"},
                   {.name = "emergency_stop"},
                   {.name = "factor"},
                   {.name = "raw", .unit = "counts", .labels = channel_labels()}}},
      {.name = "angles",
       .meaning = "each sample's joint angles, as the calibration converts them",
       .columns = {{.name = "time", .unit = "s"},
                   {.name = "station"},
                   {.name = "tick"},
                   {.name = "device_time", .unit = "us"},
                   {.name = "angle", .unit = "rad", .labels = joint_labels()}}},
      {.name = "channels",
       .meaning = "what the counts mean: value = gain raw + offset, in rad, Nm, N or m",
       .columns = {{.name = "station"},
                   {.name = "channel"},
                   {.name = "kind"},
                   {.name = "index"},
                   {.name = "gain"},
                   {.name = "offset"}}},
      {.name = "hand",
       .meaning = "about 60 a second: measured and shown angles, force on each digit",
       .columns = {{.name = "time", .unit = "s"},
                   {.name = "tick"},
                   {.name = "angle_measured", .unit = "rad", .labels = joint_labels()},
                   {.name = "angle_shown", .unit = "rad", .labels = joint_labels()},
                   {.name = "force", .unit = "N", .labels = digit_labels()}}},
      {.name = "segments",
       .meaning = "about 60 a second: pose of each shown segment in the world frame, and the force on it",
       .columns = {{.name = "time", .unit = "s"},
                   {.name = "tick"},
                   {.name = "position", .unit = "m", .labels = segment_labels({"x", "y", "z"})},
                   {.name = "orientation", .labels = segment_labels({"qx", "qy", "qz", "qw"})},
                   {.name = "force", .unit = "N", .labels = segment_labels({"x", "y", "z"})},
                   {.name = "moment", .unit = "Nm", .labels = segment_labels({"x", "y", "z"})}}},
      {.name = "observations",
       .meaning = "only if named: what exercises observe at each step, made again by a replay; fault 0 none, "
                  "1 no sample, 2 fault, 3 gap, 4 not finite",
       .columns = columns_of_observations(),
       .if_named = true},
      {.name = "events",
       .meaning = "what happened, with who and when",
       .columns = {{.name = "time", .unit = "s"},
                   {.name = "code", .is_text = true},
                   {.name = "who", .is_text = true},
                   {.name = "text", .is_text = true}}}};
  return kTables;
}

}  // namespace phalanx

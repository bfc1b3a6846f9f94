// SPDX-License-Identifier: Apache-2.0
#include "phalanx/exercise/observation_table.h"

#include "phalanx/hand/joints.h"

namespace phalanx {
namespace {

/// Axes of a pad's place.
constexpr std::array<const char*, 3> kPadAxes = {"_x", "_y", "_z"};

std::vector<std::string> names_of_joints() {
  std::vector<std::string> names;
  for (int joint = 0; joint < kJoints; ++joint) names.emplace_back(joint_name(joint));
  return names;
}

std::vector<std::string> names_of_digits() {
  std::vector<std::string> names;
  for (int digit = 0; digit < kDigits; ++digit) names.emplace_back(digit_name(digit));
  return names;
}

std::vector<std::string> names_of_pads() {
  std::vector<std::string> names;
  for (int digit = 0; digit < kDigits; ++digit)
    for (const char* axis : kPadAxes) names.emplace_back(digit_name(digit)).append(axis);
  return names;
}

template <class Array>
void append_all(const Array& values, std::vector<double>& row) {
  for (const auto& value : values) row.push_back(static_cast<double>(value));
}

}  // namespace

const std::vector<ObservationColumn>& observation_columns() {
  static const std::vector<ObservationColumn> kColumns = {
      {.name = "observation_fault"},
      {.name = "sample_time", .unit = "s"},
      {.name = "torque_on"},
      {.name = "factor"},
      {.name = "angle", .unit = "rad", .labels = names_of_joints()},
      {.name = "angle_origin", .labels = names_of_joints()},
      {.name = "pad", .unit = "m", .labels = names_of_pads()},
      {.name = "force", .unit = "N", .labels = names_of_digits()},
      {.name = "measured_force", .unit = "N", .labels = names_of_digits()},
      {.name = "touching", .labels = names_of_digits()},
      {.name = "slips", .labels = names_of_digits()},
      {.name = "stiffness", .unit = "N/m"},
      {.name = "sent_stiffness", .unit = "N/m", .labels = names_of_digits()},
      {.name = "depth", .unit = "m", .labels = names_of_digits()}};
  return kColumns;
}

void append_observation(const Observation& step, std::vector<double>& row) {
  row.push_back(static_cast<double>(step.fault));
  row.push_back(step.sample_time);
  row.push_back(step.torque_on ? 1.0 : 0.0);
  row.push_back(step.factor);
  append_all(step.angle, row);
  append_all(step.angle_origin, row);
  for (const Vec3& pad : step.pad) row.insert(row.end(), {pad.x(), pad.y(), pad.z()});
  append_all(step.force, row);
  append_all(step.measured_force, row);
  append_all(step.touching, row);
  append_all(step.slips, row);
  row.push_back(step.stiffness);
  append_all(step.sent_stiffness, row);
  append_all(step.depth, row);
}

}  // namespace phalanx

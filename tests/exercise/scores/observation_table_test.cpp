// SPDX-License-Identifier: Apache-2.0
// The columns of the table of observations, and the values that stand in them.
#include "phalanx/exercise/observation_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "exercise/scores/observation_file.h"
#include "exercise/scores/observed_steps.h"

namespace phalanx::test {
namespace {

using ::testing::Contains;

TEST(ObservationTable, HasAValueForEachColumn) {
  std::size_t columns = 0;
  for (const ObservationColumn& column : observation_columns())
    columns += std::max<std::size_t>(1, column.labels.size());
  EXPECT_EQ(columns, 5U + 2U * kJoints + 9U * kDigits);
  std::vector<double> row = {7.0};
  append_observation(running_step(0.25), row);
  EXPECT_EQ(row.size(), 1 + columns) << "it appends";
  const auto names = observation_file_columns();
  for (const char* name :
       {"time_s", "host_time_s", "observation_fault", "sample_time_s", "torque_on", "factor",
        "stiffness_n_per_m", "angle_rad_ring_pip_flexion", "angle_origin_thumb_cmc_abduction",
        "pad_m_little_z", "force_n_thumb", "measured_force_n_index", "touching_ring", "slips_middle",
        "sent_stiffness_n_per_m_little"})
    EXPECT_THAT(names, Contains(name));
}

TEST(ObservationTable, EachValueStandsInItsColumn) {
  Observation step = running_step(0.25);
  step.fault = ObservationFault::kGap;
  step.sample_time = 0.125;
  step.factor = 0.75;
  step.angle[idx(joint_index(3, 2))] = 0.5;
  step.angle_origin[idx(joint_index(3, 2))] = AngleOrigin::kCompleted;
  step.pad[4] = Vec3(1.0, 2.0, 3.0);
  step.force[1] = 4.0;
  step.measured_force[2] = 5.0;
  step.touching[3] = true;
  step.slips[0] = true;
  step.stiffness = 6.0;
  step.sent_stiffness[4] = 7.0;
  step.depth[4] = 0.008;
  std::vector<double> row = {0.25, 1.0, 9.0, 0.25};
  append_observation(step, row);
  const auto names = observation_file_columns();
  ASSERT_EQ(row.size(), names.size());
  const auto value = [&](const char* name) {
    return row[static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin())];
  };
  EXPECT_EQ(value("observation_fault"), 3.0);
  EXPECT_EQ(value("sample_time_s"), 0.125);
  EXPECT_EQ(value("torque_on"), 1.0);
  EXPECT_EQ(value("factor"), 0.75);
  EXPECT_EQ(value("angle_rad_ring_pip_flexion"), 0.5);
  EXPECT_EQ(value("angle_origin_ring_pip_flexion"), 2.0);
  EXPECT_EQ(value("pad_m_little_y"), 2.0);
  EXPECT_EQ(value("force_n_index"), 4.0);
  EXPECT_EQ(value("measured_force_n_middle"), 5.0);
  EXPECT_TRUE(std::isnan(value("measured_force_n_index"))) << "there is no sensor";
  EXPECT_EQ(value("touching_ring"), 1.0);
  EXPECT_EQ(value("slips_thumb"), 1.0);
  EXPECT_EQ(value("stiffness_n_per_m"), 6.0);
  EXPECT_EQ(value("sent_stiffness_n_per_m_little"), 7.0);
  EXPECT_EQ(value("depth_m_little"), 0.008);
}

}  // namespace
}  // namespace phalanx::test

// SPDX-License-Identifier: Apache-2.0
// Recordings of programs that call step() themselves: replay() makes every step again.
#include "phalanx/record/step_recorder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <stdexcept>
#include <vector>

#include "phalanx/mesh/primitives.h"
#include "phalanx/record/recordings.h"
#include "phalanx/record/replay.h"
#include "phalanx/record/replay_visitor.h"
#include "phalanx/record/session_recorder.h"
#include "phalanx/step/haptic_step.h"
#include "record/temporary_folder.h"
#include "station/parameter_ramp.h"

namespace phalanx {
namespace {

HapticModel slab_model() {
  TriangleMesh slab;
  append(slab, make_box({0.2, 0.02, 0.3}, 100), {.p = {0.0, -0.03, -0.1}});
  return {make_hand_model(straight_hand(), Handedness::kRight, {}, 2000), ObjectModel(slab)};
}

SessionGeometry geometry_of(const HapticModel& model) {
  SessionGeometry geometry;
  geometry.handedness = model.hand.handedness();
  geometry.hand = model.hand.parameters();
  geometry.X_WH = model.hand.palm_pose();
  geometry.segment = model.hand.meshes();
  geometry.display = geometry.segment;
  geometry.object = model.object.mesh();
  geometry.rate_hz = 200.0;
  return geometry;
}

/// A finger that bends into a slab, recorded.
class StepRecordings : public ::testing::Test {
 protected:
  StepRecorder begin() {
    return {file_,
            geometry_of(model_),
            {.scene = "slab", .values = {}, .metadata = recording_metadata("0.1.0-test")}};
  }

  /// Makes step `i`. @param changed  number of the change that it begins
  void step_once(int i, std::uint64_t changed = 0) {
    sample_.time_s = 3.0 + i / 200.0;
    sample_.angle[4] = 0.6 - 0.6 * std::cos(i / 40.0);
    sample_.angle_origin[4] = AngleOrigin::kMeasured;
    ramp_.advance();
    step(model_, ramp_.parameters(), sample_, state_);
    changed_ = changed;
  }
  [[nodiscard]] OwnStep newest(const Snapshot& snapshot) const {
    return {.sample = sample_,
            .snapshot = snapshot,
            .stiffness = ramp_.parameters().force.stiffness,
            .confirmed = 0,
            .withdrawn = false,
            .changed = changed_};
  }

  const testing::TemporaryFolder folder_;
  const std::filesystem::path file_ = folder_ / "steps.mcap";
  const HapticModel model_ = slab_model();
  HapticParameters parameters_;
  ParameterRamp ramp_{parameters_};
  HapticState state_{model_, parameters_};
  Sample sample_;
  std::uint64_t changed_ = 0;
};

TEST_F(StepRecordings, AreMadeAgainToTheLastBit) {
  StepRecorder recorder = begin();
  for (int i = 0; i < 400; ++i) {
    if (i == 150) {
      recorder.change(1, {{"force.stiffness_n_per_mm", "1.5"}});
      HapticParameters stiffer = parameters_;
      stiffer.force.stiffness = 1500.0;
      ramp_.go_to(stiffer);
    }
    step_once(i, i == 150 ? 1 : 0);
    recorder.add(newest(state_.snapshot()));
  }
  recorder.event("marker", "", "done");
  recorder.finish();
  const ReplayResult result = replay(file_);
  EXPECT_EQ(result.compared, 400U);
  EXPECT_EQ(result.different, 0U) << result.first.value_or(ReplayDifference{}).what;
  EXPECT_TRUE(result.exact);
  EXPECT_EQ(ramp_.parameters().force.stiffness, 1500.0);

  const RecordingSummary summary = summarise_recording(file_);
  EXPECT_EQ(recording_state(summary), "whole");
  EXPECT_EQ(summary.steps, 400U);
  EXPECT_EQ(summary.scene, "slab");
  EXPECT_EQ(summary.device, "program");

  // Forces about 60 times a second, events, and the samples as a motion.
  const RecordingContent content = read_recording(file_);
  EXPECT_NEAR(static_cast<double>(content.forces.size()), 2.0 * 60.0, 25.0);
  double largest = 0.0;
  for (const RecordedForce& force : content.forces) largest = std::max(largest, force.force[1]);
  EXPECT_GT(largest, 0.5);
  EXPECT_EQ(content.events.back().text, "done");
  const Motion motion = recorded_motion(file_);
  ASSERT_EQ(motion.time_s.size(), 400U);
  EXPECT_EQ(motion.angle[30][4], 0.6 - 0.6 * std::cos(30 / 40.0));
  EXPECT_EQ(motion.angle_origin[4], AngleOrigin::kMeasured);
}

TEST_F(StepRecordings, ADifferentResultIsFound) {
  StepRecorder recorder = begin();
  for (int i = 0; i < 100; ++i) {
    step_once(i);
    Snapshot told = state_.snapshot();
    if (i == 60) told.torque[7] += 1e-15;
    recorder.add(newest(told));
  }
  recorder.finish();
  const ReplayResult result = replay(file_);
  EXPECT_EQ(result.compared, 100U);
  EXPECT_EQ(result.different, 1U);
  ASSERT_TRUE(result.first.has_value());
  EXPECT_EQ(result.first->tick, 61U);
}

TEST_F(StepRecordings, StepsThatWereNotAddedAreAGap) {
  StepRecorder recorder = begin();
  for (int i = 0; i < 50; ++i) {
    step_once(i);
    if (i < 20 || i >= 30) recorder.add(newest(state_.snapshot()));
  }
  recorder.finish();
  const ReplayResult result = replay(file_);
  EXPECT_EQ(result.compared, 20U);
  EXPECT_EQ(result.missing, 10U);
  EXPECT_EQ(result.not_compared, 20U);
}

TEST_F(StepRecordings, WithoutAnEndAreRepaired) {
  {
    StepRecorder recorder = begin();
    for (int i = 0; i < 200; ++i) {
      step_once(i);
      recorder.add(newest(state_.snapshot()));
    }
  }
  EXPECT_FALSE(summarise_recording(file_).has_end);
  EXPECT_TRUE(repair_recording(file_).changed);
  const ReplayResult result = replay(file_);
  EXPECT_GT(result.compared, 150U);  // all but the chunk that was open
  EXPECT_EQ(result.different, 0U);
}

TEST_F(StepRecordings, AFileThatCannotBeMadeIsRefused) {
  const auto begin_at = [&](const std::filesystem::path& file) {
    return StepRecorder(file, geometry_of(model_), {.scene = "", .values = {}, .metadata = {}});
  };
  EXPECT_THROW(begin_at(folder_ / "steps.txt"), std::invalid_argument);
  EXPECT_THROW(begin_at("/no/such/folder/steps.mcap"), std::runtime_error);
  const StepRecorder first = begin_at(file_);
  EXPECT_THROW(begin_at(file_), std::runtime_error);  // it exists
}

}  // namespace
}  // namespace phalanx

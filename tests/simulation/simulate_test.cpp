// SPDX-License-Identifier: Apache-2.0
#include "phalanx/simulation/simulate.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <memory>

#include "phalanx/scene/build_model.h"

namespace phalanx {
namespace {

TEST(TickCount, IsSecondsTimesRate) {
  EXPECT_EQ(tick_count(3.2, 200.0), 640U);
  EXPECT_EQ(tick_count(0.0, 200.0), 1U);
  EXPECT_EQ(tick_count(0.1 + 0.2, 10.0), 3U);
  EXPECT_EQ(tick_count(0.29, 100.0), 29U) << "28.999999999999996 in binary";
}

TEST(TickCount, RefusesWhatCannotBeCounted) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double rate : {0.0, -1.0, nan, std::numeric_limits<double>::infinity()}) {
    EXPECT_THROW((void)tick_count(1.0, rate), std::invalid_argument) << rate;
  }
  for (const double seconds : {-1.0, nan, 1e12})
    EXPECT_THROW((void)tick_count(seconds, 200.0), std::invalid_argument) << seconds;
}

TEST(Simulate, GivesEveryTickInOrderAndCountsThem) {
  const SceneDescription scene = load_scene("index_ball");
  const auto model = std::make_unique<HapticModel>(build_model(scene));
  const Motion motion = build_motion(scene);
  std::vector<double> times;
  std::uint64_t done = 0;
  const StepTimes step_us = simulate(*model, scene.parameters, motion, 50,
                                     {.tick =
                                          [&](const Snapshot& snapshot) {
                                            EXPECT_EQ(snapshot.hcp_angle, motion.at(snapshot.time_s));
                                            times.push_back(snapshot.time_s);
                                          },
                                      .progress =
                                          [&](std::uint64_t now, std::uint64_t total) {
                                            EXPECT_EQ(total, 50U);
                                            EXPECT_GT(now, done);
                                            done = now;
                                          }});
  ASSERT_EQ(times.size(), 50U);
  for (std::size_t i = 0; i < times.size(); ++i) EXPECT_DOUBLE_EQ(times[i], static_cast<double>(i) / 200.0);
  EXPECT_EQ(done, 50U);
  EXPECT_GT(step_us.max, 0.0);
  EXPECT_GE(step_us.max, step_us.p50);
}

TEST(Simulate, PassesTheOriginsOfTheMotion) {
  const SceneDescription scene = load_scene("index_ball");
  const auto model = std::make_unique<HapticModel>(build_model(scene));
  Motion motion = build_motion(scene);
  motion.angle_origin[7] = AngleOrigin::kCompleted;
  int ticks = 0;
  SimulationObservers observers;
  observers.tick = [&](const Snapshot& snapshot) {
    EXPECT_EQ(snapshot.angle_origin, motion.angle_origin);
    ++ticks;
  };
  simulate(*model, scene.parameters, motion, 3, observers);
  EXPECT_EQ(ticks, 3);
}

TEST(SimulateMotion, HasARowForEachStepWithTheSnapshotsBits) {
  const SceneDescription scene = load_scene("index_ball");
  const auto model = std::make_unique<HapticModel>(build_model(scene));
  const Motion motion = build_motion(scene);
  constexpr std::uint64_t kTicks = 240;
  const SimulatedMotion all = simulate_motion(*model, scene.parameters, motion, kTicks);
  ASSERT_EQ(all.time_s.size(), kTicks);
  ASSERT_EQ(all.status.size(), kTicks);
  for (const auto* angles : {&all.hcp_angle, &all.gdp_angle, &all.torque}) ASSERT_EQ(angles->size(), kTicks);
  for (const auto* segments : {&all.depth, &all.force_raw, &all.force}) ASSERT_EQ(segments->size(), kTicks);
  std::size_t row = 0;
  double largest = 0.0;
  simulate(*model, scene.parameters, motion, kTicks,
           {.tick =
                [&](const Snapshot& snapshot) {
                  ASSERT_EQ(all.time_s[row], snapshot.time_s);
                  ASSERT_EQ(all.status[row], snapshot.status);
                  ASSERT_EQ(all.hcp_angle[row], snapshot.hcp_angle);
                  ASSERT_EQ(all.gdp_angle[row], snapshot.gdp_angle);
                  ASSERT_EQ(all.torque[row], snapshot.torque);
                  for (std::size_t s = 0; s < snapshot.segment.size(); ++s) {
                    ASSERT_EQ(all.depth[row][s], snapshot.segment[s].depth);
                    ASSERT_EQ(all.force_raw[row][s], snapshot.segment[s].force_raw);
                    ASSERT_EQ(all.force[row][s], snapshot.segment[s].force);
                    largest = std::max(largest, snapshot.segment[s].force);
                  }
                  ++row;
                },
            .progress = {}});
  EXPECT_EQ(row, kTicks);
  EXPECT_GT(largest, 0.1) << "the finger must press";
}

TEST(SimulateMotion, HasOneBlockOfMemoryAnArray) {
  const SceneDescription scene = load_scene("index_ball");
  const auto model = std::make_unique<HapticModel>(build_model(scene));
  const SimulatedMotion all = simulate_motion(*model, scene.parameters, build_motion(scene), 3);
  EXPECT_EQ(all.torque.back().data(), all.torque.front().data() + std::ptrdiff_t{2 * kJoints});
  EXPECT_EQ(all.force.back().data(), all.force.front().data() + std::ptrdiff_t{2 * kSegments});
}

}  // namespace
}  // namespace phalanx

// SPDX-License-Identifier: Apache-2.0
#include "phalanx/study/simulate.h"

#include <gmock/gmock.h>

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

}  // namespace
}  // namespace phalanx

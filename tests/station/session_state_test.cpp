// SPDX-License-Identifier: Apache-2.0
#include "station/session_state.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <new>
#include <utility>
#include <vector>

#include "station/small_station.h"
#include "support/count_allocations.h"

namespace phalanx {
namespace {

using ::testing::ElementsAre;

/// A device that states its channels and never sends a sample.
class SilentDevice final : public Device {
 public:
  explicit SilentDevice(std::vector<DeviceChannel> channels) { info_.channels = std::move(channels); }
  void open() override {}
  void close() noexcept override {}
  [[nodiscard]] const DeviceInfo& info() const override { return info_; }
  [[nodiscard]] std::size_t receive(double, std::span<DeviceSample>) noexcept override { return 0; }
  void send(const DeviceCommand&) noexcept override {}
  void reset() noexcept override {}

 private:
  DeviceInfo info_;
};

class SessionStateTest : public testing::Test {
 protected:
  SessionStateTest() {
    state.change_info([](SessionInfo& info) { info.geometry = std::make_shared<SessionGeometry>(); });
  }
  void begin(std::unique_ptr<Device> device) {
    state.begin(std::make_shared<RunningStation>(test::small_station(std::move(device), clock)));
  }

  const Clock clock;
  SessionState state;
};

// The index finger's curl sets its joints 4, 6 and 7, its splay joint 5, and the last channel is joint 2. A
// force sensor says nothing of a joint.
TEST_F(SessionStateTest, TheJointsThatADeviceSensesAreInTheirOrder) {
  const auto channel = [](ChannelKind kind, int index) {
    return DeviceChannel{.kind = kind, .index = index, .raw_min = 0, .raw_max = 4095, .gain = 1.0 / 4095.0};
  };
  begin(std::make_unique<SilentDevice>(
      std::vector{channel(ChannelKind::kCurl, 1), channel(ChannelKind::kForce, 3),
                  channel(ChannelKind::kSplay, 1), channel(ChannelKind::kAngle, 2)}));
  EXPECT_THAT(state.info()->sensed_joints, ElementsAre(2, 4, 5, 6, 7));
  state.retire();
}

// A new station counts its steps from 1. The record of steps holds four: of six that were not fetched the
// last four are there, and the others are counted as lost.
TEST_F(SessionStateTest, TheRecordsOfTheLastFourStationsThatEndedAreKept) {
  for (int i = 0; i < 6; ++i) {
    begin(test::resting_device());
    state.retire();
  }
  int stations = 0;
  std::uint64_t fetched = 0;
  StepRecord record;
  std::vector<DeviceSample> samples;
  for (; state.next_record(record, samples); ++fetched) stations += record.command.tick == 1 ? 1 : 0;
  EXPECT_EQ(stations, 4);
  EXPECT_GE(state.statistics().records_lost, 2U) << "of the first two stations";
  EXPECT_EQ(fetched + state.statistics().records_lost, state.statistics().deadlines.steps);
}

TEST_F(SessionStateTest, AStationThatHasEndedIsShownAtRestWithItsDeadlines) {
  begin(test::resting_device());
  for (int i = 0; i < 1000 && !(state.view().factor > 0.0); ++i) clock.sleep_until(clock.now() + 0.005);
  const double ran = state.view().time;
  ASSERT_GT(state.view().factor, 0.0);
  state.retire();
  EXPECT_FALSE(state.info()->running);
  EXPECT_EQ(state.current(), nullptr);
  const StationView last = state.view();
  EXPECT_GE(last.time, ran);
  EXPECT_EQ(last.factor, 0.0);
  EXPECT_TRUE(last.at_rest);
  EXPECT_EQ(last.sent, JointArray{});
  EXPECT_GT(state.deadlines().steps, 0U);
  EXPECT_EQ(state.deadlines().period, 1.0 / 200.0);
  EXPECT_FALSE(state.held()) << "nobody said stop";
}

// Each allocation of a retirement fails once.
TEST_F(SessionStateTest, AStationThatCannotBeRetiredForWantOfMemoryRunsOn) {
  if (!test::kCountsNew) GTEST_SKIP() << "ThreadSanitizer has an operator new of its own";
  begin(test::resting_device());
  std::size_t number = 1;
  for (;; ++number) {
    const auto station = state.current();
    const test::FailingAllocation failing(number);
    try {
      state.retire();
      break;
    } catch (const std::bad_alloc&) {
    }
    ASSERT_TRUE(state.info()->running);
    ASSERT_EQ(state.current(), station);
    const double time = station->station->view().time;
    for (int i = 0; i < 1000 && station->station->view().time <= time; ++i)
      clock.sleep_until(clock.now() + 0.005);
    ASSERT_GT(station->station->view().time, time) << "allocation " << number;
  }
  EXPECT_GT(number, 1U) << "a retirement needs no memory";
  EXPECT_FALSE(state.info()->running);
  EXPECT_EQ(state.current(), nullptr);
}

TEST_F(SessionStateTest, ASessionIsTheSumOfItsStations) {
  std::uint64_t steps = 0;
  std::uint64_t received = 0;
  for (int i = 0; i < 3; ++i) {
    begin(test::resting_device());
    clock.sleep_until(clock.now() + 0.1);
    if (i < 2) state.retire();
    if (i == 2) state.current()->station->shut_down();
    EXPECT_GT(state.deadlines().steps, 10U);
    steps += state.deadlines().steps;
    received += state.view().link.received;
    EXPECT_EQ(state.statistics().deadlines.steps, steps);
    EXPECT_EQ(state.statistics().deadlines.lateness.count(), steps);
    EXPECT_EQ(state.statistics().link.received, received);
  }
  EXPECT_GT(received, 0U);
}

}  // namespace
}  // namespace phalanx

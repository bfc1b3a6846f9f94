// SPDX-License-Identifier: Apache-2.0
#include "station/shared_station.h"

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

class SharedStationTest : public testing::Test {
 protected:
  SharedStationTest() {
    shared.change_state([](HostState& s) { s.geometry = std::make_shared<HostGeometry>(); });
  }
  void begin(std::unique_ptr<Device> device) {
    shared.begin(std::make_shared<RunningStation>(test::small_station(std::move(device), clock)));
  }

  const Clock clock;
  SharedStation shared;
};

// The index finger's curl sets its joints 4, 6 and 7, its splay joint 5, and the last channel is joint 2. A
// force sensor says nothing of a joint.
TEST_F(SharedStationTest, TheJointsThatADeviceSensesAreInTheirOrder) {
  const auto channel = [](ChannelKind kind, int index) {
    return DeviceChannel{.kind = kind, .index = index, .raw_min = 0, .raw_max = 4095, .gain = 1.0 / 4095.0};
  };
  begin(std::make_unique<SilentDevice>(
      std::vector{channel(ChannelKind::kCurl, 1), channel(ChannelKind::kForce, 3),
                  channel(ChannelKind::kSplay, 1), channel(ChannelKind::kAngle, 2)}));
  EXPECT_THAT(shared.state()->sensed_joints, ElementsAre(2, 4, 5, 6, 7));
  shared.retire();
}

// A new station counts its steps from 1. The record of steps holds four: of six that were not fetched the
// last four are there, and the others are counted as lost.
TEST_F(SharedStationTest, TheRecordsOfTheLastFourStationsThatEndedAreKept) {
  for (int i = 0; i < 6; ++i) {
    begin(test::resting_device());
    shared.retire();
  }
  int stations = 0;
  std::uint64_t fetched = 0;
  StepRecord record;
  for (; shared.next_record(record); ++fetched) stations += record.tick == 1 ? 1 : 0;
  EXPECT_EQ(stations, 4);
  EXPECT_GE(shared.session().records_lost, 2U) << "of the first two stations";
  EXPECT_EQ(fetched + shared.session().records_lost, shared.session().deadlines.steps);
}

TEST_F(SharedStationTest, AStationThatHasEndedIsShownAtRestWithItsDeadlines) {
  begin(test::resting_device());
  for (int i = 0; i < 1000 && !(shared.view().factor > 0.0); ++i) clock.sleep_until(clock.now() + 0.005);
  const double ran = shared.view().time;
  ASSERT_GT(shared.view().factor, 0.0);
  shared.retire();
  EXPECT_FALSE(shared.state()->running);
  EXPECT_EQ(shared.current(), nullptr);
  const StationView last = shared.view();
  EXPECT_GE(last.time, ran);
  EXPECT_EQ(last.factor, 0.0);
  EXPECT_TRUE(last.at_rest);
  EXPECT_EQ(last.sent, JointArray{});
  EXPECT_GT(shared.deadlines().steps, 0U);
  EXPECT_EQ(shared.deadlines().period, 1.0 / 200.0);
  EXPECT_FALSE(shared.held()) << "nobody said stop";
}

// Each allocation of a retirement fails once.
TEST_F(SharedStationTest, AStationThatCannotBeRetiredForWantOfMemoryRunsOn) {
  if (!test::kCountsNew) GTEST_SKIP() << "ThreadSanitizer has an operator new of its own";
  begin(test::resting_device());
  std::size_t number = 1;
  for (;; ++number) {
    const auto station = shared.current();
    const test::FailingAllocation failing(number);
    try {
      shared.retire();
      break;
    } catch (const std::bad_alloc&) {
    }
    ASSERT_TRUE(shared.state()->running);
    ASSERT_EQ(shared.current(), station);
    const double time = station->station->view().time;
    for (int i = 0; i < 1000 && station->station->view().time <= time; ++i)
      clock.sleep_until(clock.now() + 0.005);
    ASSERT_GT(station->station->view().time, time) << "allocation " << number;
  }
  EXPECT_GT(number, 1U) << "a retirement needs no memory";
  EXPECT_FALSE(shared.state()->running);
  EXPECT_EQ(shared.current(), nullptr);
}

TEST_F(SharedStationTest, ASessionIsTheSumOfItsStations) {
  std::uint64_t steps = 0;
  std::uint64_t received = 0;
  for (int i = 0; i < 3; ++i) {
    begin(test::resting_device());
    clock.sleep_until(clock.now() + 0.1);
    if (i < 2) shared.retire();
    if (i == 2) shared.current()->station->shut_down();
    EXPECT_GT(shared.deadlines().steps, 10U);
    steps += shared.deadlines().steps;
    received += shared.view().link.received;
    EXPECT_EQ(shared.session().deadlines.steps, steps);
    EXPECT_EQ(shared.session().deadlines.lateness.count(), steps);
    EXPECT_EQ(shared.session().link.received, received);
  }
  EXPECT_GT(received, 0U);
}

}  // namespace
}  // namespace phalanx

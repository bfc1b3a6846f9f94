// SPDX-License-Identifier: Apache-2.0
#include "station/sample_rate_watch.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "phalanx/core/random.h"
#include "station/fake_samples.h"

namespace phalanx {
namespace {

using test::Bench;
using test::kMcp;
using ::testing::HasSubstr;

/// A device that promises 1 kHz. Its samples are made by its own clock and read by a host.
struct RateBench {
  /// One sample. @param interval  since the last one, true time [s]
  void sample(double interval, double clock_speed = 1.0, double delay = 0.0) {
    true_time += interval;
    device_time += interval * clock_speed;
    ++next.sequence;
    next.time_us = static_cast<std::uint64_t>(std::llround(1e6 * device_time));
    next.received = std::max(next.received, true_time + delay);
    watch.take(next);
    if (!watch.good() && !found) found = true_time;
  }
  void run(double seconds, double interval, double clock_speed = 1.0) {
    const double end = true_time + seconds;
    while (true_time < end) sample(interval, clock_speed);
  }

  SampleRateWatch watch{{}, 1000.0};
  DeviceSample next;
  double true_time = 0.0;
  double device_time = 3.0;
  std::optional<double> found;  ///< when it was first not good [s]
};

TEST(SampleRateWatch, APromisedRateIsGood) {
  RateBench bench;
  bench.run(10.0, 1e-3);
  EXPECT_FALSE(bench.found);
  EXPECT_NEAR(bench.watch.rates().by_device, 1000.0, 1.0);
  EXPECT_NEAR(bench.watch.rates().by_host, 1000.0, 2.0);
}

TEST(SampleRateWatch, AFifthOfTheRateIsFoundAtTheEndOfTheFirstWindow) {
  RateBench bench;
  bench.run(2.0, 5e-3);
  ASSERT_TRUE(bench.found);
  EXPECT_NEAR(*bench.found, 0.505, 6e-3);
  EXPECT_NEAR(bench.watch.rates().by_device, 200.0, 1.0);
  EXPECT_NEAR(bench.watch.rates().by_host, 200.0, 2.0);
}

// By its own clock the device keeps its promise: only the host's clock shows it, after two windows.
TEST(SampleRateWatch, ADeviceWhoseClockIsFiveTimesTooSlowIsFoundAfterTwoWindows) {
  RateBench bench;
  bench.run(2.0, 5e-3, 0.2);
  ASSERT_TRUE(bench.found);
  EXPECT_NEAR(*bench.found, 1.01, 0.02);
  EXPECT_NEAR(bench.watch.rates().by_device, 1000.0, 10.0);
  EXPECT_NEAR(bench.watch.rates().by_host, 200.0, 10.0);
}

TEST(SampleRateWatch, TheBoundIsHalfAndTwiceThePromisedRateByEachClock) {
  struct Case {
    double interval, clock_speed;
    bool good;
  };
  for (const Case& c :
       {Case{1e-3 / 0.52, 1.0, true}, Case{1e-3 / 0.48, 1.0, false}, Case{1e-3 / 1.92, 1.0, true},
        Case{1e-3 / 2.08, 1.0, false}, Case{1e-3 / 0.52, 0.52, true}, Case{1e-3 / 0.48, 0.48, false},
        Case{1e-3 / 1.92, 1.92, true}, Case{1e-3 / 2.08, 2.08, false}}) {
    RateBench bench;
    bench.run(5.0, c.interval, c.clock_speed);
    EXPECT_EQ(!bench.found, c.good) << c.interval << " s, clock " << c.clock_speed;
  }
}

// A third of the samples is lost on the way, single ones come up to 20 ms late, and the host reads nothing
// for up to 2 s at a time, while its queue keeps 270 samples. Nothing of this is the device's fault.
TEST(SampleRateWatch, LossesJitterAndAHostThatStopsReadingAreNotTheDevicesFault) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Random random(seed);
    RateBench bench;
    double blocked_until = 0.0;
    int queued = 0;
    while (bench.true_time < 60.0) {
      const double t = bench.true_time + 1e-3;
      if (t > blocked_until && random.uniform() < 0.0003) {
        blocked_until = t + 2.0 * random.uniform();
        queued = 0;
      }
      const bool kept = t > blocked_until || ++queued <= 270;
      if (!kept || random.uniform() < 0.33) {  // sent, and lost
        bench.true_time = t;
        bench.device_time += 1e-3;
        ++bench.next.sequence;
        continue;
      }
      const double jitter = random.uniform() < 0.3 ? 0.02 * random.uniform() : 0.0;
      bench.sample(1e-3, 1.0, std::max(jitter, blocked_until - t));
    }
    EXPECT_FALSE(bench.found) << "seed " << seed << ", at " << bench.found.value_or(0.0) << " s";
  }
}

TEST(SampleRateWatch, ADeviceWhoseTicksJitterByHalfAPeriodIsGood) {
  Random random(7);
  RateBench bench;
  while (bench.true_time < 30.0) bench.sample(1e-3 * (0.5 + random.uniform()));
  EXPECT_FALSE(bench.found);
}

TEST(SampleRateWatch, NumbersOrTimesThatBeginAgainBeginAWindow) {
  RateBench bench;
  bench.run(0.7, 1e-3);
  bench.next.sequence = 0;
  bench.device_time = 0.0;
  bench.run(3.0, 1e-3);
  EXPECT_FALSE(bench.found);
  bench.next.sequence = 0xffffff00U;  // and wrap around
  bench.run(3.0, 1e-3);
  EXPECT_FALSE(bench.found);
}

// ---- in the gate ----

TEST(SafetyRate, ADeviceFiveTimesSlowerThanItPromisesIsAFaultThatNamesBothRates) {
  Bench bench({}, 5e-3, Bench::info(1000.0));
  bench.snapshot.torque[kMcp] = 0.4;
  while (bench.safety.state() != SafetyState::kFault && bench.now < 5.0) bench.step();
  EXPECT_EQ(bench.safety.fault().fault, Fault::kSampleRate);
  EXPECT_LE(bench.safety.fault().time, 0.52);
  EXPECT_FALSE(bench.safety.fault().from_device);
  EXPECT_THAT(fault_words(bench.safety.fault()),
              HasSubstr("It promises 1000 Hz. It sends 200 Hz by its own clock."));
  bench.step();
  EXPECT_EQ(bench.command.torque[kMcp], 0.0) << "5 ms later";
  EXPECT_FALSE(bench.safety.reset(Fault::kNone, bench.now)) << "it is as slow as before";
  bench.steps(1000);
  EXPECT_FALSE(bench.safety.reset(Fault::kNone, bench.now));
  EXPECT_EQ(bench.command.torque[kMcp], 0.0);
}

/// A device that promises 1 kHz and ticks at 200 Hz, in a station of 200 Hz, until it is mended.
struct MendedBench {
  /// @param interval_us  between two samples by the device's clock: 5000, or 1000 if the clock is wrong
  /// @param later        steps from the fault on until the device is mended
  MendedBench(std::uint64_t interval_us, int later) : bench({}, kPeriod, Bench::info(1000.0)) {
    bench.samples.interval_us = interval_us;
    bench.snapshot.torque[kMcp] = 0.4;
    while (bench.safety.state() != SafetyState::kFault && bench.now < 5.0) bench.step();
    EXPECT_EQ(bench.safety.fault().fault, Fault::kSampleRate);
    bench.steps(later);
    EXPECT_FALSE(bench.safety.cause_gone(bench.now));
    bench.samples.interval_us = 5000;
    const double mended = bench.now;
    while (!bench.safety.cause_gone(bench.now) && bench.now < mended + 5.0) step();
    took = bench.now - mended;
  }
  void step() {
    bench.samples.sample.sequence += 4;  // 5 ticks, of which one sample is read
    bench.step();
  }

  static constexpr double kPeriod = 5e-3;
  Bench bench;
  double took = 0.0;  ///< from the mending until a reset would be granted [s]
};

// The window in which the device is mended may still be bad, and the next one is good: 1 s at most. The clock
// is judged by two windows, of which the first must be good: 1.5 s. The moments of mending fill a window.
TEST(SafetyRate, AResetIsGrantedWithinASecondOr1500MillisecondsIfTheClockWasWrong) {
  struct Case {
    std::uint64_t interval_us;
    double at_most, more_than;
  };
  for (const Case& c : {Case{5000, 1.0, 0.5}, Case{1000, 1.5, 1.0}}) {
    double longest = 0.0;
    for (int later = 0; later <= 100; ++later)
      longest = std::max(longest, MendedBench(c.interval_us, later).took);
    EXPECT_LE(longest, c.at_most + 2.0 * MendedBench::kPeriod) << c.interval_us;
    EXPECT_GT(longest, c.more_than) << c.interval_us << ": half a second less does not suffice";
  }
}

TEST(SafetyRate, AfterTheResetTheTorqueRisesOverTheStartRamp) {
  MendedBench mended(5000, 0);
  EXPECT_TRUE(mended.bench.safety.reset(Fault::kNone, mended.bench.now));
  mended.step();
  EXPECT_LE(mended.bench.command.torque[kMcp], 0.4 * MendedBench::kPeriod + 1e-12);
  for (int i = 0; i < 600; ++i) mended.step();
  EXPECT_EQ(mended.bench.safety.state(), SafetyState::kRunning);
}

// The time of a device in this process advances with the host's steps. A glove without motors promises a
// rate that the host has measured.
TEST(SafetyRate, IsJudgedForDevicesWithMotorsAndAClockOfTheirOwnOnly) {
  DeviceInfo in_process = Bench::info(1000.0);
  in_process.simulated = true;
  DeviceInfo glove = Bench::info(1000.0);
  glove.renders_torque = false;
  DeviceInfo simulated_on_a_wire = in_process;
  simulated_on_a_wire.own_clock = true;
  for (const auto& [info, judged] :
       {std::pair{in_process, false}, std::pair{glove, false}, std::pair{simulated_on_a_wire, true}}) {
    Bench bench({}, 5e-3, info);
    bench.steps(600);
    EXPECT_EQ(bench.safety.fault().fault == Fault::kSampleRate, judged);
  }
}

TEST(SafetyRate, OtherFaultsHaveNoRates) {
  FaultEvent event{.fault = Fault::kJump, .rates = {.promised = 1.0, .by_device = 2.0, .by_host = 3.0}};
  EXPECT_EQ(fault_words(event), fault_meaning(Fault::kJump));
}

}  // namespace
}  // namespace phalanx

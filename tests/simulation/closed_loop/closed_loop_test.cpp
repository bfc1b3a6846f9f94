// SPDX-License-Identifier: Apache-2.0
#include "phalanx/simulation/closed_loop/closed_loop.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "simulation/pressing_finger.h"

namespace phalanx {
namespace {

using test::kMcp;

/// What the host saw at one of its steps.
struct HostStep {
  double t = 0.0;
  double sample_time = 0.0;  ///< of the controller's tick that it used
  Status status = Status::kOk;
  double torque = 0.0;  ///< on the MCP
};
/// What the controller was asked to render at one of its ticks.
struct ControllerTick {
  double t = 0.0;
  double torque = 0.0;  ///< on the MCP
};
struct Log {
  std::vector<HostStep> host;
  std::vector<ControllerTick> controller;
};

/// MCP and PIP with viscous friction alone, and exact sensors.
Exoskeleton damped_finger(double controller_hz) {
  Exoskeleton exo = test::two_joint_device();
  for (ExoJoint& joint : exo.joints) joint.damping = 0.05;
  exo.coupled[0].offset = 0.0;
  exo.controller.rate_hz = controller_hz;
  return exo;
}

/// The patient turns the MCP at `speed` [rad/s] from the open hand, into the slab after about 0.25 rad.
Log run(double host_hz, const Exoskeleton& exo, double seconds, double phase, double speed) {
  test::Setup model = test::finger_above_slab();
  model.parameters.rate_hz = host_hz;
  SimulatedExoskeleton device(exo, test::steady_patient(), JointArray{}, JointArray{}, 1);
  Log log;
  const auto angle = [&](double t) {
    // Asked once at the start, then at the end of each tick for where the tick leads.
    if (t > 0.0) log.controller.push_back({device.time_s(), device.rendered().asked[idx(kMcp)]});
    JointArray intended{};
    intended[idx(kMcp)] = speed * t;
    return intended;
  };
  run_closed_loop(
      model, model.parameters, device, {.angle = angle, .push = {}}, seconds, phase,
      [&](double t, const Snapshot& snapshot, const SimulatedExoskeleton& exoskeleton) {
        log.host.push_back({t, exoskeleton.sample().time_s, snapshot.status, snapshot.torque[idx(kMcp)]});
      });
  return log;
}

double largest_torque(const Log& log) {
  double largest = 0.0;
  for (const HostStep& step : log.host) largest = std::max(largest, std::abs(step.torque));
  return largest;
}

TEST(ClosedLoop, StepsTheHostAtItsRateAndPhaseOnTheNewestSample) {
  for (const double host_hz : {100.0, 200.0, 333.0, 1000.0}) {
    for (const double phase : {0.0, 0.1, 0.37, 0.999}) {
      SCOPED_TRACE(::testing::Message() << host_hz << " Hz, phase " << phase);
      const Log log = run(host_hz, damped_finger(1000.0), 0.5, phase, 0.0);
      EXPECT_NEAR(static_cast<double>(log.host.size()), 0.5 * host_hz, 1.0);
      for (std::size_t n = 0; n < log.host.size(); ++n) {
        const HostStep& step = log.host[n];
        EXPECT_NEAR(step.t, (static_cast<double>(n) + phase) / host_hz, 1e-12);
        // The last tick at or before the step.
        EXPECT_NEAR(step.sample_time, 1e-3 * std::floor(1e3 * step.t + 1e-6), 1e-9) << "step " << n;
        if (host_hz < 1000.0) {
          EXPECT_FALSE(has(step.status, Status::kTimeNotIncreasing)) << "step " << n;
        }
      }
    }
  }
}

TEST(ClosedLoop, TicksTheControllerAtItsOwnRate) {
  for (const double controller_hz : {500.0, 1000.0, 2000.0}) {
    const Log log = run(200.0, damped_finger(controller_hz), 0.1, 0.3, 0.0);
    ASSERT_EQ(log.controller.size(), static_cast<std::size_t>(0.1 * controller_hz + 0.5));
    for (std::size_t n = 0; n < log.controller.size(); ++n)
      EXPECT_NEAR(log.controller[n].t, static_cast<double>(n) / controller_hz, 1e-12);
  }
}

// Four steps of the host to one sample: three of them learn nothing new and say so.
TEST(ClosedLoop, SaysThatTheSampleIsOldWhereTheHostIsFasterThanTheController) {
  const Log log = run(4000.0, damped_finger(1000.0), 0.4, 0.5, 1.0);
  ASSERT_EQ(log.host.size(), 1600U);
  int old = 0;
  for (const HostStep& step : log.host) {
    EXPECT_NEAR(step.sample_time, 1e-3 * std::floor(1e3 * step.t), 1e-9);
    EXPECT_TRUE(std::isfinite(step.torque));
    EXPECT_FALSE(has(step.status, Status::kSampleStale));
    if (has(step.status, Status::kTimeNotIncreasing)) ++old;
  }
  EXPECT_EQ(old, 1200);
  EXPECT_GT(largest_torque(log), 0.01);  // the slab was met
}

// A step at t is rendered from the first tick at or after t + compute delay + return delay, until the next
// one is.
TEST(ClosedLoop, RendersEachCommandAfterBothDelays) {
  Exoskeleton exo = damped_finger(1000.0);
  exo.controller.compute_delay = 4.5e-3;
  exo.controller.return_delay = 1e-3;
  const Log log = run(200.0, exo, 0.5, 0.3, 1.0);
  ASSERT_GT(largest_torque(log), 0.01);
  ASSERT_EQ(log.controller.size(), 500U);
  for (const ControllerTick& tick : log.controller) {
    double expected = 0.0;
    for (const HostStep& step : log.host)
      if (step.t + 5.5e-3 <= tick.t + 1e-9) expected = step.torque;
    ASSERT_EQ(tick.torque, expected) << tick.t;
  }
}

// A patient's spring alone, without friction: the finger goes where it is meant to, and the push turns it by
// torque / stiffness.
TEST(ClosedLoop, MovesTheFingerWhereItIsMeantToGoAndWhereItIsPushed) {
  test::Setup model = test::finger_above_slab();
  Exoskeleton exo = test::two_joint_device();
  exo.motors.clear();
  for (ExoJoint& joint : exo.joints) joint.damping = 0.05;
  const PatientParameters patient = test::steady_patient();
  const JointArray rest{};
  JointArray goal{};
  goal[idx(kMcp)] = 0.1;
  JointArray push{};
  push[idx(kMcp)] = 0.5;  // on 10 Nm/rad: 0.05 rad
  SimulatedExoskeleton device(exo, patient, rest, rest, 1);
  double before_push = 0.0;
  const Intention intention{.angle = [&](double t) { return t < 0.1 ? rest : goal; },
                            .push = [&](double t) { return t < 1.0 ? JointArray{} : push; }};
  run_closed_loop(model, model.parameters, device, intention, 2.0, 0.0,
                  [&](double t, const Snapshot&, const SimulatedExoskeleton& exoskeleton) {
                    if (t < 1.0) before_push = exoskeleton.plant().angle()[idx(kMcp)];
                  });
  EXPECT_NEAR(before_push, 0.1, 1e-6);
  EXPECT_NEAR(device.plant().angle()[idx(kMcp)], 0.15, 1e-6);
}

TEST(ClosedLoop, EndsWhenTheTimeIsOver) {
  EXPECT_TRUE(run(200.0, damped_finger(1000.0), 0.0, 0.0, 0.0).host.empty());
  EXPECT_LT(run(200.0, damped_finger(1000.0), 0.05, 0.0, 0.0).host.back().t, 0.05);
}

}  // namespace
}  // namespace phalanx

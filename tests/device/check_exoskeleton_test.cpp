// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "two_joint_device.h"

namespace phalanx {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

template <typename Change>
void expect_refused(Change change, const std::vector<std::string>& words) {
  Exoskeleton exo = test::two_joint_device();
  change(exo);
  try {
    check_exoskeleton(exo);
    ADD_FAILURE() << "accepted; expected a message with " << testing::PrintToString(words);
  } catch (const std::invalid_argument& error) {
    for (const std::string& word : words) EXPECT_THAT(std::string(error.what()), testing::HasSubstr(word));
  }
}

TEST(CheckExoskeleton, AcceptsADeviceThatIsWhole) {
  EXPECT_NO_THROW(check_exoskeleton(test::two_joint_device()));
}

TEST(CheckExoskeleton, RefusesJointNumbersOutOfRange) {
  for (const double bad : {0.0, -1.0, kNaN, kInf})
    expect_refused([&](Exoskeleton& e) { e.joints[0].inertia = bad; },
                   {"joint index_mcp_flexion", "inertia", "> 0"});
  for (const double bad : {-1.0, kNaN, kInf}) {
    expect_refused([&](Exoskeleton& e) { e.joints[1].damping = bad; },
                   {"joint index_pip_flexion", "damping", ">= 0"});
    expect_refused([&](Exoskeleton& e) { e.joints[0].friction.coulomb = bad; }, {"friction", ">= 0"});
    expect_refused([&](Exoskeleton& e) { e.joints[0].friction.static_ratio = bad; },
                   {"static ratio", ">= 1"});
    expect_refused([&](Exoskeleton& e) { e.joints[0].friction.stribeck_speed = bad; },
                   {"Stribeck speed", "> 0"});
    expect_refused([&](Exoskeleton& e) { e.joints[0].friction.capstan = bad; }, {"capstan", ">= 0"});
    expect_refused([&](Exoskeleton& e) { e.joints[0].sensor_lsb = bad; }, {"sensor step", ">= 0"});
    expect_refused([&](Exoskeleton& e) { e.joints[0].sensor_noise = bad; }, {"sensor noise", ">= 0"});
  }
}

TEST(CheckExoskeleton, RefusesMotorNumbersOutOfRange) {
  for (const double bad : {-1.0, kNaN, kInf}) {
    expect_refused([&](Exoskeleton& e) { e.motors[0].lag = bad; }, {"motor mcp", "lag", ">= 0"});
    expect_refused([&](Exoskeleton& e) { e.motors[0].force_limit = bad; }, {"force limit", "> 0"});
    expect_refused([&](Exoskeleton& e) { e.motors[0].bias = bad; }, {"bias", ">= 0"});
    expect_refused([&](Exoskeleton& e) { e.motors[0].force_constant = bad; }, {"force constant", "> 0"});
    expect_refused([&](Exoskeleton& e) { e.motors[1].mass = bad; }, {"motor pip", "mass", "> 0"});
    expect_refused([&](Exoskeleton& e) { e.motors[0].damping = bad; }, {"damping", ">= 0"});
    expect_refused([&](Exoskeleton& e) { e.motors[0].tendon_stiffness = bad; }, {"tendon stiffness", "> 0"});
    expect_refused([&](Exoskeleton& e) { e.motors[0].tendon_damping = bad; }, {"tendon damping", ">= 0"});
    expect_refused([&](Exoskeleton& e) { e.motors[0].backlash = bad; }, {"backlash", ">= 0"});
    expect_refused([&](Exoskeleton& e) { e.motors[0].sheath.coulomb = bad; }, {"friction", ">= 0"});
  }
  expect_refused([](Exoskeleton& e) { e.motors[0].arm[4] = kNaN; }, {"moment arm about index_mcp_flexion"});
}

TEST(CheckExoskeleton, RefusesABiasThatTheTendonCannotHold) {
  expect_refused([](Exoskeleton& e) { e.motors[0].bias = 1.0; }, {"bias = 1", "pull_only"});
  expect_refused(
      [](Exoskeleton& e) {
        e.motors[0].pull_only = true;
        e.motors[0].bias = 11.0;
      },
      {"bias = 11", "force limit of 10"});
}

TEST(CheckExoskeleton, RefusesWhatDoesNotFitTogether) {
  expect_refused([](Exoskeleton& e) { e.joints.clear(); }, {"has no joint"});
  expect_refused([](Exoskeleton& e) { e.joints.push_back(e.joints[0]); },
                 {"joint index_mcp_flexion", "twice"});
  expect_refused([](Exoskeleton& e) { e.joints[0].joint = 20; }, {"joint 20", "0 to 19"});
  expect_refused([](Exoskeleton& e) { e.motors[0].arm = {}; }, {"motor mcp", "moves no joint"});
  expect_refused([](Exoskeleton& e) { e.motors[0].arm[7] = 0.01; },
                 {"motor mcp", "index_dip_flexion", "no such joint"});
  expect_refused([](Exoskeleton& e) { e.motors[1].name = "mcp"; }, {"motor mcp", "twice"});
  for (const char* name : {"", "0", "a.b", "a b"})
    expect_refused([&](Exoskeleton& e) { e.motors[1].name = name; }, {"begins with a letter"});
  expect_refused([](Exoskeleton& e) { e.coupled[0].joint = 6; },
                 {"coupled joint index_pip_flexion", "keep one"});
  expect_refused([](Exoskeleton& e) { e.coupled.push_back(e.coupled[0]); },
                 {"coupled joint index_dip_flexion", "coupled twice; keep one"});
  expect_refused([](Exoskeleton& e) { e.coupled[0].of = 7; }, {"follows index_dip_flexion"});
  expect_refused([](Exoskeleton& e) { e.coupled[0].ratio = kNaN; }, {"ratio = nan"});
  expect_refused(
      [](Exoskeleton& e) {
        for (int m = 0; m < 31; ++m) e.motors.push_back(test::motor_on("more" + std::to_string(m), 4, 0.01));
      },
      {"has 33 motors", "at most 32"});
}

TEST(CheckExoskeleton, RefusesControllersAndCopiesThatCannotBe) {
  expect_refused([](Exoskeleton& e) { e.controller.rate_hz = 0.0; }, {"controller", "rate", "> 0"});
  expect_refused([](Exoskeleton& e) { e.controller.compute_delay = -1e-3; }, {"compute delay", ">= 0"});
  expect_refused([](Exoskeleton& e) { e.controller.return_delay = kNaN; }, {"return delay", ">= 0"});
  expect_refused([](Exoskeleton& e) { e.controller.copy[2].of = 5; }, {"middle", "of = 5"});
  expect_refused([](Exoskeleton& e) { e.controller.copy[2].of = 0; }, {"middle", "no joint of the thumb"});
  expect_refused([](Exoskeleton& e) { e.controller.copy[1].of = 1; }, {"index", "needs no copy"});
  expect_refused([](Exoskeleton& e) { e.controller.copy[2] = {.of = 1, .gain = -1.0}; },
                 {"middle", "gain", ">= 0"});
}

}  // namespace
}  // namespace phalanx

// SPDX-License-Identifier: Apache-2.0
// `phalanx device conform` against `phalanx device simulate`, two processes with a wire between them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <nlohmann/json.hpp>

#include "faults/fault_suite.h"

namespace phalanx::testing {
namespace {

using ::testing::HasSubstr;

constexpr double kAtMost = 120.0;  ///< of the held clock [s]

void expect_conforms(const std::string& test) {
  const Outcome& o = outcome(test);
  EXPECT_EQ(o.host_exit, 0) << o.host_output << o.host_errors;
  EXPECT_THAT(o.host_output, HasSubstr("The device conforms"));
  const auto report = nlohmann::json::parse(o.summary);
  EXPECT_EQ(report["failed"], 0);
  EXPECT_GT(report["passed"], 40);
  std::printf("%s: %.1f s of the held clock\n", test.c_str(), report["seconds"].get<double>());
}

const Registered kUdp("TheSimulatedDeviceConformsOverUdp", "", {.conform = true, .seconds = kAtMost});
TEST(DeviceConform, TheSimulatedDeviceConformsOverUdp) {
  expect_conforms("TheSimulatedDeviceConformsOverUdp");
}

const Registered kPty("TheSimulatedDeviceConformsOverAPseudoTerminal", "",
                      {.pty = true, .conform = true, .seconds = kAtMost});
TEST(DeviceConform, TheSimulatedDeviceConformsOverAPseudoTerminal) {
  expect_conforms("TheSimulatedDeviceConformsOverAPseudoTerminal");
}

const Registered kConformsSlowly("ASlowDeviceDoesNotConform", "",
                                 {.controller = {"--fault", "slow=5"}, .conform = true, .seconds = kAtMost});
TEST(DeviceConform, ASlowDeviceDoesNotConform) {
  const Outcome& o = outcome("ASlowDeviceDoesNotConform");
  EXPECT_EQ(o.host_exit, 1);
  EXPECT_THAT(o.host_output, HasSubstr("promised 1000 Hz; 200 Hz by its own clock"));
  EXPECT_THAT(o.host_output, HasSubstr("The device does NOT conform"));
}

}  // namespace
}  // namespace phalanx::testing

// SPDX-License-Identifier: Apache-2.0
#include "phalanx/device/fault.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

#include "phalanx/device/link/phalanx_link.h"

namespace phalanx {
namespace {

constexpr Fault kLast = Fault::kSampleRate;

bool is_known(int value) {
  return value <= PHX_FAULT_DRIVE ||
         (value >= static_cast<int>(Fault::kNoSample) && value <= static_cast<int>(kLast));
}

TEST(FaultNames, EachFaultHasItsOwnNameMeaningAndRemedy) {
  std::set<std::string> names, meanings;
  int known = 0;
  for (int value = 0; value <= static_cast<int>(kLast); ++value) {
    if (!is_known(value)) continue;
    ++known;
    const auto fault = static_cast<Fault>(value);
    EXPECT_NE(fault_name(fault), "unknown") << value;
    names.emplace(fault_name(fault));
    meanings.emplace(fault_meaning(fault));
    EXPECT_TRUE(fault_meaning(fault).ends_with('.')) << fault_meaning(fault);
    EXPECT_TRUE(fault_remedy(fault).ends_with('.')) << fault_remedy(fault);
  }
  EXPECT_EQ(static_cast<int>(names.size()), known);
  EXPECT_EQ(static_cast<int>(meanings.size()), known);
}

TEST(FaultNames, ANameIsFitForAFile) {
  for (int value = 0; value <= static_cast<int>(kLast); ++value) {
    const std::string_view name = fault_name(static_cast<Fault>(value));
    EXPECT_EQ(name.find_first_not_of("abcdefghijklmnopqrstuvwxyz_"), std::string_view::npos) << name;
  }
  EXPECT_EQ(fault_name(Fault::kStepTooOld), "step_too_old");
  EXPECT_EQ(fault_name(Fault::kControllerRestarted), "controller_restarted");
}

TEST(FaultNames, WhatADeviceOfAnotherVersionReportsIsUnknown) {
  EXPECT_EQ(fault_name(static_cast<Fault>(42)), "unknown");
  EXPECT_EQ(fault_name(static_cast<Fault>(65535)), "unknown");
}

}  // namespace
}  // namespace phalanx

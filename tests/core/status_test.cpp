// SPDX-License-Identifier: Apache-2.0
#include "phalanx/core/status.h"

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <utility>

namespace phalanx {
namespace {

constexpr std::array<std::pair<Status, std::string_view>, 14> kBits = {{
    {Status::kSampleNotFinite, "sample_not_finite"},
    {Status::kSampleOutOfRange, "sample_out_of_range"},
    {Status::kSampleJump, "sample_jump"},
    {Status::kTimeNotIncreasing, "time_not_increasing"},
    {Status::kStartInside, "start_inside"},
    {Status::kSlid, "slid"},
    {Status::kSearchExhausted, "search_exhausted"},
    {Status::kForceLimited, "force_limited"},
    {Status::kTorqueLimited, "torque_limited"},
    {Status::kTorqueRateLimited, "torque_rate_limited"},
    {Status::kCommandNotFinite, "command_not_finite"},
    {Status::kTrajectoryExhausted, "trajectory_exhausted"},
    {Status::kSampleStale, "sample_stale"},
    {Status::kOscillating, "oscillating"},
}};

// Recordings hold the bits as one number: none changes its place.
TEST(Status, EachConditionHasItsBitAndItsName) {
  EXPECT_EQ(static_cast<std::uint32_t>(Status::kOk), 0U);
  EXPECT_EQ(kStatusBits, 14);
  std::uint32_t bit = 1;
  for (std::size_t i = 0; i < kBits.size(); ++i, bit *= 2) {
    EXPECT_EQ(static_cast<std::uint32_t>(kBits[i].first), bit) << i;
    EXPECT_EQ(status_name(static_cast<int>(i)), kBits[i].second);
  }
}

TEST(Status, HasABitIfAnyOfThoseAskedForIsSet) {
  Status status = Status::kSampleNotFinite | Status::kSlid;
  EXPECT_EQ(static_cast<std::uint32_t>(status), 33U);
  EXPECT_TRUE(has(status, Status::kSlid));
  EXPECT_TRUE(has(status, Status::kSampleNotFinite));
  EXPECT_TRUE(has(status, Status::kSlid | Status::kOscillating));
  EXPECT_FALSE(has(status, Status::kSampleJump));
  EXPECT_FALSE(has(Status::kOk, Status::kSampleNotFinite));
  status |= Status::kSampleJump;
  EXPECT_EQ(static_cast<std::uint32_t>(status), 37U);
}

}  // namespace
}  // namespace phalanx

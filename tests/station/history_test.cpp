// SPDX-License-Identifier: Apache-2.0
#include "station/history.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace phalanx {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

TEST(History, HoldsTheNewestOldestFirst) {
  History<int> history(3);
  EXPECT_EQ(history.size(), 0U);
  EXPECT_THAT(history.all(), IsEmpty());
  history.push(1);
  history.push(2);
  EXPECT_EQ(history.size(), 2U);
  EXPECT_THAT(history.all(), ElementsAre(1, 2));
  for (int i = 3; i <= 8; ++i) history.push(i);
  EXPECT_EQ(history.size(), 3U);
  EXPECT_THAT(history.all(), ElementsAre(6, 7, 8));
  history.clear();
  EXPECT_EQ(history.size(), 0U);
  EXPECT_THAT(history.all(), IsEmpty());
  history.push(9);
  EXPECT_THAT(history.all(), ElementsAre(9));
}

TEST(History, HasRoomForOneAtLeast) {
  History<int> history(0);
  history.push(1);
  history.push(2);
  EXPECT_THAT(history.all(), ElementsAre(2));
}

}  // namespace
}  // namespace phalanx

// SPDX-License-Identifier: Apache-2.0
#include "phalanx/core/latest.h"

#include <gtest/gtest.h>

namespace phalanx {
namespace {

// In any order of writes and reads the reader sees the value of its last update, and no newer one.
TEST(Latest, TheReaderKeepsItsValueUntilItAsksForTheNewest) {
  Latest<int> latest(-1);
  EXPECT_FALSE(latest.update());
  EXPECT_EQ(latest.value(), -1);
  int written = 0;
  int seen = -1;
  for (const int writes : {1, 1, 2, 1, 3, 2, 1}) {
    for (int i = 0; i < writes; ++i) {
      latest.write(++written);
      EXPECT_EQ(latest.value(), seen) << "after " << written << " values";
    }
    EXPECT_TRUE(latest.update());
    seen = written;
    EXPECT_EQ(latest.value(), seen);
    EXPECT_FALSE(latest.update()) << "nothing has come since";
    EXPECT_EQ(latest.value(), seen);
  }
}

}  // namespace
}  // namespace phalanx

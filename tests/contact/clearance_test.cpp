// SPDX-License-Identifier: Apache-2.0
// What is known of a distance without asking. It decides how much is searched, never what is found.
#include "phalanx/contact/clearance.h"

#include <gtest/gtest.h>

namespace phalanx {
namespace {

TEST(Clearance, IsTheLargestBoundThatWasLearnedLessWhatWasMoved) {
  Clearance known;
  EXPECT_EQ(known.bound(), 0.0) << "nothing is known";
  known.learn(0.5, true);
  known.spend(0.125);
  EXPECT_EQ(known.bound(), 0.375);
  known.learn(0.25, true);
  EXPECT_EQ(known.bound(), 0.375) << "both bounds hold";
  known.learn(0.5, false);
  EXPECT_EQ(known.bound(), 0.5);
  known.spend(0.75);
  EXPECT_EQ(known.bound(), 0.0) << "a distance is not negative";
}

TEST(Clearance, IsNotAskedForThreeTurnsAfterAnAnswerThatSparedNothing) {
  Clearance known;
  EXPECT_TRUE(known.worth_asking());
  known.learn(0.5, true);
  EXPECT_TRUE(known.worth_asking());
  known.learn(0.5, false);
  for (int turn = 0; turn < 3; ++turn) EXPECT_FALSE(known.worth_asking()) << turn;
  EXPECT_TRUE(known.worth_asking());
  EXPECT_TRUE(known.worth_asking());
}

}  // namespace
}  // namespace phalanx

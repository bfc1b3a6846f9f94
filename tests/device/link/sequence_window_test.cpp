// SPDX-License-Identifier: Apache-2.0
#include "phalanx/device/link/sequence_window.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace phalanx {
namespace {

using Frame = SequenceWindow::Frame;

TEST(SequenceWindow, ANumberIsLostOnlyWhenItCannotComeAnyMore) {
  SequenceWindow window;
  EXPECT_EQ(window.take(1), Frame::kNew);
  EXPECT_EQ(window.take(4), Frame::kNew);
  EXPECT_EQ(window.missing(), 2u);
  EXPECT_EQ(window.take(3), Frame::kLate);
  EXPECT_EQ(window.take(3), Frame::kDuplicate);
  EXPECT_EQ(window.take(4), Frame::kDuplicate);
  for (std::uint32_t i = 5; i <= 65; ++i) EXPECT_EQ(window.take(i), Frame::kNew);
  EXPECT_EQ(window.lost(), 0u);
  EXPECT_EQ(window.take(66), Frame::kNew);  // 2 leaves the window
  EXPECT_EQ(window.lost(), 1u);
  EXPECT_EQ(window.take(2), Frame::kDuplicate);
  EXPECT_EQ(window.missing(), 0u);
}

TEST(SequenceWindow, CountsAGapThatIsLongerThanTheWindow) {
  SequenceWindow window;
  window.take(10);
  window.take(1010);  // 11 .. 1009 have not come
  EXPECT_EQ(window.lost() + window.missing(), 999u);
}

TEST(SequenceWindow, CountsAGapThatIsJustAsLongAsTheWindow) {
  SequenceWindow window;
  window.take(1);
  window.take(65);  // 2 .. 64 have not come
  EXPECT_EQ(window.lost() + window.missing(), 63u);
}

TEST(SequenceWindow, NumbersWrapAround) {
  SequenceWindow window;
  EXPECT_EQ(window.take(0xfffffffeu), Frame::kNew);
  EXPECT_EQ(window.take(1), Frame::kNew);
  EXPECT_EQ(window.take(0xffffffffu), Frame::kLate);
  EXPECT_EQ(window.missing(), 1u);
}

// Any order within the window, any losses: every number is counted once.
TEST(SequenceWindow, AgreesWithACountByHandOnRandomStreams) {
  constexpr std::uint64_t kSeed = 20260701;
  SCOPED_TRACE(testing::Message() << "seed " << kSeed);
  std::mt19937_64 random(kSeed);
  for (int trial = 0; trial < 200; ++trial) {
    const std::size_t numbers = 500;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> stream;  // when, which
    std::vector<bool> sent(numbers + 1, false);
    for (std::uint32_t i = 1; i <= numbers; ++i) {
      const std::uint64_t copies = i == 1 || i == numbers ? 1 : random() % 4;  // 0 .. 3
      for (std::uint64_t c = 0; c < copies; ++c) {
        const auto delay = i == 1 || i == numbers ? 0u : static_cast<std::uint32_t>(random() % 30);
        stream.emplace_back(i + delay, i);
        sent[i] = true;
      }
    }
    std::sort(stream.begin(), stream.end());
    SequenceWindow window;
    std::vector<int> taken(numbers + 1, 0);
    std::size_t duplicates = 0;
    for (const auto& [when, which] : stream) {
      const Frame frame = window.take(which);
      if (frame == Frame::kDuplicate) {
        ++duplicates;
      } else {
        ++taken[which];
      }
    }
    const auto never = static_cast<std::uint64_t>(std::count(sent.begin() + 1, sent.end(), false));
    EXPECT_EQ(window.lost() + window.missing(), never);
    for (std::size_t i = 1; i <= numbers; ++i) ASSERT_EQ(taken[i], sent[i] ? 1 : 0) << i;
    EXPECT_EQ(duplicates + numbers - never, stream.size());
  }
}

}  // namespace
}  // namespace phalanx

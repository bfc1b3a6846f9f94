// SPDX-License-Identifier: Apache-2.0
#include "phalanx/device/sample_queue.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <thread>

namespace phalanx {
namespace {

DeviceSample numbered(std::uint32_t sequence) {
  DeviceSample sample;
  sample.sequence = sequence;
  sample.raw.fill(static_cast<std::int32_t>(sequence));
  return sample;
}

TEST(SampleQueue, GivesTheNewestThatFitOldestFirst) {
  const auto queue = std::make_unique<SampleQueue>();
  for (std::uint32_t i = 1; i <= 10; ++i) ASSERT_TRUE(queue->push(numbered(i)));
  std::array<DeviceSample, 4> out{};
  const auto taken = queue->take(out);
  EXPECT_EQ(taken.count, 4u);
  EXPECT_EQ(taken.dropped, 6u);
  for (std::uint32_t i = 0; i < 4; ++i) EXPECT_EQ(out[i].sequence, 7 + i);
  EXPECT_EQ(queue->take(out).count, 0u);
}

TEST(SampleQueue, TakesNoMoreThanItHolds) {
  const auto queue = std::make_unique<SampleQueue>();
  for (std::uint32_t i = 0; i < SampleQueue::kCapacity; ++i) ASSERT_TRUE(queue->push(numbered(i)));
  EXPECT_FALSE(queue->push(numbered(9999)));
  std::array<DeviceSample, 1> out{};
  EXPECT_EQ(queue->take(out).dropped, SampleQueue::kCapacity - 1);
  EXPECT_EQ(out[0].sequence, SampleQueue::kCapacity - 1);
  EXPECT_TRUE(queue->push(numbered(9999)));
}

// Two threads: in order, whole, none twice.
TEST(SampleQueue, CarriesSamplesFromOneThreadToAnother) {
  constexpr std::uint32_t kSamples = 20000;
  const auto queue = std::make_unique<SampleQueue>();
  std::thread writer([&] {
    for (std::uint32_t i = 1; i <= kSamples;) {
      if (queue->push(numbered(i))) {
        ++i;
      } else {
        std::this_thread::yield();
      }
    }
  });
  std::uint32_t expected = 1;
  std::size_t wrong = 0;
  std::array<DeviceSample, SampleQueue::kCapacity> out{};
  while (expected <= kSamples) {
    const auto taken = queue->take(out);
    wrong += taken.dropped;
    for (std::size_t i = 0; i < taken.count; ++i, ++expected) {
      const DeviceSample& sample = out[i];
      const auto same = [&](std::int32_t raw) { return raw == static_cast<std::int32_t>(expected); };
      if (sample.sequence != expected || !std::all_of(sample.raw.begin(), sample.raw.end(), same)) ++wrong;
    }
    if (taken.count == 0) std::this_thread::yield();
  }
  writer.join();
  EXPECT_EQ(wrong, 0u);
}

}  // namespace
}  // namespace phalanx

// SPDX-License-Identifier: Apache-2.0
// The counter itself, on which every "allocates nothing" rests: each way of allocating counts exactly once.
#include "support/count_allocations.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <new>
#include <thread>

namespace phalanx::test {
namespace {

/// Where the compiler must suppose that somebody looks.
void* volatile seen = nullptr;

template <class Allocate>
std::size_t counted(Allocate allocate) {
  const std::size_t before = allocations_of_this_thread();
  seen = allocate();
  return allocations_of_this_thread() - before;
}

TEST(CountAllocations, SeesEveryFormOfNewOnce) {
  if (!kCountsNew) GTEST_SKIP() << "ThreadSanitizer's operator new is not counted";
  EXPECT_EQ(counted([] { return ::operator new(8); }), 1U);
  ::operator delete(seen);
  EXPECT_EQ(counted([] { return ::operator new[](8); }), 1U);
  ::operator delete[](seen);
  EXPECT_EQ(counted([] { return ::operator new(8, std::nothrow); }), 1U);
  ::operator delete(seen, std::nothrow);
  EXPECT_EQ(counted([] { return ::operator new(8, std::align_val_t{64}); }), 1U);
  ::operator delete(seen, std::align_val_t{64});
  EXPECT_EQ(counted([] { return ::operator new[](8, std::align_val_t{64}, std::nothrow); }), 1U);
  ::operator delete[](seen, std::align_val_t{64}, std::nothrow);
}

TEST(CountAllocations, SeesEveryFormOfMallocOnce) {
  EXPECT_EQ(counted([] { return std::malloc(8); }), 1U);
  EXPECT_EQ(counted([] { return std::realloc(seen, 16); }), 1U);
  std::free(seen);
  EXPECT_EQ(counted([] { return std::calloc(2, 8); }), 1U);
  std::free(seen);
  EXPECT_EQ(counted([] { return std::aligned_alloc(64, 64); }), 1U);
  std::free(seen);
  EXPECT_EQ(counted([] {
              void* p = nullptr;
              return posix_memalign(&p, 64, 64) == 0 ? p : nullptr;
            }),
            1U);
  std::free(seen);
}

TEST(CountAllocations, TellsThreadsApart) {
  std::size_t theirs = 0;
  const std::size_t all_before = allocations();
  std::size_t mine_before = 0;
  std::size_t mine_after = 0;
  {
    std::thread other([&theirs] { theirs = counted([] { return std::malloc(8); }); });
    mine_before = allocations_of_this_thread();
    other.join();
    mine_after = allocations_of_this_thread();
  }
  std::free(seen);
  EXPECT_EQ(theirs, 1U);
  EXPECT_EQ(mine_after, mine_before);
  EXPECT_GE(allocations() - all_before, 1U);
}

TEST(FailingAllocation, FailsOnce) {
  const FailingAllocation failing(2);
  void* const first = std::malloc(8);
  void* const second = std::malloc(8);
  void* const third = std::malloc(8);
  EXPECT_NE(first, nullptr);
  EXPECT_EQ(second, nullptr);
  EXPECT_NE(third, nullptr);
  std::free(first);
  std::free(third);
}

TEST(FailingAllocation, MakesNewThrow) {
  if (!kCountsNew) GTEST_SKIP() << "ThreadSanitizer's operator new does not fail";
  bool thrown = false;
  {
    const FailingAllocation failing(1);
    try {
      seen = ::operator new(8);
    } catch (const std::bad_alloc&) {
      thrown = true;
    }
  }
  EXPECT_TRUE(thrown);
}

}  // namespace
}  // namespace phalanx::test

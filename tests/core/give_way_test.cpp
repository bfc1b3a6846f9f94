// SPDX-License-Identifier: Apache-2.0
#include "phalanx/core/give_way.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <thread>

namespace phalanx {
namespace {

// In a thread of its own, because the change cannot be undone. Where the system refuses it, nothing changes.
TEST(GiveWay, MakesTheThreadOrdinaryAndNiceAndNamesIt) {
  for (const int nicer : {0, 11}) {
    std::thread([&] {
      const auto self = static_cast<id_t>(::syscall(SYS_gettid));
      const sched_param ordinary{};
      ::sched_setscheduler(0, SCHED_BATCH, &ordinary);
      if (nicer > 0) ::setpriority(PRIO_PROCESS, self, nicer);
      const int before = ::getpriority(PRIO_PROCESS, self);
      give_way("beside");
      EXPECT_EQ(::getpriority(PRIO_PROCESS, self), std::max(5, before));
      EXPECT_EQ(::sched_getscheduler(0), SCHED_OTHER);
      std::array<char, 16> name{};
      ::pthread_getname_np(::pthread_self(), name.data(), name.size());
      EXPECT_STREQ(name.data(), "beside");
    }).join();
  }
}

}  // namespace
}  // namespace phalanx

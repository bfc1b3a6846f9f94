// SPDX-License-Identifier: Apache-2.0
// Every case runs in a child process, which is left with what it was granted, or in a thread of one.
#include "phalanx/station/realtime.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/utsname.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <functional>
#include <sstream>
#include <string>
#include <thread>

#include "support/count_allocations.h"
#include "support/sanitized.h"

namespace phalanx {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

// Sanitizers turn locking into nothing and reserve terabytes of address space.
using test::kSanitized;

/// What `body` writes in a child process. Fails the test if the child does not end well.
std::string in_child(const std::function<void(std::ostream&)>& body) {
  int ends[2];
  if (pipe(ends) != 0) return "no pipe";
  const pid_t child = fork();
  if (child == 0) {
    const sched_param ordinary{};
    sched_setscheduler(0, SCHED_OTHER, &ordinary);  // the test program itself may have real-time priority
    close(ends[0]);
    std::ostringstream text;
    body(text);
    const std::string all = text.str();
    const bool written = write(ends[1], all.data(), all.size()) == static_cast<ssize_t>(all.size());
    _exit(written ? 0 : 3);
  }
  close(ends[1]);
  std::string text;
  char part[512];
  for (ssize_t n = 0; (n = read(ends[0], part, sizeof part)) > 0;)
    text.append(part, static_cast<std::size_t>(n));
  close(ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << "the child ended with status " << status;
  return text;
}

void print(const RealtimeGrant& grant, std::ostream& out) {
  out << describe(grant) << '\n';
  for (const std::string& line : grant.missing) out << "missing: " << line << '\n';
}

/// An ordinary user whose limits allow no real-time priority and `memlock` bytes. @returns whether it worked
bool become_ordinary(rlim_t memlock) {
  const rlimit none{0, 0};
  const rlimit memory{memlock, memlock};
  if (setrlimit(RLIMIT_RTPRIO, &none) != 0 || setrlimit(RLIMIT_MEMLOCK, &memory) != 0) return false;
  constexpr uid_t kNobody = 65534;
  return geteuid() != 0 || setresuid(kNobody, kNobody, kNobody) == 0;
}

/// Of /proc/self/status [KiB]
std::uint64_t status_kib(const std::string& key) {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;)
    if (word == key + ":") {
      std::uint64_t kib = 0;
      status >> kib;
      return kib;
    }
  return 0;
}

/// The number behind these words; 0: they are not there.
std::uint64_t number_after(const std::string& text, const std::string& words) {
  const std::size_t at = text.find(words);
  return at == std::string::npos ? 0 : std::stoull(text.substr(at + words.size()));
}

/// Whether no limit binds this process: it locks a page under a limit of none.
bool locks_beyond_limits() {
  rlimit before{};
  getrlimit(RLIMIT_MEMLOCK, &before);
  const rlimit none{0, before.rlim_max};
  alignas(4096) static char page[4096];
  const bool may = setrlimit(RLIMIT_MEMLOCK, &none) == 0 && mlock(page, sizeof page) == 0;
  munlock(page, sizeof page);
  setrlimit(RLIMIT_MEMLOCK, &before);
  return may;
}

/// Whether 64 more MiB can be had and written, in blocks that malloc takes from the system one by one.
bool can_still_allocate() {
  for (int i = 0; i < 64; ++i) {
    constexpr std::size_t kSize = 1U << 20U;
    void* p = mmap(nullptr, kSize, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (p == MAP_FAILED) return false;
    static_cast<volatile char*>(p)[0] = 1;
  }
  return true;
}

TEST(Realtime, SaysWhatAnOrdinaryUserIsNotGrantedAndHowToAllowIt) {
  rlimit own{};
  ASSERT_EQ(getrlimit(RLIMIT_MEMLOCK, &own), 0);
  const rlim_t memlock = std::min<rlim_t>(own.rlim_max, 4U << 20U);  // less than the room that must stay
  const std::string text = in_child([memlock](std::ostream& out) {
    if (!become_ordinary(memlock)) return;
    print(make_realtime({.priority = 80, .cpu = -1, .lock_memory = true}), out);
    out << "own size " << (status_kib("VmSize") >> 10U) << '\n';
    out << "slack " << prctl(PR_GET_TIMERSLACK) << '\n';
    out << "policy " << sched_getscheduler(0) << '\n';
    out << "allocates " << can_still_allocate() << '\n';
  });
  if (text.empty()) GTEST_SKIP() << "this user may not become an ordinary one";
  EXPECT_THAT(text, HasSubstr("SCHED_OTHER, memory "));
  EXPECT_THAT(text, HasSubstr("missing: SCHED_FIFO 80 was refused (Operation not permitted)"));
  EXPECT_THAT(text, HasSubstr("`rtprio` for the group `realtime`"));
  if (!kSanitized) {
    EXPECT_THAT(text, HasSubstr("memory not locked, any CPU, kernel "));
    EXPECT_THAT(text, HasSubstr("missing: memory is not locked (the process has "));
    EXPECT_NEAR(static_cast<double>(number_after(text, "the process has ")),
                static_cast<double>(number_after(text, "own size ")), 8.0);
    EXPECT_THAT(text, HasSubstr(" MiB and needs 16 more to grow, the limit is " +
                                std::to_string(memlock >> 20U) + " MiB)"));
    EXPECT_THAT(text, HasSubstr("`memlock unlimited` for the group `realtime`"));
  }
  EXPECT_THAT(text, HasSubstr("docs/realtime.md"));
  EXPECT_THAT(text, HasSubstr("slack 1\n"));
  EXPECT_THAT(text, HasSubstr("policy 0\n"));
  EXPECT_THAT(text, HasSubstr("allocates 1\n"));
}

// The limit has room for what the process has now, but not for the 64 MiB that it takes afterwards.
TEST(Realtime, LocksOnlyWhatThereIsUnderALimitSoThatLaterAllocationsWork) {
  if (kSanitized) GTEST_SKIP() << "a sanitizer reserves more address space than any limit";
  const std::string text = in_child([](std::ostream& out) {
    const std::uint64_t limit = (status_kib("VmSize") << 10U) + (24U << 20U);
    if (!become_ordinary(limit)) return;
    print(make_realtime({}), out);
    out << "own limit " << (limit >> 20U) << '\n';
    out << "locks something " << (status_kib("VmLck") > 0) << '\n';
    out << "allocates " << can_still_allocate() << '\n';
  });
  if (text.empty())
    GTEST_SKIP() << "the hard limit on locked memory is too low here to be set to what this needs";
  EXPECT_THAT(text, HasSubstr("memory locked"));
  EXPECT_THAT(text, HasSubstr("missing: memory allocated from now on is not locked (the limit is "));
  EXPECT_EQ(number_after(text, "(the limit is "), number_after(text, "own limit "));
  EXPECT_THAT(text, HasSubstr("locks something 1\n"));
  EXPECT_THAT(text, HasSubstr("allocates 1\n"));
}

// With whatever rights the tests run: what is said is what the kernel says.
constexpr std::uint64_t kMiB = 1U << 20U;

TEST(LockableMemory, IsAllWithoutALimitAndNothingThatFillsOne) {
  EXPECT_EQ(lockable_memory(false, 0, 4096 * kMiB), LockableMemory::kAll);
  EXPECT_EQ(lockable_memory(true, 64 * kMiB, 48 * kMiB), LockableMemory::kPresent);
  EXPECT_EQ(lockable_memory(true, 64 * kMiB, 48 * kMiB + 1), LockableMemory::kNothing);
  EXPECT_EQ(lockable_memory(true, 8 * kMiB, 1 * kMiB), LockableMemory::kNothing);
  EXPECT_EQ(lockable_memory(true, 0, 0), LockableMemory::kNothing);
}

TEST(Realtime, SaysWhatTheKernelSays) {
  const std::string text = in_child([](std::ostream& out) {
    const bool bound = !locks_beyond_limits();
    const RealtimeGrant grant = make_realtime({.priority = 7, .cpu = -1, .lock_memory = true});
    print(grant, out);
    out << "limit heeded " << (bound || grant.memory_locked) << '\n';
    sched_param parameters{};
    sched_getparam(0, &parameters);
    const bool fifo = sched_getscheduler(0) == (SCHED_FIFO | SCHED_RESET_ON_FORK);
    out << "fifo agrees " << (fifo == grant.fifo) << '\n';
    out << "priority agrees "
        << (!fifo || grant.scheduler == "SCHED_FIFO " + std::to_string(parameters.sched_priority)) << '\n';
    out << "lock agrees " << (kSanitized || grant.memory_locked == (status_kib("VmLck") > 0)) << '\n';
    out << "reason given " << ((grant.fifo && grant.memory_locked) || !grant.missing.empty()) << '\n';
    out << "allocates " << can_still_allocate() << '\n';
  });
  EXPECT_THAT(text, AllOf(HasSubstr("limit heeded 1\n"), HasSubstr("fifo agrees 1\n"),
                          HasSubstr("priority agrees 1\n"), HasSubstr("lock agrees 1\n"),
                          HasSubstr("reason given 1\n"), HasSubstr("allocates 1\n")));
}

TEST(Realtime, ActsOnTheCallingThreadAloneAndNotOnThoseItMakes) {
#ifdef PHALANX_THREAD_SANITIZER
  GTEST_SKIP() << "ThreadSanitizer allows a child no threads if its parent has more than one";
#endif
  const std::string text = in_child([](std::ostream& out) {
    int caller = -1;
    int made_by_caller = -1;
    bool fifo = false;
    std::thread loop([&] {
      fifo = make_realtime({.priority = 1, .cpu = -1, .lock_memory = false}).fifo;
      caller = sched_getscheduler(0);
      std::thread([&] { made_by_caller = sched_getscheduler(0); }).join();
    });
    loop.join();
    out << "caller agrees " << ((caller != SCHED_OTHER) == fifo) << '\n';
    out << "others " << sched_getscheduler(0) << ' ' << made_by_caller << '\n';
  });
  EXPECT_THAT(text, HasSubstr("caller agrees 1\n"));
  EXPECT_THAT(text, HasSubstr("others 0 0\n"));
}

TEST(Realtime, StaysOnTheCpuThatWasAskedFor) {
  cpu_set_t allowed;
  CPU_ZERO(&allowed);
  ASSERT_EQ(sched_getaffinity(0, sizeof allowed, &allowed), 0);
  unsigned last = 0;
  for (unsigned cpu = 0; cpu < CPU_SETSIZE; ++cpu)
    if (CPU_ISSET(cpu, &allowed)) last = cpu;
  const std::string text = in_child([last](std::ostream& out) {
    const RealtimeGrant grant =
        make_realtime({.priority = 1, .cpu = static_cast<int>(last), .lock_memory = false});
    cpu_set_t set;
    CPU_ZERO(&set);
    sched_getaffinity(0, sizeof set, &set);
    out << "granted " << (grant.cpu == static_cast<int>(last)) << " alone "
        << (CPU_COUNT(&set) == 1 && CPU_ISSET(last, &set));
  });
  EXPECT_EQ(text, "granted 1 alone 1");
}

TEST(Realtime, SaysWhichCpusThereAreIfAnotherIsAskedFor) {
  for (const int cpu : {1023, 1024, 1 << 30}) {
    const std::string text = in_child([cpu](std::ostream& out) {
      print(make_realtime({.priority = 1, .cpu = cpu, .lock_memory = false}), out);
    });
    EXPECT_THAT(text, HasSubstr("any CPU"));
    EXPECT_THAT(text, HasSubstr("missing: CPU " + std::to_string(cpu) + " was refused (Invalid argument)"));
    EXPECT_THAT(text, HasSubstr("may move among CPUs "));
  }
}

TEST(Realtime, BringsAnImpossiblePriorityIntoRangeAndSaysSo) {
  const std::string text = in_child([](std::ostream& out) {
    const RealtimeGrant grant = make_realtime({.priority = 500, .cpu = -1, .lock_memory = false});
    out << grant.fifo << '\n';
    print(grant, out);
  });
  if (text.front() == '0') GTEST_SKIP() << "SCHED_FIFO is not permitted here:\n" << text;
  EXPECT_THAT(text, HasSubstr("SCHED_FIFO 99 instead of 500"));
}

TEST(Realtime, LeavesMemoryAloneIfNotAskedToLockIt) {
  const std::string text = in_child([](std::ostream& out) {
    print(make_realtime({.priority = 1, .cpu = -1, .lock_memory = false}), out);
    out << "locked " << status_kib("VmLck") << " KiB\n";
  });
  EXPECT_THAT(text, HasSubstr("memory not locked"));
  EXPECT_THAT(text, Not(HasSubstr("memory is not locked")));
  EXPECT_THAT(text, HasSubstr("locked 0 KiB\n"));
}

TEST(Realtime, NamesTheKernelAndHowItPreempts) {
  EXPECT_EQ(preemption("#1 SMP PREEMPT_DYNAMIC Debian 6.1.0-1", false), "PREEMPT_DYNAMIC");
  EXPECT_EQ(preemption("#1 SMP PREEMPT_RT Debian 6.1.0-1", false), "PREEMPT_RT");
  EXPECT_EQ(preemption("#1 SMP PREEMPT RT 4.19", false), "PREEMPT_RT");
  EXPECT_EQ(preemption("#1 SMP PREEMPT_DYNAMIC", true), "PREEMPT_RT");
  EXPECT_EQ(preemption("#1 SMP PREEMPT", false), "PREEMPT");
  EXPECT_EQ(preemption("#1 SMP Debian", false), "no preemption");
  utsname name{};
  ASSERT_EQ(uname(&name), 0);
  const std::string text = in_child([](std::ostream& out) {
    out << make_realtime({.priority = 1, .cpu = -1, .lock_memory = false}).kernel;
  });
  EXPECT_THAT(text, HasSubstr(&name.release[0]));
}

}  // namespace
}  // namespace phalanx

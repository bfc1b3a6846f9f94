// SPDX-License-Identifier: Apache-2.0
#include "phalanx/station/realtime.h"

#include <fmt/format.h>
#include <malloc.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/utsname.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <system_error>

namespace phalanx {
namespace {

constexpr std::size_t kStack = 64U << 10U;  ///< stack that is touched beforehand [bytes]
/// Room that must stay under the limit if only present memory is locked: a locked stack cannot grow past it.
constexpr std::uint64_t kHeadroom = 16U << 20U;

std::string reason(int error) { return std::generic_category().message(error); }

/// Raises the limit as far as an ordinary process may. @returns the new limit
rlim_t raised_limit(__rlimit_resource_t which) {
  rlimit limit{};
  if (getrlimit(which, &limit) != 0) return 0;
  const rlimit raised{.rlim_cur = limit.rlim_max, .rlim_max = limit.rlim_max};
  return setrlimit(which, &raised) == 0 ? limit.rlim_max : limit.rlim_cur;
}

/// Sets SCHED_FIFO for the calling thread. @returns 0 or errno
int set_fifo(int priority) {
  sched_param parameters{};
  parameters.sched_priority = priority;
  return sched_setscheduler(0, SCHED_FIFO | SCHED_RESET_ON_FORK, &parameters) == 0 ? 0 : errno;
}

void ask_for_fifo(int wanted, RealtimeGrant& grant) {
  const int priority =
      std::clamp(wanted, sched_get_priority_min(SCHED_FIFO), sched_get_priority_max(SCHED_FIFO));
  int granted = priority;
  int error = set_fifo(granted);
  if (error == EPERM) {
    const rlim_t limit = raised_limit(RLIMIT_RTPRIO);
    granted = static_cast<int>(std::min<rlim_t>(limit, static_cast<rlim_t>(priority)));
    if (granted > 0) error = set_fifo(granted);
  }
  grant.fifo = error == 0;
  if (!grant.fifo) {
    grant.missing.push_back(
        fmt::format("SCHED_FIFO {} was refused ({}): steps may start late. Allow it with `rtprio` for the "
                    "group `realtime` "
                    "in /etc/security/limits.d: docs/realtime.md",
                    priority, reason(error)));
    return;
  }
  grant.scheduler = fmt::format("SCHED_FIFO {}", granted);
  if (granted != wanted)
    grant.missing.push_back(fmt::format(
        "SCHED_FIFO {} instead of {}: that is the nearest this process may have. Priorities go from "
        "1 to 99 and to `rtprio` in /etc/security/limits.d: docs/realtime.md",
        granted, wanted));
}

/// Sets the timer slack to 1 ns. By default, timers may be 50 us late, so that the CPU wakes less often.
void ask_for_exact_timers(RealtimeGrant& grant) {
  if (prctl(PR_SET_TIMERSLACK, 1UL) == 0) return;
  grant.missing.push_back(
      fmt::format("a timer slack of 1 ns was refused ({}): steps start some 50 us late. "
                  "SCHED_FIFO does without it: docs/realtime.md",
                  reason(errno)));
}

std::string allowed_cpus() {
  cpu_set_t set;
  CPU_ZERO(&set);
  if (sched_getaffinity(0, sizeof set, &set) != 0) return "unknown";
  std::string text;
  for (int cpu = 0; cpu < CPU_SETSIZE; ++cpu)
    if (CPU_ISSET(static_cast<unsigned>(cpu), &set))
      text += fmt::format("{}{}", text.empty() ? "" : ",", cpu);
  return text;
}

void ask_for_cpu(int cpu, RealtimeGrant& grant) {
  if (cpu < 0) return;
  int error = EINVAL;
  if (cpu < CPU_SETSIZE) {
    cpu_set_t set;
    CPU_ZERO(&set);
    CPU_SET(static_cast<unsigned>(cpu), &set);
    error = sched_setaffinity(0, sizeof set, &set) == 0 ? 0 : errno;
  }
  if (error == 0) {
    grant.cpu = cpu;
    return;
  }
  grant.missing.push_back(
      fmt::format("CPU {} was refused ({}): the loop may move among CPUs {}. Name one of these, "
                  "or widen the container's or service's CPU set: docs/realtime.md",
                  cpu, reason(error), allowed_cpus()));
}

/// @returns true if locking has no limit. A user namespace may show the capability without having it. The
/// kernel itself is therefore asked: with a limit of zero, only a privileged process may lock a page.
bool may_lock_beyond_limits() {
  rlimit before{};
  if (getrlimit(RLIMIT_MEMLOCK, &before) != 0) return false;
  const rlimit none{.rlim_cur = 0, .rlim_max = before.rlim_max};
  if (setrlimit(RLIMIT_MEMLOCK, &none) != 0) return false;
  alignas(4096) static std::array<std::byte, 4096> page{};
  const bool may = mlock(page.data(), page.size()) == 0;
  if (may) munlock(page.data(), page.size());
  setrlimit(RLIMIT_MEMLOCK, &before);
  return may;
}

/// @returns the size of the process's address space, which the kernel compares with the limit [bytes]. The
/// kernel does not compare the resident memory.
std::uint64_t address_space() {
  std::uint64_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  return pages * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

/// Touches the stack in a frame of its own, so that the steps' frames lie on pages that are already present.
[[gnu::noinline]] void touch_stack() {
  std::array<volatile std::byte, kStack> room;
  for (std::size_t i = 0; i < room.size(); i += 1024) room[i] = std::byte{0};
}

/// Keeps freed memory in the process.
void keep_memory() {
  mallopt(M_TRIM_THRESHOLD, -1);
  mallopt(M_MMAP_MAX, 0);
  touch_stack();
}

void refuse_memory(const std::string& why, RealtimeGrant& grant) {
  grant.missing.push_back(
      fmt::format("memory is not locked ({}): a step may wait for a page. Allow it with `memlock "
                  "unlimited` for the group `realtime` in /etc/security/limits.d: docs/realtime.md",
                  why));
}

void ask_for_memory(RealtimeGrant& grant) {
  const rlim_t limit = raised_limit(RLIMIT_MEMLOCK);
  const bool limited = limit != RLIM_INFINITY && !may_lock_beyond_limits();
  const std::uint64_t size = address_space();
  const LockableMemory lockable = lockable_memory(limited, limit, size);
  if (lockable == LockableMemory::kNothing) {
    refuse_memory(fmt::format("the process has {} MiB and needs {} more to grow, the limit is {} MiB",
                              size >> 20U, kHeadroom >> 20U, limit >> 20U),
                  grant);
    return;
  }
  const bool all = lockable == LockableMemory::kAll;
  if (mlockall(all ? MCL_CURRENT | MCL_FUTURE : MCL_CURRENT) != 0) {
    refuse_memory(reason(errno), grant);
    return;
  }
  grant.memory_locked = true;
  keep_memory();
  if (!all)
    grant.missing.push_back(fmt::format(
        "memory allocated from now on is not locked (the limit is {} MiB). Allow it with `memlock "
        "unlimited` for the group `realtime` in /etc/security/limits.d: docs/realtime.md",
        limit >> 20U));
}

std::string kernel_name() {
  utsname name{};
  if (uname(&name) != 0) return "unknown";
  int realtime = 0;
  std::ifstream("/sys/kernel/realtime") >> realtime;
  return fmt::format("{} {}", &name.release[0], preemption(&name.version[0], realtime == 1));
}

}  // namespace

RealtimeGrant make_realtime(const RealtimeRequest& request) noexcept {
  // Two threads that begin together would see each other's half-set limits of the process.
  static std::mutex one_at_a_time;
  const std::lock_guard lock(one_at_a_time);
  RealtimeGrant grant;
  try {
    grant.kernel = kernel_name();
    // Memory first: fetching it takes a while, and must not happen at a priority that starves other threads.
    if (request.lock_memory) ask_for_memory(grant);
    ask_for_cpu(request.cpu, grant);
    ask_for_fifo(request.priority, grant);
    if (!grant.fifo) ask_for_exact_timers(grant);
    // NOLINTNEXTLINE(bugprone-empty-catch): no memory for a message; what was granted until here holds
  } catch (...) {
  }
  return grant;
}

std::string describe(const RealtimeGrant& grant) {
  const std::string cpu = grant.cpu < 0 ? "any CPU" : fmt::format("CPU {}", grant.cpu);
  return fmt::format("{}, memory {}locked, {}, kernel {}", grant.scheduler, grant.memory_locked ? "" : "not ",
                     cpu, grant.kernel);
}

LockableMemory lockable_memory(bool limited, std::uint64_t limit, std::uint64_t address_space) noexcept {
  if (!limited) return LockableMemory::kAll;
  const bool fits = limit >= kHeadroom && address_space <= limit - kHeadroom;
  return fits ? LockableMemory::kPresent : LockableMemory::kNothing;
}

std::string preemption(std::string_view version, bool says_realtime) {
  const auto says = [version](std::string_view word) { return version.find(word) != std::string_view::npos; };
  if (says_realtime || says("PREEMPT_RT") || says("PREEMPT RT")) return "PREEMPT_RT";
  if (says("PREEMPT_DYNAMIC")) return "PREEMPT_DYNAMIC";
  return says("PREEMPT") ? "PREEMPT" : "no preemption";
}

}  // namespace phalanx

// SPDX-License-Identifier: Apache-2.0
// Asking the system for what a loop with deadlines needs, and saying plainly what it did not give.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace phalanx {

struct RealtimeRequest {
  int priority = 80;        ///< of SCHED_FIFO, 1 .. 99
  int cpu = -1;             ///< to stay on; -1: wherever the scheduler likes
  bool lock_memory = true;  ///< so that no page has to be fetched during a step
};

/// What was granted. A station runs without any of it, only less punctually.
struct RealtimeGrant {
  std::string scheduler = "SCHED_OTHER";  ///< or, for example, "SCHED_FIFO 80"
  bool fifo = false;
  bool memory_locked = false;  ///< all that the process has now; of what comes later, see `missing`
  int cpu = -1;                ///< that the thread stays on; -1: any
  std::string kernel;          ///< release and kind of preemption: "6.1.0-28-rt-amd64 PREEMPT_RT"
  /// One line for everything that was not granted: what, the system's reason, and how to allow it.
  std::vector<std::string> missing;
};

/// Gives the CALLING thread SCHED_FIFO and, if asked for, one CPU, and locks the memory of the whole PROCESS.
/// - Threads made later by this one are ordinary again (SCHED_RESET_ON_FORK).
/// - Without SCHED_FIFO: the timer slack becomes 1 ns instead of 50 us.
/// - Memory: present and future if the system sets no limit on it. If it sets one, present memory alone and
///   only if that fits with room to spare, for locking beyond a limit would make later allocations fail.
/// - Locked memory is kept: free() returns nothing to the system, and 64 KiB of the stack are touched.
/// Set-up only; call it at the start of the loop's thread. Throws nothing.
[[nodiscard]] RealtimeGrant make_realtime(const RealtimeRequest& request) noexcept;

/// For people, in one line: "SCHED_FIFO 80, memory locked, CPU 3, kernel 6.1.0-28-rt-amd64 PREEMPT_RT".
[[nodiscard]] std::string describe(const RealtimeGrant& grant);

enum class LockableMemory { kNothing, kPresent, kAll };

/// How much memory may be locked so that no later allocation fails and no stack is kept from growing: all if
/// there is no limit; what is there now, if it leaves 16 MiB of the limit free; otherwise nothing.
/// @param limited        whether RLIMIT_MEMLOCK binds this process
/// @param limit          [bytes]
/// @param address_space  of the process, which is what the kernel holds against the limit [bytes]
[[nodiscard]] LockableMemory lockable_memory(bool limited, std::uint64_t limit,
                                             std::uint64_t address_space) noexcept;

/// The kind of preemption that a kernel has: "PREEMPT_RT", "PREEMPT_DYNAMIC", "PREEMPT" or "no preemption".
/// @param version       as `uname -v` prints it
/// @param says_realtime whether /sys/kernel/realtime is there and says 1
[[nodiscard]] std::string preemption(std::string_view version, bool says_realtime);

}  // namespace phalanx

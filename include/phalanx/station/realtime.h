// SPDX-License-Identifier: Apache-2.0
// Real-time scheduling and memory locking for the loop's thread, and a list of what the system refused.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace phalanx {

/// Requests of a thread with deadlines to the operating system.
struct RealtimeRequest {
  int priority = 80;        ///< priority under SCHED_FIFO, 1 .. 99
  int cpu = -1;             ///< the only CPU to run on; -1: any
  bool lock_memory = true;  ///< lock memory, so that no step waits for a page
};

/// The granted requests. A station also runs without them, but less punctually.
struct RealtimeGrant {
  std::string scheduler = "SCHED_OTHER";  ///< or, for example, "SCHED_FIFO 80"
  bool fifo = false;
  bool memory_locked = false;  ///< all present memory is locked; for later memory see `missing`
  int cpu = -1;                ///< the only CPU that the thread runs on; -1: any
  std::string kernel;          ///< release and kind of preemption: "6.1.0-28-rt-amd64 PREEMPT_RT"
  /// One line for each refused request: what, the system's reason, and how to allow it.
  std::vector<std::string> missing;
};

/// Gives the CALLING thread SCHED_FIFO and, if asked for, one CPU, and locks the memory of the whole PROCESS.
/// - Threads that this thread makes later are ordinary ones (SCHED_RESET_ON_FORK).
/// - Without SCHED_FIFO, the timer slack becomes 1 ns instead of 50 us.
/// - Memory: without a limit, present and future memory is locked. With a limit, only present memory is
///   locked, and only if it fits with room to spare: beyond the limit, later allocations would fail.
/// - Locked memory is kept: free() returns nothing to the system, and 64 KiB of the stack are touched.
/// Set-up only; call it at the start of the loop's thread. Throws nothing.
[[nodiscard]] RealtimeGrant make_realtime(const RealtimeRequest& request) noexcept;

/// Describes a grant in one line: "SCHED_FIFO 80, memory locked, CPU 3, kernel 6.1.0-28-rt-amd64 PREEMPT_RT".
[[nodiscard]] std::string describe(const RealtimeGrant& grant);

/// The memory of a process that may be locked.
enum class LockableMemory { kNothing, kPresent, kAll };

/// Decides how much memory may be locked so that later allocations succeed and stacks can still grow. Without
/// a limit it is all. With a limit it is the present memory if that leaves 16 MiB of the limit free;
/// otherwise it is none.
/// @param limited        whether RLIMIT_MEMLOCK binds this process
/// @param limit          RLIMIT_MEMLOCK [bytes]
/// @param address_space  of the process; the kernel compares it with the limit [bytes]
[[nodiscard]] LockableMemory lockable_memory(bool limited, std::uint64_t limit,
                                             std::uint64_t address_space) noexcept;

/// Names the kernel's kind of preemption: "PREEMPT_RT", "PREEMPT_DYNAMIC", "PREEMPT" or "no preemption".
/// @param version       as `uname -v` prints it
/// @param says_realtime whether /sys/kernel/realtime exists and contains 1
[[nodiscard]] std::string preemption(std::string_view version, bool says_realtime);

}  // namespace phalanx

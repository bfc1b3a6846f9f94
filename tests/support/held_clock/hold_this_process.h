// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace phalanx::test {

/// While it lives, each thread that takes the name `name` waits as soon as it has it. Time passes meanwhile.
/// For programs under HELD_CLOCK. One at a time.
class ThreadsWait {
 public:
  explicit ThreadsWait(const char* name);
  ThreadsWait(const ThreadsWait&) = delete;
  ThreadsWait& operator=(const ThreadsWait&) = delete;
  ~ThreadsWait();  ///< the threads continue
  [[nodiscard]] bool one_waits() const;
};

/// While it lives, the loops of this process's stations wake up too late, as on an overloaded computer. For
/// programs under HELD_CLOCK. One at a time.
class LoopWakesLate {
 public:
  explicit LoopWakesLate(double seconds);
  LoopWakesLate(const LoopWakesLate&) = delete;
  LoopWakesLate& operator=(const LoopWakesLate&) = delete;
  ~LoopWakesLate();
};

}  // namespace phalanx::test

// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace phalanx::test {

/// While it lives, time passes although threads of a name compute, for what has to happen meanwhile. For
/// programs under HELD_CLOCK (cmake/tests.cmake). One at a time.
class TimePassesBeside {
 public:
  /// @param threads  their name, as pthread_setname_np() has set it
  explicit TimePassesBeside(const char* threads);
  TimePassesBeside(const TimePassesBeside&) = delete;
  TimePassesBeside& operator=(const TimePassesBeside&) = delete;
  ~TimePassesBeside();
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

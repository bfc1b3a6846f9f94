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

}  // namespace phalanx::test

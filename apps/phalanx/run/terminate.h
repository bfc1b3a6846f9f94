// SPDX-License-Identifier: Apache-2.0
// The program's handler of std::terminate(), called when an exception leaves a destructor or a thread.
#pragma once

#include "phalanx/device/clock.h"
#include "phalanx/station/session.h"

namespace phalanx {

/// Releases the hand (LetsGoAtTerminate), writes the exception, and ends the program: the handler for
/// std::set_terminate(). If memory has run out, the exit code is kFailed, because a library's destructors may
/// need memory. SIGALRM ends the program after 30 s in any case: standard error may take nothing, or a lock
/// may be held.
[[noreturn]] void end_at_once();

/// Guard of a running station. While it lives, std::terminate() waits until the torque is zero and the log
/// has been written up to then. Only one may live at a time.
class LetsGoAtTerminate {
 public:
  /// @param session, clock  outlive the guard
  LetsGoAtTerminate(Session& session, const Clock& clock) noexcept;
  LetsGoAtTerminate(const LetsGoAtTerminate&) = delete;
  LetsGoAtTerminate& operator=(const LetsGoAtTerminate&) = delete;
  ~LetsGoAtTerminate();  ///< if std::terminate() has begun, waits for the program's end

  /// Ramps to zero torque and waits for it. For any thread; allocates nothing.
  void let_go() noexcept;

 private:
  Session& session_;
  const Clock& clock_;
};

}  // namespace phalanx

// SPDX-License-Identifier: Apache-2.0
// A program that has this file runs under a held clock from its beginning to its end: time passes while all
// its threads sleep.
#include "support/held_clock/hold_this_process.h"

#include <sys/syscall.h>
#include <unistd.h>

#include <thread>

#include "support/held_clock/held_clock.h"
#include "support/held_clock/interpose.h"

namespace phalanx::test {
namespace {

/// For the life of the process: threads may look at the clock to the last moment.
HeldClock* const kProcessClock = [] {
  auto* clock = new HeldClock;
  hold(&clock->page());
  std::thread([clock] {
    clock->ignore_thread(static_cast<std::int32_t>(::syscall(SYS_gettid)));
    clock->run([] { return false; });
  }).detach();
  return clock;
}();

/// At the end of the process its clock is the computer's again: a leak checker stops all threads, that of the
/// held clock among them, and yields until they have.
const struct Release {
  Release() = default;
  Release(const Release&) = delete;
  Release& operator=(const Release&) = delete;
  ~Release() { hold(nullptr); }
} kRelease;

}  // namespace

TimePassesBeside::TimePassesBeside(const char* threads) { kProcessClock->ignore_threads_named(threads); }
TimePassesBeside::~TimePassesBeside() { kProcessClock->ignore_threads_named(nullptr); }

LoopWakesLate::LoopWakesLate(double seconds) { kProcessClock->delay_loop(seconds); }
LoopWakesLate::~LoopWakesLate() { kProcessClock->delay_loop(0.0); }

}  // namespace phalanx::test

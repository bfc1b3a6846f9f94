// SPDX-License-Identifier: Apache-2.0
// A program that has this file runs under a held clock from its beginning to its end: time passes while all
// its threads sleep.
#include "support/held_clock/hold_this_process.h"

#include <dlfcn.h>
#include <pthread.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <condition_variable>
#include <cstring>
#include <mutex>
#include <thread>

#include "support/held_clock/held_clock.h"
#include "support/held_clock/interpose.h"

namespace phalanx::test {
namespace {

/// For the life of the process: threads may look at the clock to the last moment.
HeldClock* const kProcessClock = [] {
  auto* clock = new HeldClock;
  ask_for_the_processor(1);
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

/// The threads of a name that wait.
struct Named {
  std::mutex mutex;
  std::condition_variable changed;
  const char* name = nullptr;  ///< null: none waits
  int waiting = 0;
};

/// For the life of the process: threads may take names to the last moment.
Named& named() {
  static Named& the_only = *new Named;
  return the_only;
}

void wait_if_named(const char* name) {
  std::unique_lock lock(named().mutex);
  const auto is_to_wait = [&] { return named().name != nullptr && std::strcmp(name, named().name) == 0; };
  if (!is_to_wait()) return;
  ++named().waiting;
  named().changed.wait(lock, [&] { return !is_to_wait(); });
  --named().waiting;
  named().changed.notify_all();
}

}  // namespace

ThreadsWait::ThreadsWait(const char* name) {
  const std::lock_guard lock(named().mutex);
  named().name = name;
}
ThreadsWait::~ThreadsWait() {
  std::unique_lock lock(named().mutex);
  named().name = nullptr;
  named().changed.notify_all();
  named().changed.wait(lock, [] { return named().waiting == 0; });
}
bool ThreadsWait::one_waits() const {
  const std::lock_guard lock(named().mutex);
  return named().waiting > 0;
}

LoopWakesLate::LoopWakesLate(double seconds) { kProcessClock->delay_loop(seconds); }
LoopWakesLate::~LoopWakesLate() { kProcessClock->delay_loop(0.0); }

}  // namespace phalanx::test

/// The C library's function, after which a thread may have to wait.
extern "C" int pthread_setname_np(pthread_t thread, const char* name) {
  static const auto in_c_library =
      reinterpret_cast<decltype(&pthread_setname_np)>(::dlsym(RTLD_NEXT, "pthread_setname_np"));
  const int result = in_c_library(thread, name);
  if (::pthread_equal(thread, ::pthread_self()) != 0) phalanx::test::wait_if_named(name);
  return result;
}

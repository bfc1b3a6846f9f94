// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <condition_variable>
#include <csignal>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>

#include "phalanx/core/give_way.h"

namespace phalanx {

/// Starts a thread of lowered priority (give_way()) with all signals blocked.
/// @param name  name of the thread, at most 15 bytes
/// @throws std::system_error if the system cannot create a thread
/// Set-up only: system calls, allocates.
[[nodiscard]] inline std::thread start_nice_thread(const char* name, std::function<void()> work) {
  sigset_t all;
  sigset_t before;
  sigfillset(&all);
  // Signals are blocked before the thread exists, so that it cannot receive one at any time.
  ::pthread_sigmask(SIG_SETMASK, &all, &before);
  try {
    std::thread thread([name, work = std::move(work)] {
      give_way(name);
      work();
    });
    ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
    return thread;
  } catch (...) {
    ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
    throw;
  }
}

/// State that a thread shares with its owner, where the owner does not wait indefinitely for
/// the thread's end.
struct ThreadEnd {
  std::mutex mutex;
  std::condition_variable changed;
  bool ending = false;  ///< the owner has asked the thread to end
  bool ended = false;   ///< the thread no longer uses the shared state
};

/// Asks the thread to end and waits for it. If the thread hangs in a system call and has not ended
/// after `patience` [s], it is detached. The caller then leaves the shared state to it. Set-up only:
/// locks and waits.
inline void end_or_leave(ThreadEnd& shared, std::thread& thread, double patience) {
  std::unique_lock lock(shared.mutex);
  shared.ending = true;
  shared.changed.notify_all();
  const bool ended = shared.changed.wait_for(lock, std::chrono::duration<double>(patience),
                                             [&shared] { return shared.ended; });
  lock.unlock();
  if (ended)
    thread.join();
  else
    thread.detach();
}

}  // namespace phalanx

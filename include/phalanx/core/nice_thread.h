// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <csignal>
#include <functional>
#include <thread>
#include <utility>

#include "phalanx/core/give_way.h"

namespace phalanx {

/// A thread that gives way to others (give_way()), all signals blocked.
/// @param name  15 bytes at most. @throws std::system_error if there is no thread to be had
/// Set-up only: system calls, allocates.
[[nodiscard]] inline std::thread start_nice_thread(const char* name, std::function<void()> work) {
  sigset_t all;
  sigset_t before;
  sigfillset(&all);
  // Blocked before it exists, so that there is no moment in which it could take one.
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

}  // namespace phalanx

// SPDX-License-Identifier: Apache-2.0
// Scheduling of threads that compute, serve or write beside a loop with deadlines.
#pragma once

#include <pthread.h>
#include <sched.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>

namespace phalanx {

/// Lowers the scheduling priority of the CALLING thread: SCHED_OTHER, whatever it inherited, and at least
/// nice 5. A thread that already has a higher nice value keeps it.
/// Threads that it creates inherit both settings, and cannot undo them without privileges. A setting that the
/// system refuses stays unchanged, which affects speed only.
/// @param name  name of the thread as `top -H` shows it, at most 15 bytes; with a longer one it keeps its own
/// Set-up only: system calls.
inline void give_way(const char* name) noexcept {
  constexpr int kNice = 5;
  const sched_param ordinary{};
  ::pthread_setschedparam(::pthread_self(), SCHED_OTHER, &ordinary);
  const auto self = static_cast<id_t>(::syscall(SYS_gettid));
  ::setpriority(PRIO_PROCESS, self, std::max(kNice, ::getpriority(PRIO_PROCESS, self)));
  ::pthread_setname_np(::pthread_self(), name);
}

}  // namespace phalanx

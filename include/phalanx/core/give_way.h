// SPDX-License-Identifier: Apache-2.0
// Threads that compute, serve or write beside a loop with deadlines.
#pragma once

#include <pthread.h>
#include <sched.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>

namespace phalanx {

/// The CALLING thread gives way to others from here on: SCHED_OTHER, whatever it inherited, and nice 5, or
/// what it has if that is nicer. Threads that it makes inherit that, and cannot take it back without a right
/// to. What the system refuses is left as it is: slower, never wrong.
/// @param name  of the thread, as `top -H` shows it: at most 15 bytes, or it keeps its own
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

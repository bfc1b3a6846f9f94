// SPDX-License-Identifier: Apache-2.0
#include "serve/web/server_thread.h"

#include <pthread.h>
#include <sched.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <utility>

namespace phalanx::web {
namespace {

constexpr int kNice = 5;

// Its scheduling would be inherited. What the system refuses is left as it is: slower, never wrong.
void give_way() noexcept {
  const sched_param ordinary{};
  ::pthread_setschedparam(::pthread_self(), SCHED_OTHER, &ordinary);
  const auto self = static_cast<id_t>(::syscall(SYS_gettid));
  ::setpriority(PRIO_PROCESS, self, std::max(kNice, ::getpriority(PRIO_PROCESS, self)));
  ::pthread_setname_np(::pthread_self(), "phalanx-web");
}

}  // namespace

std::thread start_nice_thread(std::function<void()> work) {
  sigset_t all;
  sigset_t before;
  sigfillset(&all);
  // Blocked before it exists, so that there is no moment in which it could take one.
  ::pthread_sigmask(SIG_SETMASK, &all, &before);
  std::thread thread([work = std::move(work)] {
    give_way();
    work();
  });
  ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
  return thread;
}

}  // namespace phalanx::web

// SPDX-License-Identifier: Apache-2.0
#include "serve/web/server_thread.h"

#include <pthread.h>

#include <csignal>
#include <utility>

#include "phalanx/core/give_way.h"

namespace phalanx::web {

std::thread start_nice_thread(const char* name, std::function<void()> work) {
  sigset_t all;
  sigset_t before;
  sigfillset(&all);
  // Blocked before it exists, so that there is no moment in which it could take one.
  ::pthread_sigmask(SIG_SETMASK, &all, &before);
  std::thread thread([name, work = std::move(work)] {
    give_way(name);
    work();
  });
  ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
  return thread;
}

}  // namespace phalanx::web

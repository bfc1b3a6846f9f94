// SPDX-License-Identifier: Apache-2.0
// The signals that ask a command to end.
#pragma once

#include <sys/eventfd.h>

#include <atomic>
#include <cerrno>
#include <csignal>

namespace phalanx {

/// Flag of a request to end; the command then ends in good order. Any thread may read it.
inline std::atomic<int> asked_to_end = 0;
static_assert(std::atomic<int>::is_always_lock_free, "a signal handler sets it");
/// Eventfd that becomes readable with the flag; -1: none was available, or end_on_signal() was not called.
inline int end_descriptor = -1;

/// Makes Ctrl-C, SIGTERM and a closed terminal only request the end, from here on. The signals of a closed
/// output pipe, and of a terminal that belongs to another job, are ignored: they must neither end nor stop a
/// process that holds a hand.
inline void end_on_signal() {
  end_descriptor = ::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
  struct sigaction action = {};
  action.sa_handler = [](int) {
    const int error = errno;
    asked_to_end = 1;
    static_cast<void>(::eventfd_write(end_descriptor, 1));
    errno = error;
  };
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) sigaction(signal, &action, nullptr);
  action.sa_handler = SIG_IGN;
  for (const int signal : {SIGPIPE, SIGTTIN, SIGTTOU}) sigaction(signal, &action, nullptr);
}

/// Makes Ctrl-C and SIGTERM only set asked_to_end, from here on.
/// @param second_ends  true: a second signal ends the process at once; for work that loses nothing by it
inline void end_on_interrupt(bool second_ends = false) {
  struct sigaction action = {};
  if (second_ends) action.sa_flags = static_cast<int>(SA_RESETHAND);
  action.sa_handler = [](int) { asked_to_end = 1; };
  for (const int signal : {SIGINT, SIGTERM}) sigaction(signal, &action, nullptr);
}

}  // namespace phalanx

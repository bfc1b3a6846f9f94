// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/eventfd.h>

#include <cerrno>
#include <csignal>

namespace phalanx {

/// Flag of a request to end: Ctrl-C, a kill or a closed terminal. asked_to_end becomes 1, end_descriptor
/// becomes readable, and the command ends in good order. The signals of a closed output pipe, and of a
/// terminal that belongs to another job, are ignored: they must neither end nor stop a process that
/// holds a hand.
inline volatile std::sig_atomic_t asked_to_end = 0;
inline int end_descriptor = -1;  ///< an eventfd; -1: none was available

/// Installs the handlers of these signals.
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

}  // namespace phalanx

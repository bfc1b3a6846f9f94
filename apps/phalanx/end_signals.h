// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <csignal>

namespace phalanx {

/// Ctrl-C, a kill or a closed terminal: asked_to_end becomes 1 and the command ends in good order. A reader
/// of our output that has gone, or a terminal that belongs to another job, must neither end nor stop what
/// holds a hand.
inline volatile std::sig_atomic_t asked_to_end = 0;

inline void end_on_signal() {
  struct sigaction action = {};
  action.sa_handler = [](int) { asked_to_end = 1; };
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) sigaction(signal, &action, nullptr);
  action.sa_handler = SIG_IGN;
  for (const int signal : {SIGPIPE, SIGTTIN}) sigaction(signal, &action, nullptr);
}

}  // namespace phalanx

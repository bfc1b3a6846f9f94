// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/prctl.h>
#include <sys/types.h>
#include <unistd.h>

#include <csignal>

namespace phalanx::mesh {

/// Ends this process with the one that forked it. A child whose parent is killed would wait for ever for its
/// line to be read, and keep every file of the parent open, with its locks.
inline void end_with(pid_t parent) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(1);  // it was gone before that
}

}  // namespace phalanx::mesh

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/prctl.h>
#include <sys/types.h>
#include <unistd.h>

#include <csignal>

namespace phalanx::mesh {

/// Makes this process end with the one that forked it. Otherwise a child whose parent is killed would wait
/// forever for a reader of its pipe. It would also keep every file of the parent open, with its locks.
inline void end_with(pid_t parent) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(1);  // the parent ended before the call
}

}  // namespace phalanx::mesh

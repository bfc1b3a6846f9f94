// SPDX-License-Identifier: Apache-2.0
// Kills the process at a chosen system call that changes a file.
//
// The program replaces the C library's functions of these names, for itself and for the libraries that it
// loads. So a run with the same operations makes the same calls, and a number names one place in it. What the
// process wrote before its death is in the files, as after a SIGKILL. A power failure, which also loses
// writes that were not synchronised, is not simulated.
#pragma once

#include <cstdint>

namespace phalanx::testing {

/// Counts the calls of this process that change a file: write, pwrite64, fsync, fdatasync, ftruncate64,
/// rename, unlink, mkdir, by this program and by libraries. Before call number `call` (from 1), the process
/// kills itself with SIGKILL; a call that writes has then written half of its bytes.
/// @param call  0: none; the calls are counted only
void kill_at_call(std::uint64_t call);

/// Counts likewise. Call number `call` fails with ENOSPC, as on a full disk; a call that writes has then
/// written half of its bytes. Later calls succeed. @param call  0: none
void fail_at_call(std::uint64_t call);

/// From now on link() fails with EPERM, as on a file system without hard links (FAT), or works again.
void refuse_links(bool refused);

/// @returns the calls since kill_at_call() or fail_at_call()
[[nodiscard]] std::uint64_t counted_calls();

}  // namespace phalanx::testing

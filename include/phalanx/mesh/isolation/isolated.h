// SPDX-License-Identifier: Apache-2.0
// Isolation of third-party code in a child process: see also isolation_helper.h.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "phalanx/mesh/triangle_mesh.h"

namespace phalanx::mesh {

/// Limits of the work in the child process.
struct IsolationLimits {
  std::uint64_t cpu_seconds = 3;
  std::uint64_t memory_bytes = std::uint64_t{2} << 30;  ///< address space, beyond this process' own
  double wall_seconds = 60.0;                           ///< also for a reader that sleeps or blocks
  double transfer_seconds = 60.0;  ///< for sending the input to an IsolationHelper, and for the answer
};

/// Runs `read` in a forked child process and returns its mesh, bit by bit. Third-party file readers
/// write past their buffers, fail assertions or loop on damaged files. Here only the child process
/// ends. POSIX only.
/// @throws std::invalid_argument with the reader's message, or with one starting with `origin` if the child
/// crashed or reached a limit
/// @throws std::runtime_error if the system gives no process or pipe
/// Set-up only: forks, allocates, throws.
[[nodiscard]] TriangleMesh run_isolated(const std::function<TriangleMesh()>& read, const std::string& origin,
                                        const IsolationLimits& limits);

/// Runs work with a text as its result in a forked child process, as run_isolated(). It serves the
/// whole import of an untrusted mesh beside a loop that moves a hand. Changes by `work` in memory stay
/// in the child.
[[nodiscard]] std::string run_isolated_text(const std::function<std::string()>& work,
                                            const std::string& origin, const IsolationLimits& limits);

}  // namespace phalanx::mesh

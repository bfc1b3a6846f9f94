// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "phalanx/mesh/triangle_mesh.h"

namespace phalanx::mesh {

/// What the work in the child may use before it is stopped.
struct IsolationLimits {
  std::uint64_t cpu_seconds = 3;
  std::uint64_t memory_bytes = std::uint64_t{2} << 30;  ///< of address space, beyond this process' own
  double wall_seconds = 60.0;                           ///< also for a reader that sleeps or blocks
};

/// Runs `read` in a forked child process and hands its mesh back, bit by bit the same. Third-party file
/// readers write past their buffers, fail assertions or loop on damaged files; here that ends the child and
/// nothing else. POSIX only.
/// @throws std::invalid_argument with what the reader threw, or, starting with `origin`, that it crashed, ran
/// into a limit.
/// @throws std::runtime_error if the system gives no process or pipe.
/// Set-up only: forks, allocates, throws.
[[nodiscard]] TriangleMesh run_isolated(const std::function<TriangleMesh()>& read, const std::string& origin,
                                        const IsolationLimits& limits);

/// The same for work whose outcome is a text: for the whole import of a mesh from a stranger, beside a loop
/// that moves a hand. What `work` changes in memory stays in the child.
[[nodiscard]] std::string run_isolated_text(const std::function<std::string()>& work,
                                            const std::string& origin, const IsolationLimits& limits);

}  // namespace phalanx::mesh

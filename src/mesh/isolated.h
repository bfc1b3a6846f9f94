// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "phalanx/mesh/triangle_mesh.h"

namespace phalanx::mesh {

/// What a reader may use before it is stopped.
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
[[nodiscard]] TriangleMesh run_isolated(const std::function<TriangleMesh()>& read, const std::string& origin,
                                        const IsolationLimits& limits);

}  // namespace phalanx::mesh

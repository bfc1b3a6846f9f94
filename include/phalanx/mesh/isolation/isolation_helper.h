// SPDX-License-Identifier: Apache-2.0
// Isolation helper: a small process that forks instead of the program.
#pragma once

#include <sys/types.h>

#include <string>

#include "phalanx/mesh/isolation/isolated.h"

namespace phalanx::mesh {

/// Work of an isolated process on its input: a plain function of this program.
using IsolatedWork = std::string (*)(const std::string& input);
using IsolatedReading = TriangleMesh (*)(const std::string& input);

/// A small process that forks instead of this one. fork() copies a program's page tables, and the first write
/// to each page is then a fault. Beside a real-time loop at 1 kHz this delays steps by some milliseconds. A
/// process made before the program has grown does not cause this. It ends with the program.
///
/// There are two processes: a supervisor and the helper, which the supervisor forks. If the helper is ended
/// from outside (by a system out of memory, for example), the supervisor forks another and reports this on
/// standard error. Work that the helper had begun is refused. If the supervisor is ended too, all further
/// work is refused: this program never forks itself.
class IsolationHelper {
 public:
  /// Forks the supervisor. From then on run_isolated_work() uses the helper, until this object is destroyed.
  /// Only one may exist at a time.
  /// @pre the program has no threads yet
  /// @throws std::system_error if the system gives no process or socket
  IsolationHelper();
  IsolationHelper(const IsolationHelper&) = delete;
  IsolationHelper& operator=(const IsolationHelper&) = delete;
  ~IsolationHelper();

 private:
  int control_ = -1;
  pid_t process_ = -1;
};

/// Runs work that needs only its input, as run_isolated_text(). It runs in a child of the IsolationHelper, or
/// in a child of this process if there is no helper. Set-up only: allocates, throws, waits.
[[nodiscard]] std::string run_isolated_work(IsolatedWork work, const std::string& input,
                                            const std::string& origin, const IsolationLimits& limits);

/// Runs work with a mesh as its result, which is returned bit by bit; otherwise as run_isolated_work().
[[nodiscard]] TriangleMesh run_isolated_mesh(IsolatedReading work, const std::string& input,
                                             const std::string& origin, const IsolationLimits& limits);

/// @returns true if the program has an IsolationHelper
[[nodiscard]] bool has_isolation_helper() noexcept;

}  // namespace phalanx::mesh

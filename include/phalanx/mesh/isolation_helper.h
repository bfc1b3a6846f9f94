// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <string>

#include "phalanx/mesh/isolated.h"

namespace phalanx::mesh {

/// What a process apart does with bytes that it is given: plain functions of this program.
using IsolatedWork = std::string (*)(const std::string& input);
using IsolatedReading = TriangleMesh (*)(const std::string& input);

/// A small process that forks in this one's place. fork() copies a program's page tables, and makes its first
/// write to each page a fault afterwards: beside a real-time loop at 1 kHz that is steps of some
/// milliseconds. One made before the program has grown costs it nothing. Ends with the program.
///
/// Two processes: a supervisor forks the helper, and another one if that is ended from outside (by a system
/// that is out of memory, say), which it says on standard error. Work that the helper had begun is refused.
/// If the supervisor is ended too, all further work is refused: this program never forks in their place.
class IsolationHelper {
 public:
  /// Forks: before the program has threads. From then on run_isolated_work() of this program goes through it,
  /// while this lives. One at a time. @throws std::system_error  no process or socket
  IsolationHelper();
  IsolationHelper(const IsolationHelper&) = delete;
  IsolationHelper& operator=(const IsolationHelper&) = delete;
  ~IsolationHelper();

 private:
  int control_ = -1;
  pid_t process_ = -1;
};

/// As run_isolated_text(), for work that needs nothing but its input: in a child of the IsolationHelper if
/// this program has made one, else of this process. Set-up only: allocates, throws, waits.
[[nodiscard]] std::string run_isolated_work(IsolatedWork work, const std::string& input,
                                            const std::string& origin, const IsolationLimits& limits);

/// The same for a mesh, which comes back bit by bit.
[[nodiscard]] TriangleMesh run_isolated_mesh(IsolatedReading work, const std::string& input,
                                             const std::string& origin, const IsolationLimits& limits);

/// Whether there is one.
[[nodiscard]] bool has_isolation_helper() noexcept;

}  // namespace phalanx::mesh

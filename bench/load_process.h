// SPDX-License-Identifier: Apache-2.0
// The clients of cockpit_load.h in a process of their own, at the lowest priority: they stand for other
// computers, which take nothing from the station's.
#pragma once

#include <sys/types.h>

#include <cstdint>

namespace phalanx::bench {

enum class Load : std::uint8_t {
  kViewers,      ///< 20, which read all that they get
  kStuck,        ///< a page that was welcomed and never reads
  kHuge,         ///< 100 MB in one message, twice a second
  kConnections,  ///< 1,000 connections at once, twice a second
};

class LoadProcess {
 public:
  static constexpr int kViewerCount = 20;

  /// Forks: before the program has threads. @throws std::system_error  no process or socket
  LoadProcess();
  LoadProcess(const LoadProcess&) = delete;
  LoadProcess& operator=(const LoadProcess&) = delete;
  ~LoadProcess();

  /// Returns when the load is on. @throws std::runtime_error  the process has died
  void begin(Load load, std::uint16_t port);
  /// @returns messages that its viewers got, all together @throws std::runtime_error  the process has died
  std::uint64_t end();

 private:
  int socket_ = -1;
  pid_t process_ = -1;
};

}  // namespace phalanx::bench

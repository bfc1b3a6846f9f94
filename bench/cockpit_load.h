// SPDX-License-Identifier: Apache-2.0
// Clients that a cockpit has to bear, good ones and bad ones, on 127.0.0.1 without TLS or token.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

namespace phalanx::bench {

/// Viewers on one thread of their own, which read all that they get and answer pings, as pages do. The thread
/// has the scheduling of whoever made this.
class CockpitViewers {
 public:
  struct Counts {
    std::size_t connected = 0;  ///< now
    std::uint64_t messages = 0;
    std::uint64_t bytes = 0;  ///< with what frames them
  };

  /// Returns when all are connected and welcomed. @throws std::runtime_error  one was not
  CockpitViewers(std::uint16_t port, std::size_t viewers);
  CockpitViewers(const CockpitViewers&) = delete;
  CockpitViewers& operator=(const CockpitViewers&) = delete;
  ~CockpitViewers();  ///< goes, all at once

  [[nodiscard]] Counts counts() const noexcept;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

/// A page that was welcomed and never reads again.
class StuckViewer {
 public:
  /// @throws std::runtime_error  it was not welcomed
  explicit StuckViewer(std::uint16_t port);
  StuckViewer(const StuckViewer&) = delete;
  StuckViewer& operator=(const StuckViewer&) = delete;
  ~StuckViewer();

 private:
  int descriptor_;
};

/// Says one message of so many bytes as a page. @returns how many of them went before the line was closed
/// @throws std::runtime_error  it was not welcomed
std::uint64_t send_huge_message(std::uint16_t port, std::uint64_t bytes);

/// Opens so many connections, as fast as it goes, says nothing and lets them all go. @returns how many opened
std::size_t connect_often(std::uint16_t port, std::size_t connections);

}  // namespace phalanx::bench

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>

#include "phalanx/serve/web_server.h"
#include "phalanx/station/station_host.h"

namespace phalanx {

/// The shapes as pages fetch them. Two million triangles are tens of megabytes to encode: that is done beside
/// the server's thread, once a revision, so that nobody's stop and nobody's picture waits for it.
class Shapes : public std::enable_shared_from_this<Shapes> {
 public:
  using Answer = std::function<void(WebAnswer)>;

  /// Answers at once if this revision is encoded, else when it is; from any thread. Allocates.
  void ask(std::shared_ptr<const HostGeometry> shown, Answer answer);

 private:
  struct Asked {
    std::shared_ptr<const HostGeometry> shown;
    Answer answer;
  };
  void work();
  /// @returns the message of a revision; nothing if there is no memory for it
  static Bytes encode(const HostGeometry& shown) noexcept;

  std::mutex mutex_;  ///< of all below
  Bytes bytes_;       ///< the newest encoded
  std::uint32_t revision_ = 0;
  std::deque<Asked> asked_;
  bool working_ = false;
};

}  // namespace phalanx

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>

#include "phalanx/serve/web_server.h"
#include "phalanx/station/session.h"

namespace phalanx {

/// Cache of the newest encoded wire::Geometry, which a page fetches once for each revision. Two million triangles are tens of megabytes to encode. A
/// thread of its own does that once for each revision, so that neither a stop nor a tick waits for it
/// on the server's thread.
class GeometryCache : public std::enable_shared_from_this<GeometryCache> {
 public:
  using Respond = std::function<void(WebResponse)>;

  /// Responds with the encoded geometry: at once if this revision is encoded, else from the encoding thread.
  /// The status is 500 if there is no memory or no thread. Any thread; allocates.
  void request(std::shared_ptr<const SessionGeometry> geometry, Respond respond);

 private:
  struct Request {
    std::shared_ptr<const SessionGeometry> geometry;
    Respond respond;
  };
  void work();
  /// @returns the encoded geometry; null if there is no memory
  static Bytes encode(const SessionGeometry& geometry) noexcept;

  std::mutex mutex_;  ///< of all members below
  Bytes bytes_;       ///< the newest encoded geometry
  std::uint32_t revision_ = 0;
  std::deque<Request> requests_;
  bool working_ = false;  ///< the thread runs
};

}  // namespace phalanx

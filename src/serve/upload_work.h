// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>

#include "phalanx/serve/web_server.h"
#include "phalanx/station/station_host.h"
#include "serve/uploads.h"

namespace phalanx {

/// A mesh that is being read on a thread of its own: what the cockpit and that thread both hold, so that
/// either may be there longer than the other. Any thread.
class UploadWork {
 public:
  explicit UploadWork(const StationHost& host) : host_(&host) {}

  /// What the scene in force states; none: abandoned.
  [[nodiscard]] std::optional<Overrides> values() const;
  [[nodiscard]] bool done() const;
  void finish();
  /// The host is not asked any more, and the work ends with the step that it is in. @returns when it has, but
  /// waits no longer than that
  void abandon(std::chrono::milliseconds wait);

 private:
  mutable std::mutex mutex_;
  std::condition_variable ended_;
  const StationHost* host_;  ///< null: abandoned
  bool done_ = false;
};

/// Begins work on a thread that nobody has to wait for: it must hold all that it touches.
/// @param answer  is given what came of it, when the work is done: whoever hears it may send the next
void begin(const std::shared_ptr<UploadWork>& work, std::function<WebAnswer(const ValuesInForce&)> what,
           std::function<void(WebAnswer)> answer);

}  // namespace phalanx

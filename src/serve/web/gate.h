// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <mutex>

#include "serve/web/boost.h"

namespace phalanx::web {

/// The way onto the server's thread, for other threads; may outlive the server, and leads nowhere then.
class Gate {
 public:
  explicit Gate(net::io_context& thread) : thread_(&thread) {}

  void post(std::function<void()> work) {
    const std::lock_guard lock(mutex_);
    if (thread_ != nullptr) net::post(*thread_, std::move(work));
  }
  /// What is posted from now on is dropped.
  void close() noexcept {
    const std::lock_guard lock(mutex_);
    thread_ = nullptr;
  }

 private:
  std::mutex mutex_;
  net::io_context* thread_;
};

}  // namespace phalanx::web

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "phalanx/serve/web_server.h"

namespace phalanx {

/// Application that records its calls on the server's thread. A test reads them on its own thread.
class FakeApplication final : public WebApplication {
 public:
  struct Message {
    PageId page;
    std::string text;
  };

  // Functions that a test may set before the server starts; called on the server's thread.
  std::function<void(PageId)> on_joined;
  std::function<void(PageId, std::string_view)> on_received;
  std::function<void()> on_frame;
  std::function<void(const WebRequest&, std::function<void(WebResponse)>)> on_requested;
  std::size_t limit = 0;  ///< of any body

  void joined(PageId page, const ClientInfo& client) override {
    {
      const std::lock_guard lock(mutex_);
      joined_.emplace_back(page, client);
    }
    changed_.notify_all();
    if (on_joined) on_joined(page);
  }
  void left(PageId page) override {
    {
      const std::lock_guard lock(mutex_);
      left_.push_back(page);
    }
    changed_.notify_all();
  }
  void received(PageId page, std::string_view message) override {
    {
      const std::lock_guard lock(mutex_);
      received_.push_back({page, std::string(message)});
    }
    changed_.notify_all();
    if (on_received) on_received(page, message);
  }
  void received_over_limit(PageId page, std::string_view last) override {
    {
      const std::lock_guard lock(mutex_);
      over_limit_.push_back({page, std::string(last)});
    }
    changed_.notify_all();
  }
  void frame() override {
    {
      const std::lock_guard lock(mutex_);
      ++frames_;
    }
    changed_.notify_all();
    if (on_frame) on_frame();
  }
  void requested(const WebRequest& request, std::function<void(WebResponse)> answer) override {
    {
      const std::lock_guard lock(mutex_);
      requests_.push_back(request);
    }
    changed_.notify_all();
    if (on_requested) return on_requested(request, std::move(answer));
    WebResponse none;
    none.status = 404;
    none.body = std::make_shared<const std::string>("nothing here\n");
    answer(std::move(none));
  }
  std::size_t body_limit(const WebRequest& /*head*/) override { return limit; }

  std::vector<std::pair<PageId, ClientInfo>> joined_pages() const { return copy(joined_); }
  std::vector<PageId> left_pages() const { return copy(left_); }
  std::vector<Message> messages() const { return copy(received_); }
  std::vector<Message> over_limit_messages() const { return copy(over_limit_); }
  std::vector<WebRequest> requests() const { return copy(requests_); }
  std::size_t frames() const { return copy(frames_); }

  /// Waits until so many pages have joined. The others alike. @returns false after 5 minutes
  bool await_joined(std::size_t n) const {
    return await([&] { return joined_.size() >= n; });
  }
  bool await_left(std::size_t n) const {
    return await([&] { return left_.size() >= n; });
  }
  bool await_messages(std::size_t n) const {
    return await([&] { return received_.size() >= n; });
  }
  bool await_requests(std::size_t n) const {
    return await([&] { return requests_.size() >= n; });
  }
  bool await_frames(std::size_t n) const {
    return await([&] { return frames_ >= n; });
  }

 private:
  template <class T>
  T copy(const T& value) const {
    const std::lock_guard lock(mutex_);
    return value;
  }
  template <class Condition>
  bool await(const Condition& condition) const {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, std::chrono::minutes(5), condition);
  }

  mutable std::mutex mutex_;
  mutable std::condition_variable changed_;
  std::vector<std::pair<PageId, ClientInfo>> joined_;
  std::vector<PageId> left_;
  std::vector<Message> received_;
  std::vector<Message> over_limit_;
  std::vector<WebRequest> requests_;
  std::size_t frames_ = 0;
};

}  // namespace phalanx

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

/// Writes down what it is told, on the server's thread; the test reads it on its own.
class FakeApplication final : public WebApplication {
 public:
  struct Message {
    PageId page;
    std::string text;
  };

  // What a test may set before the server starts; called on the server's thread.
  std::function<void(PageId)> on_joined;
  std::function<void(PageId, std::string_view)> on_received;
  std::function<void()> on_frame;
  std::function<void(const WebRequest&, std::function<void(WebAnswer)>)> on_requested;
  std::size_t limit = 0;  ///< of any body

  void joined(PageId page, const Visitor& visitor) override {
    {
      const std::lock_guard lock(mutex_);
      joined_.emplace_back(page, visitor);
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
  void received_too_much(PageId page, std::string_view last) override {
    {
      const std::lock_guard lock(mutex_);
      too_much_.push_back({page, std::string(last)});
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
  void requested(const WebRequest& request, std::function<void(WebAnswer)> answer) override {
    {
      const std::lock_guard lock(mutex_);
      requests_.push_back(request);
    }
    changed_.notify_all();
    if (on_requested) return on_requested(request, std::move(answer));
    WebAnswer none;
    none.status = 404;
    none.body = std::make_shared<const std::string>("nothing here\n");
    answer(std::move(none));
  }
  std::size_t body_limit(const WebRequest& /*head*/) override { return limit; }

  std::vector<std::pair<PageId, Visitor>> joined_pages() const { return copy(joined_); }
  std::vector<PageId> left_pages() const { return copy(left_); }
  std::vector<Message> messages() const { return copy(received_); }
  std::vector<Message> last_words() const { return copy(too_much_); }
  std::vector<WebRequest> requests() const { return copy(requests_); }
  std::size_t frames() const { return copy(frames_); }

  /// Until so many have joined, ...; @returns false if that does not come in a generous time.
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
  std::vector<std::pair<PageId, Visitor>> joined_;
  std::vector<PageId> left_;
  std::vector<Message> received_;
  std::vector<Message> too_much_;
  std::vector<WebRequest> requests_;
  std::size_t frames_ = 0;
};

}  // namespace phalanx

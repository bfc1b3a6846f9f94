// SPDX-License-Identifier: Apache-2.0
// Pages that do not read: they delay no other page.
#include <gmock/gmock.h>

#include <atomic>
#include <future>
#include <mutex>
#include <thread>

#include "serve/web/page_client.h"
#include "serve/web/web_fixture.h"

namespace phalanx {
namespace {

constexpr int kSmallBuffer = 4096;  // [bytes]

class WebSlowPages : public WebTest {
 protected:
  /// @returns a message with its number, long enough to fill any socket soon; alive() counts it
  /// while it exists
  Bytes numbered(int number) {
    std::string text = std::to_string(number) + " ";
    text.resize(100'000, '.');
    auto made = std::make_shared<const std::string>(std::move(text));
    const std::lock_guard lock(mutex_);
    made_.emplace_back(made);
    return made;
  }
  std::size_t alive() const {
    const std::lock_guard lock(mutex_);
    std::size_t n = 0;
    for (const auto& message : made_) n += message.expired() ? 0U : 1U;
    return n;
  }
  static int number_of(const PageClient::Frame& frame) { return std::stoi(frame.payload); }

  mutable std::mutex mutex_;
  std::vector<std::weak_ptr<const std::string>> made_;
};

// A page that never reads is sent 1,000 messages of 100 kB. It is disconnected when 20 wait, while the other
// page gets all of its own messages.
TEST_F(WebSlowPages, AStuckPageDelaysNoOtherPage) {
  settings_.queue_limit = 20;
  settings_.frame_rate_hz = 1000.0;
  std::atomic<PageId> stuck_id{0};
  std::atomic<PageId> good_id{0};
  std::atomic<std::size_t> most{0};
  int frame = 0;
  application_.on_joined = [&](PageId page) { (stuck_id == 0 ? stuck_id : good_id) = page; };
  application_.on_frame = [&] {
    if (good_id == 0 || frame == 1000) return;
    server_->send(stuck_id, numbered(frame));
    server_->send(good_id, std::make_shared<const std::string>(std::to_string(frame)));
    ++frame;
    most = std::max(most.load(), alive());
  };
  start();
  PageClient stuck(port(), kSmallBuffer);
  ASSERT_TRUE(application_.await_joined(1));
  PageClient good(port());
  for (int i = 0; i < 1000; ++i) ASSERT_EQ(good.receive_message().payload, std::to_string(i));
  ASSERT_TRUE(application_.await_left(1));
  EXPECT_EQ(application_.left_pages().front(), stuck_id);
  // The queued messages, the one in flight, the newest one.
  server_->stop();  // before the variables that its frames use are destroyed
  EXPECT_LE(most, settings_.queue_limit + 2);
}

TEST_F(WebSlowPages, TheQueueIsBoundedInBytesToo) {
  settings_.queue_bytes = 1'000'000;
  application_.on_joined = [this](PageId page) {
    for (int i = 0; i < 50; ++i) server_->send(page, numbered(i));
  };
  start();
  PageClient page(port(), kSmallBuffer);
  EXPECT_TRUE(application_.await_left(1));
}

TEST_F(WebSlowPages, ASlowPageSkipsToTheNewest) {
  settings_.frame_rate_hz = 1000.0;
  std::atomic<int> sent{0};
  std::atomic<int> replaced{0};
  std::atomic<std::size_t> most{0};
  PageId id = 0;
  application_.on_joined = [&](PageId page) { id = page; };
  application_.on_frame = [&] {
    if (sent == 500) return;
    if (server_->send_newest(id, numbered(sent + 1))) ++replaced;
    ++sent;
    most = std::max(most.load(), alive());
  };
  start();
  PageClient page(port(), kSmallBuffer);
  ASSERT_TRUE(application_.await_frames(520));
  int last = 0;
  int heard = 0;
  while (last < 500) {
    const int number = number_of(page.receive_message());
    ASSERT_GT(number, last);
    last = number;
    ++heard;
  }
  EXPECT_TRUE(application_.left_pages().empty());
  server_->stop();  // before the variables that its frames use are destroyed
  EXPECT_EQ(heard + replaced, 500) << "the sender knows which were never sent";
  EXPECT_LT(heard, 100) << "most were replaced before they could be sent";
  EXPECT_LE(most, 3U) << "one in flight, one that waits, the newest one";
}

TEST_F(WebSlowPages, MessagesInOrderGoBeforeTheNewest) {
  application_.on_joined = [this](PageId page) {
    server_->send_newest(page, numbered(1));  // in flight at once
    server_->send_newest(page, numbered(2));
    server_->send(page, numbered(3));
    server_->send_newest(page, numbered(4));
    server_->send(page, numbered(5));
  };
  start();
  PageClient page(port());
  for (const int expected : {1, 3, 5, 4}) EXPECT_EQ(number_of(page.receive_message()), expected);
}

// It sends all the time, so that it is never idle.
TEST_F(WebSlowPages, AWriteThatDoesNotFinishDisconnectsThePage) {
  settings_.idle_timeout = 0.3;
  settings_.messages_per_second = 100'000;
  application_.on_received = [this](PageId page, std::string_view) {
    server_->send_newest(page, numbered(0));
  };
  start();
  PageClient page(port(), kSmallBuffer);
  std::atomic<bool> over{false};
  auto sending = std::async(std::launch::async, [&] {
    while (!over) {
      page.send("a page that does not read");
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
  });
  EXPECT_TRUE(application_.await_left(1));
  over = true;
  sending.get();
}

TEST_F(WebSlowPages, StoppingDoesNotWaitForThem) {
  application_.on_joined = [this](PageId page) {
    for (int i = 0; i < 30; ++i) server_->send(page, numbered(i));
  };
  start();
  PageClient page(port(), kSmallBuffer);
  ASSERT_TRUE(application_.await_joined(1));
  server_->stop();
  EXPECT_EQ(application_.left_pages().size(), 1U);
  EXPECT_EQ(alive(), 0U);
}

}  // namespace
}  // namespace phalanx

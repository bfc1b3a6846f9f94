// SPDX-License-Identifier: Apache-2.0
// Every bound of the server, one less and one more than it.
#include <gmock/gmock.h>

#include <memory>
#include <string>
#include <vector>

#include "serve/web/limits.h"
#include "serve/web/page_client.h"
#include "serve/web/request_checks.h"
#include "serve/web/web_fixture.h"

namespace phalanx {
namespace {

Bytes of_length(std::size_t bytes) { return std::make_shared<const std::string>(bytes, 'x'); }

TEST(OutgoingQueueBounds, HoldsItsNumberOfMessagesAndNotOneMore) {
  web::OutgoingQueue queue(3, 1000);
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(queue.push(of_length(1))) << i;
  EXPECT_FALSE(queue.push(of_length(1))) << "the fourth";
  EXPECT_NE(queue.pop(), nullptr);
  EXPECT_TRUE(queue.push(of_length(1))) << "the third again";
  EXPECT_FALSE(queue.push(of_length(1)));
}

// 4 + 5 + 1 = 10 bytes may wait; 4 + 5 + 2 = 11 may not. Removed and dropped messages do not count.
TEST(OutgoingQueueBounds, HoldsItsNumberOfBytesAndNotOneMore) {
  web::OutgoingQueue queue(100, 10);
  EXPECT_TRUE(queue.push(of_length(4)));
  EXPECT_TRUE(queue.push(of_length(5)));
  EXPECT_FALSE(queue.push(of_length(2)));
  EXPECT_TRUE(queue.push(of_length(1)));
  EXPECT_FALSE(queue.push(of_length(1)));
  EXPECT_EQ(queue.pop()->size(), 4U);
  EXPECT_FALSE(queue.push(of_length(5))) << "6 and 5";
  EXPECT_TRUE(queue.push(of_length(4))) << "6 and 4";
  queue.clear();
  EXPECT_TRUE(queue.push(of_length(10)));
  EXPECT_FALSE(queue.push(of_length(1)));
}

TEST(MessageRateLimitBounds, ASecondIsOverAfterExactlyOne) {
  using std::chrono::nanoseconds;
  using std::chrono::seconds;
  const web::MessageRateLimit::Time start{std::chrono::hours(1)};
  web::MessageRateLimit in_time(1);
  EXPECT_TRUE(in_time.allow(start));
  EXPECT_TRUE(in_time.allow(start + seconds(1)));
  web::MessageRateLimit early(1);
  EXPECT_TRUE(early.allow(start));
  EXPECT_FALSE(early.allow(start + seconds(1) - nanoseconds(1)));
}

// The first and the last character of each length in UTF-8, and their neighbours outside (RFC
// 3629, section 4).
TEST(ReadTargetBounds, Utf8EndsWhereTheStandardSays) {
  for (const char* good : {"/%C2%80", "/%DF%BF", "/%E0%A0%80", "/%ED%9F%BF", "/%EE%80%80", "/%EF%BF%BF",
                           "/%F0%90%80%80", "/%F4%8F%BF%BF", "/~"})
    EXPECT_TRUE(web::read_target(good)) << good;
  for (const char* bad :
       {"/%C1%BF", "/%E0%9F%BF", "/%ED%A0%80", "/%ED%BF%BF", "/%F0%8F%BF%BF", "/%F4%90%80%80", "/%C2%7F",
        "/%C2%C0", "/%E2%82", "/%F0%90%80", "/%", "/%4", "/%4g"})
    EXPECT_FALSE(web::read_target(bad)) << bad;
}

class WebBounds : public WebTest {
 protected:
  /// Sends messages to the page that joins, in one handler of the server's thread. None is written
  /// meanwhile, so that one is in flight and the others wait.
  void send_when_joined(std::size_t messages, std::size_t bytes) {
    application_.on_joined = [this, messages, bytes](PageId page) {
      for (std::size_t i = 0; i < messages; ++i) server_->send(page, of_length(bytes));
    };
  }
  static std::string chunk(std::size_t bytes) {
    constexpr const char* kDigits = "0123456789abcdef";
    std::string length;
    for (std::size_t rest = bytes; rest > 0; rest /= 16) length.insert(0, 1, kDigits[rest % 16]);
    return length + "\r\n" + std::string(bytes, 'x') + "\r\n";
  }
  static std::string post_head(const std::string& fields, const std::string& path = "/mesh") {
    return "POST " + path + " HTTP/1.1\r\nHost: 127.0.0.1\r\nOrigin: http://127.0.0.1\r\n" + fields + "\r\n";
  }
};

TEST_F(WebBounds, APageMayHaveOneInFlightAndAsManyWaitingAsTheQueueHolds) {
  settings_.queue_limit = 5;
  send_when_joined(6, 1);
  start();
  PageClient page(port());
  for (int i = 0; i < 6; ++i) EXPECT_EQ(page.receive_message().opcode, PageClient::kBinary) << i;
  EXPECT_TRUE(application_.left_pages().empty());
}

TEST_F(WebBounds, APageForWhichOneMoreWaitsIsDisconnectedAndHasLeft) {
  settings_.queue_limit = 5;
  send_when_joined(7, 1);
  start();
  PageClient page(port());
  EXPECT_EQ(page.receive_message().opcode, PageClient::kBinary) << "the one in flight";
  const PageClient::Frame close = page.receive_message();
  ASSERT_EQ(close.opcode, PageClient::kClose);
  EXPECT_EQ(close.code(), 1008);
  EXPECT_EQ(close.reason(), "this page does not read fast enough");
  ASSERT_TRUE(application_.await_left(1));
}

TEST_F(WebBounds, APageForWhichOneByteMoreWaitsIsDisconnected) {
  settings_.queue_bytes = 1000;
  send_when_joined(6, 200);  // 200 in flight, 5 x 200 wait
  start();
  PageClient page(port());
  for (int i = 0; i < 6; ++i) ASSERT_EQ(page.receive_message().opcode, PageClient::kBinary) << i;
  server_.reset();
  send_when_joined(6, 201);
  start();
  PageClient larger(port());
  EXPECT_EQ(larger.receive_message().opcode, PageClient::kBinary) << "the one in flight";
  EXPECT_EQ(larger.receive_message().code(), 1008);
}

// A body is read in pieces of at most 16 KiB: none of them passes the limit, but their sum does.
TEST_F(WebBounds, AChunkedBodyIsCountedOverAllItsReads) {
  constexpr std::size_t kChunk = 10'000;  // [bytes]
  constexpr std::size_t kChunks = 6;
  application_.limit = kChunks * kChunk;
  application_.on_requested = [](const WebRequest& request, const std::function<void(WebResponse)>& answer) {
    WebResponse length;
    length.body = std::make_shared<const std::string>(std::to_string(request.body.size()));
    answer(length);
  };
  start();
  std::string whole;
  for (std::size_t i = 0; i < kChunks; ++i) whole += chunk(kChunk);
  const std::string head = post_head("Connection: close\r\nTransfer-Encoding: chunked\r\n");
  EXPECT_EQ(body_of(ask(head + whole + "0\r\n\r\n")), "60000");
  const std::string refused = ask(head + whole + chunk(1) + "0\r\n\r\n");
  EXPECT_EQ(status_of(refused), 413);
  EXPECT_EQ(body_of(refused), "This is too large: at most 60000 bytes can be sent here.\n");
  EXPECT_EQ(application_.requests().size(), 1U);
}

// A body counts as large if it may become longer than 64 KiB. Without a length it may become as long as the
// limit. The server answers "100 Continue" to a body that it accepts.
TEST_F(WebBounds, TwoLargeBodiesAreReadAtOnceAndAThirdIsRefused) {
  application_.limit = 64 * 1024 + 1;
  start();
  const std::string chunked = post_head("Transfer-Encoding: chunked\r\nExpect: 100-continue\r\n");
  std::vector<std::unique_ptr<RawClient>> reading;
  for (int i = 0; i < 2; ++i) {
    reading.push_back(std::make_unique<RawClient>(port()));
    reading.back()->send(chunked);
    ASSERT_EQ(reading.back()->receive_until("\r\n\r\n"), "HTTP/1.1 100 Continue\r\n\r\n");
  }
  EXPECT_EQ(status_of(ask(chunked)), 503);
  EXPECT_EQ(status_of(ask(post_head("Content-Length: 65537\r\nExpect: 100-continue\r\n"))), 503);
  RawClient small(port());
  small.send(post_head("Content-Length: 65536\r\nExpect: 100-continue\r\n"));
  EXPECT_EQ(small.receive_until("\r\n\r\n"), "HTTP/1.1 100 Continue\r\n\r\n") << "64 KiB are not large";
  reading.front()->send("0\r\n\r\n");
  EXPECT_EQ(status_of(reading.front()->receive_response()), 404) << "whole: the application has answered";
  RawClient next(port());
  next.send(chunked);
  EXPECT_EQ(next.receive_until("\r\n\r\n"), "HTTP/1.1 100 Continue\r\n\r\n") << "its slot is free";
}

// The content of a body that is not read is never taken for a request.
TEST_F(WebBounds, AConnectionWhoseBodyWasRefusedEndsThere) {
  start();
  const std::string smuggled = get("/mark.svg");
  const std::string answer =
      ask(post_head("Content-Length: " + std::to_string(smuggled.size()) + "\r\n", "/") + smuggled);
  EXPECT_EQ(status_of(answer), 405);
  EXPECT_EQ(field_of(answer, "Connection"), "close");
  EXPECT_EQ(answer.find("HTTP/1.1", 1), std::string::npos) << "one answer, not two";
  EXPECT_EQ(answer.find("<svg/>"), std::string::npos);
}

}  // namespace
}  // namespace phalanx

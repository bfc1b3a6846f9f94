// SPDX-License-Identifier: Apache-2.0
// Pages over WebSockets: the handshake, messages both ways, limits and the close.
#include <gmock/gmock.h>

#include <future>
#include <set>
#include <thread>

#include "serve/web/page_client.h"
#include "serve/web/web_fixture.h"

namespace phalanx {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class WebPages : public WebTest {
 protected:
  static Bytes bytes(const std::string& text) { return std::make_shared<const std::string>(text); }
  int status_of_upgrade(const std::string& fields, const std::string& behind = "") const {
    RawClient client(port());
    client.send(PageClient::head(fields) + behind);
    return status_of(client.receive_response());
  }
  static std::string with(std::string fields, const std::string& what, const std::string& instead) {
    const std::size_t at = fields.find(what);
    EXPECT_NE(at, std::string::npos) << what;
    return fields.replace(at, what.size(), instead);
  }
};

TEST_F(WebPages, AHandshakeIsAnsweredAsTheProtocolSays) {
  start();
  PageClient page(port());
  EXPECT_EQ(status_of(page.handshake()), 101);
  // The example of RFC 6455, section 1.3.
  EXPECT_EQ(field_of(page.handshake(), "Sec-WebSocket-Accept"), "s3pPLMBiTxaQ9kYGzzhZRbK+xOo=");
  EXPECT_EQ(field_of(page.handshake(), "X-Content-Type-Options"), "nosniff");
  ASSERT_TRUE(application_.await_joined(1));
  const auto [id, client] = application_.joined_pages()[0];
  EXPECT_GE(id, 1U);
  EXPECT_EQ(client.address, "127.0.0.1");
  EXPECT_TRUE(client.may_operate);
}

TEST_F(WebPages, OnlyTheSitesOwnPageMayConnect) {
  start();
  const std::string good = PageClient::good_fields();
  const std::string origin = "Origin: http://127.0.0.1\r\n";
  EXPECT_EQ(status_of_upgrade(with(good, origin, "")), 403);
  EXPECT_EQ(status_of_upgrade(with(good, origin, "Origin: http://evil.example\r\n")), 403);
  EXPECT_EQ(status_of_upgrade(with(good, origin, "Origin: http://localhost\r\n")), 403);
  EXPECT_EQ(status_of_upgrade(with(good, "Host: 127.0.0.1", "Host: evil.example")), 421);
  EXPECT_EQ(status_of_upgrade(with(good, "Version: 13", "Version: 8")), 426);
  EXPECT_EQ(status_of_upgrade(with(good, "Upgrade: websocket", "Upgrade: h2c")), 400);
  EXPECT_EQ(status_of_upgrade(with(good, origin, origin + "Origin: http://evil.example\r\n")), 400);
  EXPECT_EQ(status_of_upgrade(with(good, "dGhlIHNhbXBsZSBub25jZQ==", "dGhlIHNhbXBsZQ==")), 400);
  EXPECT_EQ(status_of_upgrade(good, "too early"), 400);
  EXPECT_THAT(application_.joined_pages(), IsEmpty());
  expect_alive();
}

TEST_F(WebPages, MessagesArriveWholeAndInOrder) {
  application_.on_joined = [this](PageId page) {
    for (int i = 0; i < 100; ++i) server_->send(page, bytes("to page " + std::to_string(i)));
  };
  start();
  PageClient page(port());
  for (int i = 0; i < 100; ++i) {
    const auto frame = page.receive_message();
    EXPECT_EQ(frame.opcode, PageClient::kBinary);
    EXPECT_EQ(frame.payload, "to page " + std::to_string(i));
  }
  page.send("one");
  page.send(std::string(settings_.message_limit, 'x'));
  ASSERT_TRUE(application_.await_messages(2));
  EXPECT_EQ(application_.messages()[0].text, "one");
  EXPECT_EQ(application_.messages()[1].text, std::string(settings_.message_limit, 'x'));
}

TEST_F(WebPages, TextIsRefused) {
  start();
  PageClient page(port());
  page.send("hello", PageClient::kText);
  EXPECT_EQ(page.receive_message().code(), 1003);
  EXPECT_TRUE(application_.await_left(1));
  EXPECT_THAT(application_.messages(), IsEmpty());
}

TEST_F(WebPages, AMessageOfAHundredMegabytesIsRefusedAtTheLimit) {
  start();
  PageClient page(port());
  PageClient other(port());
  page.begin(100'000'000);
  const std::string piece(65536, 'x');
  for (int i = 0; i < 1526 && page.connection().send(piece); ++i) {
  }
  ASSERT_TRUE(application_.await_left(1));
  EXPECT_THAT(application_.messages(), IsEmpty());
  other.send("still here");
  EXPECT_TRUE(application_.await_messages(1));
}

TEST_F(WebPages, AMessageOfOneByteMoreIsRefused) {
  start();
  PageClient page(port());
  page.send(std::string(settings_.message_limit + 1, 'x'));
  EXPECT_EQ(page.receive_message().code(), 1009);
  EXPECT_TRUE(application_.await_left(1));
  EXPECT_THAT(application_.messages(), IsEmpty());
}

TEST_F(WebPages, AFrameThatIsNotMaskedIsRefused) {
  start();
  PageClient page(port());
  page.connection().send(std::string("\x82\x01x", 3));
  EXPECT_EQ(page.receive_message().code(), 1002);
  EXPECT_TRUE(application_.await_left(1));
}

TEST_F(WebPages, APageOverTheRateLimitIsDisconnected) {
  settings_.messages_per_second = 50;
  start();
  PageClient page(port());
  for (int i = 0; i < 3000; ++i) page.send("now");
  EXPECT_TRUE(application_.await_left(1));
  EXPECT_GE(application_.messages().size(), 50U);
  EXPECT_LT(application_.messages().size(), 3000U);
  const auto frame = page.receive_message();
  EXPECT_EQ(frame.code(), 1008);
  EXPECT_EQ(frame.reason(), "too many messages in a second");
}

TEST_F(WebPages, MessagesOverTheRateLimitAreReportedApart) {
  settings_.messages_per_second = 50;
  start();
  PageClient page(port());
  std::vector<std::string> burst(50 + 500, "now");
  burst.emplace_back("the last");
  page.send_at_once(burst);
  EXPECT_TRUE(application_.await_left(1));
  for (const auto& message : application_.messages()) EXPECT_EQ(message.text, "now");
  ASSERT_FALSE(application_.over_limit_messages().empty());
  EXPECT_EQ(application_.over_limit_messages().back().text, "the last");
  EXPECT_EQ(application_.messages().size() + application_.over_limit_messages().size(), 551U);
  EXPECT_EQ(page.receive_message().reason(), "too many messages in a second");
}

TEST_F(WebPages, MessagesOverTheRateLimitAreReportedForOneBurstOnly) {
  settings_.messages_per_second = 50;
  start();
  PageClient page(port());
  const std::string piece(8000, 'x');
  page.send_at_once(std::vector<std::string>(50 + 100, piece));
  EXPECT_TRUE(application_.await_left(1));
  EXPECT_LE(application_.over_limit_messages().size(), 9U) << "64 KiB";
}

// A message counts with 6 bytes of its frame: 1024 x (58 + 6) are the 64 KiB, and one more exceeds them.
TEST_F(WebPages, MessagesOverTheRateLimitAreReportedUpTo64KiBTheirFramesIncluded) {
  settings_.messages_per_second = 50;
  start();
  PageClient page(port());
  page.send_at_once(std::vector<std::string>(50 + 1200, std::string(58, 'x')));
  EXPECT_TRUE(application_.await_left(1));
  EXPECT_EQ(application_.over_limit_messages().size(), 1025U);
}

TEST_F(WebPages, PingsCountForTheRateLimit) {
  settings_.messages_per_second = 50;
  start();
  PageClient page(port());
  for (int i = 0; i < 3000; ++i) page.send("", PageClient::kPing);
  EXPECT_TRUE(application_.await_left(1));
}

TEST_F(WebPages, ADisconnectedPageGetsWhatWasSentBeforeAndTheReason) {
  application_.on_received = [this](PageId page, std::string_view) {
    server_->send(page, bytes("the last message"));
    server_->disconnect(page, "the station is being repaired");
    server_->send(page, bytes("never"));
  };
  start();
  PageClient page(port());
  page.send("hello");
  EXPECT_EQ(page.receive_message().payload, "the last message");
  const auto frame = page.receive_message();
  EXPECT_EQ(frame.opcode, PageClient::kClose);
  EXPECT_EQ(frame.code(), 1008);
  EXPECT_EQ(frame.reason(), "the station is being repaired");
  page.send("more");
  EXPECT_TRUE(application_.await_left(1));
  EXPECT_EQ(page.receive_until_closed().opcode, PageClient::kGone);
  EXPECT_EQ(application_.messages().size(), 1U);
  EXPECT_EQ(application_.left_pages().size(), 1U);
}

TEST_F(WebPages, APageThatIsResetHasLeft) {
  start();
  PageClient page(port());
  ASSERT_TRUE(application_.await_joined(1));
  page.connection().abort();
  ASSERT_TRUE(application_.await_left(1));
  EXPECT_THAT(application_.left_pages(), ElementsAre(application_.joined_pages()[0].first));
}

TEST_F(WebPages, APageThatClosesHasLeft) {
  start();
  PageClient page(port());
  page.send(std::string("\x03\xe8", 2), PageClient::kClose);
  EXPECT_EQ(page.receive_until_closed().code(), 1000);
  EXPECT_TRUE(application_.await_left(1));
}

TEST_F(WebPages, NumbersAreNeverUsedTwice) {
  std::set<PageId> seen;
  for (int round = 0; round < 2; ++round) {
    FakeApplication application;
    WebServer server(settings_, application);
    server.start();
    for (std::size_t i = 1; i <= 5; ++i) {
      PageClient page(server.port());
      ASSERT_TRUE(application.await_joined(i));
    }
    for (const auto& [id, client] : application.joined_pages()) EXPECT_TRUE(seen.insert(id).second);
  }
}

TEST_F(WebPages, FramesComeWhileThereIsAPage) {
  start();
  expect_alive();
  EXPECT_EQ(application_.frames(), 0U);
  {
    PageClient page(port());
    ASSERT_TRUE(application_.await_frames(10));
  }
  ASSERT_TRUE(application_.await_left(1));
  const std::size_t then = application_.frames();
  PageClient next(port());
  ASSERT_TRUE(application_.await_frames(then + 10));
}

TEST_F(WebPages, APageThatDoesNotAnswerAPingHasLeft) {
  settings_.idle_timeout = 0.2;
  start();
  PageClient page(port());
  ASSERT_TRUE(application_.await_left(1));
}

TEST_F(WebPages, APageThatAnswersPingsStays) {
  settings_.idle_timeout = 10.0;  // half of it for each answer
  start();
  PageClient page(port());
  for (int i = 0; i < 2; ++i) {
    const auto frame = page.receive();
    ASSERT_EQ(frame.opcode, PageClient::kPing);
    page.send(frame.payload, PageClient::kPong);
  }
  page.send("still here");
  ASSERT_TRUE(application_.await_messages(1));
  EXPECT_THAT(application_.left_pages(), IsEmpty());
}

TEST_F(WebPages, StoppingClosesAllPages) {
  start();
  PageClient first(port());
  PageClient second(port());
  ASSERT_TRUE(application_.await_joined(2));
  auto stopped = std::async(std::launch::async, [this] { server_->stop(); });
  for (PageClient* page : {&first, &second}) EXPECT_EQ(page->receive_until_closed().code(), 1001);
  stopped.get();
  EXPECT_EQ(application_.left_pages().size(), 2U);
  server_->stop();
  server_->post([] { FAIL() << "nothing runs any more"; });
  EXPECT_THROW(RawClient(server_->port()), std::runtime_error) << "no server listens";
}

TEST_F(WebPages, WhatIsPostedBeforeTheStartRunsOnTheServersThread) {
  server_ = std::make_unique<WebServer>(settings_, application_);
  std::promise<std::thread::id> where;
  server_->post([&where] { where.set_value(std::this_thread::get_id()); });
  server_->start();
  EXPECT_NE(where.get_future().get(), std::this_thread::get_id());
}

}  // namespace
}  // namespace phalanx

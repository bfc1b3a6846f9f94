// SPDX-License-Identifier: Apache-2.0
// Pages over WebSockets: who becomes one, what is said, who is shown out.
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
    client.say(PageClient::head(fields) + behind);
    return status_of(client.hear_answer());
  }
  static std::string with(std::string fields, const std::string& what, const std::string& instead) {
    const std::size_t at = fields.find(what);
    EXPECT_NE(at, std::string::npos) << what;
    return fields.replace(at, what.size(), instead);
  }
};

TEST_F(WebPages, APageIsWelcomedByTheProtocol) {
  start();
  PageClient page(port());
  EXPECT_EQ(status_of(page.welcome()), 101);
  // The example of RFC 6455, section 1.3.
  EXPECT_EQ(field_of(page.welcome(), "Sec-WebSocket-Accept"), "s3pPLMBiTxaQ9kYGzzhZRbK+xOo=");
  EXPECT_EQ(field_of(page.welcome(), "X-Content-Type-Options"), "nosniff");
  ASSERT_TRUE(application_.await_joined(1));
  const auto [id, visitor] = application_.joined_pages()[0];
  EXPECT_GE(id, 1U);
  EXPECT_EQ(visitor.address, "127.0.0.1");
  EXPECT_TRUE(visitor.may_operate);
}

TEST_F(WebPages, OnlyTheSitesOwnPageBecomesOne) {
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

TEST_F(WebPages, WhatIsSaidArrivesWholeAndInOrder) {
  application_.on_joined = [this](PageId page) {
    for (int i = 0; i < 100; ++i) server_->send(page, bytes("to page " + std::to_string(i)));
  };
  start();
  PageClient page(port());
  for (int i = 0; i < 100; ++i) {
    const auto frame = page.hear_message();
    EXPECT_EQ(frame.opcode, PageClient::kBinary);
    EXPECT_EQ(frame.payload, "to page " + std::to_string(i));
  }
  page.say("one");
  page.say(std::string(settings_.message_limit, 'x'));
  ASSERT_TRUE(application_.await_messages(2));
  EXPECT_EQ(application_.messages()[0].text, "one");
  EXPECT_EQ(application_.messages()[1].text, std::string(settings_.message_limit, 'x'));
}

TEST_F(WebPages, TextIsRefused) {
  start();
  PageClient page(port());
  page.say("hello", PageClient::kText);
  EXPECT_EQ(page.hear_message().code(), 1003);
  EXPECT_TRUE(application_.await_left(1));
  EXPECT_THAT(application_.messages(), IsEmpty());
}

TEST_F(WebPages, AMessageOfAHundredMegabytesIsRefusedAtTheLimit) {
  start();
  PageClient page(port());
  PageClient other(port());
  page.begin(100'000'000);
  const std::string piece(65536, 'x');
  for (int i = 0; i < 1526 && page.line().say(piece); ++i) {
  }
  ASSERT_TRUE(application_.await_left(1));
  EXPECT_THAT(application_.messages(), IsEmpty());
  other.say("still here");
  EXPECT_TRUE(application_.await_messages(1));
}

TEST_F(WebPages, AMessageOfOneByteMoreIsRefused) {
  start();
  PageClient page(port());
  page.say(std::string(settings_.message_limit + 1, 'x'));
  EXPECT_EQ(page.hear_message().code(), 1009);
  EXPECT_TRUE(application_.await_left(1));
  EXPECT_THAT(application_.messages(), IsEmpty());
}

TEST_F(WebPages, AFrameThatIsNotMaskedIsRefused) {
  start();
  PageClient page(port());
  page.line().say(std::string("\x82\x01x", 3));
  EXPECT_EQ(page.hear_message().code(), 1002);
  EXPECT_TRUE(application_.await_left(1));
}

TEST_F(WebPages, WhoSaysTooMuchIsShownOut) {
  settings_.messages_per_second = 50;
  start();
  PageClient page(port());
  for (int i = 0; i < 3000; ++i) page.say("now");
  EXPECT_TRUE(application_.await_left(1));
  EXPECT_GE(application_.messages().size(), 50U);
  EXPECT_LT(application_.messages().size(), 3000U);
  const auto frame = page.hear_message();
  EXPECT_EQ(frame.code(), 1008);
  EXPECT_EQ(frame.reason(), "too many messages in a second");
}

TEST_F(WebPages, TheLastWordsOfABurstAreHeardApart) {
  settings_.messages_per_second = 50;
  start();
  PageClient page(port());
  std::vector<std::string> burst(50 + 500, "now");
  burst.emplace_back("the last");
  page.say_at_once(burst);
  EXPECT_TRUE(application_.await_left(1));
  for (const auto& message : application_.messages()) EXPECT_EQ(message.text, "now");
  ASSERT_FALSE(application_.last_words().empty());
  EXPECT_EQ(application_.last_words().back().text, "the last");
  EXPECT_EQ(application_.messages().size() + application_.last_words().size(), 551U);
  EXPECT_EQ(page.hear_message().reason(), "too many messages in a second");
}

TEST_F(WebPages, NotForLongerThanABurst) {
  settings_.messages_per_second = 50;
  start();
  PageClient page(port());
  const std::string piece(8000, 'x');
  page.say_at_once(std::vector<std::string>(50 + 100, piece));
  EXPECT_TRUE(application_.await_left(1));
  EXPECT_LE(application_.last_words().size(), 9U) << "64 KiB";
}

// A message counts with 6 bytes of its frame: 1024 x (58 + 6) are the 64 KiB, and one more is too much.
TEST_F(WebPages, LastWordsAreHeardUpTo64KiBTheirFramesIncluded) {
  settings_.messages_per_second = 50;
  start();
  PageClient page(port());
  page.say_at_once(std::vector<std::string>(50 + 1200, std::string(58, 'x')));
  EXPECT_TRUE(application_.await_left(1));
  EXPECT_EQ(application_.last_words().size(), 1025U);
}

TEST_F(WebPages, PingsCount) {
  settings_.messages_per_second = 50;
  start();
  PageClient page(port());
  for (int i = 0; i < 3000; ++i) page.say("", PageClient::kPing);
  EXPECT_TRUE(application_.await_left(1));
}

TEST_F(WebPages, OneThatIsShownOutHearsWhatWasSaidBeforeAndWhy) {
  application_.on_received = [this](PageId page, std::string_view) {
    server_->send(page, bytes("last word"));
    server_->show_out(page, "the station is being repaired");
    server_->send(page, bytes("never"));
  };
  start();
  PageClient page(port());
  page.say("hello");
  EXPECT_EQ(page.hear_message().payload, "last word");
  const auto frame = page.hear_message();
  EXPECT_EQ(frame.opcode, PageClient::kClose);
  EXPECT_EQ(frame.code(), 1008);
  EXPECT_EQ(frame.reason(), "the station is being repaired");
  page.say("more");
  EXPECT_TRUE(application_.await_left(1));
  EXPECT_EQ(page.hear_end().opcode, PageClient::kGone);
  EXPECT_EQ(application_.messages().size(), 1U);
  EXPECT_EQ(application_.left_pages().size(), 1U);
}

TEST_F(WebPages, OneThatVanishesHasLeft) {
  start();
  PageClient page(port());
  ASSERT_TRUE(application_.await_joined(1));
  page.line().vanish();
  ASSERT_TRUE(application_.await_left(1));
  EXPECT_THAT(application_.left_pages(), ElementsAre(application_.joined_pages()[0].first));
}

TEST_F(WebPages, OneThatClosesHasLeft) {
  start();
  PageClient page(port());
  page.say(std::string("\x03\xe8", 2), PageClient::kClose);
  EXPECT_EQ(page.hear_end().code(), 1000);
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
    for (const auto& [id, visitor] : application.joined_pages()) EXPECT_TRUE(seen.insert(id).second);
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

TEST_F(WebPages, OneThatDoesNotAnswerAPingIsGone) {
  settings_.idle_timeout = 0.2;
  start();
  PageClient page(port());
  ASSERT_TRUE(application_.await_left(1));
}

TEST_F(WebPages, OneThatAnswersStays) {
  settings_.idle_timeout = 10.0;  // half of it for each answer
  start();
  PageClient page(port());
  for (int i = 0; i < 2; ++i) {
    const auto frame = page.hear();
    ASSERT_EQ(frame.opcode, PageClient::kPing);
    page.say(frame.payload, PageClient::kPong);
  }
  page.say("still here");
  ASSERT_TRUE(application_.await_messages(1));
  EXPECT_THAT(application_.left_pages(), IsEmpty());
}

TEST_F(WebPages, StoppingSaysGoodbyeToAll) {
  start();
  PageClient first(port());
  PageClient second(port());
  ASSERT_TRUE(application_.await_joined(2));
  auto stopped = std::async(std::launch::async, [this] { server_->stop(); });
  for (PageClient* page : {&first, &second}) EXPECT_EQ(page->hear_end().code(), 1001);
  stopped.get();
  EXPECT_EQ(application_.left_pages().size(), 2U);
  server_->stop();
  server_->post([] { FAIL() << "nothing runs any more"; });
  EXPECT_THROW(RawClient(server_->port()), std::runtime_error) << "nobody listens";
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

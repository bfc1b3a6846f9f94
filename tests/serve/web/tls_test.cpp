// SPDX-License-Identifier: Apache-2.0
// TLS and tokens.
#include <gmock/gmock.h>
#include <poll.h>
#include <sys/socket.h>

#include <array>

#include "phalanx/serve/reach.h"
#include "serve/web/page_client.h"
#include "serve/web/web_fixture.h"

namespace phalanx {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

class WebTls : public WebTest {
 protected:
  void SetUp() override {
    WebTest::SetUp();
    const CertificateFiles files = make_self_signed_certificate(folder_ / "keys", {});
    settings_.certificate = files.certificate;
    settings_.key = files.key;
    settings_.operator_token = random_token();
    settings_.viewer_token = random_token();
  }
  std::string ask(const std::string& path, const std::string& fields = "") const {
    return ask_securely(port(), get(path, fields));
  }
  std::string cookie_by(const std::string& token) const {
    const std::string field = field_of(ask("/?token=" + token), "Set-Cookie");
    return "Cookie: other=1; " + field.substr(0, field.find(';')) + "\r\n";
  }
  std::unique_ptr<PageClient> page(const std::string& fields, const std::string& path = "/") const {
    std::string own = PageClient::good_fields();
    own.replace(own.find("http:"), 5, "https:");
    return std::make_unique<PageClient>(RawClient::secure(port()), PageClient::head(own + fields, path));
  }
};

TEST_F(WebTls, AnAddressWithATokenSetsACookieAndRedirectsWithoutIt) {
  start();
  EXPECT_TRUE(server_->tls());
  EXPECT_THAT(server_->url(), StartsWith("https://127.0.0.1:"));
  const std::string answer = ask("/assets/app-1a2b.js?a=1&token=" + settings_.operator_token + "&b=2");
  EXPECT_EQ(status_of(answer), 303);
  EXPECT_EQ(field_of(answer, "Location"), "/assets/app-1a2b.js?a=1&b=2");
  const std::string cookie = field_of(answer, "Set-Cookie");
  for (const char* part : {"; HttpOnly", "; SameSite=Strict", "; Secure", "; Path=/"}) {
    EXPECT_THAT(cookie, HasSubstr(part));
  }
  EXPECT_EQ(field_of(ask("/?token=" + settings_.operator_token), "Location"), "/");
  EXPECT_EQ(status_of(ask("/", cookie_by(settings_.operator_token))), 200);
}

TEST_F(WebTls, WithoutATokenAllRequestsAreRefused) {
  start();
  const std::string wrong = random_token();
  for (const std::string& path :
       {std::string("/"), std::string("/assets/app-1a2b.js"), std::string("/none"), std::string("/?token="),
        "/?token=" + wrong, "/?token=" + settings_.operator_token.substr(1),
        "/?Token=" + settings_.operator_token, "/?token=" + wrong + "&token=" + settings_.operator_token}) {
    const std::string answer = ask(path);
    EXPECT_EQ(status_of(answer), 403) << path;
    EXPECT_EQ(field_of(answer, "Set-Cookie"), "") << path;
    EXPECT_THAT(body_of(answer), HasSubstr("token")) << path;
  }
  EXPECT_EQ(status_of(ask("/", "Cookie: phalanx-" + std::to_string(port()) + "=" + wrong + "\r\n")), 403);
  EXPECT_EQ(status_of(page("")->handshake()), 403);
  EXPECT_THAT(application_.requests(), IsEmpty());
  EXPECT_THAT(application_.joined_pages(), IsEmpty());
}

TEST_F(WebTls, TheCookieDecidesWhoMayOperate) {
  start();
  const auto operates = page(cookie_by(settings_.operator_token));
  ASSERT_EQ(status_of(operates->handshake()), 101);
  ASSERT_TRUE(application_.await_joined(1));
  const auto looks = page(cookie_by(settings_.viewer_token));
  ASSERT_EQ(status_of(looks->handshake()), 101);
  ASSERT_TRUE(application_.await_joined(2));
  EXPECT_TRUE(application_.joined_pages()[0].second.may_operate);
  EXPECT_FALSE(application_.joined_pages()[1].second.may_operate);
  ask("/request", cookie_by(settings_.viewer_token));
  ASSERT_TRUE(application_.await_requests(1));
  EXPECT_FALSE(application_.requests()[0].client.may_operate);
}

TEST_F(WebTls, AWebSocketMayHaveTheTokenInItsQuery) {
  start();
  const auto looks = page("", "/?token=" + settings_.viewer_token);
  ASSERT_EQ(status_of(looks->handshake()), 101);
  ASSERT_TRUE(application_.await_joined(1));
  EXPECT_FALSE(application_.joined_pages()[0].second.may_operate);
}

TEST_F(WebTls, MessagesOfAnyLengthGetThroughBothWays) {
  application_.on_received = [this](PageId page, std::string_view message) {
    server_->send(page, std::make_shared<const std::string>(message));
  };
  start();
  const auto echoing = page(cookie_by(settings_.operator_token));
  for (const std::size_t length : {0U, 1U, 125U, 126U, 16'384U, 65'535U, 65'536U}) {
    const std::string text(length, 'x');
    echoing->send(text);
    EXPECT_EQ(echoing->receive_message().payload, text);
  }
}

TEST_F(WebTls, AnotherSchemesOriginIsNotThePages) {
  start();
  const std::string cookie = cookie_by(settings_.operator_token);
  PageClient plain(RawClient::secure(port()), PageClient::head(PageClient::good_fields() + cookie));
  EXPECT_EQ(status_of(plain.handshake()), 403);
}

TEST_F(WebTls, AClientThatDoesNotFinishTheHandshakeIsDisconnected) {
  settings_.request_timeout = 2.0;
  start();
  RawClient half(port());
  half.send(std::string("\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03", 11));
  EXPECT_EQ(half.receive_all(), "");
  RawClient silent(port());
  EXPECT_EQ(silent.receive_all(), "");
  EXPECT_EQ(status_of(ask("/", cookie_by(settings_.operator_token))), 200);
}

// 127.0.0.2 is an address of this machine, like all of 127/8, but none of the accepted names. A request
// whose Host is accepted is refused for want of a token (403).
TEST_F(WebTls, TheHostMayBeTheConnectionsOwnAddress) {
  settings_.address = "0.0.0.0";
  start();
  const auto status = [this](const char* reached) {
    const auto client = RawClient::secure(port(), reached);
    client->send("GET / HTTP/1.1\r\nHost: 127.0.0.2\r\nConnection: close\r\n\r\n");
    return status_of(client->receive_all());
  };
  EXPECT_EQ(status("127.0.0.2"), 403);
  EXPECT_EQ(status("127.0.0.1"), 421);
}

// More bytes than one read takes. If the rest stayed unread, the connection would end with a reset. A reset
// could discard the response before the client has read it.
TEST_F(WebTls, AConnectionWithInvalidTlsRecordsClosesWithoutAReset) {
  start();
  const auto client = RawClient::secure(port());
  const std::string noise(100'000, 'x');
  ASSERT_EQ(::send(client->descriptor(), noise.data(), noise.size(), MSG_NOSIGNAL),
            static_cast<ssize_t>(noise.size()));
  std::array<char, 4096> piece{};
  ssize_t got = 1;
  while (got > 0) {
    pollfd comes{.fd = client->descriptor(), .events = POLLIN, .revents = 0};
    ASSERT_EQ(::poll(&comes, 1, 300'000), 1);
    got = ::recv(client->descriptor(), piece.data(), piece.size(), 0);
  }
  EXPECT_EQ(got, 0);
}

TEST_F(WebTls, OfTls12OnlySuitesWithoutCbcAreAccepted) {
  start();
  for (const char* suites : {"ECDHE-ECDSA-AES128-GCM-SHA256", "ECDHE-ECDSA-CHACHA20-POLY1305"})
    EXPECT_NO_THROW((void)RawClient::secure(port(), "127.0.0.1", suites)) << suites;
  for (const char* suites :
       {"ECDHE-ECDSA-AES128-SHA256", "ECDHE-ECDSA-AES256-SHA384", "ECDHE-ECDSA-AES128-SHA"})
    EXPECT_THROW((void)RawClient::secure(port(), "127.0.0.1", suites), std::runtime_error) << suites;
}

TEST_F(WebTls, PlainHttpGetsNothing) {
  start();
  EXPECT_EQ(status_of(phalanx::ask(port(), get("/?token=" + settings_.operator_token))), 0);
}

TEST_F(WebTls, StoppingClosesPagesOverTls) {
  start();
  const auto one = page(cookie_by(settings_.operator_token));
  ASSERT_TRUE(application_.await_joined(1));
  server_->stop();
  EXPECT_EQ(one->receive_message().code(), 1001);
  EXPECT_EQ(application_.left_pages().size(), 1U);
}

}  // namespace
}  // namespace phalanx

// SPDX-License-Identifier: Apache-2.0
// Who gets in, judged without a socket.
#include "serve/web/doors.h"

#include <gtest/gtest.h>

#include <set>
#include <string>
#include <variant>

#include "phalanx/serve/reach.h"
#include "serve/web/names.h"
#include "serve/web/reply.h"

namespace phalanx::web {
namespace {

constexpr const char* kOperators = "operator-token-16";
constexpr const char* kViewers = "viewers-token--16";

/// 403: refused; 1: may operate; 2: may look; 11 and 12: the same, and a cookie is set.
int judged(const TokenDoor& door, const std::string& query, const std::string& cookies = "") {
  const TokenDoor::Verdict verdict = door.judge(query, cookies);
  if (const auto* refused = std::get_if<Reply>(&verdict)) return refused->status;
  if (const auto* known = std::get_if<TokenDoor::Entry>(&verdict)) return known->may_operate ? 1 : 2;
  return std::get<TokenDoor::Cookie>(verdict).may_operate ? 11 : 12;
}

TEST(TokenDoor, AnEmptyTokenIsNobodysWhereThereIsNoViewersToken) {
  const TokenDoor door(kOperators, "", 8480, true);
  for (const char* query : {"", "token", "token=", "token=&token=operator-token-16", "a=b&token="})
    EXPECT_EQ(judged(door, query), 403) << query;
  for (const char* cookies : {"phalanx-8480", "phalanx-8480=", "a=b; phalanx-8480=; c=d"})
    EXPECT_EQ(judged(door, "", cookies), 403) << cookies;
  EXPECT_EQ(judged(door, "token=operator-token-16"), 11);
  EXPECT_EQ(judged(door, "", "phalanx-8480=operator-token-16"), 1);
}

TEST(TokenDoor, EachTokenGivesItsOwnRight) {
  const TokenDoor door(kOperators, kViewers, 8480, true);
  EXPECT_EQ(judged(door, "token=operator-token-16"), 11);
  EXPECT_EQ(judged(door, "token=viewers-token--16"), 12);
  EXPECT_EQ(judged(door, "", "phalanx-8480=operator-token-16"), 1);
  EXPECT_EQ(judged(door, "", "phalanx-8480=viewers-token--16"), 2);
  EXPECT_EQ(judged(door, "", "phalanx-8481=operator-token-16"), 403) << "another station's cookie";
  for (const char* query : {"token=", "token=viewers-token--1", "token=viewers-token--166", "token=operator"})
    EXPECT_EQ(judged(door, query), 403) << query;
}

TEST(TokenDoor, WithoutTokensEverybodyMayOperate) {
  EXPECT_EQ(judged(TokenDoor("", "", 8480, false), ""), 1);
}

TEST(TokenDoor, TheCookieIsSecureWhereTheConnectionIs) {
  const auto field = [](bool tls) {
    return std::get<TokenDoor::Cookie>(
               TokenDoor(kOperators, "", 8480, tls).judge("token=operator-token-16", ""))
        .field;
  };
  EXPECT_EQ(field(true), "phalanx-8480=operator-token-16; Path=/; HttpOnly; SameSite=Strict; Secure");
  EXPECT_EQ(field(false), "phalanx-8480=operator-token-16; Path=/; HttpOnly; SameSite=Strict");
}

TEST(HostName, APortHasUpToFiveDigits) {
  EXPECT_EQ(host_name("localhost:1"), "localhost");
  EXPECT_EQ(host_name("localhost:65535"), "localhost");
  EXPECT_EQ(host_name("[::1]:65535"), "::1");
  EXPECT_EQ(host_name("localhost:655350"), std::nullopt);
}

TEST(SameSecret, IsTheWholeText) {
  EXPECT_TRUE(same_secret("", ""));
  EXPECT_TRUE(same_secret("abc", "abc"));
  EXPECT_FALSE(same_secret("abc", "abd"));
  EXPECT_FALSE(same_secret("abc", "abcd"));
  EXPECT_FALSE(same_secret("", "a"));
}

// The first is the example of RFC 6455, section 1.3.
TEST(WebSocketKey, IsSixteenBytesInBase64) {
  for (const char* key : {"dGhlIHNhbXBsZSBub25jZQ==", "AAAAAAAAAAAAAAAAAAAAAA==", "++++++++++//////////zw=="})
    EXPECT_TRUE(is_websocket_key(key)) << key;
  for (const char* key :
       {"", "==", "dGhlIHNhbXBsZSBub25jZQ", "dGhlIHNhbXBsZSBub25jZQ=", "dGhlIHNhbXBsZSBub25jZQ===",
        "AAAAAAAAAAAAAAAAAAAAA===", "AAAAAAAAAAAAAAAAAAAAAAA=", "AAAAAAAAAAAAAAAAAAAAAAAAAA==",
        "AAAAAAAAAA-AAAAAAAAAAA==", "AAAAAAAAAA AAAAAAAAAAA==", "AAAAAAAAAA=AAAAAAAAAAA=="})
    EXPECT_FALSE(is_websocket_key(key)) << key;
}

TEST(NamesOfServer, OnLoopbackAreNoNamesOfTheNetwork) {
  for (const char* address : {"127.0.0.1", "localhost", "::1", "127.3.2.1"}) {
    std::set<std::string> names{"localhost", "127.0.0.1", "::1"};
    names.insert(address);
    EXPECT_EQ(names_of_server(address), names);
  }
  for (const std::string& name : machine_names()) EXPECT_TRUE(names_of_server("0.0.0.0").contains(name));
}

TEST(OriginRefusal, TheSchemeIsTheConnectionsOwn) {
  EXPECT_FALSE(origin_refusal("http://localhost:8480", "localhost:8480", false));
  EXPECT_TRUE(origin_refusal("https://localhost:8480", "localhost:8480", false));
  EXPECT_FALSE(origin_refusal("https://localhost:8480", "localhost:8480", true));
  EXPECT_TRUE(origin_refusal("http://localhost:8480", "localhost:8480", true));
}

/// What a page of "host" may connect to.
std::string policy(bool tls) {
  Exchange exchange;
  exchange.host = "host:8480";
  exchange.tls = tls;
  http::fields fields;
  protect(fields, exchange);
  return std::string(fields["Content-Security-Policy"]);
}

TEST(Protect, APageMayOpenWebSocketsOfItsOwnSchemeOnly) {
  EXPECT_NE(policy(false).find("connect-src 'self' ws://host:8480;"), std::string::npos);
  EXPECT_NE(policy(true).find("connect-src 'self' wss://host:8480;"), std::string::npos);
}

}  // namespace
}  // namespace phalanx::web

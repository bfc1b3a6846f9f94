// SPDX-License-Identifier: Apache-2.0
#include "serve/web/request_checks.h"

#include <gtest/gtest.h>

#include <set>
#include <string>
#include <variant>

#include "phalanx/serve/reach.h"
#include "serve/web/response.h"

namespace phalanx::web {
namespace {

constexpr const char* kOperators = "operator-token-16";
constexpr const char* kViewers = "viewers-token--16";

/// @returns 403: refused; 1: may operate; 2: may view; 11 and 12: the same, and a cookie is set
int result_of(const TokenCheck& check, const std::string& query, const std::string& cookies = "") {
  const TokenCheck::Result result = check.check(query, cookies);
  if (const auto* refused = std::get_if<Reply>(&result)) return refused->status;
  if (const auto* accepted = std::get_if<TokenCheck::Accepted>(&result)) return accepted->may_operate ? 1 : 2;
  return std::get<TokenCheck::AcceptedByAddress>(result).may_operate ? 11 : 12;
}

TEST(TokenCheck, AnEmptyTokenIsRefusedIfThereIsNoViewersToken) {
  const TokenCheck check(kOperators, "", 8480, true);
  for (const char* query : {"", "token", "token=", "token=&token=operator-token-16", "a=b&token="})
    EXPECT_EQ(result_of(check, query), 403) << query;
  for (const char* cookies : {"phalanx-8480", "phalanx-8480=", "a=b; phalanx-8480=; c=d"})
    EXPECT_EQ(result_of(check, "", cookies), 403) << cookies;
  EXPECT_EQ(result_of(check, "token=operator-token-16"), 11);
  EXPECT_EQ(result_of(check, "", "phalanx-8480=operator-token-16"), 1);
}

TEST(TokenCheck, EachTokenGivesItsOwnRight) {
  const TokenCheck check(kOperators, kViewers, 8480, true);
  EXPECT_EQ(result_of(check, "token=operator-token-16"), 11);
  EXPECT_EQ(result_of(check, "token=viewers-token--16"), 12);
  EXPECT_EQ(result_of(check, "", "phalanx-8480=operator-token-16"), 1);
  EXPECT_EQ(result_of(check, "", "phalanx-8480=viewers-token--16"), 2);
  EXPECT_EQ(result_of(check, "", "phalanx-8481=operator-token-16"), 403) << "another station's cookie";
  for (const char* query : {"token=", "token=viewers-token--1", "token=viewers-token--166", "token=operator"})
    EXPECT_EQ(result_of(check, query), 403) << query;
}

TEST(TokenCheck, WithoutTokensAllClientsMayOperate) {
  EXPECT_EQ(result_of(TokenCheck("", "", 8480, false), ""), 1);
}

TEST(TokenCheck, TheCookieIsSecureWhereTheConnectionIs) {
  const auto field = [](bool tls) {
    return std::get<TokenCheck::AcceptedByAddress>(
               TokenCheck(kOperators, "", 8480, tls).check("token=operator-token-16", ""))
        .cookie;
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

TEST(EqualSecrets, IsTheWholeText) {
  EXPECT_TRUE(equal_secrets("", ""));
  EXPECT_TRUE(equal_secrets("abc", "abc"));
  EXPECT_FALSE(equal_secrets("abc", "abd"));
  EXPECT_FALSE(equal_secrets("abc", "abcd"));
  EXPECT_FALSE(equal_secrets("", "a"));
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

TEST(ServerNames, OnLoopbackAreNoNamesOfTheNetwork) {
  for (const char* address : {"127.0.0.1", "localhost", "::1", "127.3.2.1"}) {
    std::set<std::string> names{"localhost", "127.0.0.1", "::1"};
    names.insert(address);
    EXPECT_EQ(server_names(address), names);
  }
  for (const std::string& name : machine_names()) EXPECT_TRUE(server_names("0.0.0.0").contains(name));
}

TEST(OriginRefusal, TheSchemeIsTheConnectionsOwn) {
  EXPECT_FALSE(origin_refusal("http://localhost:8480", "localhost:8480", false));
  EXPECT_TRUE(origin_refusal("https://localhost:8480", "localhost:8480", false));
  EXPECT_FALSE(origin_refusal("https://localhost:8480", "localhost:8480", true));
  EXPECT_TRUE(origin_refusal("http://localhost:8480", "localhost:8480", true));
}

/// @returns the policy of a page whose server is "host"
std::string policy(bool tls) {
  ResponseContext context;
  context.host = "host:8480";
  context.tls = tls;
  http::fields fields;
  set_security_fields(fields, context);
  return std::string(fields["Content-Security-Policy"]);
}

TEST(SecurityFields, APageMayOpenWebSocketsOfItsOwnSchemeOnly) {
  EXPECT_NE(policy(false).find("connect-src 'self' ws://host:8480;"), std::string::npos);
  EXPECT_NE(policy(true).find("connect-src 'self' wss://host:8480;"), std::string::npos);
}

TEST(ReadTarget, AcceptsUtf8AndRefusesWhatIsInvalid) {
  EXPECT_EQ(read_target("/W%C3%BCrfel.stl?q=%2F")->path, "/W\u00fcrfel.stl");
  EXPECT_EQ(read_target("/W%C3%BCrfel.stl?q=%2F")->query, "q=%2F");
  for (const char* broken : {"/%C3", "/%C0%80", "/%ED%A0%80", "/%F5%80%80%80", "/%80", "/%0A", "/%7F", ""}) {
    EXPECT_FALSE(read_target(broken)) << broken;
  }
}

TEST(ReadTarget, RefusesSegmentsThatAreEmptyOrLeadElsewhere) {
  for (const char* odd :
       {"//", "//a", "/.", "/..", "/./a", "/../a", "/a//", "/a//b", "/a/.", "/a/..", "/a/./b", "/a/../b"})
    EXPECT_FALSE(read_target(odd)) << odd;
  for (const char* plain : {"/", "/a", "/a/", "/a.", "/.a", "/a./b", "/a../b", "/...", "/a/.b/"})
    EXPECT_TRUE(read_target(plain)) << plain;
}

TEST(AcceptsGzip, ReadsWeights) {
  for (const char* yes : {"gzip", "br, gzip", "gzip;q=0.1", "deflate , gzip ; q=1"})
    EXPECT_TRUE(accepts_gzip(yes));
  for (const char* no : {"", "br", "gzip;q=0", "gzip;q=0.000", "xgzip"}) EXPECT_FALSE(accepts_gzip(no)) << no;
}

}  // namespace
}  // namespace phalanx::web

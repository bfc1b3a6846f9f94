// SPDX-License-Identifier: Apache-2.0
// Requests: the checks in their order, bodies, responses, and the limits on connections.
#include <gmock/gmock.h>

#include <future>
#include <random>
#include <thread>
#include <utility>
#include <vector>

#include "phalanx/serve/reach.h"
#include "serve/web/page_client.h"
#include "serve/web/web_fixture.h"

namespace phalanx {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

class WebRequests : public WebTest {
 protected:
  static std::string post(const std::string& path, const std::string& fields) {
    return "POST " + path +
           " HTTP/1.1\r\nHost: 127.0.0.1\r\nOrigin: http://127.0.0.1\r\nConnection: close\r\n" + fields +
           "\r\n";
  }
  /// Responds with the body of the request.
  void echo() {
    application_.on_requested = [](const WebRequest& request,
                                   const std::function<void(WebResponse)>& answer) {
      WebResponse same;
      same.body = std::make_shared<const std::string>(request.body);
      answer(same);
    };
  }
};

std::string with_host(const std::string& host) {
  return "GET / HTTP/1.1\r\nHost: " + host + "\r\nConnection: close\r\n\r\n";
}

TEST_F(WebRequests, LoopbackNamesAndAddressesAreAccepted) {
  start();
  for (const char* host :
       {"127.0.0.1", "127.0.0.1:8480", "localhost", "LOCALHOST:1", "localhost.", "[::1]:8480"}) {
    EXPECT_EQ(status_of(ask(with_host(host))), 200) << host;
  }
}

// Another machine could answer to the name "this-one.local" in the local network, and its page
// could reach us.
TEST_F(WebRequests, OnLoopbackTheMachinesNetworkNamesAreRefused) {
  start();
  std::vector<std::string> names = machine_names();
  std::erase(names, "localhost");
  for (const std::string& address : machine_addresses())
    names.push_back(address.find(':') == std::string::npos ? address : "[" + address + "]");
  for (const std::string& name : names) EXPECT_EQ(status_of(ask(with_host(name + ":8480"))), 421) << name;
}

TEST_F(WebRequests, OtherNamesAreRefused) {
  start();
  for (const char* host :
       {"evil.example", "localhost.evil.example", "192.0.2.1", "localhost:80x", "127.0.0.1 x", "[::2]",
        "[::1", "", ":8480", "localhost@evil.example", "2130706433"}) {
    const std::string answer = ask(with_host(host));
    EXPECT_EQ(status_of(answer), 421) << host;
    EXPECT_THAT(body_of(answer), HasSubstr("address that the station printed")) << host;
  }
  EXPECT_EQ(status_of(ask("GET / HTTP/1.1\r\nConnection: close\r\n\r\n")), 421);
  EXPECT_EQ(
      status_of(ask("GET / HTTP/1.1\r\nHost: localhost\r\nHost: localhost\r\nConnection: close\r\n\r\n")),
      400);
  EXPECT_THAT(application_.requests(), IsEmpty());
}

TEST_F(WebRequests, OnlyThreeMethodsAreUnderstood) {
  start();
  for (const char* method : {"PUT", "DELETE", "OPTIONS", "TRACE", "PATCH", "BREW"}) {
    const std::string answer =
        ask(std::string(method) + " / HTTP/1.1\r\nHost: 127.0.0.1\r\nConnection: close\r\n\r\n");
    EXPECT_EQ(status_of(answer), 405) << method;
    EXPECT_EQ(field_of(answer, "Allow"), "GET, HEAD, POST") << method;
  }
}

TEST_F(WebRequests, ARefusedRequestIsNotPassedOnToTheApplication) {
  start();
  const std::string closes = "Connection: close\r\n\r\n";
  std::string another_version = PageClient::good_fields();
  another_version.replace(another_version.find("Version: 13"), 11, "Version: 12");
  const std::vector<std::pair<std::string, int>> refused{
      {"GET /none HTTP/1.1\r\nHost: evil.example\r\n" + closes, 421},
      {"GET /none HTTP/1.1\r\nHost: localhost\r\nHost: localhost\r\n" + closes, 400},
      {"PUT /none HTTP/1.1\r\nHost: 127.0.0.1\r\n" + closes, 405},
      {get("/" + std::string(2048, 'a')), 414},
      {get("/%00"), 400},
      {"POST /none HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Length: 0\r\n" + closes, 403},
      {get("/none", "Upgrade: h2c\r\n"), 400},
      {PageClient::head(another_version, "/none"), 426},
      {PageClient::head(PageClient::good_fields(), "/none") + "too early", 400}};
  for (const auto& [request, status] : refused) {
    RawClient client(port());
    client.send(request);
    EXPECT_EQ(status_of(client.receive_response()), status) << request;
  }
  expect_alive();
  EXPECT_THAT(application_.requests(), IsEmpty());
  EXPECT_THAT(application_.joined_pages(), IsEmpty());
  EXPECT_EQ(status_of(ask(get("/" + std::string(2047, 'a')))), 404) << "2048 bytes are not too many";
  EXPECT_THAT(application_.requests(), testing::SizeIs(1));
}

// A proxy that reads such a body differently would take its end for a request. There is one response only.
TEST_F(WebRequests, ABodyWithAnAmbiguousEndIsRefusedAndClosesTheConnection) {
  echo();
  application_.limit = 100;
  start();
  const std::string head = "POST /mesh HTTP/1.1\r\nHost: 127.0.0.1\r\nOrigin: http://127.0.0.1\r\n";
  const std::string hidden = "\r\n0\r\n\r\nGET /hidden HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n";
  for (const char* fields :
       {"Transfer-Encoding: gzip\r\n", "Transfer-Encoding: identity\r\n", "Transfer-Encoding: xchunked\r\n",
        "Transfer-Encoding: chunked, gzip\r\n", "Transfer-Encoding: gzip, chunked\r\n",
        "Transfer-Encoding: chunked, chunked\r\n", "Transfer-Encoding: chunked;x=1\r\n",
        "Transfer-Encoding:\r\n", "Transfer-Encoding: gzip\r\nTransfer-Encoding: chunked\r\n",
        "Transfer-Encoding: gzip\r\nContent-Length: 3\r\n", "Content-Length: 5\r\nContent-Length: 5\r\n"}) {
    const std::string answer = ask(head + fields + hidden);
    EXPECT_EQ(status_of(answer), 400) << fields;
    EXPECT_EQ(answer.rfind("HTTP/1.1 "), 0U) << fields << answer;
  }
  std::string old = post("/mesh", "Transfer-Encoding: chunked\r\n") + "0\r\n\r\n";
  old.replace(old.find("HTTP/1.1"), 8, "HTTP/1.0");
  EXPECT_EQ(status_of(ask(old)), 400) << "HTTP/1.0 has no chunks";
  EXPECT_THAT(application_.requests(), IsEmpty());
  EXPECT_EQ(status_of(ask(post("/mesh", "Transfer-Encoding: Chunked\r\n") + "0\r\n\r\n")), 200);
  expect_alive();
}

TEST_F(WebRequests, AHeadHasALimit) {
  start();
  EXPECT_EQ(status_of(ask(get("/", "X-Long: " + std::string(9000, 'x') + "\r\n"))), 431);
  std::string many;
  for (int i = 0; i < 5000; ++i) many += "X-" + std::to_string(i) + ": y\r\n";
  EXPECT_EQ(status_of(ask(get("/", many))), 431);
  EXPECT_EQ(status_of(ask(get("/", "X-Long: " + std::string(4000, 'x') + "\r\n"))), 200);
  expect_alive();
}

TEST_F(WebRequests, TextThatIsNotHttpIsRefused) {
  start();
  for (const std::string& text :
       {std::string("hello\r\n\r\n"), std::string("GET / HTTP/9.9\r\n\r\n"), std::string("GET /\r\n\r\n"),
        std::string("\x16\x03\x01\x02\x01\x01\r\n\r\n"), get("/", "no colon\r\n"),
        get("/", "Content-Length: -1\r\n"), get("/", "Content-Length: 99999999999999999999\r\n"),
        get("/", "Content-Length: 1\r\nTransfer-Encoding: chunked\r\n")}) {
    EXPECT_EQ(status_of(ask(text)), 400) << text;
  }
  expect_alive();
}

TEST_F(WebRequests, TheApplicationGetsRequestsThatNameNoFile) {
  echo();
  start();
  EXPECT_EQ(status_of(ask(get("/what/is%20this?a=b&c", "X-Phalanx-Page: abc\r\n"))), 200);
  const auto requests = application_.requests();
  ASSERT_EQ(requests.size(), 1U);
  EXPECT_EQ(requests[0].method, "GET");
  EXPECT_EQ(requests[0].path, "/what/is this");
  EXPECT_EQ(requests[0].query, "a=b&c");
  EXPECT_EQ(requests[0].page_secret, "abc");
  EXPECT_EQ(requests[0].client.address, "127.0.0.1");
  EXPECT_TRUE(requests[0].client.may_operate);
}

TEST_F(WebRequests, ABodyIsReadWholeOrInChunksOrAfter100Continue) {
  echo();
  application_.limit = 10;
  start();
  EXPECT_EQ(body_of(ask(post("/mesh", "Content-Length: 10\r\n") + "0123456789")), "0123456789");
  EXPECT_EQ(
      body_of(ask(post("/mesh", "Transfer-Encoding: chunked\r\n") + "3\r\nabc\r\n4\r\ndefg\r\n0\r\n\r\n")),
      "abcdefg");
  RawClient patient(port());
  patient.send(post("/mesh", "Content-Length: 3\r\nExpect: 100-continue\r\n"));
  EXPECT_EQ(patient.receive_until("\r\n\r\n"), "HTTP/1.1 100 Continue\r\n\r\n");
  patient.send("xyz");
  EXPECT_EQ(body_of(patient.receive_response()), "xyz");
}

TEST_F(WebRequests, ABodyIsNoLongerThanAllowed) {
  echo();
  application_.limit = 10;
  start();
  EXPECT_EQ(status_of(ask(post("/mesh", "Content-Length: 11\r\n") + "01234567890")), 413);
  EXPECT_EQ(status_of(ask(post("/mesh", "Content-Length: 99999999999\r\n"))), 413)
      << "not a byte is waited for";
  EXPECT_EQ(status_of(ask(post("/mesh", "Transfer-Encoding: chunked\r\n") + "b\r\n01234567890\r\n0\r\n\r\n")),
            413);
  EXPECT_EQ(status_of(ask(post("/mesh", "Content-Length: 11\r\nExpect: 100-continue\r\n"))), 413);
  EXPECT_EQ(status_of(ask(post("/mesh", "Transfer-Encoding: chunked\r\n") + "zz\r\nabc\r\n")), 400);
  EXPECT_EQ(status_of(ask(post("/mesh", "Content-Length: 1\r\nExpect: miracles\r\n"))), 417);
  EXPECT_THAT(application_.requests(), IsEmpty());
  expect_alive();
}

TEST_F(WebRequests, ABodyIsRefusedWhereTheApplicationAllowsNone) {
  echo();
  start();
  EXPECT_EQ(status_of(ask(post("/mesh", "Content-Length: 1\r\n") + "x")), 413);
  EXPECT_EQ(status_of(ask(post("/mesh", "Content-Length: 0\r\n"))), 200);
}

TEST_F(WebRequests, APostComesFromThePageItself) {
  echo();
  start();
  const auto from = [&](const std::string& origin) {
    return status_of(
        ask("POST /x HTTP/1.1\r\nHost: localhost:8480\r\nConnection: close\r\n" + origin + "\r\n"));
  };
  EXPECT_EQ(from("Origin: http://localhost:8480\r\n"), 200);
  EXPECT_EQ(from(""), 403);
  EXPECT_EQ(from("Origin: null\r\n"), 403);
  EXPECT_EQ(from("Origin: http://localhost\r\n"), 403);
  EXPECT_EQ(from("Origin: https://localhost:8480\r\n"), 403);
  EXPECT_EQ(from("Origin: http://localhost:8480.evil.example\r\n"), 403);
  EXPECT_EQ(from("Origin: http://localhost:8480\r\nOrigin: http://evil.example\r\n"), 400);
}

TEST_F(WebRequests, AResponseMayComeLaterFromAnyThreadAndOnce) {
  std::vector<std::thread> threads;
  application_.on_requested = [&threads](const WebRequest&, std::function<void(WebResponse)> answer) {
    threads.emplace_back([answer = std::move(answer)] {
      WebResponse one;
      one.body = std::make_shared<const std::string>("first");
      answer(one);
      one.body = std::make_shared<const std::string>("second");
      answer(one);
    });
  };
  start();
  EXPECT_EQ(body_of(ask(get("/later"))), "first");
  server_->stop();
  for (std::thread& thread : threads) thread.join();
}

TEST_F(WebRequests, AForgottenResponseBecomes500) {
  application_.on_requested = [](const WebRequest&, const std::function<void(WebResponse)>&) {};
  start();
  const std::string answer = ask(get("/forgotten"));
  EXPECT_EQ(status_of(answer), 500);
  EXPECT_EQ(body_of(answer), "The station has no answer to this.\n");
}

// The second request comes with the first one, and the client resets the connection before
// the first response.
TEST_F(WebRequests, AfterAResponseThatCannotBeSentNoFurtherRequestIsHandled) {
  std::promise<std::function<void(WebResponse)>> first;
  int asked = 0;
  application_.on_requested = [&](const WebRequest&, std::function<void(WebResponse)> answer) {
    if (++asked == 1) first.set_value(std::move(answer));
  };
  start();
  RawClient client(port());
  const std::string request = "GET /none HTTP/1.1\r\nHost: localhost\r\n\r\n";
  client.send(request + request);
  const std::function<void(WebResponse)> answer = first.get_future().get();
  client.abort();
  answer(WebResponse{});
  for (int i = 0; i < 3; ++i) expect_alive();
  EXPECT_THAT(application_.requests(), testing::SizeIs(1));
}

TEST_F(WebRequests, AResponseMayComeAfterTheServersEnd) {
  std::function<void(WebResponse)> kept;
  application_.on_requested = [&](const WebRequest&, std::function<void(WebResponse)> answer) {
    kept = std::move(answer);
  };
  start();
  RawClient client(port());
  client.send(get("/never"));
  ASSERT_TRUE(application_.await_requests(1));
  server_.reset();
  EXPECT_EQ(client.receive_all(), "");
  kept(WebResponse{});
}

TEST_F(WebRequests, AClientThatIsSlowToSendARequestIsDisconnected) {
  settings_.request_timeout = 3.0;  // also of the request of expect_alive()
  start();
  RawClient slow(port());
  slow.send("GET / HTTP/1.1\r\nHost: local");
  EXPECT_EQ(slow.receive_all(), "");
  expect_alive();
}

TEST_F(WebRequests, AClientWhoseBodyDoesNotComeIsDisconnected) {
  application_.limit = 100;
  settings_.idle_timeout = 1.0;
  start();
  RawClient slow(port());
  slow.send(post("/mesh", "Content-Length: 100\r\n") + "a");
  EXPECT_EQ(slow.receive_all(), "");
  EXPECT_THAT(application_.requests(), IsEmpty());
  expect_alive();
}

TEST_F(WebRequests, MoreConnectionsThanAllowedAreRefused) {
  settings_.connections = 3;
  start();
  std::vector<std::unique_ptr<RawClient>> open;
  for (int i = 0; i < 3; ++i) {
    open.push_back(std::make_unique<RawClient>(port()));
    open.back()->send("GET / HTTP/1.1\r\nHost: localhost\r\n\r\n");
    ASSERT_EQ(status_of(open.back()->receive_response()), 200);
  }
  for (int i = 0; i < 20; ++i) EXPECT_EQ(status_of(ask(get("/"))), 503);
  open[0]->send("GET / HTTP/1.1\r\nHost: localhost\r\n\r\n");
  EXPECT_EQ(status_of(open[0]->receive_response()), 200) << "accepted connections are not affected";
  open.clear();
  while (status_of(ask(get("/"))) != 200) std::this_thread::yield();
}

constexpr const char* kEmpty = "Content-Length: 0\r\n";

TEST_F(WebRequests, FilesLeaveASixteenthOfTheConnectionsToPagesAndAPostNeedsNone) {
  settings_.connections = 16;
  start();
  std::vector<std::unique_ptr<RawClient>> open;
  for (int i = 0; i < 15; ++i) {
    open.push_back(std::make_unique<RawClient>(port()));
    open.back()->send("GET / HTTP/1.1\r\nHost: localhost\r\n\r\n");
    ASSERT_EQ(status_of(open.back()->receive_response()), 200);
  }
  EXPECT_EQ(status_of(ask(get("/"))), 503);
  PageClient page(port());
  EXPECT_EQ(status_of(page.handshake()), 101);
  EXPECT_EQ(status_of(PageClient(port()).handshake()), 503);
  for (int i = 0; i < 50; ++i)
    EXPECT_EQ(status_of(ask(post("/stop", kEmpty))), 404) << "the application's answer";
  EXPECT_THAT(application_.requests(), testing::SizeIs(50));
  application_.limit = 10;
  EXPECT_EQ(status_of(ask(post("/mesh", "Content-Length: 1\r\n") + "x")), 503) << "a body needs a connection";
  EXPECT_THAT(application_.requests(), testing::SizeIs(50));
}

TEST_F(WebRequests, APostWithoutASlotIsTheLastOfItsConnection) {
  settings_.connections = 1;
  start();
  PageClient page(port());
  RawClient line(port());
  line.send(
      "POST /stop HTTP/1.1\r\nHost: 127.0.0.1\r\nOrigin: http://127.0.0.1\r\nContent-Length: 0\r\n\r\n");
  EXPECT_EQ(status_of(line.receive_response()), 404);
  EXPECT_EQ(line.receive_all(), "") << "closed although it asked for keep-alive";
}

TEST_F(WebRequests, ViewersLeaveAnEighthOfTheConnectionsToOperators) {
  settings_.connections = 16;
  settings_.operator_token = "operator-token-16";
  settings_.viewer_token = "viewers-token--16";
  const auto page_by = [&](const std::string& token) {
    return std::make_unique<PageClient>(std::make_unique<RawClient>(port()),
                                        PageClient::head(PageClient::good_fields(), "/?token=" + token));
  };
  start();
  std::vector<std::unique_ptr<PageClient>> pages;
  for (int i = 0; i < 14; ++i) {
    pages.push_back(page_by(settings_.viewer_token));
    ASSERT_EQ(status_of(pages.back()->handshake()), 101);
  }
  EXPECT_EQ(status_of(page_by(settings_.viewer_token)->handshake()), 503);
  EXPECT_EQ(status_of(ask(get("/?token=" + settings_.viewer_token))), 503);
  // The operator reloads: first the page, then its WebSocket.
  RawClient line(port());
  const std::string cookie = "phalanx-" + std::to_string(port()) + "=" + settings_.operator_token;
  line.send("GET / HTTP/1.1\r\nHost: 127.0.0.1\r\nCookie: " + cookie + "\r\n\r\n");
  EXPECT_EQ(status_of(line.receive_response()), 200);
  line.send(PageClient::head(PageClient::good_fields(), "/?token=" + settings_.viewer_token));
  EXPECT_EQ(status_of(line.receive_response()), 503) << "its slot is not one for viewers";
  pages.push_back(page_by(settings_.operator_token));
  EXPECT_EQ(status_of(pages.back()->handshake()), 101);
  EXPECT_EQ(status_of(ask(post("/stop?token=" + settings_.viewer_token, kEmpty))), 404)
      << "it reaches the application";
}

TEST_F(WebRequests, AConnectionWithoutAnAcceptedRequestIsClosedSoon) {
  settings_.pending_timeout = 3.0;
  settings_.request_timeout = 3600.0;
  start();
  RawClient silent(port());
  RawClient wrong(port());
  wrong.send("GET / HTTP/1.1\r\nHost: evil.example\r\n\r\n");
  EXPECT_EQ(status_of(wrong.receive_response()), 421);
  EXPECT_EQ(silent.receive_all(), "");
  EXPECT_EQ(wrong.receive_all(), "");
}

TEST_F(WebRequests, IdleConnectionsDoNotLockOthersOut) {
  settings_.pending_timeout = 3600.0;
  settings_.request_timeout = 3600.0;
  start();
  std::vector<std::unique_ptr<RawClient>> silent;
  for (int i = 0; i < 200; ++i) silent.push_back(std::make_unique<RawClient>(port()));
  expect_alive();
  EXPECT_EQ(silent[100]->receive_all(), "") << "the oldest was evicted";
  silent.back()->send("GET / HTTP/1.1\r\nHost: localhost\r\n\r\n");
  EXPECT_EQ(status_of(silent.back()->receive_response()), 200) << "the newest stay";
}

// They connect while the server's thread is busy, so that it accepts all of them at once.
TEST_F(WebRequests, OfManyConnectionsAtOnceOnlyTheNewestStay) {
  settings_.pending_connections = 2;
  settings_.pending_timeout = 3600.0;
  settings_.request_timeout = 3600.0;
  start();
  std::promise<void> busy;
  std::promise<void> connected;
  server_->post([&busy, have = connected.get_future().share()] {
    busy.set_value();
    have.wait();
  });
  busy.get_future().wait();
  std::vector<std::unique_ptr<RawClient>> silent;
  for (int i = 0; i < 12; ++i) silent.push_back(std::make_unique<RawClient>(port()));
  connected.set_value();
  for (std::size_t i = 0; i < 10; ++i) EXPECT_EQ(silent[i]->receive_all(), "") << i;
  for (std::size_t i = 10; i < 12; ++i) {
    silent[i]->send("GET / HTTP/1.1\r\nHost: localhost\r\n\r\n");
    EXPECT_EQ(status_of(silent[i]->receive_response()), 200) << i;
  }
}

TEST_F(WebRequests, AThousandConnectionsLeaveItWorking) {
  start();
  RawClient open(port());
  open.send("GET / HTTP/1.1\r\nHost: localhost\r\n\r\n");
  ASSERT_EQ(status_of(open.receive_response()), 200);
  {
    std::vector<std::unique_ptr<RawClient>> many;
    for (int i = 0; i < 900; ++i) many.push_back(std::make_unique<RawClient>(port()));
    open.send("GET / HTTP/1.1\r\nHost: localhost\r\n\r\n");
    EXPECT_EQ(status_of(open.receive_response()), 200);
  }
  for (int i = 0; i < 100; ++i) RawClient(port()).abort();
  while (status_of(ask(get("/"))) != 200) std::this_thread::yield();
}

TEST_F(WebRequests, GarbageLeavesItWorking) {
  constexpr unsigned kSeed = 20261122;
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  std::mt19937 random(kSeed);
  const std::vector<std::string> beginnings{
      "",
      "GET ",
      "GET / HTTP/1.1\r\n",
      "GET / HTTP/1.1\r\nHost: localhost\r\n",
      "POST /x HTTP/1.1\r\nHost: localhost\r\nOrigin: http://localhost\r\n"
      "Transfer-Encoding: chunked\r\n\r\n",
      "GET / HTTP/1.1\r\nHost: localhost\r\nOrigin: http://localhost\r\n"
      "Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
      "Sec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\n\r\n"};
  application_.limit = 1000;
  settings_.connections = 500;  // connections that are closing must not use up all of them
  start();
  for (int i = 0; i < 2000; ++i) {
    RawClient client(port());
    std::string text = beginnings[random() % beginnings.size()];
    const bool upgrades = text.find("websocket") != std::string::npos;
    client.send(text);
    if (upgrades) client.receive_until("\r\n\r\n");
    std::string garbage(random() % 3000, '\0');
    for (char& c : garbage) c = static_cast<char>(random());
    client.send(garbage);
    if (random() % 2 == 0) client.abort();
  }
  while (status_of(ask(get("/"))) != 200) std::this_thread::yield();
}

}  // namespace
}  // namespace phalanx

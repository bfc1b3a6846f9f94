// SPDX-License-Identifier: Apache-2.0
// The settings of a server, and its thread.
#include <gmock/gmock.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <sys/stat.h>

#include <fstream>
#include <functional>
#include <future>
#include <sstream>

#include "device/descriptor.h"
#include "phalanx/serve/reach.h"
#include "serve/web/page_client.h"
#include "serve/web/raw_client.h"
#include "serve/web/web_fixture.h"
#include "support/held_clock/page.h"

namespace phalanx {
namespace {

using testing::HasSubstr;

class WebServing : public WebTest {
 protected:
  /// @returns the message with which the constructor refuses the settings; empty if it accepts them
  std::string refusal() {
    try {
      const WebServer server(settings_, application_);
    } catch (const WebServerError& error) {
      return error.what();
    }
    return "";
  }
  void with_certificate() {
    const CertificateFiles files = make_self_signed_certificate(folder_ / "keys", machine_addresses());
    settings_.certificate = files.certificate;
    settings_.key = files.key;
  }
};

TEST_F(WebServing, AnAddressThatOthersReachNeedsTlsAndAToken) {
  for (const char* address : {"0.0.0.0", "::", "192.0.2.77"}) {
    settings_.address = address;
    EXPECT_THAT(refusal(), HasSubstr("a certificate, its key and a token are needed")) << address;
  }
  settings_.address = "0.0.0.0";
  settings_.operator_token = random_token();
  EXPECT_THAT(refusal(), HasSubstr("a certificate, its key and a token are needed"));
  with_certificate();
  EXPECT_EQ(refusal(), "");
  settings_.operator_token.clear();
  EXPECT_THAT(refusal(), HasSubstr("a certificate, its key and a token are needed"));
}

TEST_F(WebServing, AnAddressIsOneOfThisMachine) {
  settings_.address = "somewhere";
  EXPECT_THAT(refusal(), HasSubstr("\"somewhere\" is no IP address"));
  settings_.address = "203.0.113.9";
  settings_.operator_token = random_token();
  with_certificate();
  EXPECT_THAT(refusal(), HasSubstr("is it an address of this machine?"));
}

/// @returns the server's descriptor of this client's connection, which is in this process as well; -1: none
int other_end(const RawClient& client) {
  sockaddr_in mine{};
  socklen_t size = sizeof mine;
  if (::getsockname(client.descriptor(), reinterpret_cast<sockaddr*>(&mine), &size) != 0) return -1;
  for (int descriptor = 0; descriptor < 1024; ++descriptor) {
    sockaddr_in peer{};
    size = sizeof peer;
    if (::getpeername(descriptor, reinterpret_cast<sockaddr*>(&peer), &size) != 0) continue;
    if (peer.sin_family == AF_INET && peer.sin_port == mine.sin_port && descriptor != client.descriptor())
      return descriptor;
  }
  return -1;
}

int tcp_option(int descriptor, int name) {
  int value = -1;
  socklen_t size = sizeof value;
  ::getsockopt(descriptor, IPPROTO_TCP, name, &value, &size);
  return value;
}

// The kernel holds at most 16 KiB of unsent data, so that a slow page receives recent messages.
TEST_F(WebServing, SendsAtOnceAndKeepsAtMost16KiBUnsent) {
  const Descriptor probe(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
  const int any = 4096;
  if (::setsockopt(probe.value(), IPPROTO_TCP, TCP_NOTSENT_LOWAT, &any, sizeof any) != 0)
    GTEST_SKIP() << "this kernel has no TCP_NOTSENT_LOWAT";
  start();
  RawClient client(port());
  ASSERT_TRUE(client.send("GET / HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n"));
  ASSERT_FALSE(client.receive_response().empty());
  const int descriptor = other_end(client);
  ASSERT_GE(descriptor, 0);
  EXPECT_EQ(tcp_option(descriptor, TCP_NODELAY), 1);
  EXPECT_EQ(tcp_option(descriptor, TCP_NOTSENT_LOWAT), 16 * 1024);
}

TEST_F(WebServing, APortThatIsTakenIsReportedOrTheNextIsTried) {
  start();
  settings_.port = port();
  settings_.next_free_port = false;
  EXPECT_THAT(refusal(), HasSubstr("is taken by another program"));
  settings_.next_free_port = true;
  const WebServer next(settings_, application_);
  EXPECT_GT(next.port(), port());
  EXPECT_LE(next.port(), port() + 20);
  EXPECT_EQ(next.url(), "http://127.0.0.1:" + std::to_string(next.port()) + "/");
}

TEST_F(WebServing, TokensAreLongAndDiffer) {
  settings_.viewer_token = random_token();
  EXPECT_THAT(refusal(), HasSubstr("without the operator's"));
  settings_.operator_token = settings_.viewer_token;
  EXPECT_THAT(refusal(), HasSubstr("must not be the operator's"));
  settings_.operator_token = "short";
  EXPECT_THAT(refusal(), HasSubstr("at least 16 letters"));
  settings_.operator_token = "sixteen letters; or more";
  EXPECT_THAT(refusal(), HasSubstr("at least 16 letters"));
}

TEST_F(WebServing, ACertificateIsOneAndItsKeyIsItsOwn) {
  settings_.certificate = folder_ / "secret.txt";
  EXPECT_THAT(refusal(), HasSubstr("only one of them was given"));
  settings_.key = folder_ / "secret.txt";
  EXPECT_THAT(refusal(), HasSubstr("no certificate in PEM"));
  with_certificate();
  EXPECT_EQ(refusal(), "");
  settings_.key = make_self_signed_certificate(folder_ / "others", {}).key;
  EXPECT_THAT(refusal(), HasSubstr("belongs to"));
  with_certificate();
  ASSERT_EQ(::chmod(settings_.key.c_str(), 0640), 0);
  EXPECT_THAT(refusal(), HasSubstr("others than its owner may read or write it (mode 0640)"));
}

TEST_F(WebServing, LimitsAreChecked) {
  settings_.frame_rate_hz = 0.0;
  EXPECT_THAT(refusal(), HasSubstr("frame rate"));
  settings_.frame_rate_hz = 60.0;
  settings_.queue_limit = 0;
  EXPECT_THAT(refusal(), HasSubstr("at least 1"));
  settings_.queue_limit = 1;
  settings_.idle_timeout = 0.0;
  EXPECT_THAT(refusal(), HasSubstr("timeout"));
}

TEST_F(WebServing, EveryLimitHasItsBounds) {
  using Settings = WebServerSettings;
  const Settings good = settings_;
  const auto says = [&](const std::function<void(Settings&)>& change) {
    settings_ = good;
    change(settings_);
    return refusal();
  };
  for (const double rate : {1.0, 1000.0}) EXPECT_EQ(says([&](Settings& s) { s.frame_rate_hz = rate; }), "");
  for (const double rate : {0.99, 1000.1})
    EXPECT_THAT(says([&](Settings& s) { s.frame_rate_hz = rate; }), HasSubstr("frame rate")) << rate;
  for (const auto timeout :
       {&Settings::request_timeout, &Settings::idle_timeout, &Settings::pending_timeout}) {
    EXPECT_EQ(says([&](Settings& s) { s.*timeout = 3600.0; }), "");
    for (const double wrong : {0.0, 3600.1})
      EXPECT_THAT(says([&](Settings& s) { s.*timeout = wrong; }), HasSubstr("timeout")) << wrong;
  }
  for (const auto limit : {&Settings::message_limit, &Settings::messages_per_second, &Settings::queue_limit,
                           &Settings::queue_bytes, &Settings::connections, &Settings::pending_connections,
                           &Settings::pending_per_address}) {
    EXPECT_EQ(says([&](Settings& s) { s.*limit = 1; }), "");
    EXPECT_THAT(says([&](Settings& s) { s.*limit = 0; }), HasSubstr("at least 1"));
  }
  EXPECT_EQ(says([](Settings& s) { s.messages_per_second = 100'000; }), "");
  EXPECT_THAT(says([](Settings& s) { s.messages_per_second = 100'001; }), HasSubstr("at most 100,000"));
  for (const std::size_t bytes : {256U, 1'048'576U})
    EXPECT_EQ(says([&](Settings& s) { s.header_limit = bytes; }), "");
  for (const std::size_t bytes : {255U, 1'048'577U})
    EXPECT_THAT(says([&](Settings& s) { s.header_limit = bytes; }), HasSubstr("256 to 1048576")) << bytes;
}

// The folder may hold 1024 files and folders, and 64 MiB.
TEST_F(WebServing, AFolderThatIsNoFrontEndIsNotReadWhole) {
  for (int i = 0; i < 1024; ++i) write("many/" + std::to_string(i), "");
  settings_.site = folder_ / "many";
  EXPECT_EQ(refusal(), "");
  write("many/one-more", "");
  EXPECT_THAT(refusal(), HasSubstr("more than 1024 files and folders, which is no built front-end"));
  write("large/film", "");
  std::filesystem::resize_file(folder_ / "large/film",
                               64U * 1024U * 1024U + 1U);  // takes no room on the disk
  settings_.site = folder_ / "large";
  EXPECT_THAT(refusal(), HasSubstr("more than 64 MiB, which is no built front-end"));
}

/// @returns the line of a file in /proc that begins with the name, without it
std::string line_of(const std::string& path, const std::string& name) {
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with(name)) return line.substr(name.size());
  }
  return "";
}

TEST_F(WebServing, ItsThreadHasLowPriorityAndBlocksAllSignals) {
  start();
  std::promise<std::string> task;
  server_->post([&task] { task.set_value("/proc/self/task/" + std::to_string(::gettid())); });
  const std::string path = task.get_future().get();
  const std::string blocked = line_of(path + "/status", "SigBlk:\t");
  // All 64 but SIGKILL (9), SIGSTOP (19) and the two of the C library (32, 33). The held clock's signal may
  // be unblocked while the thread waits.
  const std::uint64_t held_clock = 1ULL << static_cast<unsigned>(test::wake_signal() - 1);
  EXPECT_EQ(std::stoull(blocked, nullptr, 16) | held_clock,
            ~((1ULL << 8) | (1ULL << 18) | (1ULL << 31) | (1ULL << 32)));
  const std::string stat = line_of(path + "/stat", "");
  std::istringstream fields(stat.substr(stat.rfind(')') + 2));
  std::vector<std::string> values{"", "", ""};  // so that they are numbered as in proc(5)
  for (std::string value; fields >> value;) values.push_back(value);
  EXPECT_GE(std::stoi(values.at(19)), 5) << "nice";  // the policy under a held clock is the clock's
}

TEST_F(WebServing, StopsWithoutHavingStarted) {
  server_ = std::make_unique<WebServer>(settings_, application_);
  server_->stop();
  server_->start();
  EXPECT_TRUE(application_.joined_pages().empty());
}

}  // namespace
}  // namespace phalanx

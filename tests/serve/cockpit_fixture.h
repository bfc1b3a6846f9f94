// SPDX-License-Identifier: Apache-2.0
// A station with its cockpit and server, and pages that send and receive the messages of a browser's page.
#pragma once

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "phalanx/clinic/exercise_host.h"
#include "phalanx/cockpit.pb.h"
#include "phalanx/serve/cockpit.h"
#include "record/temporary_folder.h"
#include "serve/owner.h"
#include "serve/web/page_client.h"

namespace phalanx {
namespace test {

using testing::read_file;

/// Client of the cockpit's protocol.
class Page {
 public:
  explicit Page(std::uint16_t port, const std::string& secret = "", const std::string& name = "",
                const std::string& path = "/", bool patient_screen = false)
      : client_(std::make_unique<RawClient>(port), PageClient::head(PageClient::good_fields(), path)) {
    wire::ToHost hello;
    hello.mutable_hello()->set_protocol(Cockpit::kProtocol);
    hello.mutable_hello()->set_secret(secret);
    hello.mutable_hello()->set_name(name);
    hello.mutable_hello()->set_patient_screen(patient_screen);
    send(hello);
    welcome = receive(wire::ToPage::kWelcome).welcome();
    state = receive(wire::ToPage::kState).state();
  }

  void send(const wire::ToHost& message) { client_.send(message.SerializeAsString()); }
  /// Receives messages until one of a kind comes. @returns it; an empty message if the connection was closed
  wire::ToPage receive(wire::ToPage::WhatCase what) {
    return receive([what](const wire::ToPage& message) { return message.what_case() == what; });
  }
  wire::ToPage receive(const std::function<bool(const wire::ToPage&)>& so) {
    for (;;) {
      const PageClient::Frame frame = client_.receive();
      if (frame.opcode == PageClient::kPing) {
        client_.send(frame.payload, PageClient::kPong);
        continue;
      }
      if (frame.opcode != PageClient::kBinary) {
        ADD_FAILURE() << "the connection was closed: " << frame.reason();
        return {};
      }
      wire::ToPage message;
      EXPECT_TRUE(message.ParseFromString(frame.payload));
      if (message.has_state()) state = message.state();
      ticks += message.has_tick() ? 1 : 0;
      replies += message.has_reply() ? 1 : 0;
      if (so(message)) return message;
    }
  }
  wire::Notice notice(const std::string& code) {
    return receive([&](const wire::ToPage& m) { return m.has_notice() && m.notice().code() == code; })
        .notice();
  }
  /// Waits until a state meets a condition.
  void until(const std::function<bool(const wire::State&)>& so) {
    if (so(state)) return;
    receive([&](const wire::ToPage& m) { return m.has_state() && so(m.state()); });
  }
  /// @returns the reply to it
  wire::Reply ask(wire::ToHost message) {
    message.set_request(++request_);
    send(message);
    return receive([&](const wire::ToPage& m) { return m.has_reply() && m.reply().request() == request_; })
        .reply();
  }
  wire::Reply set(const std::string& key, const std::string& value) {
    wire::ToHost message;
    auto& setting = *message.mutable_set()->add_setting();
    setting.set_key(key);
    setting.set_value(value);
    return ask(message);
  }
  PageClient& client() { return client_; }

  wire::Welcome welcome;
  wire::State state;
  int ticks = 0;    ///< received
  int replies = 0;  ///< received

 private:
  PageClient client_;
  std::uint32_t request_ = 0;
};

inline wire::ToHost to_stop() {
  wire::ToHost message;
  message.mutable_stop();
  return message;
}
inline wire::ToHost to_resume(const Session& session) {
  wire::ToHost message;
  message.mutable_resume()->set_stops(session.stops());
  return message;
}
inline wire::ToHost to_see(std::uint64_t ticks) {
  wire::ToHost message;
  message.set_request(77);
  message.mutable_seen()->set_ticks(ticks);
  return message;
}
inline wire::ToHost to_be_named(const std::string& name) {
  wire::ToHost message;
  message.mutable_name()->set_name(name);
  return message;
}
inline wire::ToHost to_take() {
  wire::ToHost message;
  message.mutable_take();
  return message;
}

inline const std::string kViewerUrl = "https://192.0.2.1:8480/?token=look";

class CockpitTest : public ::testing::Test {
 protected:
  /// @param still  the cockpit's clock advances by skip() only; then a page receives the states after its
  /// Welcome and no further ones
  /// @param registry  makes the patients' registry in a folder; empty: there is none
  /// @param exercises  null: the station carries out none
  explicit CockpitTest(
      bool still = false, const std::string& device = "sliders",
      const std::function<std::shared_ptr<Registry>(const std::filesystem::path&)>& registry = {},
      std::shared_ptr<ExerciseHost> exercises = {})
      : still_(still) {
    SessionSettings station;
    station.scene = "first_touch";
    station.device = device;
    // No files to read and no grasp to plan for each test.
    station.overrides = {{"hand.meshes", "\"capsules\""}, {"grasp.type", "\"none\""}};
    station.ask_for_realtime = false;
    session_ = std::make_unique<Session>(station, clock_);
    cockpit_ = std::make_unique<Cockpit>(
        *session_, CockpitSettings{.log = folder_ / "audit.jsonl",
                                   .uploads = folder_ / "up",
                                   .recordings = folder_ / "recordings",
                                   .version = "1.2.3",
                                   .clock = [this] { return skipped_ + (still_ ? 0.0 : real_.now()); },
                                   .registry = registry ? registry(folder_.path()) : nullptr,
                                   .exercises_host = std::move(exercises)});
    serve();
  }
  ~CockpitTest() override {
    owner_.reset();
    server_.reset();
    cockpit_.reset();
  }
  /// Replaces the server.
  void serve(const std::string& operator_token = "", const std::string& viewer_token = "") {
    owner_.reset();
    server_.reset();
    WebServerSettings settings;
    settings.port = 0;
    settings.site_missing = "none";
    settings.operator_token = operator_token;
    settings.viewer_token = viewer_token;
    // A test that waits with one page does not answer the pings of another. On a slow machine
    // that takes long.
    settings.idle_timeout = settings.request_timeout = settings.pending_timeout = 600.0;
    server_ = std::make_unique<WebServer>(settings, *cockpit_);
    cockpit_->attach(*server_, {kViewerUrl});
    server_->start();
    owner_ = std::make_unique<Owner>(*session_);
  }
  [[nodiscard]] std::uint16_t port() const { return server_->port(); }
  /// Advances the cockpit's clock.
  void skip(double seconds) { skipped_ = skipped_ + seconds; }
  std::string post(const std::string& path, const std::string& body, const std::string& fields = "") const {
    return ask(port(), "POST " + path +
                           " HTTP/1.1\r\nHost: 127.0.0.1\r\nOrigin: http://127.0.0.1\r\nConnection: close\r\n"
                           "Content-Length: " +
                           std::to_string(body.size()) + "\r\n" + fields + "\r\n" + body);
  }
  /// @returns the log's file with all notices so far
  std::string log_text() const {
    const std::string mark = "mark " + std::to_string(++marks_);
    cockpit_->typed("mark", mark);
    std::string text;
    for (int i = 0; i < 60'000 && text.find(mark + "\"") == std::string::npos; ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      text = read_file(folder_ / "audit.jsonl");
    }
    return text;
  }
  std::vector<nlohmann::json> log() const {
    std::istringstream text(log_text());
    std::vector<nlohmann::json> lines;
    for (std::string line; std::getline(text, line);) {
      const nlohmann::json one = nlohmann::json::parse(line);
      if (one["code"] != "mark") lines.push_back(one);
    }
    return lines;
  }
  std::size_t logged(const std::string& code) const {
    std::size_t count = 0;
    for (const auto& line : log()) count += line["code"] == code ? 1U : 0U;
    return count;
  }

  const testing::TemporaryFolder folder_;
  const Clock clock_;
  const Clock real_;
  const bool still_;
  std::atomic<double> skipped_{0.0};
  mutable int marks_ = 0;  ///< written to the log
  std::unique_ptr<Session> session_;
  std::unique_ptr<Cockpit> cockpit_;
  std::unique_ptr<WebServer> server_;
  std::unique_ptr<Owner> owner_;
};

/// Fixture for tests that depend on exact times.
class StillCockpitTest : public CockpitTest {
 protected:
  StillCockpitTest() : CockpitTest(true) {}
};

}  // namespace test
}  // namespace phalanx

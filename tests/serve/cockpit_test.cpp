// SPDX-License-Identifier: Apache-2.0
// Pages, the server and a station: who may do what, and what everybody is told. docs/cockpit.md
#include "phalanx/serve/cockpit.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

#include "phalanx/cockpit.pb.h"
#include "phalanx/geometry.pb.h"
#include "record/temporary_folder.h"
#include "serve/owner.h"
#include "serve/web/page_client.h"

namespace phalanx {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using testing::read_file;

/// A browser's page as the cockpit knows it.
class Page {
 public:
  explicit Page(std::uint16_t port, const std::string& secret = "", const std::string& name = "")
      : client_(port) {
    wire::ToHost hello;
    hello.mutable_hello()->set_protocol(Cockpit::kProtocol);
    hello.mutable_hello()->set_secret(secret);
    hello.mutable_hello()->set_name(name);
    say(hello);
    welcome = hear(wire::ToPage::kWelcome).welcome();
    state = hear(wire::ToPage::kState).state();
  }

  void say(const wire::ToHost& message) { client_.say(message.SerializeAsString()); }
  /// The next of a kind; the others are taken in. What: kGone: the line was closed.
  wire::ToPage hear(wire::ToPage::WhatCase what) {
    return hear([what](const wire::ToPage& message) { return message.what_case() == what; });
  }
  wire::ToPage hear(const std::function<bool(const wire::ToPage&)>& so) {
    for (;;) {
      const PageClient::Frame frame = client_.hear();
      if (frame.opcode == PageClient::kPing) {
        client_.say(frame.payload, PageClient::kPong);
        continue;
      }
      if (frame.opcode != PageClient::kBinary) {
        ADD_FAILURE() << "the line was closed: " << frame.reason();
        return {};
      }
      wire::ToPage message;
      EXPECT_TRUE(message.ParseFromString(frame.payload));
      if (message.has_state()) state = message.state();
      if (so(message)) return message;
    }
  }
  wire::Notice notice(const std::string& code) {
    return hear([&](const wire::ToPage& m) { return m.has_notice() && m.notice().code() == code; }).notice();
  }
  /// Until the state is so.
  void until(const std::function<bool(const wire::State&)>& so) {
    if (so(state)) return;
    hear([&](const wire::ToPage& m) { return m.has_state() && so(m.state()); });
  }
  /// @returns the reply to it
  wire::Reply ask(wire::ToHost message) {
    message.set_request(++request_);
    say(message);
    return hear([&](const wire::ToPage& m) { return m.has_reply() && m.reply().request() == request_; })
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

 private:
  PageClient client_;
  std::uint32_t request_ = 0;
};

wire::ToHost to_stop() {
  wire::ToHost message;
  message.mutable_stop();
  return message;
}
wire::ToHost to_resume(const StationHost& host) {
  wire::ToHost message;
  message.mutable_resume()->set_stops(host.stops());
  return message;
}
wire::ToHost to_see(std::uint64_t ticks) {
  wire::ToHost message;
  message.set_request(77);
  message.mutable_seen()->set_ticks(ticks);
  return message;
}
wire::ToHost to_take() {
  wire::ToHost message;
  message.mutable_take();
  return message;
}

class CockpitTest : public ::testing::Test {
 protected:
  CockpitTest() {
    StationHostSettings station;
    station.scene = "first_touch";
    station.device = "sliders";
    station.ask_for_realtime = false;
    host_ = std::make_unique<StationHost>(station, clock_);
    cockpit_ = std::make_unique<Cockpit>(
        *host_, CockpitSettings{.log = folder_ / "audit.jsonl",
                                .uploads = folder_ / "up",
                                .version = "1.2.3",
                                .other_urls = {"https://192.0.2.1:8480/"},
                                .clock = [this] { return clock_.now() * clock_.slowdown() + skipped_; }});
    WebServerSettings settings;
    settings.port = 0;
    settings.site_missing = "none";
    server_ = std::make_unique<WebServer>(settings, *cockpit_);
    cockpit_->attach(*server_);
    server_->start();
    owner_ = std::make_unique<test::Owner>(*host_);
  }
  ~CockpitTest() override {
    owner_.reset();
    server_.reset();
    cockpit_.reset();
  }
  [[nodiscard]] std::uint16_t port() const { return server_->port(); }
  /// So long passes for the cockpit at once.
  void skip(double seconds) { skipped_ = skipped_ + seconds; }
  std::string post(const std::string& path, const std::string& body, const std::string& fields = "") const {
    return ask(port(), "POST " + path +
                           " HTTP/1.1\r\nHost: 127.0.0.1\r\nOrigin: http://127.0.0.1\r\nConnection: close\r\n"
                           "Content-Length: " +
                           std::to_string(body.size()) + "\r\n" + fields + "\r\n" + body);
  }
  std::vector<nlohmann::json> log() const {
    std::istringstream text(read_file(folder_ / "audit.jsonl"));
    std::vector<nlohmann::json> lines;
    for (std::string line; std::getline(text, line);) lines.push_back(nlohmann::json::parse(line));
    return lines;
  }
  std::size_t logged(const std::string& code) const {
    std::size_t count = 0;
    for (const auto& line : log()) count += line["code"] == code ? 1U : 0U;
    return count;
  }

  const testing::TemporaryFolder folder_;
  const Clock clock_{test::kHostSlowdown};
  std::atomic<double> skipped_{0.0};
  std::unique_ptr<StationHost> host_;
  std::unique_ptr<Cockpit> cockpit_;
  std::unique_ptr<WebServer> server_;
  std::unique_ptr<test::Owner> owner_;
};

TEST_F(CockpitTest, APageIsWelcomedAndSeesTheHandMove) {
  Page page(port(), "", "Anna");
  EXPECT_EQ(page.welcome.protocol(), Cockpit::kProtocol);
  EXPECT_EQ(page.welcome.version(), "1.2.3");
  EXPECT_EQ(page.welcome.page(), 1U);
  EXPECT_EQ(page.welcome.secret().size(), 22U);
  EXPECT_TRUE(page.welcome.may_operate());
  EXPECT_GT(page.welcome.key_size(), 0);
  EXPECT_GT(page.welcome.clock(), 0.0);
  EXPECT_EQ(page.state.operator_page(), 1U);
  EXPECT_EQ(page.state.operator_name(), "Anna");
  EXPECT_EQ(page.state.scene(), "first_touch");
  EXPECT_EQ(page.state.other_url_size(), 1);
  const wire::Tick first = page.hear(wire::ToPage::kTick).tick();
  EXPECT_EQ(first.hcp_angle_size(), kJoints);
  EXPECT_EQ(first.gdp_pose_size(), 7 * kSegments);
  const wire::Tick second = page.hear(wire::ToPage::kTick).tick();
  EXPECT_GT(second.time(), first.time());
}

TEST_F(CockpitTest, AViewerIsRefusedChangesButStopsAndItIsLoggedWhoDid) {
  Page operating(port());
  Page watching(port(), "", "Ben");
  const wire::Reply refused = watching.set("rate_hz", "250");
  EXPECT_FALSE(refused.ok());
  EXPECT_THAT(refused.error(), HasSubstr("page 1"));
  EXPECT_FALSE(watching.ask(to_resume(*host_)).ok());
  EXPECT_TRUE(watching.ask(to_stop()).ok());
  EXPECT_TRUE(host_->held_stopped());
  EXPECT_EQ(operating.notice("stopped").who(), "page 2 (127.0.0.1), Ben");
  operating.until(
      [](const wire::State& s) { return s.held_stopped() && s.safety() == wire::SAFETY_STOPPED; });
  EXPECT_FALSE(watching.ask(to_resume(*host_)).ok()) << "who stopped is a viewer still";
  EXPECT_TRUE(host_->held_stopped());
  EXPECT_TRUE(operating.ask(to_resume(*host_)).ok());
  operating.until([](const wire::State& s) { return s.safety() == wire::SAFETY_RUNNING; });
  ASSERT_EQ(logged("stopped"), 1U);
  EXPECT_EQ(log()[1]["who"], "page 2 (127.0.0.1), Ben");
  EXPECT_EQ(logged("resumed"), 1U);
}

TEST_F(CockpitTest, AKeyHeldDownIsObeyedEachTimeAndToldOnceASecondAndAfterEachResume) {
  Page page(port());
  for (int i = 0; i < 50; ++i) page.say(to_stop());
  EXPECT_TRUE(page.ask(to_stop()).ok());
  EXPECT_EQ(logged("stopped"), 1U);
  EXPECT_TRUE(page.ask(to_resume(*host_)).ok());
  EXPECT_TRUE(page.ask(to_stop()).ok());
  EXPECT_TRUE(host_->held_stopped());
  const auto lines = log();
  ASSERT_EQ(lines.size(), 4U);
  EXPECT_EQ(lines[1]["code"], "stopped");
  EXPECT_EQ(lines[2]["code"], "resumed");
  EXPECT_EQ(lines[3]["code"], "stopped") << "in the order in which it was";
  skip(1.5);
  EXPECT_TRUE(page.ask(to_stop()).ok());
  EXPECT_EQ(logged("stopped"), 3U);
}

TEST_F(CockpitTest, WhoSitsDownBecauseNobodyOperatesIsToldAndLogged) {
  Page first(port(), "", "Anna");
  ASSERT_EQ(first.welcome.past_size(), 1);
  EXPECT_EQ(first.welcome.past(0).code(), "operator_taken");
  EXPECT_EQ(first.welcome.past(0).who(), "page 1 (127.0.0.1), Anna");
  EXPECT_EQ(first.welcome.past(0).text(), "operates: nobody else did");
  wire::ToHost release;
  release.mutable_release();
  EXPECT_TRUE(first.ask(release).ok());
  Page second(port());
  EXPECT_EQ(first.notice("operator_taken").who(), "page 2 (127.0.0.1)");
  EXPECT_EQ(logged("operator_taken"), 2U);
}

TEST_F(CockpitTest, AResumeThatANewerStopHasOvertakenIsRefused) {
  Page page(port());
  EXPECT_TRUE(page.ask(to_stop()).ok());
  const wire::ToHost late = to_resume(*host_);
  EXPECT_EQ(status_of(post("/stop", "")), 200);
  EXPECT_EQ(page.ask(late).error(), "another stop has come since; look, then resume again");
  EXPECT_TRUE(host_->held_stopped());
  page.until([&](const wire::State& s) { return s.stops() == host_->stops(); });
  EXPECT_TRUE(page.ask(to_resume(*host_)).ok());
  EXPECT_FALSE(host_->held_stopped());
}

/// Ticks that come until so many states have come behind the newest of them.
int ticks_until_states(Page& page, int states) {
  int ticks = 0;
  for (int quiet = 0; quiet < states;) {
    const wire::ToPage message = page.hear([](const wire::ToPage&) { return true; });
    EXPECT_NE(message.what_case(), wire::ToPage::kReply) << "nobody answers to what was seen";
    if (message.what_case() == wire::ToPage::WHAT_NOT_SET) return -1;
    if (message.has_tick()) ++ticks;
    quiet = message.has_tick() ? 0 : quiet + (message.has_state() ? 1 : 0);
  }
  return ticks;
}

TEST_F(CockpitTest, APageIsSentOnlyTwelveTicksThatItHasNotSeen) {
  Page silent(port());
  Page diligent(port());
  silent.hear(wire::ToPage::kTick);  // the station has begun
  EXPECT_EQ(1 + ticks_until_states(silent, 3), 12);
  silent.say(to_see(5));
  EXPECT_EQ(ticks_until_states(silent, 3), 5);
  silent.say(to_see(3));
  EXPECT_EQ(ticks_until_states(silent, 2), 0) << "what was seen stays so";
  silent.say(to_see(1'000'000));
  EXPECT_EQ(ticks_until_states(silent, 3), 12) << "of those that were sent, no more can be seen";
  for (std::uint64_t i = 1; i <= 100; ++i) {
    diligent.hear(wire::ToPage::kTick);
    diligent.say(to_see(i));
  }
}

TEST_F(CockpitTest, AStopAtTheEndOfABurstIsObeyedAndNothingElse) {
  Page operating(port());
  Page hasty(port(), "", "Ben");
  std::vector<std::string> burst(400, to_see(0).SerializeAsString());
  burst.push_back(to_take().SerializeAsString());
  burst.push_back(to_stop().SerializeAsString());
  hasty.client().say_at_once(burst);
  EXPECT_EQ(operating.notice("stopped").who(), "page 2 (127.0.0.1), Ben");
  EXPECT_TRUE(host_->held_stopped());
  EXPECT_EQ(logged("operator_taken"), 1U) << "the first, when it came";
  EXPECT_THAT(hasty.client().hear_end().reason(), HasSubstr("too many"));
}

TEST_F(CockpitTest, APageThatIsOpenedAgainTakesItsOwnPlace) {
  Page first(port(), "", "Anna");
  Page again(port(), first.welcome.secret());
  EXPECT_EQ(again.welcome.page(), 1U);
  EXPECT_EQ(again.state.operator_page(), 1U);
  EXPECT_EQ(again.state.operator_name(), "Anna");
  EXPECT_EQ(first.notice("replaced").text(), "this page was opened again elsewhere");
  EXPECT_THAT(first.client().hear_end().reason(), HasSubstr("opened again elsewhere"));
  again.until([](const wire::State& s) { return s.pages() == 1; });
  EXPECT_TRUE(again.set("force.stiffness_n_per_mm", "0.8").ok());
  skip(11.0);
  EXPECT_TRUE(again.set("force.stiffness_n_per_mm", "0.9").ok()) << "that the old line ended changes nothing";
  EXPECT_EQ(logged("replaced"), 0U) << "it is for that page alone";
}

TEST_F(CockpitTest, SlidersAreLoggedOnceInTenSeconds) {
  Page page(port());
  wire::ToHost sliders;
  for (int j = 0; j < kJoints; ++j) sliders.mutable_sliders()->add_angle(0.1F);
  for (int i = 0; i < 20; ++i) EXPECT_TRUE(page.ask(sliders).ok());
  EXPECT_EQ(logged("sliders"), 1U);
  EXPECT_EQ(log().back()["text"], "moves the hand with the sliders");
  skip(10.5);
  EXPECT_TRUE(page.ask(sliders).ok());
  EXPECT_EQ(logged("sliders"), 2U);
}

TEST_F(CockpitTest, StopsAndPagesGetThroughACrowdThatOnlyConnects) {
  std::vector<std::unique_ptr<RawClient>> crowd;
  for (int i = 0; i < 200; ++i) crowd.push_back(std::make_unique<RawClient>(port()));
  EXPECT_EQ(status_of(post("/stop", "")), 200);
  EXPECT_TRUE(host_->held_stopped());
  Page page(port());
  EXPECT_TRUE(page.ask(to_resume(*host_)).ok());
}

TEST_F(CockpitTest, ControlIsTakenOpenlyAndGivenBack) {
  Page first(port(), "", "Anna");
  Page second(port(), "", "Ben");
  EXPECT_TRUE(second.ask(to_take()).ok());
  const wire::Notice told = first.notice("operator_taken");
  EXPECT_EQ(told.who(), "page 2 (127.0.0.1), Ben");
  EXPECT_EQ(told.text(), "took control from page 1 (127.0.0.1), Anna");
  first.until([](const wire::State& s) { return s.operator_page() == 2; });
  EXPECT_FALSE(first.set("force.stiffness_n_per_mm", "0.7").ok());
  EXPECT_TRUE(second.ask(to_take()).ok());
  EXPECT_EQ(logged("operator_taken"), 2U) << "from oneself is nothing";
  wire::ToHost release;
  release.mutable_release();
  EXPECT_TRUE(second.ask(release).ok());
  first.until([](const wire::State& s) { return s.operator_page() == 0; });
  EXPECT_THAT(second.set("rate_hz", "250").error(), HasSubstr("nobody operates"));
}

TEST_F(CockpitTest, AReloadKeepsTheRoleForTenSecondsAndNoLonger) {
  auto page = std::make_unique<Page>(port(), "", "Anna");
  Page other(port());
  const std::string secret = page->welcome.secret();
  page.reset();
  other.until([](const wire::State& s) { return s.pages() == 1; });
  EXPECT_FALSE(other.set("rate_hz", "250").ok());
  skip(9.0);
  page = std::make_unique<Page>(port(), secret);
  EXPECT_EQ(page->welcome.page(), 1U);
  EXPECT_EQ(page->welcome.secret(), secret);
  EXPECT_EQ(page->state.operator_page(), 1U);
  EXPECT_EQ(page->state.operator_name(), "Anna");
  page.reset();
  other.until([](const wire::State& s) { return s.pages() == 1; });
  skip(11.0);
  other.until([](const wire::State& s) { return s.operator_page() == 0; });
  EXPECT_TRUE(other.ask(to_take()).ok());
  page = std::make_unique<Page>(port(), secret);
  EXPECT_EQ(page->state.operator_page(), 2U);
}

TEST_F(CockpitTest, ChangesAreMadeToldAndLoggedAndWhatIsRefusedSaysWhy) {
  Page page(port());
  Page other(port());
  EXPECT_TRUE(page.set("force.stiffness_n_per_mm", "0.8").ok());
  EXPECT_EQ(other.notice("set").text(), "force.stiffness_n_per_mm = 0.8");
  other.until([](const wire::State& s) { return s.changed_size() == 1; });
  const wire::Reply refused = page.set("force.stiffness_n_per_mm", "-1");
  EXPECT_FALSE(refused.ok());
  EXPECT_THAT(refused.error(), HasSubstr("force.stiffness_n_per_mm"));
  EXPECT_EQ(other.notice("refused").level(), wire::Notice::WARNING);
  wire::ToHost scene;
  scene.mutable_scene()->set_name("pinch_ball");
  EXPECT_TRUE(page.ask(scene).ok());
  other.until([](const wire::State& s) { return s.scene() == "pinch_ball" && s.geometry() == 2; });
  EXPECT_EQ(logged("set"), 1U);
  EXPECT_EQ(logged("refused"), 1U);
  EXPECT_EQ(logged("scene"), 1U);
}

TEST_F(CockpitTest, NoPageLearnsAnothersSecretAndNoFrameHoldsWhatBrowsersRefuse) {
  Page first(port(), "", std::string("An\u202Ena"));
  Page second(port());
  first.set("description", "'''two\nlines'''");
  first.ask(to_stop());
  second.ask(to_take());
  std::string heard;
  for (int i = 0; i < 20; ++i) heard += second.client().hear().payload;
  EXPECT_THAT(heard, Not(HasSubstr(first.welcome.secret())));
  EXPECT_THAT(read_file(folder_ / "audit.jsonl"), Not(HasSubstr(first.welcome.secret())));
  EXPECT_THAT(read_file(folder_ / "audit.jsonl"), Not(HasSubstr(second.welcome.secret())));
  cockpit_->tell("fault", "a device named \xFF\xFE", true);
  EXPECT_EQ(first.notice("fault").text(), "a device named \xEF\xBF\xBD\xEF\xBF\xBD");
}

TEST_F(CockpitTest, TheNewestNoticesWaitForWhoeverComesHoweverLongTheyWere) {
  Page page(port());
  for (int i = 0; i < 10; ++i)
    page.set("description", "'" + std::string(4000, 'x') + std::to_string(i) + "'");
  cockpit_->tell("fault", std::string(3'000'000, 'y'), true);
  page.notice("fault");
  Page later(port());
  EXPECT_EQ(later.welcome.past_size(), 12);
  EXPECT_LT(later.welcome.ByteSizeLong(), 200000U);
}

TEST_F(CockpitTest, GarbageIsShownOutAndTheOthersGoOn) {
  Page page(port());
  PageClient garbage(port());
  garbage.say("\xFF\xFF\xFF no message");
  EXPECT_EQ(garbage.hear_end().opcode, PageClient::kClose);
  PageClient rude(port());
  wire::ToHost early;
  early.mutable_take();
  rude.say(early.SerializeAsString());
  EXPECT_THAT(rude.hear_end().reason(), HasSubstr("hello"));
  PageClient bad_text(port());
  bad_text.say(std::string("\x12\x03\x12\x01\xFF", 5));  // a hello whose secret is no UTF-8
  EXPECT_EQ(bad_text.hear_end().opcode, PageClient::kClose);
  EXPECT_TRUE(page.ask(to_take()).ok());
  wire::ToHost nothing;
  EXPECT_FALSE(page.ask(nothing).ok());
}

TEST_F(CockpitTest, WhoHasNotSaidHelloMayStopAndIsShownOutInTheEnd) {
  Page page(port());
  PageClient silent(port());
  silent.say(to_stop().SerializeAsString());
  EXPECT_EQ(page.notice("stopped").who(), "page 2 (127.0.0.1)");
  EXPECT_TRUE(host_->held_stopped());
  skip(11.0);
  EXPECT_THAT(silent.hear_end().reason(), HasSubstr("hello"));
  page.until([](const wire::State& s) { return s.pages() == 1; });
}

TEST_F(CockpitTest, AStopComesInOverPlainHttpToo) {
  Page page(port(), "", "Anna");
  EXPECT_EQ(status_of(post("/stop", "")), 200);
  EXPECT_TRUE(host_->held_stopped());
  EXPECT_EQ(page.notice("stopped").who(), "a page (127.0.0.1)");
  EXPECT_EQ(status_of(post("/stop", "", "X-Phalanx-Page: " + page.welcome.secret() + "\r\n")), 200);
  EXPECT_EQ(page.notice("stopped").who(), "page 1 (127.0.0.1), Anna");
  EXPECT_EQ(status_of(ask(port(), get("/stop"))), 405) << "no link stops a hand";
  EXPECT_EQ(status_of(post("/resume", "")), 404);
  EXPECT_TRUE(host_->held_stopped());
}

TEST_F(CockpitTest, TheShapesAreFetchedByTheirRevision) {
  Page page(port());
  const std::string answer = ask(port(), get("/geometry/1"));
  ASSERT_EQ(status_of(answer), 200);
  wire::Geometry geometry;
  ASSERT_TRUE(geometry.ParseFromString(body_of(answer)));
  EXPECT_EQ(geometry.revision(), 1U);
  EXPECT_GT(geometry.object().position_size(), 0);
  for (const std::string wrong : {"2", "", "1x", "../1", "-1", "01", "99999999999999999999"})
    EXPECT_EQ(status_of(ask(port(), get("/geometry/" + wrong))) / 100, 4) << wrong;
}

TEST_F(CockpitTest, TheOperatorSendsAMeshAndGraspsIt) {
  Page page(port());
  Page other(port());
  const std::string mesh = "v 0 0 0\nv 60 0 0\nv 0 60 0\nv 0 0 60\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";
  const std::string mine = "X-Phalanx-Page: " + page.welcome.secret() + "\r\n";
  const std::string theirs = "X-Phalanx-Page: " + other.welcome.secret() + "\r\n";
  EXPECT_EQ(status_of(post("/mesh?name=a.obj&unit=mm", mesh)) / 100, 4);
  EXPECT_EQ(status_of(post("/mesh?name=a.obj&unit=mm", mesh, theirs)) / 100, 4);
  EXPECT_EQ(status_of(post("/mesh?name=a.obj&unit=mile", mesh, mine)), 400);
  const auto bad = nlohmann::json::parse(body_of(post("/mesh?name=b.obj", "not a mesh", mine)));
  EXPECT_FALSE(bad["ok"].get<bool>());
  const auto good =
      nlohmann::json::parse(body_of(post("/mesh?token=geheim&name=../a.obj&unit=mm", mesh, mine)));
  ASSERT_TRUE(good["ok"].get<bool>()) << good.dump();
  const wire::Notice told = other.notice("upload");
  EXPECT_THAT(read_file(folder_ / "audit.jsonl"), Not(HasSubstr("geheim")));
  EXPECT_EQ(told.who(), "page 1 (127.0.0.1)");
  wire::ToHost set;
  const auto lay = [&](const std::string& key, const std::string& value) {
    auto& setting = *set.mutable_set()->add_setting();
    setting.set_key(key);
    setting.set_value(value);
  };
  lay("objects.0", "{kind = \"file\", file = \"" + good["file"].get<std::string>() +
                       "\", size_mm = 0, unit = \"mm\", position_mm = [0, 400, 0]}");
  const wire::Reply reply = page.ask(set);
  EXPECT_TRUE(reply.ok()) << reply.error();
  EXPECT_FALSE(page.set("objects.0.file", "/etc/passwd").ok());
}

TEST_F(CockpitTest, EndsWhileAPageStillAsksAndAMeshIsStillRead) {
  Page page(port());
  for (int i = 0; i < 20; ++i) {
    wire::ToHost scene;
    scene.mutable_scene()->set_name("pinch_ball");
    scene.set_request(100U + static_cast<unsigned>(i));
    page.say(scene);
  }
  std::string mesh;
  for (int i = 0; i < 3000; ++i) {
    const std::string x = std::to_string(i);
    mesh += "v " + x + " 0 0\nv " + x + " 1 0\nv " + x + " 0 1\n";
    const std::string n = std::to_string(3 * i + 1);
    mesh += "f " + n + " " + std::to_string(3 * i + 2) + " " + std::to_string(3 * i + 3) + "\n";
  }
  RawClient line(port());
  line.say(
      "POST /mesh?name=a.obj HTTP/1.1\r\nHost: 127.0.0.1\r\nOrigin: http://127.0.0.1\r\nX-Phalanx-Page: " +
      page.welcome.secret() + "\r\nContent-Length: " + std::to_string(mesh.size()) + "\r\n\r\n" + mesh);
  page.notice("upload");
  owner_.reset();
  server_.reset();
  cockpit_.reset();
  for (int i = 0; i < 20; ++i) host_->go_on();  // answers to a cockpit that is no more
}

TEST_F(CockpitTest, AnUploadThatIsStuckDoesNotKeepItFromEnding) {
  Page page(port());
  const std::string mesh = "v 0 0 0\nv 60 0 0\nv 0 60 0\nv 0 0 60\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";
  const std::string mine = "X-Phalanx-Page: " + page.welcome.secret() + "\r\n";
  const auto good = nlohmann::json::parse(body_of(post("/mesh?name=a.obj&unit=mm", mesh, mine)));
  ASSERT_TRUE(good["ok"].get<bool>()) << good.dump();
  page.notice("upload");
  // The next one is written to a pipe that nobody reads.
  const std::string pipe = good["file"].get<std::string>() + ".partial";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  RawClient line(port());
  line.say("POST /mesh?name=a.obj&unit=mm HTTP/1.1\r\nHost: 127.0.0.1\r\nOrigin: http://127.0.0.1\r\n" +
           mine + "Content-Length: " + std::to_string(mesh.size()) + "\r\n\r\n" + mesh);
  page.notice("upload");
  std::this_thread::sleep_for(std::chrono::milliseconds(500));  // most often it is stuck by then
  owner_.reset();
  server_.reset();
  cockpit_.reset();  // hangs if it waits
  const int reader = ::open(pipe.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  ASSERT_GE(reader, 0);
  std::array<char, 4096> piece{};
  for (;;) {
    const ssize_t got = ::read(reader, piece.data(), piece.size());
    if (got == 0 || (got < 0 && errno != EAGAIN)) break;
    std::this_thread::yield();
  }
  ::close(reader);
}

}  // namespace
}  // namespace phalanx

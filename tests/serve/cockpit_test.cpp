// SPDX-License-Identifier: Apache-2.0
// Pages, the server and a station: roles, notices, ticks and states. See docs/cockpit.md.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <string>
#include <tuple>
#include <vector>

#include "device/opengloves/glove_firmware.h"
#include "phalanx/core/index.h"
#include "phalanx/hand/hand_model.h"
#include "phalanx/scene/data_paths.h"
#include "serve/cockpit_fixture.h"
#include "serve/full_disk.h"
#include "support/held_clock/hold_this_process.h"

namespace phalanx {
namespace {

using namespace test;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

const std::string kStiffness = "force.stiffness_n_per_mm";

/// [s]
double since_1970() {
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

TEST_F(CockpitTest, APageGetsAWelcomeAndSeesTheHandMove) {
  clock_.sleep_until(1.0);
  const double before = since_1970();
  Page page(port(), "", "Anna");
  const double after = since_1970();
  ASSERT_EQ(page.welcome.past_size(), 1) << "the notice that it operates";
  for (const double told : {page.welcome.unix_time(), page.welcome.past(0).unix_time()}) {
    EXPECT_GE(told, before);
    EXPECT_LE(told, after);
  }
  EXPECT_EQ(page.welcome.protocol(), Cockpit::kProtocol);
  EXPECT_EQ(page.welcome.version(), "1.2.3");
  EXPECT_EQ(page.welcome.page(), 1U);
  EXPECT_EQ(page.welcome.secret().size(), 22U);
  EXPECT_TRUE(page.welcome.may_operate());
  EXPECT_GT(page.welcome.key_size(), 0);
  EXPECT_GE(page.welcome.clock(), 1.0);
  EXPECT_LE(page.welcome.clock(), session_->now());
  EXPECT_EQ(page.state.operator_page(), 1U);
  EXPECT_EQ(page.state.operator_name(), "Anna");
  EXPECT_EQ(page.state.scene(), "first_touch");
  ASSERT_EQ(page.welcome.viewer_url_size(), 1);
  EXPECT_EQ(page.welcome.viewer_url(0), kViewerUrl);
  const wire::Tick first = page.receive(wire::ToPage::kTick).tick();
  EXPECT_EQ(first.hcp_angle_size(), kJoints);
  EXPECT_EQ(first.gdp_pose_size(), 7 * kSegments);
  const wire::Tick second = page.receive(wire::ToPage::kTick).tick();
  EXPECT_GT(second.time(), first.time());
}

// In slow motion frames come more often than steps.
// The GDP of a fist goes through itself, and the angles say so; the poses are those of the displayed hand.
TEST_F(CockpitTest, APageGetsAHandWhoseDigitsDoNotGoThroughEachOther) {
  Page page(port());
  ASSERT_TRUE(page.set("objects.0.position_mm", "[0, 0, -400]").ok());
  const auto geometry = session_->info()->geometry;
  const HandModel hand(geometry->hand, geometry->handedness, geometry->X_WH, geometry->segment);
  /// @returns the greatest distance between a segment that was sent and where the GDP's angles have it [m]
  const auto apart = [&](const wire::Tick& tick) {
    JointArray angle{};
    for (int j = 0; j < kJoints; ++j) angle[idx(j)] = static_cast<double>(tick.gdp_angle(j));
    HandPoses poses;
    hand.poses(angle, poses);
    double most = 0.0;
    for (int segment = 0; segment < kPalm; ++segment) {
      const Vec3& p = poses.digit[idx(digit_of_segment(segment))].segment[idx(segment % kSegmentsPerDigit)].p;
      Vec3 sent;
      for (int i = 0; i < 3; ++i) sent[i] = static_cast<double>(tick.gdp_pose(7 * segment + i));
      most = std::max(most, (sent - p).norm());
    }
    return most;
  };
  const auto next = [&] {
    const wire::Tick tick = page.receive(wire::ToPage::kTick).tick();
    page.send(to_see(static_cast<std::uint64_t>(page.ticks)));
    return tick;
  };
  EXPECT_LT(apart(next()), 1e-4) << "the open hand is clear of itself";
  wire::ToHost fist;
  for (int j = 0; j < kJoints; ++j) {
    const double open = geometry->hand.open_angle[idx(j)];
    const bool flexes = j % kJointsPerDigit != kAbductionJoint;
    const double wanted = flexes ? open + 0.8 * (geometry->hand.max_angle[idx(j)] - open) : open;
    fist.mutable_sliders()->add_angle(static_cast<float>(wanted));
  }
  ASSERT_TRUE(page.ask(fist).ok());
  const auto closed = [&](const wire::Tick& tick) {
    for (int j = 0; j < kJoints; ++j)
      if (std::abs(tick.gdp_angle(j) - fist.sliders().angle(j)) > 0.01F) return false;
    return true;
  };
  wire::Tick tick;
  const auto expect_apart = [&] {
    do tick = next();
    while (!closed(tick));
    EXPECT_GT(apart(tick), 2e-3);
  };
  expect_apart();
  // Another margin or object, which begin another displayed hand, below a hand that stays a fist.
  ASSERT_TRUE(page.set("contact.margin_mm", "0.7").ok());
  expect_apart();
  ASSERT_TRUE(page.set("objects.0.size_mm", "110").ok());
  expect_apart();
}

TEST_F(CockpitTest, AStepIsSentOnceHoweverManyFramesComeInBetween) {
  Page page(port());
  double last = -1.0;
  for (int i = 0; i < 10; ++i) {
    server_->post([this] {
      for (int k = 0; k < 3; ++k) cockpit_->frame();
    });
    const wire::Tick tick = page.receive(wire::ToPage::kTick).tick();
    EXPECT_GT(tick.time(), last);
    last = tick.time();
    page.send(to_see(static_cast<std::uint64_t>(page.ticks)));
  }
}

TEST_F(CockpitTest, ThePagesFirstStateFollowsItsWelcomeBeforeAnyTick) {
  const Page operating(port());
  clock_.sleep_until(1.0);
  const Page watching(port(), "", "Ben");
  EXPECT_EQ(watching.ticks, 0);
  EXPECT_EQ(watching.state.operator_page(), 1U);
}

struct OpenGlove {
  GloveFirmware firmware{"A0B0C0D0E0F2047G2047"};
};
class GloveCockpitTest : private OpenGlove, public CockpitTest {
 protected:
  GloveCockpitTest() : CockpitTest(false, "opengloves:" + firmware.port()) {}
};

TEST_F(GloveCockpitTest, APageIsToldThatTheDeviceHoldsAFingerWithoutItsHost) {
  Page page(port());
  EXPECT_TRUE(page.state.holds_without_host());
  EXPECT_THAT(page.notice("no_watchdog").text(), HasSubstr("has no watchdog"));
}

TEST_F(CockpitTest, AViewerMayNotChangeButMayStopAndIsLogged) {
  Page operating(port());
  Page watching(port(), "", "Ben");
  const wire::Reply refused = watching.set("rate_hz", "250");
  EXPECT_FALSE(refused.ok());
  EXPECT_THAT(refused.error(), HasSubstr("page 1"));
  EXPECT_FALSE(watching.ask(to_resume(*session_)).ok());
  EXPECT_TRUE(watching.ask(to_stop()).ok());
  EXPECT_TRUE(session_->held_stopped());
  EXPECT_EQ(operating.notice("stopped").who(), "page 2 (127.0.0.1), Ben");
  operating.until(
      [](const wire::State& s) { return s.held_stopped() && s.safety() == wire::SAFETY_STOPPED; });
  EXPECT_FALSE(watching.ask(to_resume(*session_)).ok()) << "a viewer remains one after a stop";
  EXPECT_TRUE(session_->held_stopped());
  EXPECT_TRUE(operating.ask(to_resume(*session_)).ok());
  operating.until([](const wire::State& s) { return s.safety() == wire::SAFETY_RUNNING; });
  ASSERT_EQ(logged("stopped"), 1U);
  EXPECT_EQ(log()[1]["who"], "page 2 (127.0.0.1), Ben");
  EXPECT_EQ(logged("resumed"), 1U);
}

TEST_F(StillCockpitTest, ARepeatedStopIsAppliedEachTimeAndLoggedOnceASecondAndAfterEachResume) {
  Page page(port());
  for (int i = 0; i < 50; ++i) page.send(to_stop());
  EXPECT_TRUE(page.ask(to_stop()).ok());
  EXPECT_EQ(logged("stopped"), 1U);
  EXPECT_TRUE(page.ask(to_resume(*session_)).ok());
  EXPECT_TRUE(page.ask(to_stop()).ok());
  EXPECT_TRUE(session_->held_stopped());
  const auto lines = log();
  ASSERT_EQ(lines.size(), 4U);
  EXPECT_EQ(lines[1]["code"], "stopped");
  EXPECT_EQ(lines[2]["code"], "resumed");
  EXPECT_EQ(lines[3]["code"], "stopped") << "in order";
  skip(1.5);
  EXPECT_TRUE(page.ask(to_stop()).ok());
  EXPECT_EQ(logged("stopped"), 3U);
}

TEST_F(StillCockpitTest, AStopWithAnEffectIsLoggedHoweverSoonItComes) {
  Page page(port());
  EXPECT_TRUE(page.ask(to_stop()).ok());
  session_->resume();  // at the terminal
  EXPECT_TRUE(page.ask(to_stop()).ok());
  EXPECT_EQ(logged("stopped"), 2U);
  EXPECT_TRUE(page.ask(to_stop()).ok());
  EXPECT_EQ(logged("stopped"), 2U) << "it had no effect";
}

TEST_F(StillCockpitTest, TwoAddressesWithoutAPageAreLoggedApart) {
  const auto stop_from = [this](const std::string& address) {
    WebRequest request;
    request.method = "POST";
    request.path = "/stop";
    request.client.address = address;
    server_->post([this, request] { cockpit_->requested(request, [](const WebResponse&) {}); });
  };
  for (const char* address : {"192.0.2.1", "192.0.2.2", "192.0.2.1"}) stop_from(address);
  const auto lines = log();
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_EQ(lines[0]["who"], "a page (192.0.2.1)");
  EXPECT_EQ(lines[1]["who"], "a page (192.0.2.2)");
}

TEST_F(CockpitTest, BecomingTheFirstOperatorIsNotifiedAndLogged) {
  Page first(port(), "", "Anna");
  ASSERT_EQ(first.welcome.past_size(), 1);
  EXPECT_EQ(first.welcome.past(0).code(), "operator_taken");
  EXPECT_EQ(first.welcome.past(0).who(), "page 1 (127.0.0.1), Anna");
  EXPECT_EQ(first.welcome.past(0).text(), "operates: there was no operator");
  wire::ToHost release;
  release.mutable_release();
  EXPECT_TRUE(first.ask(release).ok());
  Page second(port());
  EXPECT_EQ(first.notice("operator_taken").who(), "page 2 (127.0.0.1)");
  EXPECT_EQ(logged("operator_taken"), 2U);
}

TEST_F(CockpitTest, AResumeAfterANewerStopIsRefused) {
  Page page(port());
  EXPECT_TRUE(page.ask(to_stop()).ok());
  const wire::ToHost late = to_resume(*session_);
  EXPECT_EQ(status_of(post("/stop", "")), 200);
  EXPECT_EQ(page.ask(late).error(), "another stop or fault has come since; look, then resume again");
  EXPECT_TRUE(session_->held_stopped());
  page.until([&](const wire::State& s) { return s.stops() == session_->stops(); });
  EXPECT_TRUE(page.ask(to_resume(*session_)).ok());
  EXPECT_FALSE(session_->held_stopped());
}

TEST_F(CockpitTest, APageIsSentAtMostTwelveUnacknowledgedTicks) {
  Page silent(port());
  Page prompt(port());
  std::uint64_t seen = 0;
  // Ticks that the silent page receives after this acknowledgement, while the other one receives 20.
  const auto ticks = [&](std::uint64_t ticks_seen) {
    const int before = silent.ticks;
    silent.send(to_see(ticks_seen));
    silent.ask(to_be_named("silent"));  // it has been handled
    for (int i = 0; i < 20; ++i) {
      prompt.receive(wire::ToPage::kTick);
      prompt.send(to_see(++seen));
    }
    for (int i = 0; i < 2; ++i) silent.ask(to_be_named("silent"));  // a tick may come behind the first reply
    return silent.ticks - before;
  };
  EXPECT_EQ(ticks(0), 12);
  EXPECT_EQ(ticks(5), 5);
  EXPECT_EQ(ticks(3), 0) << "an acknowledgement is not taken back";
  EXPECT_EQ(ticks(1'000'000), 12) << "no more than were sent can be acknowledged";
  EXPECT_EQ(silent.replies, 4 * 3) << "acknowledgements have no reply";
}

// A state comes at least every 0.5 s and, after a change, at most every 0.05 s. Of 20 ticks at most 12 were
// sent before the clock was advanced; the others follow the state that is due then.
TEST_F(StillCockpitTest, AStateComesWhenItIsDueOrSomethingHasChangedAndOnlyOnce) {
  const auto rests = [this](SafetyState state) {
    for (int i = 0; i < 60'000 && session_->view().state != state; ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    return session_->view().state == state;
  };
  ASSERT_TRUE(rests(SafetyState::kRunning));
  Page page(port());
  page.receive(wire::ToPage::kState);  // the first that all pages are sent
  // States that come with 20 ticks.
  const auto states = [&page] {
    int count = 0;
    for (int ticks = 0; ticks < 20;) {
      const wire::ToPage message =
          page.receive([](const wire::ToPage& m) { return m.has_tick() || m.has_state(); });
      if (!message.has_tick() && !message.has_state()) return -1;
      count += message.has_state() ? 1 : 0;
      if (!message.has_tick()) continue;
      ++ticks;
      page.send(to_see(static_cast<std::uint64_t>(page.ticks)));
    }
    return count;
  };
  skip(1.0);
  EXPECT_EQ(states(), 1);
  EXPECT_EQ(states(), 0) << "no time passes";
  skip(0.3);
  EXPECT_EQ(states(), 0) << "nothing has changed";
  skip(0.3);
  EXPECT_EQ(states(), 1) << "0.6 s after the last one";
  EXPECT_TRUE(page.ask(to_be_named("Anna")).ok());
  EXPECT_EQ(states(), 0) << "too soon";
  skip(0.1);
  EXPECT_EQ(states(), 1) << "a page has changed";
  session_->stop();  // at the terminal
  ASSERT_TRUE(rests(SafetyState::kStopped));
  skip(0.1);
  EXPECT_EQ(states(), 1) << "the station has changed";
}

TEST_F(CockpitTest, AStopAtTheEndOfABurstIsAppliedAndNothingElse) {
  Page operating(port());
  Page fast(port(), "", "Ben");
  std::vector<std::string> burst(400, to_see(0).SerializeAsString());
  burst.push_back(to_take().SerializeAsString());
  burst.push_back(to_stop().SerializeAsString());
  fast.client().send_at_once(burst);
  EXPECT_EQ(operating.notice("stopped").who(), "page 2 (127.0.0.1), Ben");
  EXPECT_TRUE(session_->held_stopped());
  EXPECT_EQ(logged("operator_taken"), 1U) << "the first page";
  EXPECT_THAT(fast.client().receive_until_closed().reason(), HasSubstr("too many"));
}

TEST_F(CockpitTest, AViewersTokenAllowsViewingOnly) {
  serve("operator-token-16", "viewers-token--16");
  Page viewer(port(), "", "Ben", "/?token=viewers-token--16");
  EXPECT_FALSE(viewer.welcome.may_operate());
  EXPECT_EQ(viewer.welcome.viewer_url_size(), 0);
  EXPECT_EQ(viewer.state.operator_page(), 0U);
  EXPECT_FALSE(viewer.ask(to_take()).ok());
  Page operating(port(), "", "Anna", "/?token=operator-token-16");
  EXPECT_TRUE(operating.welcome.may_operate());
  ASSERT_EQ(operating.welcome.viewer_url_size(), 1);
  EXPECT_EQ(operating.welcome.viewer_url(0), kViewerUrl);
  EXPECT_EQ(operating.state.operator_name(), "Anna");
}

TEST_F(CockpitTest, ASecondHelloIsIgnored) {
  Page page(port());
  wire::ToHost again;
  again.mutable_hello()->set_protocol(Cockpit::kProtocol);
  page.send(again);
  wire::ToHost take = to_take();
  take.set_request(9);
  page.send(take);
  int welcomes = 0;
  page.receive([&](const wire::ToPage& m) {
    welcomes += m.has_welcome() ? 1 : 0;
    return m.has_reply();
  });
  EXPECT_EQ(welcomes, 0);
}

TEST_F(CockpitTest, APageThatIsOpenedAgainReplacesTheOlder) {
  Page first(port(), "", "Anna");
  Page again(port(), first.welcome.secret());
  EXPECT_EQ(again.welcome.page(), 1U);
  EXPECT_EQ(again.state.operator_page(), 1U);
  EXPECT_EQ(again.state.operator_name(), "Anna");
  const wire::Notice why = first.notice("replaced");
  EXPECT_EQ(why.text(), "this page was opened again elsewhere");
  EXPECT_EQ(why.level(), wire::Notice::WARNING);
  EXPECT_GT(why.unix_time(), 0.0);
  EXPECT_THAT(first.client().receive_until_closed().reason(), HasSubstr("opened again elsewhere"));
  again.until([](const wire::State& s) { return s.pages() == 1; });
  EXPECT_TRUE(again.set("force.stiffness_n_per_mm", "0.8").ok());
  skip(11.0);
  EXPECT_TRUE(again.set("force.stiffness_n_per_mm", "0.9").ok())
      << "the end of the old connection changes nothing";
  EXPECT_EQ(logged("replaced"), 0U) << "the notice is for that page only";
}

wire::ToHost to_drag(const std::string& key, const std::string& value, bool dragging = true) {
  wire::ToHost message;
  auto& setting = *message.mutable_set()->add_setting();
  setting.set_key(key);
  setting.set_value(value);
  message.mutable_set()->set_dragging(dragging);
  return message;
}

TEST_F(StillCockpitTest, ADragIsOneLineWithItsLastValue) {
  Page page(port());
  for (int i = 1; i <= 26; ++i) EXPECT_TRUE(page.ask(to_drag(kStiffness, fmt::format("0.{:02}", i))).ok());
  EXPECT_TRUE(page.ask(to_drag(kStiffness, "0.26", false)).ok());
  EXPECT_EQ(page.notice("set").text(), kStiffness + " = 0.26");
  ASSERT_EQ(logged("set"), 1U);
}

// It is logged with its value at that time, before the notice that comes in between.
TEST_F(StillCockpitTest, ADragThatDoesNotEndIsLoggedAllTheSame) {
  auto here = std::make_unique<Page>(port());
  Page& page = *here;
  page.ask(to_drag(kStiffness, "0.1"));
  page.ask(to_drag(kStiffness, "0.2"));
  page.ask(to_stop());
  page.ask(to_drag(kStiffness, "0.3"));
  page.ask(to_drag("smoothing.max_n_per_s", "2"));
  page.ask(to_be_named("Anna"));  // the messages before it have been handled
  skip(10.0);
  EXPECT_EQ(page.receive([](const wire::ToPage& m) {
                  return m.has_notice() && m.notice().text().find("smoothing") != std::string::npos;
                })
                .notice()
                .code(),
            "set");
  page.ask(to_drag(kStiffness, "0.4"));
  page.ask(to_be_named("Anna"));
  cockpit_->typed("set", "typed");
  page.ask(to_drag(kStiffness, "0.5"));
  page.ask(to_be_named("Anna"));
  here.reset();
  std::vector<std::string> texts;
  for (int i = 0; i < 10'000 && (texts.empty() || texts.back() != kStiffness + " = 0.5"); ++i) {
    texts.clear();
    for (const auto& line : log())
      if (line["code"] == "set" || line["code"] == "stopped") texts.push_back(line["text"]);
  }
  EXPECT_EQ(texts, (std::vector<std::string>{kStiffness + " = 0.2", "stopped the torque",
                                             kStiffness + " = 0.3", "smoothing.max_n_per_s = 2",
                                             kStiffness + " = 0.4", "typed", kStiffness + " = 0.5"}));
}

TEST_F(StillCockpitTest, SlidersAreLoggedOnceInTenSeconds) {
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

TEST_F(CockpitTest, IdleConnectionsDoNotLockOutStopsAndPages) {
  std::vector<std::unique_ptr<RawClient>> idle;
  for (int i = 0; i < 200; ++i) idle.push_back(std::make_unique<RawClient>(port()));
  EXPECT_EQ(status_of(post("/stop", "")), 200);
  EXPECT_TRUE(session_->held_stopped());
  Page page(port());
  EXPECT_TRUE(page.ask(to_resume(*session_)).ok());
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
  EXPECT_EQ(logged("operator_taken"), 2U) << "the operator cannot take control from itself";
  wire::ToHost release;
  release.mutable_release();
  EXPECT_TRUE(second.ask(release).ok());
  first.until([](const wire::State& s) { return s.operator_page() == 0; });
  EXPECT_THAT(second.set("rate_hz", "250").error(), HasSubstr("there is no operator"));
}

TEST_F(CockpitTest, AReloadKeepsTheRoleForTenSecondsAndNoLonger) {
  auto page = std::make_unique<Page>(port(), "", "Anna");
  Page other(port());
  const std::string secret = page->welcome.secret();
  page.reset();
  other.until([](const wire::State& s) { return s.pages() == 1; });
  EXPECT_FALSE(other.set("rate_hz", "250").ok());
  skip(5.0);  // participants_test.cpp tests the exact time
  page = std::make_unique<Page>(port(), secret);
  EXPECT_EQ(page->welcome.page(), 1U);
  EXPECT_EQ(page->welcome.secret(), secret);
  EXPECT_EQ(page->state.operator_page(), 1U);
  EXPECT_EQ(page->state.operator_name(), "Anna");
  page.reset();
  other.until([](const wire::State& s) { return s.pages() == 1; });
  skip(11.0);
  other.until([](const wire::State& s) { return s.operator_page() == 2; });  // it is the only page
  EXPECT_TRUE(other.set("rate_hz", "250").ok());
  EXPECT_EQ(logged("operator_taken"), 2U);
  page = std::make_unique<Page>(port(), secret);
  EXPECT_EQ(page->state.operator_page(), 2U);
}

TEST_F(CockpitTest, ChangesAreAppliedNotifiedAndLoggedAndRefusalsHaveAReason) {
  Page page(port());
  Page other(port());
  EXPECT_TRUE(page.set("force.stiffness_n_per_mm", "0.8").ok());
  EXPECT_EQ(other.notice("set").text(), "force.stiffness_n_per_mm = 0.8");
  other.until([](const wire::State& s) {
    return std::any_of(s.changed().begin(), s.changed().end(),
                       [](const auto& one) { return one.key() == "force.stiffness_n_per_mm"; });
  });
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

// Both refusals name a shipped file.
TEST_F(CockpitTest, ARefusalDoesNotShowWhereTheProgramIsInstalled) {
  Page page(port());
  for (const auto& [key, value, named] :
       {std::tuple{"hand.profile", "nobody-has-it", "assets/profiles/nobody-has-it.toml"},
        std::tuple{"smoothing.min_n", "-0.1", "scenes/first_touch.toml"}}) {
    const wire::Reply refused = page.set(key, value);
    EXPECT_FALSE(refused.ok());
    EXPECT_THAT(refused.error(), AllOf(HasSubstr(named), Not(HasSubstr(data_folder().string()))));
    EXPECT_THAT(page.notice("refused").text(), Not(HasSubstr(data_folder().string())));
  }
}

TEST_F(CockpitTest, AnOvertakenValueIsNoChange) {
  Page page(port());
  // The station first ramps to zero torque. The messages arrive together, and the clock stands still until
  // all are handled, so that the values wait.
  wire::ToHost load;
  load.mutable_scene()->set_name("first_touch");
  load.set_request(99);
  std::vector<std::string> burst = {load.SerializeAsString()};
  for (const std::string value : {"99", "0.7", "0.8"}) {
    wire::ToHost message;
    auto& setting = *message.mutable_set()->add_setting();
    setting.set_key("force.stiffness_n_per_mm");
    setting.set_value(value);
    message.set_request(100);
    burst.push_back(message.SerializeAsString());
  }
  page.client().send_at_once(burst);
  for (int i = 0; i < 4; ++i) {
    const wire::Reply reply = page.receive(wire::ToPage::kReply).reply();
    EXPECT_EQ(reply.request(), i == 0 ? 99U : 100U);
    EXPECT_TRUE(reply.ok()) << reply.error();
  }
  EXPECT_TRUE(page.ask(to_take()).ok());  // the values have been logged
  EXPECT_EQ(logged("refused"), 0U);
  ASSERT_EQ(logged("set"), 1U);
  EXPECT_EQ(log().back()["text"], "force.stiffness_n_per_mm = 0.8");
}

TEST_F(CockpitTest, NoPageLearnsAnothersSecretAndAllTextIsValidUtf8) {
  Page first(port(), "", std::string("An\u202Ena"));
  Page second(port());
  first.set("description", "'''two\nlines'''");
  first.ask(to_stop());
  second.ask(to_take());
  std::string received;
  for (int i = 0; i < 20; ++i) received += second.client().receive().payload;
  EXPECT_THAT(received, Not(HasSubstr(first.welcome.secret())));
  EXPECT_THAT(log_text(), Not(HasSubstr(first.welcome.secret())));
  EXPECT_THAT(log_text(), Not(HasSubstr(second.welcome.secret())));
  cockpit_->notify("fault", "a device named \xFF\xFE", true);
  EXPECT_EQ(first.notice("fault").text(), "a device named \xEF\xBF\xBD\xEF\xBF\xBD");
}

TEST_F(CockpitTest, TheNewestNoticesAreKeptShortForPagesThatConnect) {
  Page page(port());
  for (int i = 0; i < 10; ++i)
    page.set("description", "'" + std::string(4000, 'x') + std::to_string(i) + "'");
  cockpit_->notify("fault", std::string(3'000'000, 'y'), true);
  page.notice("fault");
  Page later(port());
  EXPECT_EQ(later.welcome.past_size(), 12);
  EXPECT_LT(later.welcome.ByteSizeLong(), 200000U);
}

TEST_F(CockpitTest, APageThatSendsGarbageIsDisconnectedAndOthersAreNot) {
  Page page(port());
  PageClient garbage(port());
  garbage.send("\xFF\xFF\xFF no message");
  EXPECT_EQ(garbage.receive_until_closed().opcode, PageClient::kClose);
  PageClient early_page(port());
  wire::ToHost early;
  early.mutable_take();
  early_page.send(early.SerializeAsString());
  EXPECT_THAT(early_page.receive_until_closed().reason(), HasSubstr("hello"));
  PageClient bad_text(port());
  bad_text.send(std::string("\x12\x03\x12\x01\xFF", 5));  // a hello whose secret is no UTF-8
  EXPECT_EQ(bad_text.receive_until_closed().opcode, PageClient::kClose);
  EXPECT_TRUE(page.ask(to_take()).ok());
  wire::ToHost nothing;
  EXPECT_FALSE(page.ask(nothing).ok());
}

TEST_F(CockpitTest, APageWithoutHelloMayStopAndIsDisconnectedAfterItsTime) {
  Page page(port());
  PageClient silent(port());
  silent.send(to_stop().SerializeAsString());
  EXPECT_EQ(page.notice("stopped").who(), "page 2 (127.0.0.1)");
  EXPECT_TRUE(session_->held_stopped());
  skip(11.0);
  EXPECT_THAT(silent.receive_until_closed().reason(), HasSubstr("hello"));
  page.until([](const wire::State& s) { return s.pages() == 1; });
}

TEST_F(CockpitTest, APageOfAnotherProtocolIsRefusedWithAReasonAndMayStop) {
  for (const std::uint32_t protocol : {0U, Cockpit::kProtocol + 1}) {
    PageClient other(port());
    other.send(to_stop().SerializeAsString());
    wire::ToHost hello;
    hello.mutable_hello()->set_protocol(protocol);
    other.send(hello.SerializeAsString());
    wire::ToPage only;
    ASSERT_TRUE(only.ParseFromString(other.receive_message().payload));
    EXPECT_EQ(only.welcome().protocol(), Cockpit::kProtocol);
    EXPECT_EQ(only.welcome().version(), "1.2.3");
    EXPECT_EQ(only.welcome().secret(), "");
    EXPECT_THAT(other.receive_until_closed().reason(), HasSubstr("reload"));
  }
  EXPECT_TRUE(session_->held_stopped());
  EXPECT_EQ(logged("operator_taken"), 0U);
}

TEST_F(CockpitTest, AReportIsShownBesideItsOwnFaultOnly) {
  Page page(port());
  page.until([](const wire::State& s) { return s.safety() == wire::SAFETY_RUNNING; });
  const test::LoopWakesLate overload(0.0075);  // the period is 5 ms
  page.until([](const wire::State& s) { return s.has_fault(); });
  const double fault_time = page.state.fault().time();
  cockpit_->fault_reported("of_an_earlier_one.json", fault_time - 1.0);
  cockpit_->typed("mark", "");
  page.notice("mark");
  EXPECT_EQ(page.receive(wire::ToPage::kState).state().fault().report(), "");
  cockpit_->fault_reported("its_own.json", fault_time);
  page.until([](const wire::State& s) { return s.fault().report() == "its_own.json"; });
}

TEST_F(CockpitTest, AFullDiskIsNotifiedAndTheLogNamesTheMissingLines) {
  Page page(port());
  EXPECT_EQ(log().size(), 1U);
  {
    const FullDisk full;
    EXPECT_TRUE(page.ask(to_stop()).ok());
    EXPECT_EQ(page.notice("log_broken").level(), wire::Notice::WARNING);
  }
  EXPECT_TRUE(page.ask(to_resume(*session_)).ok());
  const auto lines = log();
  ASSERT_GE(lines.size(), 3U);
  EXPECT_EQ(lines[1]["code"], "log_gap");
  EXPECT_EQ(lines.back()["code"], "resumed");
  EXPECT_EQ(logged("stopped"), 0U);
}

TEST_F(CockpitTest, AChangeAtTheTerminalIsNotifiedAndLogged) {
  Page page(port());
  cockpit_->typed("set", "force.stiffness_n_per_mm=0.7");
  const wire::Notice told = page.notice("set");
  EXPECT_EQ(told.who(), "the terminal");
  EXPECT_EQ(told.level(), wire::Notice::CHANGE);
  EXPECT_EQ(logged("set"), 1U);
}

}  // namespace
}  // namespace phalanx

// SPDX-License-Identifier: Apache-2.0
// The patient's screen and the exercise that runs, at pages of the cockpit.
#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "phalanx/clinic/exercise_host.h"
#include "serve/cockpit_fixture.h"
#include "serve/people_registry.h"

namespace phalanx {
namespace {

using namespace test;
using nlohmann::json;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

using Stage = ExerciseStatus::Stage;

const std::string kScreenPassword = "a long password";

/// Host that keeps what it is asked for.
class KeptExercises final : public ExerciseHost {
 public:
  std::uint32_t begin(const Actor&, const ExerciseOrder&) override { return 1; }
  using ExerciseHost::input;
  void input(const ExerciseInput& input, const InputOrigin&) override {
    const std::lock_guard lock(mutex_);
    if (!refuses_.empty()) throw std::invalid_argument(refuses_);
    inputs_.push_back(exercise_input_text(input));
  }
  void reset() override {}
  void release_key(const std::string&) override {}
  [[nodiscard]] ExerciseStatus status() const override {
    const std::lock_guard lock(mutex_);
    return status_;
  }
  void set(const std::function<void(ExerciseStatus&)>& change) {
    const std::lock_guard lock(mutex_);
    change(status_);
  }
  void refuse(const std::string& why) {
    const std::lock_guard lock(mutex_);
    refuses_ = why;
  }
  [[nodiscard]] std::vector<std::string> inputs() const {
    const std::lock_guard lock(mutex_);
    return inputs_;
  }

 private:
  mutable std::mutex mutex_;
  ExerciseStatus status_;
  std::string refuses_;
  std::vector<std::string> inputs_;
};

wire::ToHost to_feel(wire::Feel::Kind kind, std::uint32_t value = 0) {
  wire::ToHost message;
  message.mutable_feel()->set_kind(kind);
  message.mutable_feel()->set_value(value);
  return message;
}

class PatientScreen : public CockpitTest {
 protected:
  PatientScreen() : PatientScreen(std::make_shared<KeptExercises>(), {}) {}
  PatientScreen(std::shared_ptr<KeptExercises> host,
                const std::function<std::shared_ptr<Registry>(const std::filesystem::path&)>& registry)
      : CockpitTest(false, "sliders", registry, host), exercises(std::move(host)) {}

  [[nodiscard]] Page screen(const std::string& secret = "", const std::string& path = "/") const {
    return Page(port(), secret, "", path, true);
  }
  void run(const std::function<void(ExerciseStatus&)>& change = {}) const {
    exercises->set([&](ExerciseStatus& status) {
      status.stage = Stage::kRunning;
      status.number = 1;
      status.view.phase = ExercisePhase::kTrial;
      if (change) change(status);
    });
  }
  static wire::Exercise next_exercise(Page& page, const std::function<bool(const wire::Exercise&)>& so) {
    return page.receive([&](const wire::ToPage& m) { return m.has_exercise() && so(m.exercise()); })
        .exercise();
  }

  const std::shared_ptr<KeptExercises> exercises;
};

TEST_F(PatientScreen, NeverOperatesAndCanOnlyStopAndReport) {
  Page patient = screen();
  EXPECT_EQ(patient.state.operator_page(), 0U) << "the first page";
  EXPECT_FALSE(patient.welcome.may_operate());
  wire::ToHost resume;
  resume.mutable_resume()->set_stops(0);
  wire::ToHost scene;
  scene.mutable_scene()->set_name("pinch_ball");
  wire::ToHost reset;
  reset.mutable_reset();
  wire::ToHost sliders;
  for (int j = 0; j < kJoints; ++j) sliders.mutable_sliders()->add_angle(0.1F);
  wire::ToHost release;
  release.mutable_release();
  for (const wire::ToHost& message : {to_take(), to_be_named("A"), resume, scene, reset, sliders, release}) {
    const wire::Reply reply = patient.ask(message);
    EXPECT_FALSE(reply.ok()) << message.ShortDebugString();
    EXPECT_THAT(reply.error(), HasSubstr("the patient's screen")) << message.ShortDebugString();
  }
  EXPECT_FALSE(patient.set("force.stiffness_n_per_mm", "0.1").ok());
  const std::string from = "X-Phalanx-Page: " + patient.welcome.secret() + "\r\n";
  EXPECT_EQ(status_of(post("/marker", "x", from)), 403);
  EXPECT_EQ(status_of(post("/mesh?name=a.stl", "x", from)) / 100, 4);
  EXPECT_TRUE(patient.ask(to_stop()).ok());
  EXPECT_TRUE(session_->held_stopped());
  Page cockpit(port());
  EXPECT_EQ(cockpit.state.operator_page(), cockpit.welcome.page());
  EXPECT_TRUE(cockpit.ask(to_resume(*session_)).ok());
  EXPECT_FALSE(session_->held_stopped());
}

TEST_F(PatientScreen, WithAnOperatorsSecretDoesNotOperateEither) {
  Page cockpit(port());
  ASSERT_EQ(cockpit.state.operator_page(), cockpit.welcome.page());
  Page patient = screen(cockpit.welcome.secret());
  EXPECT_EQ(patient.welcome.page(), cockpit.welcome.page());
  EXPECT_EQ(patient.state.operator_page(), 0U);
  EXPECT_FALSE(patient.set("force.stiffness_n_per_mm", "0.1").ok());
}

TEST_F(PatientScreen, GetsNeitherSceneNorSettingsNorNotices) {
  Page cockpit(port());
  Page patient = screen();
  EXPECT_EQ(cockpit.state.scene(), "first_touch");
  EXPECT_GT(cockpit.welcome.key_size(), 0);
  EXPECT_EQ(patient.state.scene(), "");
  EXPECT_EQ(patient.state.value_size(), 0);
  EXPECT_EQ(patient.state.geometry(), 0U);
  EXPECT_EQ(patient.welcome.key_size() + patient.welcome.past_size() + patient.welcome.viewer_url_size(), 0);
  EXPECT_TRUE(cockpit.set("force.stiffness_n_per_mm", "0.75").ok());
  cockpit.notice("set");
  EXPECT_TRUE(cockpit.ask(to_stop()).ok());
  patient.receive([](const wire::ToPage& message) {
    EXPECT_FALSE(message.has_notice()) << message.ShortDebugString();
    EXPECT_EQ(message.state().value_size(), 0);
    return message.has_state() && message.state().held_stopped();
  });
}

TEST_F(PatientScreen, NoPageSeesAHiddenScene) {
  run([](ExerciseStatus& status) { status.view.hides_scene = true; });
  Page cockpit(port());  // its frames read the status first
  next_exercise(cockpit, [](const wire::Exercise& exercise) { return exercise.hides_scene(); });
  Page patient = screen();
  for (int i = 0; i < 20; ++i) {
    const wire::Exercise seen = next_exercise(patient, [](const wire::Exercise&) { return true; });
    EXPECT_EQ(seen.force_size() + seen.flexion_size(), 0);
  }
  EXPECT_EQ(patient.ticks, 0);
  const wire::State hidden =
      cockpit
          .receive([](const wire::ToPage& message) {
            const auto& values = message.state().value();
            return message.has_state() && std::none_of(values.begin(), values.end(), [](const auto& setting) {
                     return setting.key().starts_with("force.") || setting.key().starts_with("objects");
                   });
          })
          .state();
  EXPECT_GT(hidden.value_size(), 0);
  const std::string geometry = "/geometry/" + std::to_string(hidden.geometry());
  EXPECT_EQ(status_of(ask(port(), get(geometry))), 404);
  run([](ExerciseStatus& status) { status.view.hides_scene = false; });
  EXPECT_GT(cockpit.receive(wire::ToPage::kTick).tick().time(), 0.0);
  EXPECT_EQ(status_of(ask(port(), get(geometry))), 200);
  EXPECT_GT(patient.receive(wire::ToPage::kTick).tick().time(), 0.0);
}

TEST_F(PatientScreen, PauseStopsTheTorqueBeforeAnythingElseAndRatingsReachTheExercise) {
  run();
  Page patient = screen();
  EXPECT_TRUE(patient.ask(to_feel(wire::Feel::PAIN, 0)).ok());
  EXPECT_TRUE(patient.ask(to_feel(wire::Feel::TIRED, 10)).ok());
  EXPECT_EQ(session_->stops(), 0U);
  EXPECT_TRUE(patient.ask(to_feel(wire::Feel::PAUSE)).ok());
  EXPECT_EQ(session_->stops(), 1U);
  EXPECT_TRUE(session_->held_stopped());
  EXPECT_THAT(exercises->inputs(), ElementsAre("pain 0", "fatigue 10", "pause"));
  const wire::Reply reply = patient.ask(to_feel(wire::Feel::PAIN, 11));
  EXPECT_FALSE(reply.ok());
  EXPECT_EQ(reply.error(), "pain 11: a rating is 0 to 10");
  exercises->refuse("no exercise runs");
  EXPECT_EQ(patient.ask(to_feel(wire::Feel::PAUSE)).error(), "no exercise runs");
  EXPECT_EQ(session_->stops(), 2U) << "the torque is stopped all the same";
  EXPECT_EQ(exercises->inputs().size(), 3U);
  for (const auto& line : log()) EXPECT_THAT(line.dump(), ::testing::Not(HasSubstr("pain")));
}

TEST_F(PatientScreen, APageThatMayOperateReportsToo) {
  run();
  Page cockpit(port());
  EXPECT_TRUE(cockpit.ask(to_feel(wire::Feel::PAIN, 4)).ok());
  EXPECT_THAT(exercises->inputs(), ElementsAre("pain 4"));
}

TEST_F(PatientScreen, AViewerSeesNoSettingsWhileAnExerciseRuns) {
  serve("operators-own-token", "viewers-own-token");
  Page viewer(port(), "", "", "/?token=viewers-own-token");
  EXPECT_GT(viewer.state.value_size(), 0);
  run();
  Page late(port(), "", "", "/?token=viewers-own-token");
  EXPECT_EQ(late.state.value_size() + static_cast<int>(late.state.scene().size()), 0);
  viewer.receive([](const wire::ToPage& m) { return m.has_state() && m.state().value_size() == 0; });
  Page operating(port(), "", "", "/?token=operators-own-token");
  EXPECT_GT(operating.state.value_size(), 0);
}

TEST_F(PatientScreen, AViewerOnlyStops) {
  serve("operators-own-token", "viewers-own-token");
  run();
  Page viewer(port(), "", "", "/?token=viewers-own-token");
  EXPECT_FALSE(viewer.ask(to_feel(wire::Feel::PAIN, 4)).ok());
  EXPECT_FALSE(viewer.ask(to_feel(wire::Feel::PAUSE)).ok());
  EXPECT_TRUE(session_->held_stopped());
  EXPECT_THAT(exercises->inputs(), IsEmpty());
  Page patient = screen("", "/?token=operators-own-token");
  EXPECT_TRUE(patient.ask(to_feel(wire::Feel::PAIN, 4)).ok());
}

TEST_F(PatientScreen, APageIsSentThePresentExerciseAndEachChange) {
  Page early = screen();
  EXPECT_EQ(early.receive(wire::ToPage::kExercise).exercise().number(), 0U);
  run([](ExerciseStatus& status) {
    status.stage = Stage::kOpening;
    status.symbol = "otter";
    status.view.phase = ExercisePhase::kReady;
  });
  EXPECT_EQ(
      next_exercise(early, [](const auto& e) { return e.stage() == wire::Exercise::STAGE_OPENING; }).symbol(),
      "otter");
  run([](ExerciseStatus& status) { status.view.progress = 0.25; });
  next_exercise(early, [](const auto& e) { return e.phase() == wire::Exercise::PHASE_TRIAL; });
  run([](ExerciseStatus& status) { status.view.progress = 0.75; });
  next_exercise(early, [](const auto& e) { return e.progress() == 0.75F; });
  exercises->set([](ExerciseStatus& status) {
    status.stage = Stage::kEnded;
    status.trouble = "P07: the disk is full";
    status.trouble_without_code = "the disk is full";
  });
  EXPECT_EQ(
      next_exercise(early, [](const auto& e) { return e.stage() == wire::Exercise::STAGE_ENDED; }).trouble(),
      "the disk is full");
  Page late(port());
  EXPECT_EQ(late.receive(wire::ToPage::kExercise).exercise().stage(), wire::Exercise::STAGE_ENDED);
}

TEST_F(PatientScreen, AnExerciseHasTheStationUntilItEnds) {
  Page cockpit(port());
  wire::ToHost scene;
  scene.mutable_scene()->set_name("pinch_ball");
  wire::ToHost source;
  source.mutable_source()->set_source(wire::HAND_PATIENT);
  wire::ToHost calibrate;
  calibrate.mutable_calibrate()->set_step(wire::Calibrate::BEGIN);
  wire::ToHost sliders;
  for (int j = 0; j < kJoints; ++j) sliders.mutable_sliders()->add_angle(0.1F);
  for (const Stage stage : {Stage::kOpening, Stage::kRunning, Stage::kClosing}) {
    run([&](ExerciseStatus& status) { status.stage = stage; });
    for (const wire::ToHost& message : {scene, source, calibrate})
      EXPECT_EQ(cockpit.ask(message).error(), "an exercise runs; end it first");
    EXPECT_EQ(cockpit.set("force.stiffness_n_per_mm", "0.1").error(), "an exercise runs; end it first");
    EXPECT_TRUE(cockpit.ask(to_stop()).ok());
    EXPECT_THAT(cockpit.ask(to_resume(*session_)).error(), HasSubstr("an exercise runs"));
    EXPECT_TRUE(session_->held_stopped());
  }
  run([](ExerciseStatus& status) { status.simulated = true; });
  EXPECT_TRUE(cockpit.ask(sliders).ok()) << "they are the participant's hand";
  run([](ExerciseStatus& status) { status.demo = true; });
  EXPECT_FALSE(cockpit.ask(sliders).ok()) << "a simulated participant moves the hand";
  exercises->set([](ExerciseStatus& status) { status.stage = Stage::kEnded; });
  EXPECT_TRUE(cockpit.ask(to_resume(*session_)).ok());
  EXPECT_TRUE(cockpit.set("force.stiffness_n_per_mm", "0.6").ok());
  EXPECT_TRUE(cockpit.ask(sliders).ok());
}

/// A station with accounts.
class PatientScreenAccounts : public PatientScreen {
 protected:
  PatientScreenAccounts()
      : PatientScreen(std::make_shared<KeptExercises>(), [](const std::filesystem::path& folder) {
          const auto registry = make_registry(folder, std::make_shared<RegistryClocks>());
          const Actor chief{.account = "chief", .role = Role::kAdministrator};
          registry->add_account(Actor::owner(), {.name = "chief", .role = Role::kAdministrator},
                                kScreenPassword);
          registry->add_account(chief, {.name = "screen1", .role = Role::kPatientScreen}, kScreenPassword);
          registry->add_account(chief, {.name = "looker", .role = Role::kLookOn}, kScreenPassword);
          return registry;
        }) {}

  /// Waits until so many notices of accounts are in the log.
  [[nodiscard]] bool until_logged(std::size_t count) const {
    for (int i = 0; i < 1000; ++i)
      if (logged("account") >= count) return true;
    return false;
  }
  /// @returns the response. @param fields  of the request, with their line ends
  std::string sign_in(const std::string& account, const std::string& fields = "") const {
    return post("/people/sign_in", json({{"account", account}, {"password", kScreenPassword}}).dump(),
                fields);
  }
};

TEST_F(PatientScreenAccounts, ReportsOnceAnAccountHasSignedInAndStopsAlways) {
  run();
  Page patient = screen();
  const wire::Reply refused = patient.ask(to_feel(wire::Feel::PAIN, 2));
  EXPECT_THAT(refused.error(), HasSubstr("sign in at this screen first"));
  EXPECT_THAT(patient.ask(to_feel(wire::Feel::PAUSE)).error(), HasSubstr("sign in"));
  EXPECT_TRUE(session_->held_stopped()) << "the torque is stopped all the same";
  EXPECT_TRUE(session_->resume());
  EXPECT_TRUE(patient.ask(to_stop()).ok());
  EXPECT_TRUE(session_->held_stopped());
  EXPECT_THAT(exercises->inputs(), IsEmpty());

  const std::string from = "X-Phalanx-Page: " + patient.welcome.secret() + "\r\n";
  EXPECT_EQ(status_of(sign_in("looker", from)), 403);
  const std::string answer = sign_in("screen1", from);
  ASSERT_EQ(status_of(answer), 200) << answer;
  const json session = json::parse(body_of(answer));
  EXPECT_EQ(session.at("role"), "patient_screen");
  ASSERT_TRUE(until_logged(1)) << "it signed in";
  EXPECT_TRUE(patient.ask(to_feel(wire::Feel::PAIN, 2)).ok());
  EXPECT_TRUE(patient.ask(to_feel(wire::Feel::PAUSE)).ok());
  EXPECT_THAT(exercises->inputs(), ElementsAre("pain 2", "pause"));

  const std::string mine = from + "X-Phalanx-Session: " + session.at("session").get<std::string>() + "\r\n";
  EXPECT_EQ(status_of(post("/people/lock", "{}", mine)), 200);
  ASSERT_TRUE(until_logged(2)) << "it signed in and out";
  EXPECT_THAT(patient.ask(to_feel(wire::Feel::PAIN, 2)).error(), HasSubstr("sign in"));
}

TEST_F(PatientScreenAccounts, TheRoleOfAScreenSeesNothingBelowPeople) {
  const json session = json::parse(body_of(sign_in("screen1")));
  const std::string mine = "X-Phalanx-Session: " + session.at("session").get<std::string>() + "\r\n";
  const std::string patient = "/people/patients/" + std::string(32, 'a');
  for (const std::string& path :
       {std::string("/people/patients"), std::string("/people/exercises"), std::string("/people/exercise"),
        std::string("/people/templates"), std::string("/people/nothing"), patient, patient + "/course",
        patient + "/export", patient + "/report", patient + "/fhir"})
    EXPECT_EQ(status_of(ask(port(), get(path, mine))), 403) << path;
  for (const std::string& path :
       {std::string("/people/patients"), std::string("/people/exercise"), patient, patient + "/exercise",
        patient + "/tests", patient + "/notes", patient + "/delete"})
    EXPECT_EQ(status_of(post(path, "{}", mine)), 403) << path;
  EXPECT_EQ(status_of(ask(port(), get("/people", mine))), 200);
  EXPECT_EQ(status_of(post("/people/alive", "{}", mine)), 200);
  EXPECT_EQ(status_of(post("/people/sign_out", "{}", mine)), 200);
  EXPECT_EQ(status_of(ask(port(), get("/people/patients", mine))), 401) << "signed out";
}

}  // namespace
}  // namespace phalanx

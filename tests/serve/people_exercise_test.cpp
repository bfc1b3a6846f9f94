// SPDX-License-Identifier: Apache-2.0
// The addresses of the exercise below /people: who may begin one, what is sent, and what stops at once.
#include "serve/people_exercise.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <future>
#include <memory>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "record/temporary_folder.h"
#include "registry/private_file.h"
#include "serve/people.h"
#include "serve/people_registry.h"

namespace phalanx {
namespace {

using nlohmann::json;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

using Kind = ExerciseInput::Kind;

/// Host that keeps what it is asked for.
class AskedHost final : public ExerciseHost {
 public:
  std::uint32_t begin(const Actor& actor, const ExerciseOrder& order) override {
    if (!refusal.empty()) throw std::runtime_error(refusal);
    account = actor.account;
    orders.push_back(order);
    return 3;
  }
  using ExerciseHost::input;
  void input(const ExerciseInput& input, const InputOrigin& origin) override {
    const std::lock_guard lock(mutex_);
    if (origin.stops && *origin.stops != now.stops) throw std::runtime_error("another stop has come since");
    inputs_.push_back(input);
    by = origin.account;
  }
  void reset() override { ++resets; }
  void release_key(const std::string& record) override {
    if (!refusal.empty()) throw std::runtime_error(refusal);
    released.push_back(record);
    had_key = keys && keys(record).has_value();
  }
  [[nodiscard]] ExerciseStatus status() const override { return now; }

  [[nodiscard]] std::vector<ExerciseInput> inputs() const {
    const std::lock_guard lock(mutex_);
    return inputs_;
  }

  std::string refusal;
  std::string account;
  std::string by;  // of the newest input
  std::vector<ExerciseOrder> orders;
  int resets = 0;
  std::vector<std::string> released;
  FindRecordingKey keys;
  bool had_key = false;  // when release_key() was called
  ExerciseStatus now = {.number = 3};

 private:
  mutable std::mutex mutex_;
  std::vector<ExerciseInput> inputs_;
};

struct HostAnswer {
  int status = 0;
  std::string text;
};

class PeopleExercise : public ::testing::Test {
 protected:
  ~PeopleExercise() override { EXPECT_TRUE(people_->finish(std::chrono::minutes(5))); }

  std::future<HostAnswer> begin_sending(const std::string& method, const std::string& path,
                                        const std::string& session, const json& body = {}) {
    WebRequest request;
    request.method = method;
    request.path = path;
    request.session = session;
    request.client = {.address = "127.0.0.1", .may_operate = true};
    if (method == "POST") request.body = body.dump();
    auto promise = std::make_shared<std::promise<HostAnswer>>();
    std::future<HostAnswer> future = promise->get_future();
    people_->request(request, [promise](const WebResponse& response) {
      promise->set_value({.status = response.status, .text = response.body ? *response.body : ""});
    });
    return future;
  }
  HostAnswer send(const std::string& method, const std::string& path, const std::string& session,
                  const json& body = {}) {
    return begin_sending(method, path, session, body).get();
  }
  std::string owner() {
    return json::parse(send("POST", "/people/sign_in", "", {{"account", ""}, {"password", ""}}).text)
        .at("session")
        .get<std::string>();
  }
  HostAnswer input(json body) {
    if (!body.contains("number")) body["number"] = 3;
    return send("POST", "/people/exercise", session_, body);
  }

  const testing::TemporaryFolder folder_;
  const std::shared_ptr<test::RegistryClocks> clocks_ = std::make_shared<test::RegistryClocks>();
  const std::shared_ptr<Registry> registry_ = test::make_registry(folder_.path(), clocks_);
  const std::shared_ptr<AskedHost> host_ = std::make_shared<AskedHost>();
  const std::shared_ptr<People> people_ = std::make_shared<People>(
      registry_, people::ListExercises(), [clocks = clocks_] { return clocks->utc.load(); }, host_);
  const std::string record_ = registry_->add_patient(Actor::owner(), test::ready_patient("SIM1")).record;
  const std::string session_ = owner();
  const bool has_keys_ = (host_->keys = registry_->keys().finder(), true);
};

TEST_F(PeopleExercise, ABeginHasTheFieldsOfItsBodyAndTheAccount) {
  const std::string path = "/people/patients/" + record_ + "/exercise";
  const HostAnswer begun =
      send("POST", path, session_,
           {{"exercise", "wave_slowly"}, {"confirm", "SIM1"}, {"demo", "healthy"}, {"seed", 7}});
  EXPECT_EQ(begun.status, 200) << begun.text;
  EXPECT_EQ(json::parse(begun.text), json({{"number", 3}}));
  ASSERT_EQ(host_->orders.size(), 1U);
  EXPECT_EQ(host_->account, "owner");
  EXPECT_EQ(host_->orders[0].record, record_);
  EXPECT_EQ(host_->orders[0].exercise, "wave_slowly");
  EXPECT_EQ(host_->orders[0].confirm, "SIM1");
  EXPECT_EQ(host_->orders[0].demo, "healthy");
  EXPECT_EQ(host_->orders[0].seed, 7U);
  EXPECT_EQ(send("GET", path, session_).status, 405);
  EXPECT_EQ(send("POST", path, session_, {{"exercise", "a"}, {"seed", -1}}).status, 400);
  host_->refusal = "another exercise runs; end it first";
  const HostAnswer refused = send("POST", path, session_, {{"exercise", "a"}, {"confirm", "SIM1"}});
  EXPECT_EQ(refused.status, 409);
  EXPECT_THAT(refused.text, HasSubstr("another exercise runs"));
}

TEST_F(PeopleExercise, WithoutASessionNothingIsToldBegunOrEntered) {
  EXPECT_EQ(send("GET", "/people/exercise", "").status, 401);
  EXPECT_EQ(send("POST", "/people/exercise", "", {{"kind", "resume"}}).status, 401);
  EXPECT_EQ(send("POST", "/people/patients/" + record_ + "/exercise", "", {{"exercise", "a"}}).status, 401);
  EXPECT_THAT(host_->inputs(), IsEmpty());
  EXPECT_THAT(host_->orders, IsEmpty());
}

TEST_F(PeopleExercise, APauseStopsBeforeTheRequestWaitsForAnythingAndWithoutASession) {
  EXPECT_EQ(send("POST", "/people/exercise", "", {{"kind", "pause"}}).status, 401);
  ASSERT_EQ(host_->inputs().size(), 1U) << "a stop needs no sign-in";
  EXPECT_EQ(host_->inputs()[0].kind, Kind::kPause);
  EXPECT_EQ(input({{"kind", "abort"}}).status, 200);
  EXPECT_EQ(host_->inputs()[1].kind, Kind::kPause);
  EXPECT_EQ(host_->inputs()[2].kind, Kind::kAbort);
  EXPECT_EQ(input({{"kind", "pain"}, {"value", 9}}).status, 200);
  EXPECT_EQ(host_->inputs()[3].kind, Kind::kPause);
  host_->now.view.phase = ExercisePhase::kRating;
  EXPECT_EQ(input({{"kind", "pain"}, {"value", 9}}).status, 200);
  ASSERT_EQ(host_->inputs().size(), 6U);
  EXPECT_EQ(host_->inputs()[5].kind, Kind::kPain) << "without torque there is nothing to pause";
}

TEST_F(PeopleExercise, AnInputHasItsValueAndWrongOnesAreRefusedInWords) {
  EXPECT_EQ(input({{"kind", "begin"}}).status, 200);
  EXPECT_EQ(input({{"kind", "answer"}, {"value", 2}}).status, 200);
  EXPECT_EQ(input({{"kind", "difficulty"}, {"value", 0.25}}).status, 200);
  EXPECT_EQ(input({{"kind", "reset"}}).status, 200);
  EXPECT_THAT(host_->inputs(), ElementsAre(ExerciseInput{.kind = Kind::kBegin, .value = 0.0},
                                           ExerciseInput{.kind = Kind::kAnswer, .value = 2.0},
                                           ExerciseInput{.kind = Kind::kDifficulty, .value = 0.25}));
  EXPECT_EQ(host_->resets, 1);
  for (const json& wrong : {json{{"kind", "sing"}}, json{{"kind", "pain"}},
                            json{{"kind", "pain"}, {"value", 2.5}}, json{{"kind", "pain"}, {"value", -1}},
                            json{{"kind", "pause"}, {"value", 1}}, json{{"kind", "answer"}, {"value", "2"}}})
    EXPECT_EQ(input(wrong).status, 400) << wrong.dump();
}

TEST_F(PeopleExercise, AResumeStatesTheStopsThatItsPersonHasSeenAndEndsNoLaterStop) {
  host_->now.stops = 5;
  EXPECT_EQ(input({{"kind", "resume"}, {"stops", 4}}).status, 409);
  EXPECT_EQ(input({{"kind", "resume"}}).status, 400);
  EXPECT_THAT(host_->inputs(), IsEmpty());
  EXPECT_EQ(input({{"kind", "resume"}, {"stops", 5}}).status, 200);
  EXPECT_EQ(host_->inputs().size(), 1U);
  EXPECT_EQ(host_->by, "owner");
}

TEST_F(PeopleExercise, AnInputForAnotherExerciseIsRefusedAndItsPauseStopsAllTheSame) {
  const auto send_it = [&](const json& body) { return send("POST", "/people/exercise", session_, body); };
  EXPECT_EQ(send_it({{"kind", "begin"}}).status, 400);
  EXPECT_EQ(send_it({{"kind", "begin"}, {"number", 2}}).status, 409);
  EXPECT_EQ(send_it({{"kind", "reset"}, {"number", 2}}).status, 409);
  EXPECT_EQ(send_it({{"kind", "reset"}}).status, 400);
  EXPECT_THAT(host_->inputs(), IsEmpty());
  EXPECT_EQ(host_->resets, 0);
  EXPECT_EQ(send_it({{"kind", "abort"}, {"number", 2}}).status, 409);
  EXPECT_THAT(host_->inputs(), ElementsAre(ExerciseInput{.kind = Kind::kPause, .value = 0.0}));
}

TEST_F(PeopleExercise, APatientIsNotDeletedWhileTheirExerciseRuns) {
  const std::string path = "/people/patients/" + record_ + "/delete";
  host_->refusal = "an exercise of this patient runs; end it first";
  const HostAnswer refused = send("POST", path, session_, {{"confirm", "SIM1"}});
  EXPECT_EQ(refused.status, 409);
  EXPECT_THAT(refused.text, HasSubstr("end it first"));
  EXPECT_EQ(registry_->patient(Actor::owner(), record_).code, "SIM1");
  host_->refusal.clear();
  EXPECT_EQ(send("POST", path, session_, {{"confirm", "SIM2"}}).status, 400);
  EXPECT_THAT(host_->released, IsEmpty()) << "another code leaves the station as it is";
  EXPECT_EQ(send("POST", path, session_, {{"confirm", "SIM1"}}).status, 200);
  EXPECT_THAT(host_->released, ElementsAre(record_));
  EXPECT_TRUE(host_->had_key) << "the station lets go before the key is erased";
}

TEST_F(PeopleExercise, APatientWithWhoseKeyAnotherStationRecordsIsNotDeleted) {
  const std::string path = "/people/patients/" + record_ + "/delete";
  {
    const auto use = registry_->use_key(Actor::owner(), record_);
    const HostAnswer refused = send("POST", path, session_, {{"confirm", "SIM1"}});
    EXPECT_EQ(refused.status, 409);
    EXPECT_THAT(refused.text, AllOf(HasSubstr("records with the key of this patient"), HasSubstr("process"),
                                    HasSubstr("end that program and delete again")));
  }
  EXPECT_EQ(send("POST", path, session_, {{"confirm", "SIM1"}}).status, 200);
}

TEST_F(PeopleExercise, ARegistryThatAnotherProgramHoldsIsNamedAndDelaysNoStop) {
  host_->now.stage = ExerciseStatus::Stage::kRunning;
  std::optional<registry::FileLock> held(folder_.path() / "data/lock");
  std::future<HostAnswer> list = begin_sending("GET", "/people/patients", session_);
  // The thread of the patients waits for the registry: the clock stands still while this thread works.
  std::future<HostAnswer> pause =
      begin_sending("POST", "/people/exercise", session_, {{"kind", "pause"}, {"number", 3}});
  EXPECT_THAT(host_->inputs(), ElementsAre(ExerciseInput{.kind = Kind::kPause, .value = 0.0}))
      << "before the request comes to its turn";
  const HostAnswer refused = list.get();
  EXPECT_EQ(refused.status, 503);
  EXPECT_THAT(refused.text, AllOf(HasSubstr("process"), HasSubstr("has held"),
                                  HasSubstr("wait until it is done, or end it, then try again")));
  EXPECT_EQ(pause.get().status, 200);
  held.reset();
  EXPECT_EQ(send("GET", "/people/patients", session_).status, 200);
}

TEST_F(PeopleExercise, TheStateHasAllFieldsAndHidesForcesWithTheScene) {
  EXPECT_EQ(json::parse(send("GET", "/people/exercise", session_).text).at("stage"), "none");
  ExerciseStatus& now = host_->now;
  now.stage = ExerciseStatus::Stage::kRunning;
  now.number = 2;
  now.code = "SIM1";
  now.exercise.name = "press_and_hold";
  now.exercise.measure = ExerciseMeasure::kPressAndHold;
  now.view.phase = ExercisePhase::kTrial;
  now.view.target.kind = ExerciseTarget::Kind::kForce;
  now.view.target.digits = {false, true, false, false, false};
  now.view.target.low = 1.5;
  now.view.target.high = 2.5;
  now.view.value = 1.25;
  now.view.asks = Kind::kPain;
  now.newest = Observation{};
  now.newest->force = {0.0, 1.25, 0.0, 0.0, 0.0};
  const json shown = json::parse(send("GET", "/people/exercise", session_).text);
  EXPECT_EQ(shown.at("stage"), "running");
  EXPECT_EQ(shown.at("phase"), "trial");
  EXPECT_EQ(shown.at("measure"), "press_and_hold");
  EXPECT_EQ(shown.at("target").at("kind"), "force");
  EXPECT_EQ(shown.at("target").at("digits"), json::array({"index"}));
  EXPECT_EQ(shown.at("target").at("high"), 2.5);
  EXPECT_EQ(shown.at("value"), 1.25);
  EXPECT_EQ(shown.at("asks"), "pain");
  EXPECT_EQ(shown.at("force").at(1), 1.25);
  EXPECT_TRUE(shown.at("result").is_null());
  now.view.hides_scene = true;
  now.view.value.reset();
  now.result.emplace();
  now.result->scores = {
      {.name = "a_n", .unit = "N", .value = 0.0, .origin = ScoreOrigin::kMeasured, .invalid = "no"}};
  const json hidden = json::parse(send("GET", "/people/exercise", session_).text);
  EXPECT_EQ(hidden.at("force"), json::array());
  EXPECT_TRUE(hidden.at("value").is_null());
  EXPECT_TRUE(hidden.at("result").at("scores").at(0).at("value").is_null());
  EXPECT_EQ(hidden.at("result").at("scores").at(0).at("invalid"), "no");
}

TEST_F(PeopleExercise, ALockedSessionWatchesTheExerciseWithoutItsPatientAndMayPauseAndRateIt) {
  registry_->add_account(Actor::owner(), {.name = "chief", .role = Role::kAdministrator}, "a long password");
  const std::string session =
      json::parse(
          send("POST", "/people/sign_in", "", {{"account", "chief"}, {"password", "a long password"}}).text)
          .at("session")
          .get<std::string>();
  ExerciseStatus& now = host_->now;
  now.stage = ExerciseStatus::Stage::kRunning;
  now.record = record_;
  now.code = "SIM1";
  now.symbol = "kite";
  now.side = "right";
  now.recording = "recording-of-SIM1.mcap";
  now.trouble = "SIM1: the disk is full";
  now.trouble_without_code = "the patient: the disk is full";
  now.exercise.name = "press_and_hold";
  now.view.phase = ExercisePhase::kTrial;
  now.view.trial = 2;
  now.result.emplace();
  now.fault = Fault::kDeviceLost;
  const std::string path = "/people/exercise/watched";
  EXPECT_EQ(send("GET", path, "").status, 401) << "only with a session";
  EXPECT_EQ(send("POST", "/people/lock", session, json::object()).status, 200);
  EXPECT_EQ(send("GET", "/people/exercise", session).status, 401);
  const HostAnswer watched = send("GET", path, session);
  ASSERT_EQ(watched.status, 200) << watched.text;
  const json shown = json::parse(watched.text);
  EXPECT_EQ(shown.at("phase"), "trial");
  EXPECT_EQ(shown.at("trial"), 2);
  EXPECT_EQ(shown.at("trouble"), "the patient: the disk is full");
  EXPECT_EQ(shown.at("fault").at("name"), "device_lost");
  EXPECT_EQ(shown.at("fault").at("meaning"), fault_meaning(Fault::kDeviceLost));
  EXPECT_EQ(shown.at("fault").at("remedy"), fault_remedy(Fault::kDeviceLost));
  for (const std::string& hidden : {std::string("SIM1"), record_, std::string("kite"), std::string("right")})
    EXPECT_EQ(watched.text.find(hidden), std::string::npos) << hidden;
  EXPECT_FALSE(shown.contains("result"));
  for (const std::string kind : {"begin", "resume", "skip", "answer", "difficulty", "reset"})
    EXPECT_EQ(send("POST", path, session, {{"kind", kind}, {"value", 1}, {"number", 3}, {"stops", 0}}).status,
              401)
        << kind;
  EXPECT_THAT(host_->inputs(), IsEmpty());
  EXPECT_EQ(send("POST", path, session, {{"kind", "abort"}, {"number", 3}}).status, 401);
  EXPECT_THAT(host_->inputs(), ElementsAre(testing::Field(&ExerciseInput::kind, Kind::kPause)))
      << "an end stops the torque at once, and ends nothing";
  EXPECT_EQ(send("POST", path, session, {{"kind", "pause"}, {"number", 3}}).status, 200);
  EXPECT_EQ(send("POST", path, session, {{"kind", "pain"}, {"value", 2}, {"number", 3}}).status, 200);
  EXPECT_EQ(host_->inputs().back().kind, Kind::kPain);
  EXPECT_EQ(host_->by, "chief");
  EXPECT_EQ(send("POST", path, session, {{"kind", "pain"}, {"value", 2}, {"number", 2}}).status, 409);
  EXPECT_EQ(send("GET", "/people/exercise", session).status, 401) << "it is still locked";
  EXPECT_EQ(send("POST", "/people/sign_out", session, json::object()).status, 200);
  EXPECT_EQ(send("GET", path, session).status, 401);
}

TEST_F(PeopleExercise, AStationThatCarriesOutNoneSaysSo) {
  EXPECT_EQ(json::parse(send("GET", "/people", "").text).at("exercises"), true);
  const auto without = std::make_shared<People>(registry_);
  std::promise<HostAnswer> promise;
  WebRequest request;
  request.method = "GET";
  request.path = "/people";
  request.client = {.address = "127.0.0.1", .may_operate = true};
  without->request(request, [&promise](const WebResponse& response) {
    promise.set_value({.status = response.status, .text = *response.body});
  });
  EXPECT_EQ(json::parse(promise.get_future().get().text).at("exercises"), false);
  EXPECT_TRUE(without->finish(std::chrono::minutes(5)));
}

TEST_F(PeopleExercise, ThePollingOfAPageKeepsNoSessionUnlocked) {
  registry_->add_account(Actor::owner(), {.name = "chief", .role = Role::kAdministrator}, "a long password");
  const std::string session =
      json::parse(
          send("POST", "/people/sign_in", "", {{"account", "chief"}, {"password", "a long password"}}).text)
          .at("session")
          .get<std::string>();
  EXPECT_EQ(send("GET", "/people/exercise", session).status, 200);
  clocks_->steady = clocks_->steady + 0.6 * test::kRegistryIdle;
  EXPECT_EQ(send("GET", "/people/exercise", session).status, 200);
  clocks_->steady = clocks_->steady + 0.6 * test::kRegistryIdle;
  EXPECT_EQ(send("GET", "/people/exercise", session).status, 401);
}

}  // namespace
}  // namespace phalanx

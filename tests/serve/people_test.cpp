// SPDX-License-Identifier: Apache-2.0
// The addresses below /people, without a server: who may see what, and what they answer.
#include "serve/people.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <future>
#include <memory>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "record/temporary_folder.h"
#include "serve/people_registry.h"

namespace phalanx {
namespace {

using nlohmann::json;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

const std::string kTherapist = "a.meier";
const std::string kPassword = "a long password";

/// Response with its body as text and, if it is some, as JSON.
struct Answer {
  int status = 0;
  std::string text;
  json value = {};
};

class PeopleTest : public ::testing::Test {
 protected:
  ~PeopleTest() override { EXPECT_TRUE(people_->finish(std::chrono::minutes(5))); }

  /// Sends a request of this computer, as one that may operate.
  static std::future<Answer> send(People& people, WebRequest request) {
    auto promise = std::make_shared<std::promise<Answer>>();
    std::future<Answer> future = promise->get_future();
    people.request(request, [promise](const WebResponse& response) {
      Answer answer{.status = response.status, .text = response.body ? *response.body : ""};
      if (response.type == "application/json") answer.value = json::parse(answer.text);
      promise->set_value(std::move(answer));
    });
    return future;
  }
  static WebRequest request_for(const std::string& path, const std::string& session) {
    WebRequest request;
    request.method = "GET";
    request.path = path;
    request.session = session;
    request.client = {.address = "127.0.0.1", .may_operate = true};
    return request;
  }
  [[nodiscard]] Answer get(const std::string& path, const std::string& session) {
    return send(*people_, request_for(path, session)).get();
  }
  Answer post_text(const std::string& path, const std::string& body, const std::string& session) {
    WebRequest request = request_for(path, session);
    request.method = "POST";
    request.body = body;
    return send(*people_, request).get();
  }
  Answer post(const std::string& path, const json& body, const std::string& session) {
    return post_text(path, body.dump(), session);
  }
  /// Edits a patient as the page does: from the fields as they are now.
  Answer edit(const std::string& path, json fields, const std::string& session) {
    fields["revision"] = get(path, session).value.value("revision", "");
    return post(path, fields, session);
  }
  [[nodiscard]] std::size_t audited(const std::string& account, const std::string& action) {
    const auto all = registry_->audit(registry_->has_accounts() ? chief_ : Actor::owner());
    return static_cast<std::size_t>(std::count_if(all.begin(), all.end(), [&](const AuditEntry& entry) {
      return entry.account == account && entry.action == action;
    }));
  }
  Answer sign_in(const std::string& account = "", const std::string& password = "") {
    return post("/people/sign_in", {{"account", account}, {"password", password}}, "");
  }
  /// @returns the secret of the owner's session
  std::string owner() { return sign_in().value.at("session").get<std::string>(); }
  /// Adds an administrator and a therapist. @returns the secret of the therapist's session
  std::string therapist() {
    registry_->add_account(Actor::owner(), {.name = "chief", .role = Role::kAdministrator}, kPassword);
    registry_->add_account(chief_, {.name = kTherapist, .role = Role::kTherapist}, kPassword);
    return sign_in(kTherapist, kPassword).value.at("session").get<std::string>();
  }
  std::string patient(const std::string& code) {
    return registry_->add_patient(Actor::owner(), test::ready_patient(code)).record;
  }

  const Actor chief_{.account = "chief", .role = Role::kAdministrator};
  const testing::TemporaryFolder folder_;
  const std::shared_ptr<test::RegistryClocks> clocks_ = std::make_shared<test::RegistryClocks>();
  const std::shared_ptr<Registry> registry_ = test::make_registry(folder_.path(), clocks_);
  std::shared_ptr<People> people_ = std::make_shared<People>(
      registry_,
      [] {
        return std::vector<ListedExercise>{
            {.name = "press", .title = "Press and hold", .kind = "assessment", .measure = "press_and_hold"}};
      },
      [clocks = clocks_] { return clocks->utc.load(); });
};

TEST_F(PeopleTest, AStationWithoutARegistrySaysHowToGetOne) {
  const auto without = std::make_shared<People>(nullptr);
  const Answer answer = send(*without, request_for("/people", "")).get();
  EXPECT_EQ(answer.status, 404);
  EXPECT_THAT(answer.text, HasSubstr("--data"));
  WebRequest post = request_for("/people/sign_in", "");
  post.method = "POST";
  EXPECT_EQ(without->body_limit(post), 0U);
  EXPECT_EQ(people_->body_limit(post), People::kBodyLimit);
}

TEST_F(PeopleTest, AViewerGetsNothingEvenWithTheSecretOfASession) {
  const std::string session = owner();
  const std::string record = patient("P07");
  for (const std::string path : {"/people", "/people/sign_in", "/people/patients", "/people/exercises"})
    for (const std::string method : {"GET", "POST"}) {
      WebRequest request = request_for(path, session);
      request.method = method;
      request.client.may_operate = false;
      EXPECT_EQ(people_->body_limit(request), 0U);
      EXPECT_EQ(send(*people_, request).get().status, 403) << method << " " << path;
    }
  WebRequest one = request_for("/people/patients/" + record, session);
  one.client.may_operate = false;
  EXPECT_THAT(send(*people_, one).get().text, Not(HasSubstr("P07")));
}

TEST_F(PeopleTest, TheOwnerNeedsNoPasswordOnThisComputerAndIsRefusedOnAnother) {
  const json status = get("/people", "").value;
  EXPECT_EQ(status["accounts"], false);
  EXPECT_EQ(status["symbols"].size(), 12U);
  EXPECT_EQ(status["tests"].size(), test_kinds().size());
  const std::string session = owner();
  EXPECT_EQ(get("/people/patients", session).status, 200);
  WebRequest other = request_for("/people/patients", session);
  other.client.address = "192.0.2.7";
  EXPECT_EQ(send(*people_, other).get().status, 401);
  other.path = "/people/sign_in";
  other.method = "POST";
  other.body = "{}";
  const Answer refused = send(*people_, other).get();
  EXPECT_EQ(refused.status, 403);
  EXPECT_THAT(refused.text, HasSubstr("phalanx account add"));
}

TEST_F(PeopleTest, EachRequestNeedsTheSecretOfASession) {
  const std::string record = patient("P07");
  const std::string session = owner();
  for (const std::string& wrong : {std::string(), std::string("x"), session + "x", std::string(64, '0')})
    for (const std::string& path :
         {std::string("/people/patients"), "/people/patients/" + record, std::string("/people/exercises")}) {
      const Answer answer = get(path, wrong);
      EXPECT_EQ(answer.status, 401) << path;
      EXPECT_THAT(answer.text, Not(HasSubstr("P07")));
    }
  EXPECT_EQ(post("/people/patients", {{"code", "P08"}}, "").status, 401);
  EXPECT_EQ(registry_->patients(Actor::owner()).size(), 1U);
}

TEST_F(PeopleTest, APatientIsAddedShownChangedAndDeletedInTheRegistryOfTheCommands) {
  const std::string session = owner();
  const Answer added = post("/people/patients", {{"code", "P07"}, {"side", "left"}, {"symbol", ""}}, session);
  ASSERT_EQ(added.status, 200) << added.text;
  const std::string record = added.value["record"].get<std::string>();
  const std::string path = "/people/patients/" + record;
  EXPECT_EQ(added.value["obstacles"], json({"unchecked", "no_consent"}));
  const Answer changed =
      edit(path, {{"consent", true}, {"force_limit_n", 3.5}, {"warnings", {"thin skin"}}, {"record", "ff"}},
           session);
  ASSERT_EQ(changed.status, 200) << changed.text;
  const Patient kept = registry_->patient(Actor::owner(), "P07");
  EXPECT_EQ(kept.record, record) << "the record id is not changed";
  EXPECT_EQ(kept.side, Handedness::kLeft);
  EXPECT_TRUE(kept.consent);
  EXPECT_EQ(kept.force_limit_n, 3.5);
  EXPECT_THAT(kept.warnings, ElementsAre("thin skin"));
  EXPECT_EQ(kept.consent_date, "2026-05-28") << "of today";
  EXPECT_EQ(edit(path, {{"force_limit_n", nullptr}}, session).status, 200);
  EXPECT_FALSE(registry_->patient(Actor::owner(), record).force_limit_n.has_value());
  EXPECT_EQ(get(path, session).value["warnings"], json({"thin skin"}));

  const json list = get("/people/patients", session).value["patients"];
  ASSERT_EQ(list.size(), 1U);
  EXPECT_EQ(list[0]["code"], "P07");
  EXPECT_EQ(list[0]["side"], "left");
  EXPECT_FALSE(list[0].contains("warnings")) << "the list holds no more than it needs";

  const Answer unconfirmed = post(path + "/delete", {{"confirm", "P08"}}, session);
  EXPECT_EQ(unconfirmed.status, 400);
  EXPECT_EQ(post(path + "/delete", json::object(), session).status, 400);
  EXPECT_EQ(post(path + "/delete", {{"confirm", "P07"}}, session).status, 200);
  EXPECT_EQ(get(path, session).status, 404);
  EXPECT_THAT(registry_->patients(Actor::owner()), IsEmpty());
}

TEST_F(PeopleTest, TheRegistrysRefusalsKeepTheirWordsAndChangeNothing) {
  const std::string session = owner();
  const std::string path = "/people/patients/" + patient("P07");
  patient("P08");
  const auto refused = [&](const json& fields, int status, const std::string& text) {
    const Answer answer = edit(path, fields, session);
    EXPECT_EQ(answer.status, status) << fields;
    EXPECT_THAT(answer.text, HasSubstr(text)) << fields;
  };
  refused({{"code", "P08"}}, 409, "P08");
  refused({{"code", "a b"}}, 400, "code");
  refused({{"code", 7}}, 400, "code");
  refused({{"side", "middle"}}, 400, "side");
  refused({{"force_limit_n", 1e9}}, 400, "force_limit_n");
  refused({{"surname", "Meier"}}, 400, "surname");
  refused({{"note", "a@b.example"}}, 400, "note");
  refused({{"calibration", "/nowhere/c.toml"}, {"calibration_expires", "2199-01-01"}}, 400,
          "/nowhere/c.toml");
  refused({{"calibration_expires", "2199-01-01"}}, 400, "calibration");
  refused({{"calibration_serial", "0002"}}, 400, "calibration_serial");
  refused({{"prescription", json::array({{{"exercise", "train_press"}, {"minutes_per_day", 119.0}}})}}, 400,
          "most_minutes");
  EXPECT_EQ(get(path, session).value["code"], "P07");
  EXPECT_EQ(post("/people/patients", {{"code", "P08"}, {"side", "left"}}, session).status, 409);
}

TEST_F(PeopleTest, AnEditOfFieldsThatChangedMeanwhileIsRefusedAndLosesNothing) {
  const std::string session = owner();
  const std::string path = "/people/patients/" + patient("P07");
  const json opened = get(path, session).value;
  ASSERT_EQ(edit(path, {{"contraindications", {"open wound"}}}, session).status, 200);
  const Answer late = post(path, {{"note", "likes music"}, {"revision", opened["revision"]}}, session);
  EXPECT_EQ(late.status, 409);
  EXPECT_THAT(late.text, HasSubstr("changed meanwhile"));
  EXPECT_EQ(post(path, {{"note", "likes music"}}, session).status, 400) << "without a revision";
  EXPECT_EQ(edit(path, {{"note", "likes music"}}, session).status, 200);
  const Patient kept = registry_->patient(Actor::owner(), "P07");
  EXPECT_THAT(kept.contraindications, ElementsAre("open wound"));
  EXPECT_EQ(kept.note, "likes music");
  const std::size_t edits = audited("owner", "edit");
  EXPECT_EQ(edit(path, {{"note", "likes music"}}, session).status, 200);
  EXPECT_EQ(audited("owner", "edit"), edits) << "equal fields are no change";
}

TEST_F(PeopleTest, AnotherSideClearsWhatWasMeasuredOnTheFirstHandAndSaysSo) {
  const std::string session = owner();
  Patient measured = test::ready_patient("P07");
  measured.own_force_n[1] = 12.0;
  measured.own_range_deg["index_pip_flexion"] = {2.0, 80.0};
  const std::string path = "/people/patients/" + registry_->add_patient(Actor::owner(), measured).record;
  const Answer changed = edit(path, {{"side", "left"}}, session);
  ASSERT_EQ(changed.status, 200) << changed.text;
  EXPECT_THAT(changed.value["said"].dump(), HasSubstr("measure the left hand"));
  const Patient kept = registry_->patient(Actor::owner(), "P07");
  EXPECT_EQ(kept.own_force_n[1], 0.0);
  EXPECT_THAT(kept.own_range_deg, IsEmpty());
  EXPECT_FALSE(kept.entry.has_value());
  EXPECT_THAT(kept.calibration_expires, IsEmpty());
}

TEST_F(PeopleTest, TheOwnersComputerGetsTheKeysOfRecordingsWithOneLineInTheAuditLog) {
  const std::string record = patient("P07");
  const RecordingAccess access = people_->recording_access(request_for("/recordings", ""));
  EXPECT_EQ(audited("owner", "keys"), 0U) << "before a key is needed";
  ASSERT_TRUE(access.keys);
  EXPECT_EQ(access.keys(record), registry_->keys().find(record));
  EXPECT_TRUE(access.keys(record).has_value());
  for (int i = 0; i < 3; ++i)
    EXPECT_TRUE(people_->recording_access(request_for("/recordings/x", "")).keys(record).has_value());
  EXPECT_EQ(audited("owner", "keys"), 1U);
  WebRequest other = request_for("/recordings", owner());
  other.client.address = "192.0.2.7";
  EXPECT_FALSE(people_->recording_access(other).keys) << "another computer, with the owner's secret";
  EXPECT_THAT(people_->recording_access(other).refusal, HasSubstr("phalanx account add"));
}

TEST_F(PeopleTest, WithAccountsOnlyASessionThatIsSignedInGetsTheKeysOfRecordings) {
  const std::string record = patient("P07");
  const std::string session = therapist();
  const auto access = [&](const std::string& secret) {
    return people_->recording_access(request_for("/recordings/x", secret));
  };
  EXPECT_FALSE(access("").keys);
  EXPECT_THAT(access("").refusal, HasSubstr("sign in"));
  EXPECT_FALSE(access(std::string(64, 'a')).keys);
  EXPECT_TRUE(access(session).keys(record).has_value());
  EXPECT_TRUE(access(session).keys(record).has_value());
  EXPECT_EQ(audited(kTherapist, "keys"), 1U);
  static_cast<void>(post("/people/lock", json::object(), session));
  EXPECT_FALSE(access(session).keys) << "locked";
  static_cast<void>(post("/people/unlock", {{"password", kPassword}}, session));
  EXPECT_TRUE(access(session).keys);
  clocks_->steady = clocks_->steady + test::kRegistryIdle - 1.0;
  EXPECT_TRUE(access(session).keys);
  clocks_->steady = clocks_->steady + 2.0;
  EXPECT_FALSE(access(session).keys) << "a recording that is read does not put the lock off";
  const std::string next = sign_in(kTherapist, kPassword).value.at("session").get<std::string>();
  EXPECT_TRUE(access(next).keys(record).has_value());
  EXPECT_EQ(audited(kTherapist, "keys"), 2U) << "once for each session";
}

TEST_F(PeopleTest, ASessionThatLocksByItselfIsReportedOnce) {
  const std::string session = therapist();
  ASSERT_EQ(people_->take_sign_ins().size(), 1U);
  people_->check_sessions();
  EXPECT_TRUE(people_->finish(std::chrono::minutes(5)));
  EXPECT_THAT(people_->take_sign_ins(), IsEmpty());
  clocks_->steady = clocks_->steady + test::kRegistryIdle + 1.0;
  for (int i = 0; i < 2; ++i) {
    people_->check_sessions();
    EXPECT_TRUE(people_->finish(std::chrono::minutes(5)));
  }
  const auto ended = people_->take_sign_ins();
  ASSERT_EQ(ended.size(), 1U);
  EXPECT_EQ(ended[0].account, kTherapist);
  EXPECT_FALSE(ended[0].in);
}

TEST_F(PeopleTest, WhatIsNoObjectOfJsonIsRefused) {
  const std::string session = owner();
  const std::string path = "/people/patients/" + patient("P07");
  std::string deep;
  for (int i = 0; i < 3000; ++i) deep += "{\"a\":";
  for (const std::string& body :
       {std::string(), std::string("{"), std::string("[]"), std::string("7"), std::string("null"),
        std::string("{}{}"), std::string("{\"code\":\"\xff\"}"), std::string("\0\0", 2), deep,
        deep + "1" + std::string(3000, '}')})
    for (const std::string& at : {path, path + "/tests", path + "/notes", path + "/delete",
                                  std::string("/people/patients"), std::string("/people/sign_in")})
      EXPECT_EQ(post_text(at, body, session).status, 400) << at << " " << body.substr(0, 20);
  EXPECT_EQ(get(path, session).value["code"], "P07");
}

TEST_F(PeopleTest, AnAddressHasTheRecordIdAndNeverTheCode) {
  const std::string session = owner();
  const std::string record = patient("P07");
  for (const std::string& path :
       {std::string("/people/patients/P07"), std::string("/people/patients/"),
        std::string("/people/patientsX"), std::string("/people/"), std::string("/people/secrets"),
        "/people/patients/" + record + "/", "/people/patients/" + record + "/keys",
        "/people/patients/" + record + "/course/1", "/people/patients/" + std::string(32, 'f')})
    EXPECT_EQ(get(path, session).status, 404) << path;
  const std::string one = "/people/patients/" + record;
  EXPECT_EQ(get(one + "/delete", session).status, 405);
  EXPECT_EQ(get(one + "/notes", session).status, 405);
  EXPECT_EQ(post(one + "/course", json::object(), session).status, 405);
  EXPECT_EQ(post("/people", json::object(), session).status, 405);
  EXPECT_EQ(get("/people/sign_in", session).status, 405);
  EXPECT_EQ(post("/people/exercises", json::object(), session).status, 405);
  EXPECT_EQ(get("/people/exercises", session).value["exercises"][0]["title"], "Press and hold");
}

TEST_F(PeopleTest, TheCourseHasResultsTestsNotesAndTrends) {
  const std::string session = owner();
  const std::string record = patient("P07");
  const std::string path = "/people/patients/" + record;
  ResultRow row;
  row.recording = "2026-05-28T10-00-00Z.mcap.enc";
  row.exercise = "press_and_hold";
  row.assessment = true;
  row.date = 1'779'960'000.0;
  row.scores = {
      {.name = "mean_n", .unit = "N", .value = 4.25, .origin = ScoreOrigin::kMeasured, .invalid = ""},
      {.name = "ring_n", .unit = "N", .invalid = "not measured: no sensor of the ring finger"}};
  ASSERT_TRUE(registry_->add_result(Actor::owner(), record, row));
  for (const auto& [date, value] : {std::pair{"2026-05-04", 20.0}, std::pair{"2026-05-28", 24.0}}) {
    const Answer entered = post(path + "/tests",
                                {{"kind", "grip"},
                                 {"side", "more_affected"},
                                 {"value", value},
                                 {"date", date},
                                 {"rater", "PT1"},
                                 {"note", ""}},
                                session);
    ASSERT_EQ(entered.status, 200) << entered.text;
  }
  EXPECT_EQ(post(path + "/notes", {{"text", "hand is warm"}}, session).status, 200);
  EXPECT_EQ(post(path + "/notes", {{"text", std::string(4001, 'a')}}, session).status, 400);
  EXPECT_EQ(post(path + "/notes", {{"text", ""}}, session).status, 400);
  EXPECT_EQ(post(path + "/tests", {{"kind", "grip"}, {"value", -1}}, session).status, 400);
  EXPECT_EQ(post(path + "/tests", {{"kind", "jumping"}, {"value", 1}}, session).status, 400);

  const json course = get(path + "/course", session).value;
  const json& scores = course["results"][0]["scores"];
  EXPECT_EQ(scores[0]["value"], 4.25);
  EXPECT_EQ(scores[0]["origin"], "measured");
  EXPECT_EQ(course["names"]["mean_n"]["en"], "Mean n") << "a name that is not known keeps its words";
  EXPECT_FALSE(scores[1].contains("value")) << "a score that was not measured has no value";
  EXPECT_THAT(scores[1]["invalid"].get<std::string>(), HasSubstr("ring finger"));
  EXPECT_EQ(course["tests"].size(), 2U);
  EXPECT_EQ(course["notes"][0]["text"], "hand is warm");
  bool found = false;
  for (const json& trend : course["trends"]) {
    if (trend["name"] != "grip/more_affected") continue;
    found = true;
    EXPECT_EQ(trend["points"].size(), 2U);
    EXPECT_EQ(trend["smallest_real_difference"], 2.9);
    EXPECT_EQ(trend["proven"], true) << "4 kg are more than 2.9 kg";
  }
  EXPECT_TRUE(found);
}

TEST_F(PeopleTest, AnExportHasThreeFilesAndOneLineInTheAuditLogAndNeverTheCodeInAnAddress) {
  const std::string session = owner();
  const std::string record = patient("P07");
  const std::string path = "/people/patients/" + record + "/export";
  const Answer answer = get(path, session);
  ASSERT_EQ(answer.status, 200) << answer.text;
  const json& files = answer.value["files"];
  ASSERT_EQ(files.size(), 3U);
  EXPECT_EQ(files[0]["name"], "patient.json");
  EXPECT_EQ(files[0]["type"], "application/json");
  EXPECT_EQ(json::parse(files[0]["text"].get<std::string>())["patient"]["code"], "P07");
  EXPECT_EQ(files[1]["name"], "results.csv");
  EXPECT_THAT(files[1]["text"].get<std::string>(), HasSubstr("record,code,recording"));
  EXPECT_EQ(files[2]["name"], "tests.csv");
  EXPECT_EQ(audited("owner", "export"), 1U);
  EXPECT_EQ(post(path, json::object(), session).status, 405);
  EXPECT_EQ(get(path, "").status, 401);
  EXPECT_EQ(get("/people/patients/P07/export", session).status, 404);
}

TEST_F(PeopleTest, AReportIsAPageAndABundleOfWhatTheRegistryHolds) {
  const std::string session = owner();
  const std::string record = patient("P07");
  const std::string path = "/people/patients/" + record;
  ResultRow row;
  row.recording = "2026-05-28T10-00-00Z.mcap.enc";
  row.exercise = "press_and_hold";
  row.assessment = true;
  row.date = 1'779'960'000.0;
  row.scores = {
      {.name = "mean_n", .unit = "N", .value = 4.25, .origin = ScoreOrigin::kMeasured, .invalid = ""}};
  ASSERT_TRUE(registry_->add_result(Actor::owner(), record, row));
  EXPECT_EQ(get(path + "/report", "").status, 401);
  const Answer english = get(path + "/report", session);
  ASSERT_EQ(english.status, 200) << english.text;
  EXPECT_THAT(english.text,
              AllOf(HasSubstr("<!DOCTYPE html>"), HasSubstr("P07"), HasSubstr("data-value=\"4.25\"")));
  const auto asked = [&](const std::string& part, const std::string& query) {
    WebRequest request = request_for(path + part, session);
    request.query = query;
    return send(*people_, request).get();
  };
  EXPECT_THAT(asked("/report", "lang=de").text, HasSubstr("kein Medizinprodukt"));
  EXPECT_EQ(asked("/report", "lang=de&day=2026-05-28").status, 200);
  for (const std::string query : {"lang=fr", "day=2026-05-27", "day=yesterday", "x=1", "lang"})
    EXPECT_EQ(asked("/report", query).status, 400) << query;
  EXPECT_EQ(asked("/fhir", "lang=de").status, 400);
  const Answer bundle = asked("/fhir", "day=2026-05-28");
  ASSERT_EQ(bundle.status, 200) << bundle.text;
  EXPECT_EQ(json::parse(bundle.text)["resourceType"], "Bundle");
  for (const std::string part : {"/report", "/fhir"})
    EXPECT_EQ(post(path + part, json::object(), session).status, 405);
}

TEST_F(PeopleTest, TheTemplatesOfPrescriptionsCanBePrescribedAsTheyAre) {
  const std::string session = owner();
  const std::string path = "/people/patients/" + patient("P07");
  EXPECT_EQ(get("/people/templates", "").status, 401);
  EXPECT_EQ(post("/people/templates", json::object(), session).status, 405);
  const json templates = get("/people/templates", session).value["templates"];
  std::vector<std::string> names;
  for (const json& each : templates) {
    names.push_back(each["name"].get<std::string>());
    EXPECT_FALSE(each["title"].get<std::string>().empty());
    EXPECT_FALSE(each["title_de"].get<std::string>().empty());
    for (const json& line : each["lines"])
      EXPECT_EQ(line["note"] != "", each["notes_de"].contains(line["exercise"].get<std::string>()))
          << each["name"] << ": a note without its German one";
    const Answer edited = edit(path, {{"prescription", each["lines"]}}, session);
    EXPECT_EQ(edited.status, 200) << edited.text;
    EXPECT_EQ(registry_->patient(Actor::owner(), "P07").prescription.size(), each["lines"].size());
  }
  EXPECT_THAT(names, ElementsAre("assessment_day", "mild", "moderate", "severe"));
}

TEST_F(PeopleTest, AccountsEndTheOwnersSession) {
  const std::string before = owner();
  const std::string session = therapist();
  EXPECT_EQ(get("/people/patients", before).status, 401);
  EXPECT_EQ(get("/people", "").value["accounts"], true);
  EXPECT_EQ(get("/people/patients", session).status, 200);
  EXPECT_EQ(sign_in().status, 401) << "without a password";
  WebRequest other = request_for("/people/patients", session);
  other.client.address = "192.0.2.7";
  EXPECT_EQ(send(*people_, other).get().status, 200) << "accounts sign in from any computer that may operate";
}

TEST_F(PeopleTest, TheOwnerAddsTheFirstAccountAndAnAdministratorTheOthers) {
  const std::string session = owner();
  EXPECT_EQ(get("/people/accounts", session).value["accounts"], json::array());
  const json first = {{"name", "chief"}, {"role", "administrator"}, {"password", kPassword}};
  EXPECT_EQ(post("/people/accounts", {{"name", "m"}, {"role", "therapist"}, {"password", kPassword}}, session)
                .status,
            409)
      << "the first one is an administrator";
  const Answer added = post("/people/accounts", first, session);
  ASSERT_EQ(added.status, 200) << added.text;
  EXPECT_EQ(get("/people/accounts", session).status, 401) << "the owner's session has ended";
  EXPECT_TRUE(people_->has_accounts());
  const std::string chief = sign_in("chief", kPassword).value.at("session").get<std::string>();
  const json second = {{"name", kTherapist}, {"role", "therapist"}, {"password", kPassword}};
  EXPECT_EQ(post("/people/accounts", second, chief).status, 200);
  EXPECT_EQ(post("/people/accounts", second, chief).status, 409) << "the name is taken";
  EXPECT_EQ(
      post("/people/accounts", {{"name", "x"}, {"role", "chief"}, {"password", kPassword}}, chief).status,
      400);
  EXPECT_EQ(
      post("/people/accounts", {{"name", "x"}, {"role", "therapist"}, {"password", "short"}}, chief).status,
      400);
  const Answer list = get("/people/accounts", chief);
  EXPECT_EQ(list.value["accounts"], json({{{"name", kTherapist}, {"role", "therapist"}},
                                          {{"name", "chief"}, {"role", "administrator"}}}));
  EXPECT_THAT(list.text, Not(HasSubstr(kPassword)));

  const std::string of_therapist = "/people/accounts/" + kTherapist;
  EXPECT_EQ(post(of_therapist, {{"role", "look_on"}, {"password", kPassword}}, chief).status, 400)
      << "one at a time";
  EXPECT_EQ(post(of_therapist, {{"role", "patient_screen"}}, chief).status, 200);
  EXPECT_EQ(post(of_therapist, {{"password", "another long one"}}, chief).status, 200);
  EXPECT_EQ(sign_in(kTherapist, "another long one").value.at("role"), "patient_screen");
  EXPECT_EQ(post("/people/accounts/chief", {{"role", "therapist"}}, chief).status, 409)
      << "the last administrator";
  EXPECT_EQ(post("/people/accounts/nobody/delete", json::object(), chief).status, 404);
  EXPECT_EQ(post(of_therapist + "/delete", json::object(), chief).status, 200);
  EXPECT_EQ(get("/people/accounts", chief).value["accounts"].size(), 1U);
}

TEST_F(PeopleTest, ATherapistSeesNoAccountsAndChangesTheOwnPasswordOnly) {
  const std::string session = therapist();
  EXPECT_EQ(get("/people/accounts", session).status, 403);
  EXPECT_EQ(post("/people/accounts", {{"name", "x"}, {"role", "therapist"}, {"password", kPassword}}, session)
                .status,
            403);
  EXPECT_EQ(post("/people/accounts/chief", {{"password", "another long one"}}, session).status, 403);
  EXPECT_EQ(post("/people/accounts/chief/delete", json::object(), session).status, 403);
  EXPECT_EQ(post("/people/accounts/" + kTherapist, {{"password", "another long one"}}, session).status, 200);
  EXPECT_EQ(get("/people/patients", session).status, 401) << "it signs in again with the new one";
  EXPECT_EQ(sign_in(kTherapist, "another long one").status, 200);
}

TEST_F(PeopleTest, WrongPasswordsAreDelayed) {
  static_cast<void>(therapist());
  int wrong = 0;
  int status = 401;
  while (status == 401 && wrong < 50) {
    status = sign_in(kTherapist, "not the password").status;
    ++wrong;
  }
  EXPECT_EQ(status, 429) << "after " << wrong;
  EXPECT_EQ(sign_in(kTherapist, kPassword).status, 429) << "the right password has to wait, too";
  clocks_->utc = clocks_->utc + 86'400.0;
  clocks_->steady = clocks_->steady + 86'400.0;
  EXPECT_EQ(sign_in(kTherapist, kPassword).status, 200);
}

TEST_F(PeopleTest, AnAccountThatLooksOnSeesNoPatient) {
  static_cast<void>(therapist());
  registry_->add_account(chief_, {.name = "viewer", .role = Role::kLookOn}, kPassword);
  const Answer viewer = sign_in("viewer", kPassword);
  EXPECT_EQ(viewer.status, 403);
  EXPECT_FALSE(viewer.value.contains("session"));
  registry_->add_account(chief_, {.name = "screen", .role = Role::kPatientScreen}, kPassword);
  const Answer screen = sign_in("screen", kPassword);
  ASSERT_EQ(screen.status, 200) << "the patient's screen signs in, so that it can report pain";
  EXPECT_EQ(get("/people/patients", screen.value.at("session").get<std::string>()).status, 403);
}

TEST_F(PeopleTest, AnIdleSessionIsLockedUntilThePasswordIsGivenAgain) {
  const std::string session = therapist();
  clocks_->steady = clocks_->steady + test::kRegistryIdle - 1.0;
  EXPECT_EQ(post("/people/alive", json::object(), session).status, 200);
  clocks_->steady = clocks_->steady + test::kRegistryIdle - 1.0;
  EXPECT_EQ(get("/people/patients", session).status, 200) << "a report put the lock off";
  clocks_->steady = clocks_->steady + test::kRegistryIdle + 1.0;
  EXPECT_EQ(get("/people/patients", session).status, 401);
  EXPECT_EQ(post("/people/alive", json::object(), session).status, 401);
  EXPECT_EQ(post("/people/unlock", {{"password", "not the password"}}, session).status, 401);
  EXPECT_EQ(get("/people/patients", session).status, 401);
  EXPECT_EQ(post("/people/unlock", {{"password", kPassword}}, session).status, 200);
  EXPECT_EQ(get("/people/patients", session).status, 200);
}

TEST_F(PeopleTest, ASessionIsLockedAndSignedOutByHand) {
  const std::string session = therapist();
  EXPECT_EQ(post("/people/lock", json::object(), session).status, 200);
  EXPECT_EQ(get("/people/patients", session).status, 401);
  EXPECT_EQ(post("/people/unlock", {{"password", kPassword}}, session).status, 200);
  EXPECT_EQ(post("/people/sign_out", json::object(), session).status, 200);
  EXPECT_EQ(get("/people/patients", session).status, 401);
  EXPECT_EQ(post("/people/unlock", {{"password", kPassword}}, session).status, 401);
  EXPECT_EQ(post("/people/lock", json::object(), "").status, 200) << "nothing is locked";
}

TEST_F(PeopleTest, TheAuditLogNamesTheAccountAndNeverTheCode) {
  const std::string record = patient("P07");
  const std::string session = therapist();
  const std::string path = "/people/patients/" + record;
  static_cast<void>(get("/people/patients", session));
  static_cast<void>(get(path, session));
  static_cast<void>(edit(path, {{"consent", false}}, session));
  std::vector<std::string> seen;
  for (const AuditEntry& entry : registry_->audit(chief_)) {
    EXPECT_THAT(entry.record + entry.detail + entry.action, Not(HasSubstr("P07")));
    if (entry.account == kTherapist && entry.record == record) seen.push_back(entry.action);
  }
  EXPECT_THAT(seen, ::testing::IsSupersetOf({"show", "edit"}));
  EXPECT_TRUE(registry_->check_audit(chief_).whole);
}

TEST_F(PeopleTest, RequestsBeyondThoseThatMayWaitAreRefusedAtOnceAndNoneIsLost) {
  std::promise<void> go_on;
  std::promise<void> begun;
  const auto slow = std::make_shared<People>(registry_, [&, waits = go_on.get_future().share()] {
    begun.set_value();
    waits.wait();
    return std::vector<ListedExercise>();
  });
  WebRequest sign_in = request_for("/people/sign_in", "");
  sign_in.method = "POST";
  sign_in.body = "{}";
  const auto session = send(*slow, sign_in).get().value["session"].get<std::string>();
  auto first = send(*slow, request_for("/people/exercises", session));
  begun.get_future().wait();
  std::vector<std::future<Answer>> waiting;
  for (std::size_t i = 0; i < People::kMostWaiting; ++i)
    waiting.push_back(send(*slow, request_for("/people", "")));
  EXPECT_EQ(send(*slow, request_for("/people", "")).get().status, 503);
  go_on.set_value();
  EXPECT_EQ(first.get().status, 200);
  for (auto& one : waiting) EXPECT_EQ(one.get().status, 200);
  EXPECT_TRUE(slow->finish(std::chrono::minutes(5)));
}

TEST_F(PeopleTest, NoRandomRequestWithoutASessionReadsOrChangesAPatient) {
  const std::string record = patient("P07");
  static_cast<void>(therapist());
  const std::string before = patient_json(registry_->patient(chief_, record));
  const std::vector<std::string> paths = {"/people",
                                          "/people/patients",
                                          "/people/patients/" + record,
                                          "/people/patients/" + record + "/course",
                                          "/people/patients/" + record + "/notes",
                                          "/people/patients/" + record + "/tests",
                                          "/people/patients/" + record + "/delete",
                                          "/people/exercises",
                                          "/people/alive",
                                          "/people/lock",
                                          "/people/sign_out",
                                          "/people/unlock"};
  const std::vector<std::string> bodies = {"",
                                           "{}",
                                           R"({"confirm": "P07"})",
                                           R"({"code": "P66"})",
                                           R"({"text": "x"})",
                                           R"({"password": "a long password"})"};
  constexpr std::uint32_t kSeed = 24;
  SCOPED_TRACE(kSeed);
  std::mt19937 random(kSeed);
  const auto any = [&](const auto& of) { return of[random() % of.size()]; };
  for (int i = 0; i < 500; ++i) {
    std::string secret(random() % 70, '\0');
    for (char& c : secret) c = static_cast<char>(random() % 256);
    WebRequest request = request_for(any(paths), secret);
    request.method = random() % 2 == 0 ? "POST" : "GET";
    request.body = any(bodies);
    if (!request.body.empty() && random() % 3 == 0)
      request.body[random() % request.body.size()] = static_cast<char>(random() % 256);
    const Answer answer = send(*people_, request).get();
    EXPECT_THAT(answer.text, Not(HasSubstr("P07"))) << request.path;
    if (request.path.starts_with("/people/patients")) {
      EXPECT_EQ(answer.status, 401) << request.path;
    }
  }
  EXPECT_EQ(patient_json(registry_->patient(chief_, record)), before);
}

TEST(Obstacles, AreTheEntryCheckConsentCalibrationAndContraindications) {
  Patient patient = test::ready_patient("P07");
  EXPECT_THAT(people::obstacles(patient, "2026-12-31"), IsEmpty()) << "the last day is valid";
  EXPECT_THAT(people::obstacles(patient, "2027-01-01"), ElementsAre("expired"));
  patient.calibration_expires.clear();
  EXPECT_THAT(people::obstacles(patient, "2027-01-01"), IsEmpty()) << "it does not expire";
  patient.contraindications = {"open wound"};
  patient.consent = false;
  patient.entry->suitable = false;
  EXPECT_THAT(people::obstacles(patient, "2026-05-28"),
              ElementsAre("unsuitable", "no_consent", "contraindication"));
  patient.entry.reset();
  EXPECT_THAT(people::obstacles(patient, "2026-05-28"),
              ElementsAre("unchecked", "no_consent", "contraindication"));
}

}  // namespace
}  // namespace phalanx

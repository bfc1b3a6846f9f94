// SPDX-License-Identifier: Apache-2.0
// Patients at the addresses below /people: who may see what, and what they answer.
#include <chrono>
#include <cstdint>
#include <future>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "serve/people_bench.h"

namespace phalanx::test {
namespace {

using nlohmann::json;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

TEST_F(PeopleTest, AStationWithoutARegistrySaysHowToGetOne) {
  const auto without = std::make_shared<People>(nullptr);
  const PeopleAnswer answer = send(*without, request_for("/people", "")).get();
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
  const PeopleAnswer refused = send(*people_, other).get();
  EXPECT_EQ(refused.status, 403);
  EXPECT_THAT(refused.text, HasSubstr("phalanx account add"));
}

TEST_F(PeopleTest, EachRequestNeedsTheSecretOfASession) {
  const std::string record = patient("P07");
  const std::string session = owner();
  for (const std::string& wrong : {std::string(), std::string("x"), session + "x", std::string(64, '0')})
    for (const std::string& path :
         {std::string("/people/patients"), "/people/patients/" + record, std::string("/people/exercises")}) {
      const PeopleAnswer answer = get(path, wrong);
      EXPECT_EQ(answer.status, 401) << path;
      EXPECT_THAT(answer.text, Not(HasSubstr("P07")));
    }
  EXPECT_EQ(post("/people/patients", {{"code", "P08"}}, "").status, 401);
  EXPECT_EQ(registry_->patients(Actor::owner()).size(), 1U);
}

TEST_F(PeopleTest, APatientIsAddedShownChangedAndDeletedInTheRegistryOfTheCommands) {
  const std::string session = owner();
  const PeopleAnswer added =
      post("/people/patients", {{"code", "P07"}, {"side", "left"}, {"symbol", ""}}, session);
  ASSERT_EQ(added.status, 200) << added.text;
  const std::string record = added.value["record"].get<std::string>();
  const std::string path = "/people/patients/" + record;
  EXPECT_EQ(added.value["obstacles"], json({"unchecked", "no_consent"}));
  const PeopleAnswer changed =
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

  const PeopleAnswer unconfirmed = post(path + "/delete", {{"confirm", "P08"}}, session);
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
    const PeopleAnswer answer = edit(path, fields, session);
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
  const PeopleAnswer late = post(path, {{"note", "likes music"}, {"revision", opened["revision"]}}, session);
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
  Patient measured = ready_patient("P07");
  measured.own_force_n[1] = 12.0;
  measured.own_range_deg["index_pip_flexion"] = {2.0, 80.0};
  const std::string path = "/people/patients/" + registry_->add_patient(Actor::owner(), measured).record;
  const PeopleAnswer changed = edit(path, {{"side", "left"}}, session);
  ASSERT_EQ(changed.status, 200) << changed.text;
  EXPECT_THAT(changed.value["said"].dump(), HasSubstr("measure the left hand"));
  const Patient kept = registry_->patient(Actor::owner(), "P07");
  EXPECT_EQ(kept.own_force_n[1], 0.0);
  EXPECT_THAT(kept.own_range_deg, IsEmpty());
  EXPECT_FALSE(kept.entry.has_value());
  EXPECT_THAT(kept.calibration_expires, IsEmpty());
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
    const PeopleAnswer entered = post(path + "/tests",
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
  const PeopleAnswer answer = get(path, session);
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
  const PeopleAnswer english = get(path + "/report", session);
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
  const PeopleAnswer bundle = asked("/fhir", "day=2026-05-28");
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
    const PeopleAnswer edited = edit(path, {{"prescription", each["lines"]}}, session);
    EXPECT_EQ(edited.status, 200) << edited.text;
    EXPECT_EQ(registry_->patient(Actor::owner(), "P07").prescription.size(), each["lines"].size());
  }
  EXPECT_THAT(names, ElementsAre("assessment_day", "mild", "moderate", "severe"));
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
  std::vector<std::future<PeopleAnswer>> waiting;
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
    const PeopleAnswer answer = send(*people_, request).get();
    EXPECT_THAT(answer.text, Not(HasSubstr("P07"))) << request.path;
    if (request.path.starts_with("/people/patients")) {
      EXPECT_EQ(answer.status, 401) << request.path;
    }
  }
  EXPECT_EQ(patient_json(registry_->patient(chief_, record)), before);
}

TEST(Obstacles, AreTheEntryCheckConsentCalibrationAndContraindications) {
  Patient patient = ready_patient("P07");
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
}  // namespace phalanx::test

// SPDX-License-Identifier: Apache-2.0
// Accounts and sessions at the addresses below /people.
#include <chrono>
#include <string>
#include <vector>

#include "serve/people_bench.h"

namespace phalanx::test {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

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
  const PeopleAnswer added = post("/people/accounts", first, session);
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
  const PeopleAnswer list = get("/people/accounts", chief);
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
  const PeopleAnswer viewer = sign_in("viewer", kPassword);
  EXPECT_EQ(viewer.status, 403);
  EXPECT_FALSE(viewer.value.contains("session"));
  registry_->add_account(chief_, {.name = "screen", .role = Role::kPatientScreen}, kPassword);
  const PeopleAnswer screen = sign_in("screen", kPassword);
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

}  // namespace
}  // namespace phalanx::test

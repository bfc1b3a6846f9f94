// SPDX-License-Identifier: Apache-2.0
// The addresses below /people behind the cockpit's server: tokens, bodies, STOP, and the account in the
// log of changes.
#include <gmock/gmock.h>

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "record/mcap/encrypted_file.h"
#include "record/mcap/mcap_writer.h"
#include "record/recording/topics.h"
#include "serve/cockpit_fixture.h"
#include "serve/people.h"
#include "serve/people_registry.h"

namespace phalanx {
namespace {

using namespace test;
using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;

const std::string kAccount = "a.meier";
const std::string kAccountPassword = "a long password";

class PeopleCockpit : public CockpitTest {
 protected:
  PeopleCockpit()
      : CockpitTest(false, "sliders", [](const std::filesystem::path& folder) {
          const auto registry = make_registry(folder, registry_clocks());
          registry->add_account(Actor::owner(), {.name = "chief", .role = Role::kAdministrator},
                                kAccountPassword);
          registry->add_account({.account = "chief", .role = Role::kAdministrator},
                                {.name = kAccount, .role = Role::kTherapist}, kAccountPassword);
          return registry;
        }) {}

  /// @returns the clocks of the registry of the running test
  static const std::shared_ptr<RegistryClocks>& registry_clocks() {
    static std::shared_ptr<RegistryClocks> clocks;
    if (!clocks) clocks = std::make_shared<RegistryClocks>();
    return clocks;
  }
  /// @param fields  of the request, with their line ends
  std::string sign_in(const std::string& fields = "") {
    const std::string answer =
        post("/people/sign_in", json({{"account", kAccount}, {"password", kAccountPassword}}).dump(), fields);
    EXPECT_EQ(status_of(answer), 200) << answer;
    return json::parse(body_of(answer)).at("session").get<std::string>();
  }
  static std::string field_of_session(const std::string& session) {
    return "X-Phalanx-Session: " + session + "\r\n";
  }
};

TEST_F(PeopleCockpit, TheSecretComesInItsFieldAndBodiesAreBounded) {
  const std::string mine = field_of_session(sign_in());
  EXPECT_EQ(status_of(ask(port(), get("/people/patients"))), 401);
  const std::string answer = ask(port(), get("/people/patients", mine));
  EXPECT_EQ(status_of(answer), 200);
  EXPECT_THAT(field_of(answer, "Cache-Control"), HasSubstr("no-store"));
  EXPECT_EQ(status_of(post("/people/patients", R"({"code": "P07", "side": "left"})", mine)), 200);
  EXPECT_EQ(status_of(post("/people/patients", std::string(People::kBodyLimit + 1, ' '), mine)), 413);
  EXPECT_THAT(log_text(), Not(HasSubstr("P07"))) << "the log of changes holds no code";
}

TEST_F(PeopleCockpit, TheViewersTokenGetsNothing) {
  serve("operators-own-token", "viewers-own-token");
  const auto asked_as = [&](const std::string& token) {
    const std::string cookie = "Cookie: phalanx-" + std::to_string(port()) + "=" + token + "\r\n";
    return status_of(ask(port(), get("/people", cookie)));
  };
  EXPECT_EQ(asked_as("viewers-own-token"), 403);
  EXPECT_EQ(asked_as("operators-own-token"), 200);
  EXPECT_EQ(status_of(post("/people/sign_in?token=viewers-own-token", "{}")) / 100, 4);
}

TEST_F(PeopleCockpit, AStopNeedsNoSession) {
  EXPECT_EQ(status_of(post("/stop", "")), 200) << "signed out";
  EXPECT_TRUE(session_->held_stopped());
  Page page(port());
  EXPECT_TRUE(page.ask(to_resume(*session_)).ok());
  const std::string mine = field_of_session(sign_in());
  EXPECT_EQ(status_of(post("/people/lock", "{}", mine)), 200);
  EXPECT_EQ(status_of(ask(port(), get("/people/patients", mine))), 401) << "locked";
  EXPECT_EQ(status_of(post("/stop", "", mine)), 200);
  EXPECT_TRUE(session_->held_stopped());
}

TEST_F(PeopleCockpit, TheLogOfChangesNamesTheAccountBesideItsPage) {
  Page page(port(), "", "Anna");
  const std::string from = "X-Phalanx-Page: " + page.welcome.secret() + "\r\n";
  const std::string mine = from + field_of_session(sign_in(from));
  const wire::Notice in = page.notice("account");
  EXPECT_EQ(in.who(), "page 1 (127.0.0.1), Anna");
  EXPECT_EQ(in.text(), "account a.meier signed in");
  page.send(to_stop());
  EXPECT_EQ(page.notice("stopped").who(), "page 1 (127.0.0.1, account a.meier), Anna");
  EXPECT_EQ(status_of(post("/people/sign_out", "{}", mine)), 200);
  EXPECT_EQ(page.notice("account").text(), "account a.meier signed out");
  EXPECT_TRUE(page.ask(to_resume(*session_)).ok());
  EXPECT_EQ(page.notice("resumed").who(), "page 1 (127.0.0.1), Anna");
}

TEST_F(PeopleCockpit, ASessionThatLocksByItselfIsNoLongerNamed) {
  Page page(port());
  static_cast<void>(sign_in("X-Phalanx-Page: " + page.welcome.secret() + "\r\n"));
  EXPECT_EQ(page.notice("account").text(), "account a.meier signed in");
  registry_clocks()->steady = registry_clocks()->steady + kRegistryIdle + 1.0;
  skip(10.0);
  EXPECT_EQ(page.notice("account").text(), "account a.meier signed out");
  page.send(to_stop());
  EXPECT_EQ(page.notice("stopped").who(), "page 1 (127.0.0.1)");
}

TEST_F(PeopleCockpit, AnEncryptedRecordingNeedsASessionThatIsSignedIn) {
  const std::string mine = field_of_session(sign_in());
  const std::string added = post("/people/patients", R"({"code": "P07", "side": "left"})", mine);
  const auto record = json::parse(body_of(added)).at("record").get<std::string>();
  const auto key = KeyStore::open(folder_ / "config" / "keys").find(record);
  ASSERT_TRUE(key.has_value());
  std::filesystem::create_directories(folder_ / "recordings");
  {
    mcap::DiskFile disk(folder_ / "recordings" / "2026-05-28T10-00-00Z.mcap.enc");
    mcap::EncryptedFile encrypted(disk, {.id = record, .key = key.value_or(RecordingKey{})});
    mcap::McapWriter writer(encrypted, recording_schemas(), recording_channels(), {});
    writer.add(static_cast<std::uint16_t>(Topic::kEvent), 5'000'000'000, "");
    writer.finish();
  }
  const auto asked = [&](const std::string& fields) {
    return ask(port(), get("/recordings/2026-05-28T10-00-00Z.mcap.enc", "Range: bytes=0-7\r\n" + fields));
  };
  EXPECT_EQ(status_of(asked("")), 409) << "the operator's token alone opens no patient's recording";
  EXPECT_THAT(body_of(asked("")), HasSubstr("sign in"));
  EXPECT_EQ(status_of(asked(mine)), 206);
  EXPECT_THAT(body_of(asked(mine)), HasSubstr("MCAP"));
  EXPECT_EQ(status_of(post("/people/lock", "{}", mine)), 200);
  EXPECT_EQ(status_of(asked(mine)), 409) << "locked";
}

TEST_F(PeopleCockpit, AnAccountWithoutAPageOfTheCockpitIsLoggedToo) {
  static_cast<void>(sign_in());
  static_cast<void>(ask(port(), get("/people")));  // no frame comes while no page is open
  EXPECT_EQ(logged("account"), 1U);
  EXPECT_THAT(log_text(), HasSubstr("account a.meier signed in"));
}

}  // namespace
}  // namespace phalanx

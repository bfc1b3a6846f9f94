// SPDX-License-Identifier: Apache-2.0
#include "phalanx/registry/accounts.h"

#include <gmock/gmock.h>

#include "registry/registry_files.h"

namespace phalanx {
namespace {

using testing::example_patient;
using testing::fault_of;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::kOwner;
using testing::RegistryFiles;
using ::testing::SizeIs;

const std::string kPassword = "correct horse battery";

/// A registry with an account of each role.
struct WithAccounts {
  RegistryFiles files;
  Registry registry = files.open();
  std::string record;
  Actor admin{.account = "ada", .role = Role::kAdministrator};
  Actor therapist{.account = "tom", .role = Role::kTherapist};
  Actor look_on{.account = "lou", .role = Role::kLookOn};
  Actor screen{.account = "screen1", .role = Role::kPatientScreen};

  WithAccounts() {
    record = registry.add_patient(kOwner, example_patient()).record;
    registry.add_account(kOwner, {.name = "ada", .role = Role::kAdministrator}, kPassword);
    for (const Actor& each : {therapist, look_on, screen})
      registry.add_account(admin, {.name = each.account, .role = each.role}, kPassword + each.account);
  }
  [[nodiscard]] RegistryFault wrong(const std::string& name = "tom") {
    return fault_of([&] { static_cast<void>(registry.authenticate(name, "wrong password")); });
  }
};

TEST(Accounts, EndTheOwnerMode) {
  RegistryFiles files;
  Registry registry = files.open();
  EXPECT_FALSE(registry.has_accounts());
  EXPECT_EQ(
      fault_of([&] { registry.add_account(kOwner, {.name = "tom", .role = Role::kTherapist}, kPassword); }),
      RegistryFault::kConflict)
      << "the first one is an administrator";
  registry.add_account(kOwner, {.name = "ada", .role = Role::kAdministrator}, kPassword);
  EXPECT_TRUE(registry.has_accounts());
  EXPECT_EQ(fault_of([&] { static_cast<void>(registry.patients(kOwner)); }), RegistryFault::kSignIn);
  EXPECT_EQ(fault_of([&] {
              static_cast<void>(registry.patients({.account = "eve", .role = Role::kAdministrator}));
            }),
            RegistryFault::kSignIn);
  EXPECT_THAT(files.open().patients(registry.authenticate("ada", kPassword)), IsEmpty());
}

TEST(Accounts, MayOnlyWhatTheirRolePermits) {
  WithAccounts with;
  Registry& registry = with.registry;
  for (const Actor& actor : {with.admin, with.therapist}) {
    EXPECT_THAT(registry.patients(actor), SizeIs(1));
    registry.add_note(actor, with.record, "text");
  }
  for (const Actor& actor :
       {with.look_on, with.screen,
        Actor{.account = "lou", .role = Role::kAdministrator}}) {  // a claimed role does not count
    const auto denied = [&](const std::function<void()>& call) {
      EXPECT_EQ(fault_of(call), RegistryFault::kDenied);
    };
    denied([&] { static_cast<void>(registry.patients(actor)); });
    denied([&] { static_cast<void>(registry.patient(actor, "P07")); });
    denied([&] { static_cast<void>(registry.patient(actor, "P99")); });
    denied([&] { registry.add_patient(actor, example_patient("P08")); });
    denied([&] { registry.edit_patient(actor, example_patient("P08")); });
    denied([&] { registry.delete_patient(actor, with.record); });
    denied([&] { static_cast<void>(registry.results(actor, with.record)); });
    denied([&] { static_cast<void>(registry.recordings_without_result(actor, with.record)); });
    denied([&] { static_cast<void>(registry.tests(actor, with.record)); });
    denied([&] { static_cast<void>(registry.notes(actor, with.record)); });
    denied([&] { static_cast<void>(registry.trends(actor, with.record)); });
    denied([&] { static_cast<void>(registry.recording_keys(actor)); });
    denied([&] { static_cast<void>(registry.recording_key(actor, with.record)); });
    denied([&] { registry.export_patient(actor, with.record, with.files.path("export")); });
    denied([&] { registry.rebuild(actor, {}, {}); });
    denied([&] { registry.backup(actor, with.files.path("backup")); });
  }
  for (const Actor& actor : {with.therapist, with.look_on, with.screen}) {
    const auto denied = [&](const std::function<void()>& call) {
      EXPECT_EQ(fault_of(call), RegistryFault::kDenied);
    };
    denied([&] { static_cast<void>(registry.accounts(actor)); });
    denied([&] { registry.add_account(actor, {.name = "eve", .role = Role::kAdministrator}, kPassword); });
    denied([&] { registry.edit_account(actor, {.name = actor.account, .role = Role::kAdministrator}); });
    denied([&] { registry.delete_account(actor, "ada"); });
    denied([&] { registry.set_password(actor, "ada", kPassword); });
    denied([&] { static_cast<void>(registry.audit(actor)); });
  }
  registry.set_password(with.look_on, "lou", "a new password");
  EXPECT_EQ(registry.authenticate("lou", "a new password").role, Role::kLookOn);
}

TEST(Accounts, KeepAnAdministrator) {
  WithAccounts with;
  EXPECT_EQ(
      fault_of([&] { with.registry.edit_account(with.admin, {.name = "ada", .role = Role::kTherapist}); }),
      RegistryFault::kConflict);
  EXPECT_EQ(fault_of([&] { with.registry.delete_account(with.admin, "ada"); }), RegistryFault::kConflict);
  for (const char* name : {"tom", "lou", "screen1"}) with.registry.delete_account(with.admin, name);
  EXPECT_EQ(fault_of([&] { with.registry.delete_account(with.admin, "tom"); }), RegistryFault::kUnknown);
  with.registry.delete_account(with.admin, "ada");
  EXPECT_FALSE(with.registry.has_accounts());
  EXPECT_THAT(with.registry.patients(kOwner), SizeIs(1));
}

TEST(Accounts, RefuseNamesAndPasswordsOutOfRange) {
  RegistryFiles files;
  Registry registry = files.open();
  const auto add = [&](const std::string& name, const std::string& password) {
    registry.add_account(kOwner, {.name = name, .role = Role::kAdministrator}, password);
  };
  for (const char* name : {"", "owner", "Ada", "1ada", "a b", "a@b", "abcdefghijklmnopqrstuvwxyz1234567"})
    EXPECT_THROW(add(name, kPassword), std::invalid_argument) << name;
  EXPECT_THROW(add("ada", "too short"), std::invalid_argument);
  EXPECT_THROW(add("ada", std::string(257, 'a')), std::invalid_argument);
  add("ada", std::string(256, 'a'));
  EXPECT_EQ(fault_of([&] {
              registry.add_account({.account = "ada"}, {.name = "ada", .role = Role::kTherapist}, kPassword);
            }),
            RegistryFault::kConflict);
  EXPECT_EQ(parse_role("look_on"), Role::kLookOn);
  EXPECT_THROW(static_cast<void>(parse_role("nurse")), std::invalid_argument);
}

TEST(Accounts, AreDelayedAfterWrongPasswords) {
  WithAccounts with;
  const std::string right = kPassword + "tom";
  for (int i = 0; i < 3; ++i) EXPECT_EQ(with.wrong(), RegistryFault::kSignIn);
  EXPECT_EQ(with.wrong(), RegistryFault::kDelayed);
  EXPECT_EQ(fault_of([&] { static_cast<void>(with.registry.authenticate("tom", right)); }),
            RegistryFault::kDelayed)
      << "the right one is not checked either";
  Registry again = with.files.open();
  EXPECT_EQ(fault_of([&] { static_cast<void>(again.sign_in("tom", right)); }), RegistryFault::kDelayed)
      << "another program counts them, too";
  EXPECT_EQ(with.registry.authenticate("ada", kPassword).account, "ada") << "other accounts are not delayed";
  double delay = 2.0;
  for (int i = 0; i < 12; ++i) {
    with.files.utc += delay - 0.5;
    EXPECT_EQ(with.wrong(), RegistryFault::kDelayed) << delay;
    with.files.utc += 0.5;
    EXPECT_EQ(with.wrong(), RegistryFault::kSignIn) << delay;
    delay = std::min(900.0, 2.0 * delay);
  }
  with.files.utc -= 1e6;  // the clock is set back: the delay begins again, and is as long as before
  EXPECT_EQ(with.wrong(), RegistryFault::kDelayed);
  with.files.utc += 899.5;
  EXPECT_EQ(with.wrong(), RegistryFault::kDelayed);
  with.files.utc += 0.5;
  EXPECT_EQ(with.registry.authenticate("tom", right).role, Role::kTherapist);
  EXPECT_EQ(with.wrong(), RegistryFault::kSignIn) << "the count begins again";
}

TEST(Accounts, AnswerUnknownNamesAsWrongPasswords) {
  WithAccounts with;
  for (const char* name : {"nemo", "NEMO", "", "owner"}) {
    for (int i = 0; i < 3 && std::string(name) == "nemo"; ++i)
      EXPECT_EQ(with.wrong(name), RegistryFault::kSignIn);
  }
  EXPECT_EQ(with.wrong("nemo"), RegistryFault::kDelayed) << "as that of an account";
  EXPECT_EQ(with.wrong("NEMO"), RegistryFault::kSignIn);
  EXPECT_EQ(with.wrong(std::string(5000, 'x')), RegistryFault::kSignIn);
  EXPECT_EQ(testing::files_with(with.files.data(), "NEMO"), std::vector<std::string>{});
}

TEST(Accounts, AreLockedAfterAnIdleTime) {
  WithAccounts with;
  const std::string token = with.registry.sign_in("tom", kPassword + "tom");
  EXPECT_EQ(token.size(), 64U);
  EXPECT_EQ(with.registry.signed_in(token).state, SignInState::kActive);
  EXPECT_EQ(with.registry.signed_in(token).actor.account, "tom");
  with.files.steady += 599.0;
  EXPECT_EQ(with.registry.signed_in(token, false).state, SignInState::kActive);
  EXPECT_EQ(with.registry.signed_in(token).state, SignInState::kActive) << "a request restarts the time";
  with.files.steady += 600.0;
  EXPECT_EQ(with.registry.signed_in(token).state, SignInState::kLocked);
  EXPECT_EQ(with.registry.signed_in(token).state, SignInState::kLocked) << "a request does not unlock";
  EXPECT_EQ(fault_of([&] { with.registry.unlock(token, "wrong password"); }), RegistryFault::kSignIn);
  with.registry.unlock(token, kPassword + "tom");
  EXPECT_EQ(with.registry.signed_in(token).state, SignInState::kActive);
  with.registry.lock(token);
  EXPECT_EQ(with.registry.signed_in(token).state, SignInState::kLocked);
  with.files.steady += 43200.0;
  EXPECT_EQ(with.registry.signed_in(token).state, SignInState::kNone) << "no sign-in lasts longer";
  EXPECT_EQ(fault_of([&] { with.registry.unlock(token, kPassword + "tom"); }), RegistryFault::kSignIn);
}

TEST(Accounts, LoseTheirTokensWithTheirAccountOrPassword) {
  WithAccounts with;
  const std::string first = with.registry.sign_in("tom", kPassword + "tom");
  const std::string second = with.registry.sign_in("lou", kPassword + "lou");
  const std::string third = with.registry.sign_in("ada", kPassword);
  with.registry.edit_account(with.admin, {.name = "tom", .role = Role::kLookOn});
  EXPECT_EQ(with.registry.signed_in(first).actor.role, Role::kLookOn) << "the role of now";
  with.registry.set_password(with.admin, "tom", "another password");
  with.registry.delete_account(with.admin, "lou");
  with.registry.sign_out(third);
  for (const std::string& token : {first, second, third, std::string(), std::string(64, '0')})
    EXPECT_EQ(with.registry.signed_in(token).state, SignInState::kNone);
}

TEST(Accounts, AreInTheAuditLog) {
  WithAccounts with;
  const std::string token = with.registry.sign_in("tom", kPassword + "tom");
  EXPECT_EQ(with.wrong("ada"), RegistryFault::kSignIn);
  EXPECT_EQ(with.wrong("nemo"), RegistryFault::kSignIn);
  static_cast<void>(with.registry.patient(with.therapist, "P07"));
  with.registry.sign_out(token);
  std::vector<std::string> lines;
  for (const AuditEntry& entry : with.registry.audit(with.admin, 5))
    lines.push_back(fmt::format("{} {}", entry.account, entry.action));
  EXPECT_THAT(lines, ::testing::ElementsAre("tom sign_in", "ada authenticate_failed", "? authenticate_failed",
                                            "tom show", "tom sign_out"));
}

TEST(Accounts, CannotBeForgedOrLostInTheDataFolder) {
  WithAccounts with;
  const std::filesystem::path file = with.files.data() / "accounts";
  const std::string whole = testing::read_file(file);
  for (const char* text : {"argon2", "administrator"}) EXPECT_EQ(whole.find(text), std::string::npos);

  RegistryFiles foreign;  // accounts of a foreign registry
  foreign.open().add_account(kOwner, {.name = "eve", .role = Role::kAdministrator}, kPassword);
  testing::write_bytes(file, testing::read_file(foreign.data() / "accounts"));
  EXPECT_EQ(fault_of([&] { static_cast<void>(with.files.open().authenticate("eve", kPassword)); }),
            RegistryFault::kDamaged);

  std::filesystem::remove(file);  // without accounts the owner would enter
  Registry registry = with.files.open();
  EXPECT_TRUE(registry.has_accounts());
  EXPECT_EQ(fault_of([&] { static_cast<void>(registry.patients(kOwner)); }), RegistryFault::kDamaged);
  testing::write_bytes(file, whole);
  EXPECT_EQ(with.files.open().authenticate("ada", kPassword).role, Role::kAdministrator);
}

}  // namespace
}  // namespace phalanx

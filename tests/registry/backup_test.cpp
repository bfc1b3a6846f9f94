// SPDX-License-Identifier: Apache-2.0
// Backup and restore.
#include "phalanx/registry/backup.h"

#include <gmock/gmock.h>

#include "registry/registry_files.h"

namespace phalanx {
namespace {

using testing::example_patient;
using testing::example_result;
using testing::fault_of;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::kOwner;
using testing::RegistryFiles;
using ::testing::SizeIs;
using testing::state_text;

struct BackedUp {
  RegistryFiles files;
  std::filesystem::path backup = files.path("backup");
  std::string record;
  std::string state;

  BackedUp() {
    Registry registry = files.open();
    record = registry.add_patient(kOwner, example_patient()).record;
    registry.add_result(kOwner, record, example_result("a.mcap.enc"));
    registry.add_note(kOwner, record, "before");
    state = state_text(registry);
    const BackupReport report = registry.backup(kOwner, backup);
    EXPECT_EQ(report.patients, 1U);
    EXPECT_GT(report.bytes, 4096U);
  }
};

TEST(RegistryBackup, BringsBackALostFolder) {
  BackedUp b;
  std::filesystem::remove_all(b.files.data());
  Registry registry = b.files.open();
  const RestoreReport report = registry.restore(kOwner, b.backup);
  EXPECT_EQ(report.patients, 1U);
  EXPECT_EQ(report.audit_lines_missing, 0U);
  EXPECT_EQ(state_text(registry), b.state);
  EXPECT_FALSE(testing::files_with(b.files.data(), b.record).empty());
  EXPECT_TRUE(registry.check_audit(kOwner).whole) << registry.check_audit(kOwner).text;
  EXPECT_EQ(state_text(registry), b.state);
  EXPECT_THAT(testing::open_to_others(b.files.data()), IsEmpty());
  registry.restore(kOwner, b.backup);
  EXPECT_EQ(state_text(registry), b.state) << "twice changes nothing";
}

TEST(RegistryBackup, StatesTheAuditLinesThatAreLost) {
  BackedUp b;
  for (const char* text : {"after the backup", "and again"}) b.files.open().add_note(kOwner, b.record, text);
  std::filesystem::remove_all(b.files.data());
  Registry registry = b.files.open();
  const RestoreReport report = registry.restore(kOwner, b.backup);
  EXPECT_EQ(report.audit_lines_missing, 2U);
  const AuditCheck check = registry.check_audit(kOwner);
  EXPECT_TRUE(check.whole) << check.text;
  EXPECT_THAT(check.text, HasSubstr("of the audit log are missing"));
}

TEST(RegistryBackup, KeepsWhatIsNewerThanIt) {
  BackedUp b;
  Registry registry = b.files.open();
  registry.add_note(kOwner, b.record, "after");
  Patient patient = registry.patient(kOwner, b.record);
  patient.code = "NEWER";
  registry.edit_patient(kOwner, patient);
  registry.add_patient(kOwner, example_patient("P08"));
  const std::string before = state_text(registry);
  const RestoreReport report = registry.restore(kOwner, b.backup);
  EXPECT_EQ(report.patients, 2U);
  EXPECT_EQ(report.events_added, 0U);
  EXPECT_EQ(state_text(registry), before);
}

TEST(RegistryBackup, BringsBackEventsThatTheJournalLost) {
  BackedUp b;
  {
    Registry registry = b.files.open();
    registry.backup(kOwner, b.files.path("second"));
  }
  for (const char* name : {"registry.sqlite", "registry.sqlite-wal", "registry.sqlite-shm"})
    std::filesystem::remove(b.files.data() / name);
  const std::filesystem::path journal = b.files.data() / "journal" / b.record;
  std::filesystem::resize_file(journal, std::filesystem::file_size(journal) - 20);
  Registry registry = b.files.open();
  EXPECT_THAT(registry.notes(kOwner, b.record), IsEmpty());
  EXPECT_EQ(registry.restore(kOwner, b.backup).events_added, 1U);
  EXPECT_EQ(state_text(registry), b.state);
}

TEST(RegistryBackup, IsJoinedWithAJournalThatLostItsPatient) {
  BackedUp b;
  {
    b.files.open().add_note(kOwner, b.record, "after");
  }
  for (const char* name : {"registry.sqlite", "registry.sqlite-wal", "registry.sqlite-shm"})
    std::filesystem::remove(b.files.data() / name);
  const std::filesystem::path journal = b.files.data() / "journal" / b.record;
  std::string damaged = testing::read_file(journal);
  damaged[100] = static_cast<char>(damaged[100] ^ 1);  // in the first event: the patient
  testing::write_bytes(journal, damaged);
  Registry registry = b.files.open();
  EXPECT_THAT(registry.patients(kOwner), IsEmpty());
  EXPECT_EQ(registry.rebuild(kOwner, {}, {}).damaged_events, 1U);
  EXPECT_EQ(testing::read_file(journal), damaged) << "what can be read of it is not thrown away";
  registry.restore(kOwner, b.backup);
  EXPECT_THAT(registry.patients(kOwner), SizeIs(1));
  EXPECT_THAT(registry.results(kOwner, b.record), SizeIs(1));
  EXPECT_THAT(registry.notes(kOwner, b.record), SizeIs(2));
}

TEST(RegistryBackup, RestoresTheFilesThatAreWholeAndNamesTheOthers) {
  BackedUp b;
  std::filesystem::remove_all(b.files.data());
  const std::filesystem::path database = b.backup / "registry.sqlite";
  std::filesystem::resize_file(database, std::filesystem::file_size(database) - 1);
  std::filesystem::remove(b.backup / "id");
  Registry registry = b.files.open();
  EXPECT_THAT(registry.restore(kOwner, b.backup).damaged_files,
              ::testing::ElementsAre("id", "registry.sqlite"));
  EXPECT_EQ(state_text(registry), b.state);
}

TEST(RegistryBackup, StatesThatAnAuditLogDoesNotFit) {
  BackedUp b;
  std::filesystem::remove_all(b.files.data());
  Registry registry = b.files.open();
  static_cast<void>(registry.patients(kOwner));  // this registry has a log of its own from here on
  EXPECT_TRUE(registry.restore(kOwner, b.backup).audit_log_left_out);
  EXPECT_EQ(state_text(registry), b.state);
}

TEST(RegistryBackup, BringsBackALostOrDamagedFileOfAccounts) {
  RegistryFiles files;
  const std::string password = "a long password";
  const Actor admin{.account = "ada", .role = Role::kAdministrator};
  {
    Registry registry = files.open();
    registry.backup(kOwner, files.path("without"));
    registry.add_account(kOwner, {.name = "ada", .role = Role::kAdministrator}, password);
    registry.backup(admin, files.path("backup"));
  }
  for (const bool is_missing : {true, false}) {
    SCOPED_TRACE(is_missing);
    if (is_missing) {
      std::filesystem::remove(files.data() / "accounts");
    } else {
      testing::write_bytes(files.data() / "accounts", "00ff\n");
    }
    Registry registry = files.open();
    EXPECT_TRUE(registry.accounts_lost());
    EXPECT_EQ(fault_of([&] { static_cast<void>(registry.patients(kOwner)); }), RegistryFault::kDamaged);
    EXPECT_TRUE(registry.restore(kOwner, files.path("without")).accounts_left_out);
    EXPECT_TRUE(registry.accounts_lost());
    EXPECT_FALSE(registry.restore(kOwner, files.path("backup")).accounts_left_out);
    EXPECT_FALSE(registry.accounts_lost());
    EXPECT_THAT(registry.patients(registry.authenticate("ada", password)), IsEmpty());
  }
}

TEST(RegistryBackup, IsRefusedIfItsManifestIsDamagedOrNewer) {
  BackedUp b;
  Registry registry = b.files.open();
  const std::string before = state_text(registry);
  const std::string manifest = testing::read_file(b.backup / "manifest.json");
  const auto refusal = [&] { return fault_of([&] { registry.restore(kOwner, b.backup); }); };
  const auto damage = [](std::string text) {
    text[text.size() / 2] = static_cast<char>(text[text.size() / 2] ^ 1);
    return text;
  };
  for (const std::filesystem::path& file : testing::files_below(b.backup)) {
    if (file.filename() == "manifest.json") continue;
    const std::string whole = testing::read_file(file);
    testing::write_bytes(file, damage(whole));
    EXPECT_THAT(registry.restore(kOwner, b.backup).damaged_files,
                ::testing::ElementsAre(file.lexically_relative(b.backup).string()));
    testing::write_bytes(file, whole);
  }
  testing::write_bytes(b.backup / "manifest.json", manifest.substr(0, manifest.size() / 2));
  EXPECT_EQ(refusal(), RegistryFault::kDamaged);
  std::string newer = manifest;
  newer.replace(newer.find("\"schema\": 1"), 11, "\"schema\": 2");
  testing::write_bytes(b.backup / "manifest.json", newer);
  EXPECT_EQ(refusal(), RegistryFault::kNewer);
  std::string foreign = manifest;
  foreign.replace(foreign.find("\"id\""), 4, "\"../id\"");
  testing::write_bytes(b.backup / "manifest.json", foreign);
  EXPECT_EQ(refusal(), RegistryFault::kDamaged);
  EXPECT_EQ(fault_of([&] { registry.restore(kOwner, b.files.path("nowhere")); }), RegistryFault::kUnknown);
  EXPECT_EQ(state_text(registry), before);
}

TEST(RegistryBackup, IsNotWrittenOverAnother) {
  BackedUp b;
  Registry registry = b.files.open();
  EXPECT_EQ(fault_of([&] { registry.backup(kOwner, b.backup); }), RegistryFault::kConflict);
  EXPECT_THROW(registry.backup(kOwner, b.files.data() / "backup"), std::invalid_argument);
}

TEST(RegistryBackup, BringsBackAccounts) {
  RegistryFiles files;
  const std::string password = "a long password";
  const Actor admin{.account = "ada", .role = Role::kAdministrator};
  {
    Registry registry = files.open();
    registry.add_account(kOwner, {.name = "ada", .role = Role::kAdministrator}, password);
    registry.add_account(admin, {.name = "tom", .role = Role::kTherapist}, password);
    registry.add_patient(admin, example_patient());
    registry.backup({.account = "tom", .role = Role::kTherapist}, files.path("backup"));
    EXPECT_EQ(fault_of([&] {
                registry.restore({.account = "tom", .role = Role::kTherapist}, files.path("backup"));
              }),
              RegistryFault::kDenied);
  }
  std::filesystem::remove_all(files.data());
  Registry registry = files.open();
  registry.restore(kOwner, files.path("backup"));
  EXPECT_EQ(fault_of([&] { static_cast<void>(registry.patients(kOwner)); }), RegistryFault::kSignIn);
  EXPECT_THAT(registry.patients(registry.authenticate("tom", password)), SizeIs(1));
}

TEST(RegistryBackup, HoldsNoKey) {
  BackedUp b;
  const RecordingKey key = b.files.keys().find(b.record).value();
  EXPECT_THAT(testing::files_with(b.backup, std::string(key.begin(), key.end())), IsEmpty());
  Registry other({.folder = b.files.path("elsewhere")}, KeyStore::create(b.files.path("other/keys")));
  const RestoreReport report = other.restore(kOwner, b.backup);
  EXPECT_THAT(report.without_key, ::testing::ElementsAre(b.record));
  EXPECT_THAT(other.patients(kOwner), IsEmpty());
}

}  // namespace
}  // namespace phalanx

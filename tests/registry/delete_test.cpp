// SPDX-License-Identifier: Apache-2.0
// Deletion of a patient, searched byte by byte.
#include <gmock/gmock.h>
#include <sqlite3.h>

#include "registry/registry_files.h"

namespace phalanx {
namespace {

using ::testing::ElementsAre;
using testing::example_patient;
using testing::example_result;
using testing::fault_of;
using testing::files_with;
using ::testing::IsEmpty;
using testing::kOwner;
using testing::RegistryFiles;
using ::testing::SizeIs;

const std::string kCode = "ZQ7X4K-DEL";

/// A registry with a patient who has everything that a patient can have, and another one.
struct Filled {
  RegistryFiles files;
  std::string record;
  std::string other;

  Filled() {
    Registry registry = files.open();
    other = registry.add_patient(kOwner, example_patient("P01")).record;
    record = registry.add_patient(kOwner, example_patient(kCode)).record;
    registry.add_result(kOwner, other, example_result("other.mcap.enc"));
    registry.add_result(kOwner, record, example_result("a.mcap.enc"));
    registry.add_result(kOwner, record, example_result("plain.mcap"));
    registry.add_recording(kOwner, record, "later.mcap");
    registry.add_note(kOwner, record, "about " + kCode);
    registry.export_patient(kOwner, record, files.path("first_export"));
    registry.export_patient(kOwner, record, files.path("export"));
  }
  [[nodiscard]] std::vector<std::string> found(const std::string& text) const {
    std::vector<std::string> out;
    for (const char* folder : {"data", "config", "export", "first_export", "backup"})
      for (const std::string& file : files_with(files.path(folder), text)) out.push_back(file);
    return out;
  }
};

TEST(RegistryDelete, LeavesNoByteOfTheCode) {
  Filled filled;
  ASSERT_THAT(filled.found(kCode), SizeIs(4)) << "the exported patient.json and results.csv, twice";
  std::string key_bytes;
  {
    Registry registry = filled.files.open();
    const RecordingKey key = registry.recording_key(kOwner, filled.record).key;
    key_bytes.assign(key.begin(), key.end());
    const DeleteReport report = registry.delete_patient(kOwner, filled.record);
    EXPECT_EQ(report.record, filled.record);
    EXPECT_THAT(report.exports_removed, SizeIs(6));
    EXPECT_THAT(report.exports_missing, IsEmpty());
    EXPECT_THAT(report.encrypted_recordings, ElementsAre("a.mcap.enc"));
    EXPECT_THAT(report.plain_recordings, ElementsAre("later.mcap", "plain.mcap"));
    EXPECT_THAT(filled.found(kCode), IsEmpty()) << "while the registry is open: the write-ahead log, too";
    EXPECT_THAT(registry.patients(kOwner), SizeIs(1));
    EXPECT_EQ(fault_of([&] { static_cast<void>(registry.results(kOwner, filled.record)); }),
              RegistryFault::kUnknown);
    EXPECT_THAT(registry.results(kOwner, filled.other), SizeIs(1));
  }
  EXPECT_THAT(filled.found(kCode), IsEmpty());
  EXPECT_THAT(filled.found(key_bytes), IsEmpty());
  EXPECT_FALSE(std::filesystem::exists(filled.files.path("export")));
  std::vector<std::string> names;
  for (const std::string& file : filled.found(filled.record))
    names.push_back(std::filesystem::path(file).filename().string());
  std::sort(names.begin(), names.end());
  EXPECT_THAT(names, ElementsAre("audit.jsonl", "deleted", "keys", "registry.sqlite"))
      << "only the random record id remains";
}

TEST(RegistryDelete, LeavesNoSealedRowInDatabaseOrWriteAheadLog) {
  Filled filled;
  Registry registry = filled.files.open();
  std::vector<std::string> sealed;
  sqlite3* db = nullptr;
  ASSERT_EQ(sqlite3_open((filled.files.data() / "registry.sqlite").c_str(), &db), SQLITE_OK);
  for (const char* table : {"patients", "results", "entries"}) {
    sqlite3_stmt* statement = nullptr;
    const std::string query = fmt::format("SELECT sealed FROM {} WHERE record = '{}'", table, filled.record);
    ASSERT_EQ(sqlite3_prepare_v2(db, query.c_str(), -1, &statement, nullptr), SQLITE_OK);
    while (sqlite3_step(statement) == SQLITE_ROW)
      sealed.emplace_back(reinterpret_cast<const char*>(sqlite3_column_text(statement, 0)));
    sqlite3_finalize(statement);
  }
  sqlite3_close(db);
  ASSERT_THAT(sealed, SizeIs(1 + 2 + 8)) << "patient, results, recording, note, exports";
  for (const std::string& row : sealed)
    ASSERT_FALSE(files_with(filled.files.data(), row.substr(0, 64)).empty());
  registry.delete_patient(kOwner, filled.record);
  for (const std::string& row : sealed)
    EXPECT_THAT(files_with(filled.files.data(), row.substr(0, 64)), IsEmpty());
}

TEST(RegistryDelete, ReportsExportsThatWereMoved) {
  Filled filled;
  std::filesystem::rename(filled.files.path("export/patient.json"), filled.files.path("moved.json"));
  testing::write_bytes(filled.files.path("export/results.csv"), "another file of that name");
  Registry registry = filled.files.open();
  const DeleteReport report = registry.delete_patient(kOwner, filled.record);
  EXPECT_THAT(report.exports_missing,
              ElementsAre(filled.files.path("export/patient.json"), filled.files.path("export/results.csv")));
  EXPECT_EQ(testing::read_file(filled.files.path("export/results.csv")), "another file of that name");
}

TEST(RegistryDelete, FindsAnExportThatAKillInterrupted) {
  Filled filled;
  std::filesystem::rename(filled.files.path("export/patient.json"),
                          filled.files.path("export/patient.json.new"));
  filled.files.open().delete_patient(kOwner, filled.record);
  EXPECT_THAT(filled.found(kCode), IsEmpty());
}

TEST(RegistryDelete, RefusesAnExportIntoTheDataFolder) {
  Filled filled;
  Registry registry = filled.files.open();
  EXPECT_THROW(registry.export_patient(kOwner, filled.record), std::invalid_argument);
  EXPECT_THROW(registry.export_patient(kOwner, filled.record, filled.files.data() / "export"),
               std::invalid_argument);
}

TEST(RegistryDelete, NeedsNoKeyAndNoReadableRow) {
  Filled filled;
  const std::string journal = testing::read_file(filled.files.data() / "journal" / filled.record);
  sqlite3* db = nullptr;
  ASSERT_EQ(sqlite3_open((filled.files.data() / "registry.sqlite").c_str(), &db), SQLITE_OK);
  const std::string damage =
      fmt::format("UPDATE patients SET sealed = '00' WHERE record = '{}'", filled.record);
  ASSERT_EQ(sqlite3_exec(db, damage.c_str(), nullptr, nullptr, nullptr), SQLITE_OK);
  sqlite3_close(db);
  std::string damaged = journal;
  for (std::size_t i = 60; i < damaged.size(); ++i) damaged[i] = static_cast<char>(damaged[i] ^ 1);
  testing::write_bytes(filled.files.data() / "journal" / filled.record, damaged);
  Registry registry = filled.files.open();
  EXPECT_THAT(registry.patients(kOwner), SizeIs(1)) << "one damaged record does not hide the others";
  EXPECT_THAT(registry.damaged_patients(kOwner), ElementsAre(filled.record));
  EXPECT_EQ(fault_of([&] { static_cast<void>(registry.patient(kOwner, filled.record)); }),
            RegistryFault::kDamaged);
  registry.add_patient(kOwner, example_patient("P02"));
  EXPECT_EQ(registry.delete_patient(kOwner, filled.record).unreadable_rows, 1U);
  EXPECT_THAT(registry.damaged_patients(kOwner), IsEmpty());
  EXPECT_EQ(filled.files.keys().find(filled.record), std::nullopt);
}

TEST(RegistryDelete, ReachesABackup) {
  Filled filled;
  Registry registry = filled.files.open();
  registry.backup(kOwner, filled.files.path("backup"));
  registry.delete_patient(kOwner, filled.record);
  EXPECT_THAT(filled.found(kCode), IsEmpty()) << "the backup is sealed";
  const RestoreReport report = registry.restore(kOwner, filled.files.path("backup"));
  EXPECT_EQ(report.deleted_stay_deleted, 1U);
  EXPECT_EQ(report.patients, 1U);
  EXPECT_EQ(fault_of([&] { static_cast<void>(registry.patient(kOwner, kCode)); }), RegistryFault::kUnknown);
  EXPECT_THAT(registry.patients_without_key(kOwner), IsEmpty());
}

TEST(RegistryDelete, AlsoHoldsIfAnOldKeyFileIsPutBack) {
  Filled filled;
  const std::string keys = testing::read_file(filled.files.keys_file());
  {
    filled.files.open().delete_patient(kOwner, filled.record);
  }
  testing::write_bytes(filled.files.keys_file(), keys);
  EXPECT_TRUE(filled.files.keys().find(filled.record).has_value());
  Registry registry = filled.files.open();
  EXPECT_EQ(filled.files.keys().find(filled.record), std::nullopt) << "it is erased again";
  EXPECT_THAT(registry.patients(kOwner), SizeIs(1));
}

TEST(RegistryDelete, IsNotDoneByAForgedMark) {
  Filled filled;
  testing::write_bytes(filled.files.data() / "deleted",
                       filled.record + " " + std::string(120, 'a') + "\n" + filled.other + "\n");
  Registry registry = filled.files.open();
  EXPECT_THAT(registry.patients(kOwner), SizeIs(2));
  EXPECT_TRUE(filled.files.keys().find(filled.record).has_value());
}

TEST(RegistryDelete, IsCompletedWhenOnlyTheKeyWasErased) {
  Filled filled;
  filled.files.keys().erase(filled.record);  // as after a kill
  Registry registry = filled.files.open();
  EXPECT_THAT(registry.patients(kOwner), SizeIs(1));
  EXPECT_FALSE(std::filesystem::exists(filled.files.data() / "journal" / filled.record));
  EXPECT_THAT(files_with(filled.files.data(), kCode), IsEmpty());
}

}  // namespace
}  // namespace phalanx

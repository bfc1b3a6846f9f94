// SPDX-License-Identifier: Apache-2.0
#include "phalanx/registry/registry.h"

#include <gmock/gmock.h>
#include <sqlite3.h>

#include <algorithm>
#include <fstream>
#include <iterator>

#include "registry/registry_files.h"

namespace phalanx {
namespace {

using ::testing::ElementsAre;
using testing::example_patient;
using testing::example_result;
using testing::fault_of;
using ::testing::IsEmpty;
using testing::kOwner;
using testing::RegistryFiles;
using ::testing::SizeIs;

EnteredTest example_test() {
  return {.kind = TestKind::kGrip,
          .value = 12.5,
          .side = TestSide::kMoreAffected,
          .date = "2026-05-04",
          .rater = "LW",
          .note = "by Jamar"};
}

TEST(Registry, KeepsAPatientWithAllFields) {
  RegistryFiles files;
  std::string record;
  std::string whole;
  {
    Registry registry = files.open();
    const Patient added = registry.add_patient(kOwner, example_patient());
    record = added.record;
    whole = patient_json(added);
    EXPECT_TRUE(is_record_id(record));
    EXPECT_TRUE(files.keys().find(record).has_value());
  }
  Registry registry = files.open();
  EXPECT_EQ(patient_json(registry.patient(kOwner, "P07")), whole);
  EXPECT_EQ(patient_json(registry.patient(kOwner, record)), whole);
  EXPECT_THAT(registry.patients(kOwner), SizeIs(1));
  EXPECT_EQ(fault_of([&] { static_cast<void>(registry.patient(kOwner, "P08")); }), RegistryFault::kUnknown);
}

TEST(Registry, ChoosesSymbolsThatDiffer) {
  RegistryFiles files;
  Registry registry = files.open();
  std::set<std::string> symbols;
  for (int i = 0; i < 4; ++i) {
    Patient patient = example_patient(fmt::format("P{}", i));
    patient.symbol.clear();
    symbols.insert(registry.add_patient(kOwner, patient).symbol);
  }
  EXPECT_THAT(symbols, SizeIs(4));
}

TEST(Registry, HasACodeOnceAmongTheLiving) {
  RegistryFiles files;
  Registry registry = files.open();
  const Patient first = registry.add_patient(kOwner, example_patient());
  EXPECT_EQ(fault_of([&] { registry.add_patient(kOwner, example_patient()); }), RegistryFault::kConflict);
  Patient second = registry.add_patient(kOwner, example_patient("P08"));
  second.code = "P07";
  EXPECT_EQ(fault_of([&] { registry.edit_patient(kOwner, second); }), RegistryFault::kConflict);
  registry.delete_patient(kOwner, first.record);
  registry.edit_patient(kOwner, second);
  EXPECT_EQ(registry.patient(kOwner, "P07").record, second.record);
}

TEST(Registry, ReplacesAllFieldsOnAnEdit) {
  RegistryFiles files;
  Registry registry = files.open();
  Patient patient = registry.add_patient(kOwner, example_patient());
  patient.code = "Q1";
  patient.entry.reset();
  patient.force_limit_n = 2.5;
  patient.prescription.clear();
  registry.edit_patient(kOwner, patient);
  EXPECT_EQ(patient_json(registry.patient(kOwner, "Q1")), patient_json(patient));
  patient.force_limit_n = -1.0;
  EXPECT_THROW(registry.edit_patient(kOwner, patient), std::invalid_argument);
  patient.record = std::string(32, '0');
  patient.force_limit_n = 1.0;
  EXPECT_EQ(fault_of([&] { registry.edit_patient(kOwner, patient); }), RegistryFault::kUnknown);
  EXPECT_EQ(registry.patient(kOwner, "Q1").force_limit_n, 2.5);
}

TEST(Registry, MakesAChangeOnceMoreAfterAConflict) {
  RegistryFiles files;
  Registry registry = files.open();
  const std::string record = registry.add_patient(kOwner, example_patient()).record;
  int calls = 0;
  int others = 1;
  const auto change = [&](Patient& patient) {
    ++calls;
    if (others > 0) {
      --others;
      Patient other = registry.patient(kOwner, record);
      other.note = fmt::format("another change, {}", calls);
      registry.edit_patient(kOwner, other);
    }
    patient.own_force_n[1] = 7.25;
    return true;
  };
  EXPECT_TRUE(update_patient(registry, kOwner, record, change));
  EXPECT_EQ(calls, 2);
  EXPECT_EQ(registry.patient(kOwner, record).note, "another change, 1");
  EXPECT_EQ(registry.patient(kOwner, record).own_force_n[1], 7.25);
  others = 2;
  EXPECT_EQ(fault_of([&] { update_patient(registry, kOwner, record, change); }), RegistryFault::kConflict);
  EXPECT_EQ(calls, 4) << "not a third time";
  EXPECT_EQ(registry.patient(kOwner, record).note, "another change, 4");
  const std::string before = patient_revision(registry.patient(kOwner, record));
  EXPECT_FALSE(update_patient(registry, kOwner, record, [](Patient& patient) {
    patient.note = "not stored";
    return false;
  }));
  EXPECT_EQ(patient_revision(registry.patient(kOwner, record)), before);
}

TEST(Registry, NamesTheRecordingsThatHaveNoResult) {
  RegistryFiles files;
  Registry registry = files.open();
  const std::string record = registry.add_patient(kOwner, example_patient()).record;
  const std::string other = registry.add_patient(kOwner, example_patient("P08")).record;
  for (const char* name : {"c.mcap.enc", "a.mcap.enc", "b.mcap"})
    registry.add_recording(kOwner, record, name);
  registry.add_recording(kOwner, other, "d.mcap");
  EXPECT_THAT(registry.recordings_without_result(kOwner, record),
              ElementsAre("a.mcap.enc", "b.mcap", "c.mcap.enc"));
  registry.add_result(kOwner, record, example_result("b.mcap"));
  EXPECT_THAT(registry.recordings_without_result(kOwner, record), ElementsAre("a.mcap.enc", "c.mcap.enc"));
  EXPECT_THAT(registry.recordings_without_result(kOwner, other), ElementsAre("d.mcap"));
}

TEST(Registry, RefusesAnEditOfFieldsThatChangedMeanwhile) {
  RegistryFiles files;
  Registry registry = files.open();
  Patient first = registry.add_patient(kOwner, example_patient());
  Patient second = first;
  const std::string base = patient_revision(first);
  first.note = "of the first editor";
  second.note = "of the second editor";
  registry.edit_patient(kOwner, first, base);
  EXPECT_EQ(fault_of([&] { registry.edit_patient(kOwner, second, base); }), RegistryFault::kConflict);
  EXPECT_EQ(registry.patient(kOwner, "P07").note, "of the first editor");
  registry.edit_patient(kOwner, second, patient_revision(first));
  EXPECT_EQ(registry.patient(kOwner, "P07").note, "of the second editor");
}

TEST(Registry, AddsAResultOnce) {
  RegistryFiles files;
  Registry registry = files.open();
  const std::string record = registry.add_patient(kOwner, example_patient()).record;
  EXPECT_TRUE(registry.add_result(kOwner, record, example_result("a.mcap.enc", 1)));
  EXPECT_FALSE(registry.add_result(kOwner, record, example_result("a.mcap.enc", 1)));
  EXPECT_FALSE(registry.add_result(kOwner, record, example_result("a.mcap.enc", 1, 99.0)))
      << "the first one stays";
  EXPECT_TRUE(registry.add_result(kOwner, record, example_result("a.mcap.enc", 2)));
  Registry again = files.open();
  const std::vector<ResultRow> rows = again.results(kOwner, record);
  ASSERT_THAT(rows, SizeIs(2));
  EXPECT_EQ(result_json(rows[0]), result_json(example_result("a.mcap.enc", 1)));
}

TEST(Registry, KeepsTestsAndNotesInTheirOrder) {
  RegistryFiles files;
  Registry registry = files.open();
  const std::string record = registry.add_patient(kOwner, example_patient()).record;
  EnteredTest test = example_test();
  registry.add_test(kOwner, record, test);
  registry.add_test(kOwner, record, test);
  test.value = 16.0;
  test.date = "2026-06-01";
  registry.add_test(kOwner, record, test);
  registry.add_note(kOwner, record, "first");
  files.utc += 60.0;
  registry.add_note(kOwner, record, "second");
  const std::vector<EnteredTest> tests = files.open().tests(kOwner, record);
  ASSERT_THAT(tests, SizeIs(3)) << "two equal entries are two tests";
  EXPECT_EQ(test_json(tests[0]), test_json(example_test()));
  const std::vector<PatientNote> notes = files.open().notes(kOwner, record);
  ASSERT_THAT(notes, SizeIs(2));
  EXPECT_EQ(notes[0].text, "first");
  EXPECT_EQ(notes[1].date, files.utc);
  EXPECT_EQ(notes[1].account, "owner");
  EXPECT_TRUE(registry.trends(kOwner, record).at(0).proven) << "3.5 kg of 2.9 kg";
  EXPECT_THROW(registry.add_note(kOwner, record, ""), std::invalid_argument);
}

TEST(Registry, IsSharedBySeveralPrograms) {
  RegistryFiles files;
  Registry first = files.open();
  Registry second = files.open();
  const std::string record = first.add_patient(kOwner, example_patient()).record;
  second.add_note(kOwner, record, "from the second");
  first.add_note(kOwner, record, "from the first");
  second.add_result(kOwner, record, example_result("a.mcap"));
  EXPECT_THAT(first.notes(kOwner, record), SizeIs(2));
  EXPECT_FALSE(first.add_result(kOwner, record, example_result("a.mcap")));
  second.delete_patient(kOwner, record);
  EXPECT_THAT(first.patients(kOwner), IsEmpty());
  EXPECT_TRUE(first.check_audit(kOwner).whole) << first.check_audit(kOwner).text;
}

TEST(Registry, AnExportInMemoryEqualsThatOnTheDiskAndIsWrittenNowhere) {
  RegistryFiles files;
  Registry registry = files.open();
  const std::string record = registry.add_patient(kOwner, example_patient()).record;
  registry.add_result(kOwner, record, example_result("a.mcap"));
  registry.add_note(kOwner, record, "cold \xC3\xA4hand, \"dry\"");
  const std::vector<ExportText> texts = registry.export_texts(kOwner, record);
  const auto exports = [&] {
    const auto all = registry.audit(kOwner);
    return std::count_if(all.begin(), all.end(), [&](const AuditEntry& entry) {
      return entry.action == "export" && entry.record == record;
    });
  };
  EXPECT_EQ(exports(), 1);
  const ExportReport report = registry.export_patient(kOwner, record, files.path("export"));
  EXPECT_EQ(exports(), 2);
  ASSERT_EQ(texts.size(), report.files.size());
  for (std::size_t i = 0; i < texts.size(); ++i) {
    EXPECT_EQ(texts[i].name, report.files[i].filename().string());
    std::ifstream file(report.files[i]);
    EXPECT_EQ(texts[i].text, std::string(std::istreambuf_iterator<char>(file), {})) << texts[i].name;
  }
  EXPECT_THAT(texts[1].text, ::testing::HasSubstr("a.mcap"));
  EXPECT_THROW(static_cast<void>(registry.export_texts(kOwner, std::string(32, 'f'))), RegistryError);
}

TEST(Registry, HasFilesThatOthersCannotRead) {
  RegistryFiles files;
  Registry registry = files.open();
  const std::string record = registry.add_patient(kOwner, example_patient()).record;
  registry.add_result(kOwner, record, example_result("a.mcap"));
  registry.export_patient(kOwner, record, files.path("export"));
  registry.backup(kOwner, files.path("backup"));
  EXPECT_THAT(testing::open_to_others(files.data()), IsEmpty());
  EXPECT_THAT(testing::open_to_others(files.path("export")), IsEmpty());
  EXPECT_THAT(testing::open_to_others(files.path("backup")), IsEmpty());
  struct stat state{};
  ASSERT_EQ(::stat(files.data().c_str(), &state), 0);
  EXPECT_EQ(state.st_mode & 0777U, 0700U);
}

TEST(Registry, RefusesANewerSchemaInWords) {
  RegistryFiles files;
  {
    static_cast<void>(files.open().add_patient(kOwner, example_patient()));
  }
  sqlite3* db = nullptr;
  ASSERT_EQ(sqlite3_open((files.data() / "registry.sqlite").c_str(), &db), SQLITE_OK);
  ASSERT_EQ(sqlite3_exec(db, "PRAGMA user_version = 2", nullptr, nullptr, nullptr), SQLITE_OK);
  sqlite3_close(db);
  try {
    static_cast<void>(files.open());
    FAIL();
  } catch (const RegistryError& error) {
    EXPECT_EQ(error.fault(), RegistryFault::kNewer);
    EXPECT_THAT(error.what(),
                ::testing::HasSubstr("has schema 2; this program knows 1: install a newer one"));
  }
}

TEST(Registry, RefusesADamagedDatabaseWithARemedyThatWorks) {
  RegistryFiles files;
  std::string before;
  {
    Registry registry = files.open();
    registry.add_patient(kOwner, example_patient());
    before = testing::state_text(registry);
  }
  testing::write_bytes(files.data() / "registry.sqlite", std::string(8192, 'x'));
  try {
    static_cast<void>(files.open());
    FAIL();
  } catch (const RegistryError& error) {
    EXPECT_EQ(error.fault(), RegistryFault::kDamaged);
    EXPECT_THAT(error.what(), ::testing::HasSubstr("move it away"));
  }
  for (const char* name : {"registry.sqlite", "registry.sqlite-wal", "registry.sqlite-shm"})
    std::filesystem::remove(files.data() / name);
  Registry registry = files.open();
  EXPECT_EQ(testing::state_text(registry), before);
}

TEST(Registry, RefusesAKeyFileInTheDataFolder) {
  RegistryFiles files;
  EXPECT_THROW(Registry(files.settings(), KeyStore::create(files.data() / "keys")), std::invalid_argument);
}

TEST(Registry, RevealsNothingWithoutTheKeys) {
  RegistryFiles files;
  {
    Registry registry = files.open();
    const std::string record = registry.add_patient(kOwner, example_patient("PX93QZ")).record;
    registry.add_result(kOwner, record, example_result("2026-05-04T09-46-40Z.mcap.enc"));
    registry.add_test(kOwner, record, example_test());
    registry.add_note(kOwner, record, "slept badly");
    registry.backup(kOwner, files.path("backup"));
  }
  for (const std::filesystem::path& folder : {files.data(), files.path("backup"), files.path("config")})
    for (const char* text : {"PX93QZ", "fragile", "stroke", "press_and_hold", "mean_n", "09-46-40", "grip",
                             "Jamar", "slept", "boat", "simulated", "left_p07"})
      EXPECT_THAT(testing::files_with(folder, text), IsEmpty()) << text;
  Registry other(files.settings(), KeyStore::create(files.path("other/keys")));
  EXPECT_THAT(other.patients(kOwner), IsEmpty());
  EXPECT_THAT(other.patients_without_key(kOwner), SizeIs(1));
  EXPECT_EQ(
      fault_of([&] { static_cast<void>(other.results(kOwner, other.patients_without_key(kOwner)[0])); }),
      RegistryFault::kNoKey);
  Registry back = files.open();
  EXPECT_THAT(back.patients(kOwner), SizeIs(1)) << "a wrong key file must not destroy anything";
}

TEST(Registry, RefusesRowsThatWereMovedToAnotherPatient) {
  RegistryFiles files;
  std::string first;
  std::string second;
  {
    Registry registry = files.open();
    first = registry.add_patient(kOwner, example_patient("P1")).record;
    second = registry.add_patient(kOwner, example_patient("P2")).record;
    registry.add_result(kOwner, first, example_result("a.mcap"));
  }
  sqlite3* db = nullptr;
  ASSERT_EQ(sqlite3_open((files.data() / "registry.sqlite").c_str(), &db), SQLITE_OK);
  const std::string change = fmt::format("UPDATE results SET record = '{}'", second);
  ASSERT_EQ(sqlite3_exec(db, change.c_str(), nullptr, nullptr, nullptr), SQLITE_OK);
  sqlite3_close(db);
  Registry registry = files.open();
  EXPECT_EQ(fault_of([&] { static_cast<void>(registry.results(kOwner, second)); }), RegistryFault::kDamaged);
  const RebuildReport report = registry.rebuild(kOwner, {}, {});
  EXPECT_EQ(report.results, 1U);
  EXPECT_THAT(registry.results(kOwner, first), SizeIs(1));
  EXPECT_THAT(registry.results(kOwner, second), IsEmpty());
}

TEST(Registry, GivesTheKeyOfTheRecordings) {
  RegistryFiles files;
  Registry registry = files.open();
  const std::string record = registry.add_patient(kOwner, example_patient()).record;
  const RecordingEncryption encryption = registry.recording_key(kOwner, record);
  EXPECT_EQ(encryption.id, record);
  EXPECT_EQ(registry.recording_keys(kOwner)(record), encryption.key);
  registry.delete_patient(kOwner, record);
  EXPECT_EQ(registry.recording_keys(kOwner)(record), std::nullopt);
}

}  // namespace
}  // namespace phalanx

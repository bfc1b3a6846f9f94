// SPDX-License-Identifier: Apache-2.0
// The rows again, from journal and recordings.
#include <gmock/gmock.h>

#include <map>

#include "registry/registry_files.h"

namespace phalanx {
namespace {

using ::testing::ElementsAre;
using testing::example_patient;
using testing::example_result;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::kOwner;
using testing::RegistryFiles;
using ::testing::SizeIs;
using testing::state_text;

/// Recordings of these tests: a text file with the record id, empty if it is not encrypted. The rows
/// are given apart.
class Recordings {
 public:
  explicit Recordings(std::filesystem::path folder) : folder_(std::move(folder)) {
    std::filesystem::create_directories(folder_);
  }
  void add(const std::string& name, const std::string& id, std::vector<ResultRow> rows) {
    testing::write_bytes(folder_ / name, id);
    rows_[name] = std::move(rows);
  }
  [[nodiscard]] RecordedResultsOf reader() const {
    return [this](const std::filesystem::path& file, const FindRecordingKey& keys) {
      const std::string id = testing::read_file(file);
      if (id == "torn") throw std::runtime_error("it has no end; repair it");
      if (!id.empty() && !keys(id)) throw std::runtime_error("its key is not here");
      return rows_.at(file.filename().string());
    };
  }
  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }

 private:
  std::filesystem::path folder_;
  std::map<std::string, std::vector<ResultRow>> rows_;
};

struct Recorded {
  RegistryFiles files;
  Recordings recordings{files.path("recordings")};
  Registry registry = files.open();
  std::string first = registry.add_patient(kOwner, example_patient("P1")).record;
  std::string second = registry.add_patient(kOwner, example_patient("P2")).record;

  RebuildReport rebuild() { return registry.rebuild(kOwner, {recordings.folder()}, recordings.reader()); }
  /// Removes the database, as a failing disk does.
  void lose_database() {
    registry = Registry({.folder = files.path("elsewhere")}, testing::keys_of(files.path("other/keys")));
    for (const char* name : {"registry.sqlite", "registry.sqlite-wal", "registry.sqlite-shm"})
      std::filesystem::remove(files.data() / name);
    registry = files.open();
  }
};

TEST(RegistryRebuild, MakesTheSameRowsFromJournalAndRecordings) {
  Recorded r;
  r.recordings.add("a.mcap.enc", r.first, {example_result("a.mcap.enc", 1), example_result("a.mcap.enc", 2)});
  for (int number : {1, 2}) r.registry.add_result(kOwner, r.first, example_result("a.mcap.enc", number));
  r.registry.add_note(kOwner, r.second, "a note");
  r.registry.add_test(kOwner, r.second,
                      {.kind = TestKind::kAshworth,
                       .value = 2,
                       .side = TestSide::kLessAffected,
                       .date = "2026-05-04",
                       .rater = "A",
                       .note = {}});
  const std::string before = state_text(r.registry);
  const RebuildReport report = r.rebuild();
  EXPECT_EQ(report.patients, 2U);
  EXPECT_EQ(report.results, 2U);
  EXPECT_EQ(report.tests, 1U);
  EXPECT_EQ(report.notes, 1U);
  EXPECT_EQ(report.added + report.changed, 0U);
  EXPECT_THAT(report.kept_without_file, IsEmpty());
  EXPECT_EQ(state_text(r.registry), before);
  r.lose_database();
  EXPECT_EQ(state_text(r.registry), before);
  r.rebuild();
  EXPECT_EQ(state_text(r.registry), before);
}

TEST(RegistryRebuild, AddsWhatARecordingHasAndTheRegistryHasNot) {
  Recorded r;
  r.recordings.add("a.mcap.enc", r.second,
                   {example_result("another name", 1), example_result("another name", 2, 7.0)});
  EXPECT_EQ(r.rebuild().added, 2U);
  EXPECT_THAT(r.registry.results(kOwner, r.first), IsEmpty());
  ASSERT_THAT(r.registry.results(kOwner, r.second), SizeIs(2));
  EXPECT_EQ(r.registry.results(kOwner, r.second)[0].recording, "a.mcap.enc") << "the file's own name counts";
  EXPECT_EQ(r.rebuild().added, 0U);
  r.lose_database();
  EXPECT_THAT(r.registry.results(kOwner, r.second), SizeIs(2));
}

TEST(RegistryRebuild, KeepsResultsWhoseRecordingIsMissing) {
  Recorded r;
  r.registry.add_result(kOwner, r.first, example_result("gone.mcap.enc", 3));
  const RebuildReport report = r.rebuild();
  EXPECT_THAT(report.kept_without_file, ElementsAre("gone.mcap.enc 3"));
  EXPECT_THAT(r.registry.results(kOwner, r.first), SizeIs(1));
}

TEST(RegistryRebuild, GivesNoPatientTheRecordingOfAnother) {
  Recorded r;
  r.registry.add_result(kOwner, r.first, example_result("known.mcap"));
  r.registry.add_recording(kOwner, r.second, "announced.mcap");
  r.registry.add_recording(kOwner, r.first, "both.mcap");
  r.registry.add_recording(kOwner, r.second, "both.mcap");
  r.recordings.add("known.mcap", "", {example_result("known.mcap"), example_result("known.mcap", 2)});
  r.recordings.add("announced.mcap", "", {example_result("announced.mcap")});
  r.recordings.add("both.mcap", "", {example_result("both.mcap")});
  r.recordings.add("unknown.mcap", "", {example_result("unknown.mcap")});
  r.recordings.add("foreign.mcap.enc", std::string(32, 'f'), {example_result("foreign.mcap.enc")});
  r.recordings.add("torn.mcap", "torn", {});
  const RebuildReport report = r.rebuild();
  EXPECT_EQ(report.added, 2U) << "known.mcap 2 and announced.mcap 1";
  EXPECT_THAT(report.unreadable, ElementsAre("torn.mcap: it has no end; repair it"));
  EXPECT_THAT(report.not_assigned,
              ElementsAre(HasSubstr("both.mcap"), HasSubstr("foreign.mcap.enc"), HasSubstr("unknown.mcap")));
  EXPECT_THAT(r.registry.results(kOwner, r.first), SizeIs(2));
  EXPECT_THAT(r.registry.results(kOwner, r.second), SizeIs(1));
}

TEST(RegistryRebuild, TrustsAnEncryptedRecordingMoreThanTheRowAndAPlainOneLess) {
  Recorded r;
  r.registry.add_result(kOwner, r.first, example_result("a.mcap.enc", 1, 1.0));
  r.registry.add_result(kOwner, r.first, example_result("b.mcap", 1, 1.0));
  r.recordings.add("a.mcap.enc", r.first, {example_result("a.mcap.enc", 1, 2.0)});
  r.recordings.add("b.mcap", "", {example_result("b.mcap", 1, 2.0)});
  const RebuildReport report = r.rebuild();
  EXPECT_EQ(report.changed, 1U);
  EXPECT_THAT(report.differ, ElementsAre("b.mcap 1"));
  r.lose_database();
  const std::vector<ResultRow> rows = r.registry.results(kOwner, r.first);
  ASSERT_THAT(rows, SizeIs(2));
  EXPECT_EQ(rows[0].scores[0].value, 2.0);
  EXPECT_EQ(rows[1].scores[0].value, 1.0);
}

TEST(RegistryRebuild, DoesNotDoubleTheResultsOfACopiedRecording) {
  Recorded r;
  r.recordings.add("a.mcap.enc", r.first, {example_result("a.mcap.enc")});
  r.recordings.add("copy.mcap.enc", r.first, {example_result("a.mcap.enc")});
  const RebuildReport report = r.rebuild();
  EXPECT_EQ(report.added, 1U);
  EXPECT_THAT(report.not_assigned, ElementsAre(HasSubstr("copy of a.mcap.enc")));
}

TEST(RegistryRebuild, HoldsApartTwoPatientsWhoHadTheSameCode) {
  Recorded r;
  r.registry.add_result(kOwner, r.first, example_result("a.mcap.enc"));
  r.recordings.add("a.mcap.enc", r.first, {example_result("a.mcap.enc")});
  r.registry.delete_patient(kOwner, r.first);
  const std::string third = r.registry.add_patient(kOwner, example_patient("P1")).record;
  r.recordings.add("b.mcap.enc", third, {example_result("b.mcap.enc")});
  for (int i = 0; i < 2; ++i) {
    const RebuildReport report = r.rebuild();
    EXPECT_THAT(report.not_assigned, ElementsAre("a.mcap.enc: its patient was deleted"));
    EXPECT_EQ(report.patients, 2U);
    ASSERT_THAT(r.registry.results(kOwner, third), SizeIs(1));
    EXPECT_EQ(r.registry.results(kOwner, third)[0].recording, "b.mcap.enc");
    r.lose_database();
  }
}

TEST(RegistryRebuild, MakesALostOrDamagedJournalFromTheRows) {
  Recorded r;
  r.registry.add_result(kOwner, r.first, example_result("a.mcap.enc"));
  r.registry.add_note(kOwner, r.first, "one");
  r.registry.add_note(kOwner, r.first, "two");
  const std::string before = state_text(r.registry);
  const std::filesystem::path journal = r.files.data() / "journal" / r.first;
  const std::string whole = testing::read_file(journal);

  std::filesystem::remove(journal);
  r.registry = r.files.open();
  EXPECT_EQ(state_text(r.registry), before);
  r.lose_database();
  EXPECT_EQ(state_text(r.registry), before) << "the journal is whole again";

  for (std::size_t place = 0; place < whole.size(); place += 97) {
    SCOPED_TRACE(place);
    std::string damaged = testing::read_file(journal);
    damaged[place % damaged.size()] = static_cast<char>(damaged[place % damaged.size()] ^ 0x40);
    testing::write_bytes(journal, damaged);
    r.rebuild();
    EXPECT_EQ(state_text(r.registry), before);
    r.lose_database();
    EXPECT_EQ(state_text(r.registry), before);
  }
}

TEST(RegistryRebuild, KeepsAnEditThatTheJournalLost) {
  for (const bool is_cut : {false, true}) {
    SCOPED_TRACE(is_cut);
    Recorded r;
    const std::filesystem::path journal = r.files.data() / "journal" / r.first;
    Patient edited = r.registry.patient(kOwner, r.first);
    edited.force_limit_n = 3.0;
    r.registry.edit_patient(kOwner, edited);
    const std::string before = state_text(r.registry);
    std::string bytes = testing::read_file(journal);
    bytes.back() = static_cast<char>(bytes.back() ^ 1);
    if (is_cut) bytes.resize(bytes.size() - 9);
    testing::write_bytes(journal, bytes);
    const RebuildReport report = r.rebuild();
    if (!is_cut) {
      EXPECT_EQ(report.damaged_events, 1U);
    }
    EXPECT_EQ(state_text(r.registry), before);
    r.lose_database();
    EXPECT_EQ(state_text(r.registry), before) << "the journal has the edit again";
  }
}

TEST(RegistryRebuild, LeavesAJournalWithoutAReadablePatientAsItIs) {
  Recorded r;
  const std::filesystem::path journal = r.files.data() / "journal" / r.first;
  std::string bytes = testing::read_file(journal);
  bytes[100] = static_cast<char>(bytes[100] ^ 1);
  testing::write_bytes(journal, bytes);
  r.lose_database();
  EXPECT_THAT(r.registry.damaged_patients(kOwner), ElementsAre(r.first));
  EXPECT_EQ(r.rebuild().damaged_events, 1U);
  EXPECT_THAT(r.registry.patients(kOwner), SizeIs(1)) << "the other patient";
  EXPECT_EQ(testing::read_file(journal), bytes);
  EXPECT_EQ(r.registry.delete_patient(kOwner, r.first).unreadable_rows, 1U);
  EXPECT_FALSE(std::filesystem::exists(journal));
  EXPECT_THAT(r.registry.damaged_patients(kOwner), IsEmpty());
}

TEST(RegistryRebuild, CutsATornOrRepeatedEventAndGoesOn) {
  Recorded r;
  const std::filesystem::path journal = r.files.data() / "journal" / r.first;
  const std::string before_note = state_text(r.registry);
  const std::string whole = testing::read_file(journal);
  r.registry.add_note(kOwner, r.first, "whole");
  const std::string with_note = testing::read_file(journal);
  for (const std::size_t more : {std::size_t{1}, std::size_t{3}, std::size_t{4}, std::size_t{40},
                                 with_note.size() - whole.size() - 1, with_note.size() - whole.size()}) {
    testing::write_bytes(journal, with_note + with_note.substr(whole.size(), more));
    Registry registry = r.files.open();
    EXPECT_THAT(registry.notes(kOwner, r.first), SizeIs(1)) << more;
    EXPECT_EQ(testing::read_file(journal), with_note) << more;
  }
  r.registry.add_note(kOwner, r.first, "after");
  EXPECT_THAT(r.files.open().notes(kOwner, r.first), SizeIs(2));
}

TEST(RegistryRebuild, RefusesAPlaceThatDoesNotExist) {
  Recorded r;
  EXPECT_THROW(r.registry.rebuild(kOwner, {r.files.path("nowhere")}, r.recordings.reader()),
               std::invalid_argument);
}

}  // namespace
}  // namespace phalanx

// SPDX-License-Identifier: Apache-2.0
// Encrypted recordings of a folder: listed, read, repaired and deleted, with their keys and without.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "phalanx/record/recordings.h"
#include "phalanx/record/replay.h"
#include "phalanx/record/retention.h"
#include "phalanx/recording.pb.h"
#include "record/mcap/mcap_file.h"
#include "record/mcap/mcap_writer.h"
#include "record/recording/topics.h"
#include "record/stored_recording.h"
#include "record/temporary_folder.h"

namespace phalanx {
namespace {

namespace fs = std::filesystem;
using test::test_encryption;
using test::test_keys;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;
using ::testing::ThrowsMessage;

constexpr const char* kName = "2026-11-28T10-00-00Z.mcap.enc";
constexpr double kNamedBegin = 1795860000.0;  // that date: UTC [s since 1970]

constexpr const char* kEvent = "P07 presses";  // a given "P07" is in 1 % of ciphertexts of 175 kB

class EncryptedRecordings : public ::testing::Test {
 protected:
  /// Writes a recording of ten events, one a chunk. @param finished  false: it has no end
  fs::path written(const std::string& name, bool finished = true) const {
    const fs::path file = folder / name;
    mcap::DiskFile disk(file);
    mcap::EncryptedFile encrypted(disk, test_encryption());
    mcap::McapWriter writer(encrypted, recording_schemas(), recording_channels(),
                            {{"phalanx", {{"version", "9"}}}});
    for (std::uint64_t i = 0; i < 10; ++i) {
      wire::Event event;
      event.set_code("marker");
      event.set_text(kEvent);
      writer.add(static_cast<std::uint16_t>(Topic::kEvent), (100 + i) * 1'000'000'000,
                 event.SerializeAsString());
      writer.write_chunk();
    }
    if (finished) writer.finish();
    return file;
  }
  static void cut(const fs::path& file, std::uintmax_t bytes) {
    fs::resize_file(file, fs::file_size(file) - bytes);
  }

  const testing::TemporaryFolder folder;
};

TEST(RecordingName, IsThatOfAnEncryptedOneToo) {
  for (const char* name : {"a.mcap", "b/a.mcap.enc"}) EXPECT_TRUE(has_recording_name(name)) << name;
  for (const char* name : {"a.enc", "a.mcap.torn", "a.mcap.enc.torn", "a.html", "mcap", ".mcap.enc"})
    EXPECT_FALSE(has_recording_name(name)) << name;
  EXPECT_EQ(beside_recording("b/a.mcap", ".html"), "b/a.html");
  EXPECT_EQ(beside_recording("b/a.mcap.enc", ".html"), "b/a.html");
  EXPECT_EQ(beside_recording("b/a.mcap.enc", ""), "b/a");
}

TEST_F(EncryptedRecordings, AreListedWithTheirKeysAndWithout) {
  const fs::path file = written(kName);
  const auto with = list_recordings(folder.path(), {}, test_keys());
  ASSERT_THAT(with, SizeIs(1));
  EXPECT_EQ(recording_state(with[0]), "whole");
  EXPECT_EQ(with[0].begin, 100.0);
  EXPECT_EQ(with[0].events, 10U);
  EXPECT_EQ(with[0].version, "9");
  EXPECT_EQ(with[0].bytes, fs::file_size(file));
  EXPECT_TRUE(with[0].encrypted);
  EXPECT_FALSE(with[0].no_key);
  const auto without = list_recordings(folder.path(), with);
  ASSERT_THAT(without, SizeIs(1))
      << "what was read with the key before is kept, as long as the file is the same";
  EXPECT_EQ(without[0].events, 10U);
  const RecordingSummary none = summarise_recording(file);
  EXPECT_EQ(recording_state(none), "encrypted, no key");
  EXPECT_TRUE(none.no_key);
  EXPECT_EQ(none.key_id, test_encryption().id);
  EXPECT_EQ(none.begin, kNamedBegin);
  EXPECT_TRUE(none.has_end);
  EXPECT_THAT(none.trouble, AllOf(HasSubstr(none.key_id), HasSubstr("--keys FILE")));
}

TEST_F(EncryptedRecordings, AreReadWithTheirKeysAndRefusedWithout) {
  const fs::path file = written(kName);
  const RecordingContent content = read_recording(file, {}, test_keys());
  ASSERT_THAT(content.events, SizeIs(10));
  EXPECT_EQ(content.events[9].text, kEvent);
  const auto refused = ThrowsMessage<std::runtime_error>(
      AllOf(HasSubstr(kName), HasSubstr("its key (id"), Not(HasSubstr("repair"))));
  EXPECT_THAT([&] { static_cast<void>(read_recording(file)); }, refused);
  EXPECT_THAT([&] { static_cast<void>(recorded_motion(file)); }, refused);
  EXPECT_THAT([&] { static_cast<void>(replay(file)); }, refused);
  EXPECT_THAT([&] { static_cast<void>(replay(file, {}, nullptr, test_keys())); },
              ThrowsMessage<std::runtime_error>(HasSubstr("it holds no station")));
  EXPECT_THAT(testing::read_file(file), Not(HasSubstr(kEvent)));
}

TEST_F(EncryptedRecordings, ADamagedFrameIsNamedByItsPlaceWhenItIsRead) {
  const fs::path file = written(kName);
  std::string bytes = testing::read_file(file);
  bytes[bytes.size() / 2] ^= 1;
  std::ofstream(file, std::ios::binary) << bytes;
  EXPECT_THAT(
      [&] { static_cast<void>(read_recording(file, {}, test_keys())); },
      ThrowsMessage<std::runtime_error>(AllOf(HasSubstr("of the encrypted file"), HasSubstr("repair"))));
}

TEST_F(EncryptedRecordings, ARepairWithTheKeyMakesAWholeEncryptedFile) {
  const fs::path file = written(kName, false);
  cut(file, 10);  // in the last chunk
  EXPECT_EQ(recording_state(summarise_recording(file, test_keys())), "no end: repair");
  const RepairedRecording repaired = repair_recording(file, test_keys());
  EXPECT_TRUE(repaired.changed);
  EXPECT_FALSE(repaired.needs_key);
  EXPECT_EQ(repaired.chunks, 9U);
  EXPECT_EQ(repaired.original, file.string() + ".torn");
  EXPECT_THAT(repaired.losses, ElementsAre(HasSubstr("the file ends in a frame")));
  EXPECT_GT(repaired.lost_bytes, 0U);
  const RecordingSummary whole = summarise_recording(file, test_keys());
  EXPECT_EQ(recording_state(whole), "whole");
  EXPECT_EQ(whole.events, 9U);
  EXPECT_EQ(whole.key_id, test_encryption().id);
  EXPECT_FALSE(repair_recording(file, test_keys()).changed);
  EXPECT_THAT(testing::read_file(file), Not(HasSubstr(kEvent)));
}

TEST_F(EncryptedRecordings, ARepairWithoutTheKeyKeepsWholeFramesAndTheKeyCompletesIt) {
  const fs::path file = written(kName, false);
  cut(file, 10);
  const RepairedRecording kept = repair_recording(file);
  EXPECT_TRUE(kept.changed);
  EXPECT_TRUE(kept.needs_key);
  EXPECT_EQ(kept.chunks, 10U) << "frames: the beginning and nine chunks";
  EXPECT_THAT(kept.losses, ElementsAre(HasSubstr("of the encrypted file: the file ends in a frame")));
  EXPECT_EQ(recording_state(summarise_recording(file)), "encrypted, no key, no end: repair");
  const RepairedRecording again = repair_recording(file);
  EXPECT_FALSE(again.changed);
  EXPECT_TRUE(again.needs_key);
  EXPECT_EQ(repair_recording(file, test_keys()).chunks, 9U);
  EXPECT_EQ(read_recording(file, {}, test_keys()).events.size(), 9U);
  const RepairedRecording whole = repair_recording(file);
  EXPECT_FALSE(whole.changed);
  EXPECT_TRUE(fs::exists(file.string() + ".torn-2"));
}

TEST_F(EncryptedRecordings, AnotherKeyUnderTheIdRepairsNothing) {
  const fs::path file = written(kName, false);
  const std::string before = testing::read_file(file);
  const auto wrong = [](const std::string&) { return std::optional(RecordingKey{}); };
  EXPECT_THAT([&] { static_cast<void>(repair_recording(file, wrong)); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("is another")));
  EXPECT_EQ(testing::read_file(file), before);
  EXPECT_THAT(list_recordings(folder.path()), SizeIs(1));
}

TEST_F(EncryptedRecordings, AreDeletedByAgeWithoutTheirKeysAndCountForTheQuota) {
  const fs::path old = written(kName);
  const fs::path torn = written("2026-11-29T10-00-00Z.mcap.enc", false);
  const fs::path newest = written("2026-11-30T10-00-00Z.mcap.enc");
  EXPECT_EQ(recorded_bytes(folder.path()), fs::file_size(old) + fs::file_size(torn) + fs::file_size(newest));
  const double in_a_year = kNamedBegin + 400.0 * 86400.0;
  std::vector<RecordingSummary> all = list_recordings(folder.path());
  for (RecordingSummary& each : all) each.changed = each.begin;
  const auto expired = expired_recordings(all, {.days = 30.0, .bytes = {}}, in_a_year);
  ASSERT_THAT(expired, SizeIs(1)) << "the newest stays, and so does the one without an end";
  EXPECT_EQ(expired[0].file, old);
  for (const char* name : {"2026-11-28T10-00-00Z.html", "2026-11-28T10-00-00Z.mcap.enc.torn"})
    std::ofstream(folder / name) << "x";
  EXPECT_THAT(delete_recording(old), SizeIs(3));
  EXPECT_FALSE(fs::exists(folder / "2026-11-28T10-00-00Z.html"));
}

}  // namespace
}  // namespace phalanx

// SPDX-License-Identifier: Apache-2.0
#include "phalanx/record/retention.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "record/temporary_folder.h"

namespace phalanx {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr double kDay = 86400.0;

RecordingSummary recording(const char* name, double day, std::uint64_t bytes) {
  RecordingSummary made;
  made.file = name;
  made.begin = day * kDay;
  made.bytes = bytes;
  made.begins = made.has_end = true;
  made.version = "1";
  return made;
}

std::vector<std::string> expired(const std::vector<RecordingSummary>& all, const RetentionRule& rule) {
  std::vector<std::string> names;
  for (const RecordingSummary& each : expired_recordings(all, rule, 100.0 * kDay))
    names.push_back(each.file.string());
  return names;
}

TEST(Retention, DeletesNothingUnlessARuleSaysSo) {
  EXPECT_THAT(expired({recording("a", 0, 1'000'000'000'000)}, {}), IsEmpty());
}

TEST(Retention, DeletesByAgeAndTheOldestBySize) {
  const std::vector<RecordingSummary> all = {recording("a", 10, 50), recording("b", 69, 40),
                                             recording("c", 71, 30), recording("d", 99, 20)};
  EXPECT_THAT(expired(all, {.days = 30.0, .bytes = {}}), ElementsAre("a", "b"));
  EXPECT_THAT(expired(all, {.days = {}, .bytes = 140}), IsEmpty());
  EXPECT_THAT(expired(all, {.days = {}, .bytes = 139}), ElementsAre("a"));
  EXPECT_THAT(expired(all, {.days = {}, .bytes = 50}), ElementsAre("a", "b"));
  EXPECT_THAT(expired(all, {.days = 95.0, .bytes = {}}), IsEmpty());
  EXPECT_THAT(expired(all, {.days = 80.0, .bytes = 89}), ElementsAre("a", "b"))
      << "a by its age, then b for room";
}

TEST(Retention, AlwaysKeepsTheNewest) {
  const std::vector<RecordingSummary> all = {recording("a", 1, 50), recording("b", 2, 40)};
  EXPECT_THAT(expired(all, {.days = {}, .bytes = 0}), ElementsAre("a"));
  EXPECT_THAT(expired(all, {.days = 1.0, .bytes = {}}), ElementsAre("a"));
}

TEST(Retention, DoesNotTrustTheClockOfARecordingAlone) {
  std::vector<RecordingSummary> all = {recording("in 1970", 0, 50), recording("newest", 99, 40)};
  all[0].changed = 99.5 * kDay;  // written after the clock had been set
  EXPECT_THAT(expired(all, {.days = 30.0, .bytes = {}}), IsEmpty());
}

TEST(Retention, KeepsWhatIsBeingWrittenDamagedOrOfOthersAndDoesNotCountIt) {
  std::vector<RecordingSummary> all = {recording("written", 1, 90), recording("torn", 2, 90),
                                       recording("others", 3, 90),  recording("whole", 4, 10),
                                       recording("strange", 5, 90), recording("newest", 6, 10)};
  all[0].written = true;
  all[1].has_end = false;
  all[2].version.clear();
  all[4].trouble = "its first station does not match its schema";
  EXPECT_THAT(expired(all, {.days = 1.0, .bytes = {}}), ElementsAre("whole"));
  EXPECT_THAT(expired(all, {.days = {}, .bytes = 19}), ElementsAre("whole"));
  EXPECT_THAT(expired(all, {.days = {}, .bytes = 20}), IsEmpty());
}

TEST(Retention, DeletesARecordingWithWhatBelongsToIt) {
  const testing::TemporaryFolder folder;
  for (const char* name : {"a.mcap", "a.html", "a.mcap.torn", "a.mcap.torn-2", "ab.mcap", "b.html"})
    std::ofstream(folder / name) << "12345";
  EXPECT_EQ(recorded_bytes(folder.path()), 20U);
  EXPECT_EQ(delete_recording(folder / "a.mcap").size(), 4U);
  EXPECT_TRUE(std::filesystem::exists(folder / "ab.mcap"));
  EXPECT_TRUE(std::filesystem::exists(folder / "b.html"));
  EXPECT_EQ(recorded_bytes(folder.path()), 5U);
  EXPECT_EQ(recorded_bytes(folder / "none"), 0U);
}

}  // namespace
}  // namespace phalanx

// SPDX-License-Identifier: Apache-2.0
// docs/cli.md: every finished point goes "onto the disk at once". The linker leads all calls of fsync() in
// this program to the function below (--wrap), which writes them down.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cerrno>
#include <cstdint>
#include <mutex>
#include <stdexcept>
#include <utility>
#include <vector>

#include "phalanx/record/output_file.h"
#include "phalanx/study/laboratory/outputs.h"
#include "record/temporary_folder.h"
#include "study/laboratory/journal.h"
#include "study/laboratory/synthetic.h"

namespace phalanx::journal_on_disk {
namespace {

/// A call of fsync(): on what, and how much of it there was by then.
struct Synchronised {
  ino_t file = 0;
  bool folder = false;
  std::uintmax_t length = 0;  ///< [bytes]
};

std::mutex the_mutex;
std::vector<Synchronised> the_calls;
int the_error = 0;  ///< what the next calls fail with; 0: they do not

int note_down(int descriptor) {
  const std::lock_guard lock(the_mutex);
  struct stat status{};
  if (::fstat(descriptor, &status) != 0) return -1;
  the_calls.push_back({.file = status.st_ino,
                       .folder = S_ISDIR(status.st_mode),
                       .length = static_cast<std::uintmax_t>(status.st_size)});
  if (the_error == 0) return 0;
  errno = the_error;
  return -1;
}

/// The calls since the last time.
std::vector<Synchronised> calls() {
  const std::lock_guard lock(the_mutex);
  return std::exchange(the_calls, {});
}

ino_t inode_of(const std::filesystem::path& path) {
  struct stat status{};
  EXPECT_EQ(::stat(path.c_str(), &status), 0);
  return status.st_ino;
}

JournalHeader header() {
  return {.study = testing::study_of(testing::kTwelvePoints), .inputs = "abc", .commit = "test"};
}

PointResult point(int index) {
  PointResult result;
  result.index = index;
  return result;
}

}  // namespace
}  // namespace phalanx::journal_on_disk

// Its name is the linker's.
extern "C" int __wrap_fsync(int descriptor);
extern "C" int __wrap_fsync(int descriptor) { return phalanx::journal_on_disk::note_down(descriptor); }

namespace phalanx::journal_on_disk {
namespace {

using testing::TemporaryFolder;

TEST(JournalOnDisk, ANewJournalIsSynchronisedAndThenTheFolderThatNamesIt) {
  const TemporaryFolder folder;
  static_cast<void>(calls());
  const Journal journal(folder / "points.jsonl", header(), false);
  const auto made = calls();
  ASSERT_EQ(made.size(), 2U);
  EXPECT_EQ(made[0].file, inode_of(folder / "points.jsonl"));
  EXPECT_EQ(made[0].length, journal_text({.header = header(), .points = {}}).size()) << "all of the header";
  EXPECT_TRUE(made[1].folder);
  EXPECT_EQ(made[1].file, inode_of(folder.path()));
}

TEST(JournalOnDisk, EveryPointIsSynchronisedWholeBeforeAppendReturns) {
  const TemporaryFolder folder;
  Journal journal(folder / "points.jsonl", header(), false);
  static_cast<void>(calls());
  std::uintmax_t length = journal_text({.header = header(), .points = {}}).size();
  for (int index = 0; index < 3; ++index) {
    journal.append(point(index));
    length += result_line(point(index)).size();
    const auto made = calls();
    ASSERT_EQ(made.size(), 1U) << index;
    EXPECT_EQ(made[0].file, inode_of(folder / "points.jsonl"));
    EXPECT_EQ(made[0].length, length) << "with the line that was just written";
  }
}

TEST(JournalOnDisk, ADiskThatDoesNotTakeAPointIsAnError) {
  const TemporaryFolder folder;
  Journal journal(folder / "points.jsonl", header(), false);
  {
    const std::lock_guard lock(the_mutex);
    the_error = EIO;
  }
  EXPECT_THROW(journal.append(point(0)), std::runtime_error);
  {
    const std::lock_guard lock(the_mutex);
    the_error = 0;
  }
  EXPECT_NO_THROW(journal.append(point(1)));
}

// What is merged may replace a journal whose points were on the disk: it is there itself before it takes the
// name.
TEST(JournalOnDisk, AMergedJournalIsSynchronisedBeforeItTakesItsName) {
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder / "part");
  JournalContent whole{.header = header(), .points = {}};
  for (int index = 0; index < 12; ++index) whole.points.push_back(point(index));
  write_text_file(folder / "part" / "points.jsonl", journal_text(whole));
  static_cast<void>(merge_studies({folder / "part"}, folder / "all"));
  const auto made = calls();
  ASSERT_GE(made.size(), 2U);
  const Synchronised& file = made[made.size() - 2];
  EXPECT_EQ(file.file, inode_of(folder / "all" / "points.jsonl")) << "under another name then";
  EXPECT_EQ(file.length, journal_text(whole).size());
  EXPECT_TRUE(made.back().folder);
  EXPECT_EQ(made.back().file, inode_of(folder / "all"));
}

}  // namespace
}  // namespace phalanx::journal_on_disk

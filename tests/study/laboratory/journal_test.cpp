// SPDX-License-Identifier: Apache-2.0
#include "study/laboratory/journal.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "phalanx/record/output_file.h"
#include "record/temporary_folder.h"
#include "study/laboratory/expect_refusal.h"
#include "study/laboratory/fingerprint.h"
#include "study/laboratory/synthetic.h"

namespace phalanx {
namespace {

using testing::expect_refusal;
using testing::read_file;
using testing::TemporaryFolder;

JournalHeader header() {
  return {.study = testing::study_of(testing::kTwelvePoints), .inputs = "abc", .commit = "test"};
}

PointResult point(int index) {
  PointResult result;
  result.index = index;
  result.k_lim = 100.0 / 3.0;  // no short decimal
  result.trials = 7;
  result.why_invalid = "\"quoted\"\nlines";
  result.checked = {{.n_per_mm = 0.1, .verdict = Verdict::kInvalid, .seeds_run = 3, .force_swing = 1e-300}};
  return result;
}

/// A journal of points 0, 1 and 2.
std::filesystem::path three_points(const TemporaryFolder& folder) {
  const auto file = folder / "points.jsonl";
  Journal journal(file, header(), false);
  for (int index = 0; index < 3; ++index) journal.append(point(index));
  return file;
}

TEST(Journal, GivesBackWhatWasWrittenToTheLastBit) {
  const TemporaryFolder folder;
  const Journal again(three_points(folder), header(), false);
  ASSERT_EQ(again.finished().size(), 3U);
  EXPECT_EQ(again.finished()[2].index, 2);
  EXPECT_EQ(again.finished()[2].k_lim, 100.0 / 3.0);
  EXPECT_TRUE(std::isnan(again.finished()[2].k_eff));
  EXPECT_EQ(again.finished()[2].why_invalid, "\"quoted\"\nlines");
  EXPECT_EQ(again.finished()[2].checked[0].force_swing, 1e-300);
  EXPECT_EQ(result_line(again.finished()[2]), result_line(point(2)));
}

// Wherever the power went: what was complete is kept, the rest is cut off, and the file can be written on.
TEST(Journal, CutsOffATornLastLineAtEveryLength) {
  const TemporaryFolder folder;
  const std::string whole = read_file(three_points(folder));
  for (std::size_t length = 0; length < whole.size(); length += length < 40 ? 1 : 37) {
    SCOPED_TRACE(length);
    const auto file = folder / "torn.jsonl";
    write_text_file(file, whole.substr(0, length));
    const std::string complete = whole.substr(0, whole.rfind('\n', length == 0 ? 0 : length - 1) + 1);
    const auto lines = static_cast<std::size_t>(std::count(complete.begin(), complete.end(), '\n'));
    {
      Journal journal(file, header(), false);
      ASSERT_EQ(journal.finished().size(), lines == 0 ? 0 : lines - 1);
      journal.append(point(11));
    }
    const JournalContent content = read_journal(file);
    EXPECT_EQ(content.points.back().index, 11);
  }
}

/// While it lives, this process may open so many files more.
class FilesLeft {
 public:
  explicit FilesLeft(unsigned files) {
    ::getrlimit(RLIMIT_NOFILE, &before_);
    const int next = ::open("/dev/null", O_RDONLY | O_CLOEXEC);  // the lowest number that is free
    ::close(next);
    const rlimit few{.rlim_cur = static_cast<rlim_t>(next) + files, .rlim_max = before_.rlim_max};
    EXPECT_EQ(::setrlimit(RLIMIT_NOFILE, &few), 0);
  }
  FilesLeft(const FilesLeft&) = delete;
  FilesLeft& operator=(const FilesLeft&) = delete;
  ~FilesLeft() { ::setrlimit(RLIMIT_NOFILE, &before_); }

 private:
  rlimit before_{};
};

TEST(Journal, IsNotTakenForEmptyWhereNoFurtherFileCanBeOpened) {
  const TemporaryFolder folder;
  const auto file = three_points(folder);
  const std::string before = read_file(file);
  {
    const FilesLeft one(1);
    const Journal journal(file, header(), false);
    EXPECT_EQ(journal.finished().size(), 3U);
  }
  EXPECT_EQ(read_file(file), before);
}

TEST(Journal, RefusesAnotherStudyInWordsAndKeepsItsPoints) {
  const TemporaryFolder folder;
  const auto file = three_points(folder);
  const std::string before = read_file(file);
  JournalHeader other = header();
  other.study.seeds = 6;
  expect_refusal([&] { const Journal journal(file, other, false); },
                 {"another study", "--restart", "3 finished points", "--out"});
  other = header();
  other.inputs = "abd";
  expect_refusal([&] { const Journal journal(file, other, false); }, {"scene", "has changed since"});
  other = header();
  other.commit = "newer";
  expect_refusal([&] { const Journal journal(file, other, false); }, {"another version", "test", "newer"});
  EXPECT_EQ(read_file(file), before);
  const Journal restarted(file, other, true);
  EXPECT_TRUE(restarted.finished().empty());
}

TEST(Journal, RefusesPointsOfAMachineThatRoundsDifferently) {
  const TemporaryFolder folder;
  const auto file = folder / "points.jsonl";
  JournalHeader here = header();
  here.libm = "1111";
  JournalHeader other = header();
  other.libm = "2222";
  EXPECT_NO_THROW(Journal(file, here, false));
  EXPECT_NO_THROW(Journal(file, other, false).append(point(0))) << "nothing was measured before";
  const std::string before = read_file(file);
  EXPECT_EQ(read_journal(file).header.libm, "2222");
  expect_refusal([&] { const Journal journal(file, here, false); },
                 {"rounds differently", "--restart", "1 finished points", "--out"});
  EXPECT_EQ(read_file(file), before);
  const Journal collecting(file, header(), false);  // measures nothing
  EXPECT_EQ(collecting.libm(), "2222");
  EXPECT_EQ(read_file(file), before);
}

TEST(Journal, RefusesWhatIsNoJournalAndLeavesItAlone) {
  const TemporaryFolder folder;
  for (const char* text :
       {"dear diary", "dear diary\n", "{}\n", "{\"phalanx_study_journal\": 99}\n", "[]\n"}) {
    write_text_file(folder / "a", text);
    expect_refusal([&] { const Journal journal(folder / "a", header(), false); },
                   {"no journal", "--restart"});
    EXPECT_EQ(read_file(folder / "a"), text);
  }
}

TEST(Journal, RefusesADamagedLineByItsNumber) {
  const TemporaryFolder folder;
  const auto file = three_points(folder);
  std::string text = read_file(file);
  text[text.find("\"point\":1") + 9] = '}';
  write_text_file(file, text);
  expect_refusal([&] { const Journal journal(file, header(), false); }, {"points.jsonl:3: is damaged"});
}

TEST(Journal, RefusesAPointTwiceUnlessBothAgree) {
  const TemporaryFolder folder;
  const auto file = three_points(folder);
  const std::string text = read_file(file);
  write_text_file(file, text + result_line(point(1)));
  EXPECT_EQ(read_journal(file).points.size(), 3U);
  PointResult other = point(1);
  other.trials = 8;
  write_text_file(file, text + result_line(other));
  expect_refusal([&] { static_cast<void>(read_journal(file)); }, {"point 1", "twice"});
  write_text_file(file, text + result_line(point(12)));
  expect_refusal([&] { static_cast<void>(read_journal(file)); }, {"no point 12"});
}

TEST(Journal, IsWrittenByOneAtATime) {
  const TemporaryFolder folder;
  const auto file = folder / "points.jsonl";
  {
    const Journal first(file, header(), false);
    expect_refusal([&] { const Journal second(file, header(), false); }, {"another process"});
    expect_refusal([&] { const Journal second(file, header(), true); }, {"another process"});
  }
  const Journal after(file, header(), false);
  EXPECT_TRUE(after.finished().empty());
}

/// Files of this process may not grow beyond a size, as if the disk were full, as long as this lives.
class FullDisk {
 public:
  explicit FullDisk(std::uintmax_t size) : handler_(::signal(SIGXFSZ, SIG_IGN)) {
    ::getrlimit(RLIMIT_FSIZE, &before_);
    rlimit limit = before_;
    limit.rlim_cur = static_cast<rlim_t>(size);
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FullDisk() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    ::signal(SIGXFSZ, handler_);
  }
  FullDisk(const FullDisk&) = delete;
  FullDisk& operator=(const FullDisk&) = delete;

 private:
  rlimit before_{};
  void (*handler_)(int);
};

TEST(Journal, EndsWithItsLastCompleteLineIfTheDiskIsFull) {
  const TemporaryFolder folder;
  const auto file = three_points(folder);
  const std::string before = read_file(file);
  Journal journal(file, header(), false);
  for (const unsigned room : {0U, 20U}) {
    const FullDisk full(before.size() + room);
    EXPECT_THROW(journal.append(point(3)), std::runtime_error) << room;
    EXPECT_EQ(read_file(file), before) << room;
  }
  journal.append(point(3));
  EXPECT_EQ(read_journal(file).points.size(), 4U);
}

// A file in memory that may grow and not shrink: what is torn cannot be cut off, nor the rest thrown away.
TEST(Journal, SaysThatATornLineCannotBeCutOff) {
  const int memory = ::memfd_create("journal", MFD_CLOEXEC | MFD_ALLOW_SEALING);
  ASSERT_GE(memory, 0);
  const std::string text = journal_text({.header = header(), .points = {point(0)}}) + "torn";
  ASSERT_EQ(::write(memory, text.data(), text.size()), static_cast<ssize_t>(text.size()));
  ASSERT_EQ(::fcntl(memory, F_ADD_SEALS, F_SEAL_SHRINK), 0);
  const auto file = std::filesystem::path("/proc/self/fd") / std::to_string(memory);
  const auto why_not = [&](bool restart) -> std::string {
    try {
      const Journal journal(file, header(), restart);
      return "";
    } catch (const std::runtime_error& error) {
      return error.what();
    }
  };
  EXPECT_THAT(why_not(false), ::testing::HasSubstr("cannot be shortened: "));
  EXPECT_THAT(why_not(true), ::testing::HasSubstr("cannot be emptied: "));
  EXPECT_EQ(read_file(file), text);
  ::close(memory);
}

TEST(Journal, RefusesADevice) {
  const TemporaryFolder folder;
  std::filesystem::create_symlink("/dev/null", folder / "points.jsonl");
  expect_refusal([&] { const Journal journal(folder / "points.jsonl", header(), false); },
                 {"no ordinary file"});
}

TEST(Fingerprint, CountsNamesAndContentsButNotFoldersOrOrder) {
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder / "other");
  write_text_file(folder / "a", "1");
  write_text_file(folder / "b", "2");
  write_text_file(folder / "other/a", "1");
  const std::string both = fingerprint_of_files({folder / "a", folder / "b"});
  EXPECT_EQ(fingerprint_of_files({folder / "b", folder / "other/a", folder / "b"}), both);
  write_text_file(folder / "b", "3");
  EXPECT_NE(fingerprint_of_files({folder / "a", folder / "b"}), both);
  EXPECT_THROW(static_cast<void>(fingerprint_of_files({folder / "none"})), std::runtime_error);
}

// The published test vector of FNV-1a, 64 bit, for "foobar".
TEST(Fingerprint, IsFnv1a) {
  Fingerprint print;
  print.add("foo");
  print.add("bar");
  EXPECT_EQ(print.text(), "85944171f73967e8");
}

}  // namespace
}  // namespace phalanx

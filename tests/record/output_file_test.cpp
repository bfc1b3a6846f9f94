// SPDX-License-Identifier: Apache-2.0
#include "phalanx/record/output_file.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <sys/file.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <limits>
#include <memory>
#include <random>
#include <stdexcept>
#include <vector>

#include "record/temporary_folder.h"

namespace {

int flock_error = 0;  ///< what flock() of this program fails with; 0: it does not

}  // namespace

/// In the place of the C library's.
extern "C" int flock(int descriptor, int operation) noexcept {
  if (flock_error == 0) return static_cast<int>(::syscall(SYS_flock, descriptor, operation));
  errno = flock_error;
  return -1;
}

namespace phalanx {
namespace {

using ::testing::HasSubstr;
using testing::read_file;
using testing::TemporaryFolder;

TEST(OutputFile, AppearsUnderItsNameOnlyWhenCommitted) {
  const TemporaryFolder folder;
  const auto file = folder / "a.txt";
  OutputFile out(file);
  out.text("tick");
  EXPECT_FALSE(std::filesystem::exists(file));
  out.commit();
  EXPECT_EQ(read_file(file), "tick");
  EXPECT_FALSE(std::filesystem::exists(folder / "a.txt.partial"));
}

TEST(OutputFile, LeavesNothingAndTheOldFileUntouchedWithoutACommit) {
  const TemporaryFolder folder;
  const auto file = folder / "a.txt";
  write_text_file(file, "old");
  {
    OutputFile out(file);
    out.text("new");
  }
  EXPECT_EQ(read_file(file), "old");
  EXPECT_FALSE(std::filesystem::exists(folder / "a.txt.partial"));
}

TEST(OutputFile, WritesTheShortestDecimals) {
  const TemporaryFolder folder;
  OutputFile out(folder / "a.txt");
  for (const double value : {0.1, 0.0, -0.0, 1.0 / 3.0, 1e-300, 5e-324}) {
    out.number(value);
    out.text(" ");
  }
  out.integer(18446744073709551615U);
  out.commit();
  EXPECT_EQ(read_file(folder / "a.txt"), "0.1 0 -0 0.3333333333333333 1e-300 5e-324 18446744073709551615");
}

TEST(OutputFile, WritesNumbersThatReadBackToTheSameBits) {
  const TemporaryFolder folder;
  constexpr std::uint64_t kSeed = 20101;
  std::mt19937_64 random(kSeed);
  std::vector<double> values;
  while (values.size() < 100'000) {
    const auto value = std::bit_cast<double>(random());
    if (std::isfinite(value)) values.push_back(value);
  }
  OutputFile out(folder / "a.txt");
  for (const double value : values) {
    out.number(value);
    out.text("\n");
  }
  out.commit();
  std::istringstream lines(read_file(folder / "a.txt"));
  std::string line;
  for (const double value : values) {
    ASSERT_TRUE(std::getline(lines, line));
    ASSERT_EQ(std::bit_cast<std::uint64_t>(std::strtod(line.c_str(), nullptr)),
              std::bit_cast<std::uint64_t>(value))
        << "seed " << kSeed << ", line '" << line << "'";
  }
}

TEST(OutputFile, SaysWhichFileCannotBeWritten) {
  try {
    const OutputFile out("/no/such/folder/a.txt");
    FAIL() << "opened";
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), HasSubstr("/no/such/folder/a.txt"));
  }
}

/// As long as it lives, no file of this process grows beyond a size.
class FullDisk {
 public:
  explicit FullDisk(rlim_t bytes) : signal_(std::signal(SIGXFSZ, SIG_IGN)) {
    ::getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{.rlim_cur = bytes, .rlim_max = before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FullDisk() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, signal_);
  }
  FullDisk(const FullDisk&) = delete;
  FullDisk& operator=(const FullDisk&) = delete;

 private:
  rlimit before_{};
  void (*signal_)(int);
};

TEST(OutputFile, FailsWhenTheDiskIsFullAndLeavesNothing) {
  const TemporaryFolder folder;
  {
    OutputFile out(folder / "a.txt");
    out.text("tick");
    const FullDisk full(2);
    EXPECT_THROW(out.commit(), std::runtime_error);
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

// 200,000 times 18 characters or more are over 3 MB, more than the buffer: they reach the disk before all is
// taken.
TEST(OutputFile, FailsAsSoonAsTheDiskIsFull) {
  const std::vector<std::function<void(OutputFile&)>> writes = {
      [](OutputFile& out) { out.text("eighteen or so chars"); },
      [](OutputFile& out) { out.number(1.0 / 3.0); },
      [](OutputFile& out) { out.integer(18446744073709551615U); }};
  for (const auto& write : writes) {
    const TemporaryFolder folder;
    const std::filesystem::path file = folder / "a.txt";
    OutputFile out(file);
    const FullDisk full(1000);
    const auto write_much = [&] {
      for (int i = 0; i < 200'000; ++i) write(out);
    };
    EXPECT_THAT(write_much, ::testing::ThrowsMessage<std::runtime_error>(
                                HasSubstr("cannot write '" + file.string() + "'")));
  }
}

TEST(OutputFile, RemovesALinkInThePlaceOfItsPartAndLeavesItsTargetAlone) {
  const TemporaryFolder folder;
  write_text_file(folder / "victim", "precious");
  for (const auto unfinished : {Unfinished::kRemoved, Unfinished::kLeft}) {
    std::filesystem::create_symlink("victim", folder / "a.txt.partial");
    OutputFile out(folder / "a.txt", unfinished);
    out.text("new\nlines\n");
    out.commit();
    EXPECT_EQ(read_file(folder / "a.txt"), "new\nlines\n");
    EXPECT_EQ(read_file(folder / "victim"), "precious");
    EXPECT_FALSE(std::filesystem::is_symlink(folder / "a.txt"));
  }
}

TEST(OutputFile, APipeInThePlaceOfItsPartHoldsNothingUp) {
  const TemporaryFolder folder;
  ASSERT_EQ(mkfifo((folder / "a.txt.partial").c_str(), 0600), 0);
  OutputFile out(folder / "a.txt", Unfinished::kLeft);
  out.text("new");
  out.commit();
  EXPECT_EQ(read_file(folder / "a.txt"), "new");
}

TEST(OutputFile, AFileThatIsBeingWrittenIsNotTakenForOneThatWasLeft) {
  const TemporaryFolder folder;
  OutputFile first(folder / "a.csv", Unfinished::kLeft);
  first.text("header\nrow\n");
  first.write_through();
  EXPECT_THAT([&] { OutputFile second(folder / "a.csv", Unfinished::kLeft); },
              ::testing::ThrowsMessage<std::runtime_error>(HasSubstr("another program is writing it")));
  first.commit();
  EXPECT_EQ(read_file(folder / "a.csv"), "header\nrow\n");
}

/// flock() fails as long as it lives.
class FailingLocks {
 public:
  explicit FailingLocks(int error) { flock_error = error; }
  ~FailingLocks() { flock_error = 0; }
  FailingLocks(const FailingLocks&) = delete;
  FailingLocks& operator=(const FailingLocks&) = delete;
};

// Nothing tells there whether another program is writing it: it is neither cut nor taken away.
TEST(OutputFile, WithoutLocksAPartThatIsThereIsLeftAlone) {
  for (const int error : {EOPNOTSUPP, ENOSYS, EINVAL, ENOLCK}) {
    SCOPED_TRACE(error);
    const FailingLocks none(error);
    const TemporaryFolder folder;
    OutputFile first(folder / "a.csv", Unfinished::kLeft);
    first.text("header\nrow\nhalf a r");
    first.write_through();
    for (const auto unfinished : {Unfinished::kLeft, Unfinished::kRemoved})
      EXPECT_THAT([&] { OutputFile second(folder / "a.csv", unfinished); },
                  ::testing::ThrowsMessage<std::runtime_error>(
                      ::testing::AllOf(HasSubstr("has no locks"), HasSubstr("rename or remove it"))));
    first.text("ow\n");
    first.commit();
    EXPECT_EQ(read_file(folder / "a.csv"), "header\nrow\nhalf a row\n");
  }
}

TEST(OutputFile, ALockThatFailsOtherwiseIsAnError) {
  const TemporaryFolder folder;
  const FailingLocks broken(EIO);
  EXPECT_THAT([&] { OutputFile out(folder / "a.csv"); },
              ::testing::ThrowsMessage<std::runtime_error>(HasSubstr("cannot lock")));
}

// As by a program on another computer, whose locks are not seen.
TEST(OutputFile, APartThatAnotherProgramHasPutInItsPlaceIsNeitherRenamedNorRemoved) {
  const TemporaryFolder folder;
  const auto replace = [&] {
    std::filesystem::rename(folder / "a.txt.partial", folder / "aside");
    std::ofstream(folder / "a.txt.partial") << "theirs";
  };
  {
    OutputFile out(folder / "a.txt");
    out.text("ours");
    replace();
    EXPECT_THAT([&] { out.commit(); },
                ::testing::ThrowsMessage<std::runtime_error>(HasSubstr("another program has put a file")));
  }
  EXPECT_EQ(read_file(folder / "a.txt.partial"), "theirs");
  std::filesystem::remove(folder / "a.txt.partial");
  EXPECT_THROW(write_then_rename(folder / "a.txt", [&](const std::filesystem::path&) { replace(); }),
               std::runtime_error);
  EXPECT_EQ(read_file(folder / "a.txt.partial"), "theirs");
  EXPECT_FALSE(std::filesystem::exists(folder / "a.txt"));
}

TEST(OutputFile, ALogIsLeftWithWhatWasWritten) {
  const TemporaryFolder folder;
  {
    OutputFile out(folder / "a.csv", Unfinished::kLeft);
    out.text("header\nrow\n");
    EXPECT_EQ(out.partial(), folder / "a.csv.partial");
  }
  EXPECT_EQ(read_file(folder / "a.csv.partial"), "header\nrow\n");
  EXPECT_FALSE(std::filesystem::exists(folder / "a.csv"));
}

TEST(OutputFile, ALogIsLeftWhereItCannotGetItsName) {
  const TemporaryFolder folder;
  {
    OutputFile out(folder / "a.csv", Unfinished::kLeft);
    out.text("header\nrow\n");
    std::filesystem::create_directory(folder / "a.csv");
    EXPECT_THROW(out.commit(), std::runtime_error);
  }
  EXPECT_EQ(read_file(folder / "a.csv.partial"), "header\nrow\n");
}

TEST(OutputFile, ALogWithoutARowIsRemoved) {
  const TemporaryFolder folder;
  {
    OutputFile out(folder / "a.csv", Unfinished::kLeft);
    out.text("header\nhalf a r");
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

// Longer than one block that is read, in lines and in the last line's half.
TEST(OutputFile, TheNextStartFinishesALogThatWasLeftBehind) {
  const TemporaryFolder folder;
  const std::string row = std::string(150'000, 'x') + "\n";
  write_text_file(folder / "a.csv", "of another day\n");
  write_text_file(folder / "a-recovered.csv", "of another one\n");
  for (const char* name : {"a-recovered-2.csv", "a-recovered-3.csv"}) {
    write_text_file(folder / "a.csv.partial", "header\n" + row + row + std::string(140'000, 'y'));
    const OutputFile out(folder / "a.csv", Unfinished::kLeft);
    EXPECT_EQ(out.finished_earlier(), folder / name);
    EXPECT_EQ(read_file(folder / name), "header\n" + row + row);
  }
  EXPECT_EQ(read_file(folder / "a.csv"), "of another day\n");
  EXPECT_EQ(read_file(folder / "a-recovered.csv"), "of another one\n");
}

TEST(OutputFile, WhatWasLeftBehindWithoutARowIsRemoved) {
  const TemporaryFolder folder;
  for (const char* left : {"", "header\n", "header\nhalf a r"}) {
    write_text_file(folder / "a.csv.partial", left);
    OutputFile out(folder / "a.csv", Unfinished::kLeft);
    EXPECT_EQ(out.finished_earlier(), "");
    out.commit();
    EXPECT_EQ(read_file(folder / "a.csv"), "");
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "a-recovered.csv"));
}

TEST(OutputFile, AFileWithASecondNameIsNotCut) {
  const TemporaryFolder folder;
  write_text_file(folder / "victim", "header\nrow\nno line's end");
  std::filesystem::create_hard_link(folder / "victim", folder / "a.csv.partial");
  OutputFile out(folder / "a.csv", Unfinished::kLeft);
  out.commit();
  EXPECT_EQ(read_file(folder / "victim"), "header\nrow\nno line's end");
}

TEST(OutputFile, WhatIsWrittenThroughIsThereBeforeTheCommit) {
  const TemporaryFolder folder;
  OutputFile out(folder / "a.csv", Unfinished::kLeft);
  out.text("header\nrow\n");
  EXPECT_EQ(read_file(folder / "a.csv.partial"), "");
  out.write_through();
  EXPECT_EQ(read_file(folder / "a.csv.partial"), "header\nrow\n");
}

TEST(OutputFile, LeavesThePartOfTheNextAloneOnceItIsCommitted) {
  const TemporaryFolder folder;
  auto first = std::make_unique<OutputFile>(folder / "a.txt");
  first->text("old");
  first->commit();
  OutputFile second(folder / "a.txt");
  second.text("new");
  first.reset();
  second.commit();
  EXPECT_EQ(read_file(folder / "a.txt"), "new");
}

TEST(WriteThenRename, PutsTheWholeUnderItsName) {
  const TemporaryFolder folder;
  write_then_rename(folder / "a.obj",
                    [](const std::filesystem::path& partial) { std::ofstream(partial) << "whole"; });
  EXPECT_EQ(read_file(folder / "a.obj"), "whole");
  EXPECT_FALSE(std::filesystem::exists(folder / "a.obj.partial"));
}

TEST(WriteThenRename, RemovesALinkInThePlaceOfItsPartAndLeavesItsTargetAlone) {
  const TemporaryFolder folder;
  write_text_file(folder / "victim", "precious");
  std::filesystem::create_symlink("victim", folder / "a.obj.partial");
  write_then_rename(folder / "a.obj",
                    [](const std::filesystem::path& partial) { std::ofstream(partial) << "whole"; });
  EXPECT_EQ(read_file(folder / "a.obj"), "whole");
  EXPECT_EQ(read_file(folder / "victim"), "precious");
}

TEST(WriteThenRename, RemovesThePartWhenTheWriterThrows) {
  const TemporaryFolder folder;
  EXPECT_THROW(write_then_rename(folder / "a.obj",
                                 [](const std::filesystem::path& partial) {
                                   std::ofstream(partial) << "half";
                                   throw std::runtime_error("stop");
                                 }),
               std::runtime_error);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(WriteThenRename, HoldsItsLockUntilTheRename) {
  const TemporaryFolder folder;
  write_then_rename(folder / "a.obj", [&](const std::filesystem::path& partial) {
    std::ofstream(partial) << "whole";
    EXPECT_THAT([&] { OutputFile second(folder / "a.obj"); },
                ::testing::ThrowsMessage<std::runtime_error>(HasSubstr("another program is writing it")));
  });
  EXPECT_EQ(read_file(folder / "a.obj"), "whole");
}

TEST(WriteThenRename, LeavesAPipeWhereItIsAndRemovesThePart) {
  const TemporaryFolder folder;
  ASSERT_EQ(mkfifo((folder / "pipe").c_str(), 0600), 0);
  EXPECT_THROW(
      write_then_rename(folder / "pipe",
                        [](const std::filesystem::path& partial) { std::ofstream(partial) << "whole"; }),
      std::runtime_error);
  EXPECT_TRUE(std::filesystem::is_fifo(folder / "pipe"));
  EXPECT_FALSE(std::filesystem::exists(folder / "pipe.partial"));
}

TEST(PrepareOutputFolder, MakesParents) {
  const TemporaryFolder folder;
  prepare_output_folder(folder.path() / "a" / "b");
  EXPECT_TRUE(std::filesystem::is_directory(folder.path() / "a" / "b"));
}

TEST(PrepareOutputFolder, RefusesAFileByName) {
  const TemporaryFolder folder;
  write_text_file(folder / "out", "");
  try {
    prepare_output_folder(folder / "out");
    FAIL() << "accepted a file";
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), HasSubstr("is a file"));
    EXPECT_THAT(error.what(), HasSubstr((folder / "out").string()));
  }
}

TEST(PrepareOutputFolder, RefusesAFolderBelowAFile) {
  const TemporaryFolder folder;
  write_text_file(folder / "out", "");
  EXPECT_THROW(prepare_output_folder(folder / "out/deeper"), std::invalid_argument);
}

TEST(OutputFile, DoesNotTakeThePlaceOfAPipeOrADevice) {
  const TemporaryFolder folder;
  ASSERT_EQ(mkfifo((folder / "pipe").c_str(), 0600), 0);
  EXPECT_THROW(write_text_file(folder / "pipe", "text"), std::runtime_error);
  EXPECT_TRUE(std::filesystem::is_fifo(folder / "pipe"));
  EXPECT_FALSE(std::filesystem::exists(folder / "pipe.partial"));
}

}  // namespace
}  // namespace phalanx

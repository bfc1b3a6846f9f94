// SPDX-License-Identifier: Apache-2.0
// The bounds of a log whose disk is stuck: a pipe that is full and not read.
#include "serve/log_file.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>

#include "record/temporary_folder.h"

namespace phalanx {
namespace {

using testing::read_file;
using testing::TemporaryFolder;

std::string gap_in_words(const LogGap& gap) {
  return "missing " + std::to_string(gap.lines) + " from " + std::to_string(static_cast<int>(gap.since)) +
         " to " + std::to_string(static_cast<int>(gap.until)) + "\n";
}

/// Waits for what another thread does.
template <class Condition>
void until_so(const Condition& so) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(5);
  while (!so()) {
    ASSERT_LT(std::chrono::steady_clock::now(), end);
    std::this_thread::yield();
  }
}

/// A log that writes to a pipe, and the pipe's other end.
class StuckLog {
 public:
  StuckLog() : pipe_(folder_ / "pipe") {
    EXPECT_EQ(::mkfifo(pipe_.c_str(), 0600), 0);
    reader_ = ::open(pipe_.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    log = std::make_unique<LogFile>(pipe_, std::uintmax_t{1} << 40, gap_in_words);
  }
  StuckLog(const StuckLog&) = delete;
  StuckLog& operator=(const StuckLog&) = delete;
  ~StuckLog() {
    ::close(reader_);
    log.reset();
  }

  /// Adds a line that is longer than the pipe, and waits until the writing thread is in the middle of it:
  /// from then on lines wait.
  void fill() {
    const int capacity = ::fcntl(reader_, F_GETPIPE_SZ);
    log->add(0.0, std::string(static_cast<std::size_t>(capacity) + 1, 'f') + "\n");
    until_so([&] {
      int held = 0;
      return ::ioctl(reader_, FIONREAD, &held) == 0 && held == capacity;
    });
  }
  /// Reads until so many lines have come.
  std::string read_lines(std::ptrdiff_t count) {
    std::string all;
    std::ptrdiff_t lines = 0;
    std::array<char, 65536> piece{};
    until_so([&] {
      const ssize_t got = ::read(reader_, piece.data(), piece.size());
      if (got > 0) {
        all.append(piece.data(), static_cast<std::size_t>(got));
        lines += std::count(piece.begin(), piece.begin() + got, '\n');
      }
      return lines >= count;
    });
    return all;
  }

  std::unique_ptr<LogFile> log;

 private:
  TemporaryFolder folder_;
  std::filesystem::path pipe_;
  int reader_ = -1;
};

// The line of fill() is being written, so it does not wait.
TEST(LogFileBounds, SoManyLinesWaitAndNotOneMore) {
  StuckLog stuck;
  stuck.fill();
  for (std::size_t i = 0; i < LogFile::kWaiting; ++i) stuck.log->add(1.0, "a\n");
  ASSERT_FALSE(stuck.log->broken()) << "as many as may wait";
  stuck.log->add(7.0, "lost\n");
  ASSERT_TRUE(stuck.log->broken());
  stuck.log->add(8.0, "lost\n");
  const std::string lines = stuck.read_lines(1 + static_cast<std::ptrdiff_t>(LogFile::kWaiting));
  EXPECT_EQ(lines.find("lost"), std::string::npos);
  stuck.log->add(9.0, "after\n");
  EXPECT_EQ(stuck.read_lines(2), "missing 2 from 7 to 8\nafter\n");
}

// Eight lines of 1,000,000 bytes are the 8,000,000 that may wait; one byte more may not. What was written
// counts no more: the second time it is the same.
TEST(LogFileBounds, SoManyBytesWaitAndNotOneMore) {
  StuckLog stuck;
  const std::string line = std::string(LogFile::kWaitingBytes / 8 - 1, 'a') + "\n";
  for (int round = 0; round < 2; ++round) {
    stuck.fill();
    for (int i = 0; i < 8; ++i) stuck.log->add(1.0, line);
    ASSERT_FALSE(stuck.log->broken()) << round;
    stuck.log->add(7.0, "\n");
    ASSERT_TRUE(stuck.log->broken()) << round;
    stuck.read_lines(9);
    stuck.log->add(8.0, "after\n");
    EXPECT_EQ(stuck.read_lines(2), "missing 1 from 7 to 7\nafter\n");
    until_so([&] { return !stuck.log->broken(); });
  }
}

// 10 bytes may be in the file: 5 and 5 are, and one more begins it anew.
TEST(LogFileBounds, AFileIsFilledToItsLengthAndNotBeyond) {
  const TemporaryFolder folder;
  const auto file = folder / "log";
  LogFile log(file, 10, gap_in_words);
  log.add(0.0, "1234\n");
  log.add(0.0, "6789\n");
  until_so([&] { return read_file(file).size() >= 10 || std::filesystem::exists(folder / "log.1"); });
  ASSERT_EQ(read_file(file), "1234\n6789\n");
  log.add(0.0, "\n");
  until_so([&] { return read_file(file) == "\n"; });
  EXPECT_EQ(read_file(folder / "log.1"), "1234\n6789\n");
}

}  // namespace
}  // namespace phalanx

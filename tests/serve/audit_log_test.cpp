// SPDX-License-Identifier: Apache-2.0
#include "serve/audit_log.h"

#include <fcntl.h>
#include <gmock/gmock.h>
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
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "record/temporary_folder.h"
#include "serve/full_disk.h"

namespace phalanx {
namespace {

using testing::read_file;
using ::testing::StartsWith;
using testing::TemporaryFolder;

wire::Notice notice(const std::string& who, const std::string& text, double at = 1777887000.1234) {
  wire::Notice out;
  out.set_level(wire::Notice::CHANGE);
  out.set_unix_time(at);
  out.set_who(who);
  out.set_code("set");
  out.set_text(text);
  return out;
}

std::vector<nlohmann::json> lines_in(const std::string& text) {
  std::istringstream stream(text);
  std::vector<nlohmann::json> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(nlohmann::json::parse(line));
  return lines;
}

/// @param awaited  lines: another thread writes them
std::vector<nlohmann::json> lines_of(const std::filesystem::path& file, std::ptrdiff_t awaited = 0) {
  std::string text = read_file(file);
  for (int i = 0; i < 60'000 && std::count(text.begin(), text.end(), '\n') < awaited; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    text = read_file(file);
  }
  return lines_in(text);
}

void until_broken(const AuditLog& log) {
  for (int i = 0; i < 60'000 && !log.broken(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  ASSERT_TRUE(log.broken());
}

/// @returns 7 for the line "lines missing here, ...: 7"; 0 for another line
int missing(const nlohmann::json& line) {
  const auto text = line["text"].get<std::string>();
  return line["code"] == "log_gap" ? std::stoi(text.substr(text.rfind(' '))) : 0;
}

TEST(AuditLog, IsAJsonLineForEachWithTimeAndWho) {
  const TemporaryFolder folder;
  AuditLog log(folder / "deep/down/audit.jsonl");
  log.add(notice("page 1 (127.0.0.1), Anna", "rate_hz = 250"));
  const auto lines = lines_of(folder / "deep/down/audit.jsonl", 1);
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_EQ(lines[0]["time"], "2026-05-04T09:30:00.123Z");
  EXPECT_EQ(lines[0]["level"], "CHANGE");
  EXPECT_EQ(lines[0]["who"], "page 1 (127.0.0.1), Anna");
  EXPECT_EQ(lines[0]["code"], "set");
  EXPECT_EQ(lines[0]["text"], "rate_hz = 250");
  EXPECT_FALSE(log.broken());
}

TEST(AuditLog, ANoticeCannotForgeAnotherLine) {
  const TemporaryFolder folder;
  {
    AuditLog log(folder / "audit.jsonl");
    log.add(notice("x\",\"who\":\"page 1", "a\"}\n{\"time\":\"now\",\"code\":\"resumed\"}\r\n"));
    log.add(notice("\xFF\xFE", std::string("nul \0 byte", 10)));
  }
  AuditLog again(folder / "audit.jsonl");
  again.add(notice("page 2", "appended"));
  const auto lines = lines_of(folder / "audit.jsonl", 3);
  ASSERT_EQ(lines.size(), 3U);
  EXPECT_EQ(lines[0]["who"], "x\",\"who\":\"page 1");
  EXPECT_EQ(lines[0]["code"], "set");
  EXPECT_EQ(lines[2]["text"], "appended");
}

TEST(AuditLog, RemembersTheNewestShortenedAndWritesThemWhole) {
  const TemporaryFolder folder;
  AuditLog log(folder / "audit.jsonl");
  const std::string text(60000, 'v');
  for (int i = 0; i < 150; ++i) {
    log.add(notice("page " + std::to_string(i), text));
    // The writer's queue holds some megabytes; what does not fit is dropped.
    if (i % 50 == 49) {
      ASSERT_EQ(lines_of(folder / "audit.jsonl", i + 1).size(), static_cast<std::size_t>(i + 1));
    }
  }
  ASSERT_EQ(log.newest().size(), AuditLog::kRemembered);
  EXPECT_EQ(log.newest().back().who(), "page 149");
  std::size_t bytes = 0;
  for (const wire::Notice& one : log.newest()) bytes += one.ByteSizeLong();
  EXPECT_LT(bytes, 300000U) << "a page that comes gets all of them";
  EXPECT_EQ(lines_of(folder / "audit.jsonl", 150).back()["text"], text);
}

TEST(AuditLog, AFileThatIsFullIsRenamedAndReplaced) {
  const TemporaryFolder folder;
  const auto file = folder / "audit.jsonl";
  const auto aside = folder / "audit.jsonl.1";
  const auto numbered = [](int i) { return notice("page 1", std::to_string(i) + std::string(300, 'v')); };
  constexpr std::uintmax_t kMost = 4000;  // [bytes]: 9 lines
  for (int run = 0; run < 5; ++run) {     // what an earlier run has written counts
    {
      AuditLog log(file, kMost);
      for (int i = 0; i < 8; ++i) log.add(numbered(8 * run + i));
    }
    EXPECT_LE(std::filesystem::file_size(file), kMost);
  }
  const auto lines = lines_of(file);
  const auto before = lines_of(aside);
  EXPECT_LE(std::filesystem::file_size(aside), kMost);
  const std::size_t held = lines.size() + before.size();
  ASSERT_GT(before.size(), 0U);
  EXPECT_EQ(lines.back()["text"], numbered(39).text());
  EXPECT_EQ(before.front()["text"], numbered(40 - static_cast<int>(held)).text())
      << "none is missing between";
}

TEST(AuditLog, WithoutAFileItIsMemoryAlone) {
  AuditLog log("");
  log.add(notice("page 1", "x"));
  EXPECT_EQ(log.newest().size(), 1U);
  EXPECT_FALSE(log.broken());
}

TEST(AuditLog, AFileThatCannotBeWrittenIsRefused) {
  const TemporaryFolder folder;
  EXPECT_THROW(AuditLog(folder.path()), std::runtime_error) << "a folder";
}

TEST(AuditLog, AfterAFullDiskEachLineTriesToWriteAgain) {
  const TemporaryFolder folder;
  const auto file = folder / "audit.jsonl";
  AuditLog log(file);
  log.add(notice("page 1", "before"));
  ASSERT_EQ(lines_of(file, 1).size(), 1U);
  {
    const FullDisk full;
    log.add(notice("page 1", "lost", 1777887060.5));
    until_broken(log);
    EXPECT_EQ(log.newest().size(), 2U);
  }
  log.add(notice("page 1", "after"));
  const auto lines = lines_of(file, 3);
  ASSERT_EQ(lines.size(), 3U);
  EXPECT_EQ(lines[1]["code"], "log_gap");
  EXPECT_EQ(lines[1]["level"], "WARNING");
  EXPECT_EQ(lines[1]["time"], "2026-05-04T09:31:00.500Z");
  EXPECT_EQ(lines[1]["text"],
            "lines missing here, from 2026-05-04T09:31:00.500Z on, because the disk did not take them: 1");
  EXPECT_EQ(lines[2]["text"], "after");
}

TEST(AuditLog, ALineThatWasWrittenInPartSpoilsNoOther) {
  const TemporaryFolder folder;
  const auto file = folder / "audit.jsonl";
  {
    AuditLog log(file);
    {
      const FullDisk full(10);  // [bytes]
      log.add(notice("page 1", "torn"));
      until_broken(log);
    }
    log.add(notice("page 1", "after"));
  }
  const std::string text = read_file(file);
  EXPECT_THAT(text, StartsWith("{\"time\":\"2\n{"));
  const auto lines = lines_in(text.substr(11));
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_EQ(missing(lines[0]), 1);
  EXPECT_EQ(lines[1]["text"], "after");
}

// A pipe that is not read acts like a disk that accepts nothing.
TEST(AuditLog, ADiskThatIsStuckDelaysNoCallerAndEveryLineIsWrittenOrCounted) {
  const TemporaryFolder folder;
  const auto pipe = folder / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  const int reader = ::open(pipe.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  ASSERT_GE(reader, 0);
  constexpr int kAdded = 3000;
  {
    AuditLog log(pipe);
    const std::string text(1000, 'v');
    for (int i = 0; i < kAdded; ++i) log.add(notice("page 1", text));  // hangs if it waits
    EXPECT_TRUE(log.broken());
  }  // hangs if it waits for all of it
  ASSERT_EQ(::fcntl(reader, F_SETFL, 0), 0);
  std::string all;
  std::array<char, 65536> piece{};
  for (ssize_t got = 1; got > 0;) {
    got = ::read(reader, piece.data(), piece.size());
    all.append(piece.data(), static_cast<std::size_t>(std::max<ssize_t>(got, 0)));
  }
  ::close(reader);
  int written = 0;
  int missed = 0;
  for (const nlohmann::json& line : lines_in(all)) {
    missed += missing(line);
    if (line["code"] == "set") ++written;
  }
  EXPECT_GE(written, static_cast<int>(LogFile::kWaiting));
  EXPECT_GT(missed, 0);
  EXPECT_EQ(written + missed, kAdded);
}

// ---- LogFile: its bounds, with a disk that is stuck (a full pipe that is not read) ----

std::string gap_in_words(const LogGap& gap) {
  return "missing " + std::to_string(gap.lines) + " from " + std::to_string(static_cast<int>(gap.since)) +
         " to " + std::to_string(static_cast<int>(gap.until)) + "\n";
}

/// Waits until a condition holds that another thread brings about.
template <class Condition>
void wait_until(const Condition& so) {
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

  /// Adds a line that is longer than the pipe, and waits until the writing thread is in the middle of it.
  /// From then on further lines wait.
  void fill() {
    const int capacity = ::fcntl(reader_, F_GETPIPE_SZ);
    log->add(0.0, std::string(static_cast<std::size_t>(capacity) + 1, 'f') + "\n");
    wait_until([&] {
      int held = 0;
      return ::ioctl(reader_, FIONREAD, &held) == 0 && held == capacity;
    });
  }
  /// Reads until so many lines have come.
  std::string read_lines(std::ptrdiff_t count) {
    std::string all;
    std::ptrdiff_t lines = 0;
    std::array<char, 65536> piece{};
    wait_until([&] {
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
TEST(LogFileBounds, ItsNumberOfLinesMayWaitAndNotOneMore) {
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

// Eight lines of 1,000,000 bytes are the 8,000,000 that may wait; one byte more may not. Written lines do not
// count: the second round is like the first.
TEST(LogFileBounds, ItsNumberOfBytesMayWaitAndNotOneMore) {
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
    wait_until([&] { return !stuck.log->broken(); });
  }
}

// The file may hold 10 bytes: 5 and 5 fit, and one more begins a new file.
TEST(LogFileBounds, AFileIsFilledToItsLengthAndNotBeyond) {
  const TemporaryFolder folder;
  const auto file = folder / "log";
  LogFile log(file, 10, gap_in_words);
  log.add(0.0, "1234\n");
  log.add(0.0, "6789\n");
  wait_until([&] { return read_file(file).size() >= 10 || std::filesystem::exists(folder / "log.1"); });
  ASSERT_EQ(read_file(file), "1234\n6789\n");
  log.add(0.0, "\n");
  wait_until([&] { return read_file(file) == "\n"; });
  EXPECT_EQ(read_file(folder / "log.1"), "1234\n6789\n");
}

}  // namespace
}  // namespace phalanx

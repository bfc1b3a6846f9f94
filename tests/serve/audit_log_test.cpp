// SPDX-License-Identifier: Apache-2.0
#include "serve/audit_log.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
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

/// How many lines "lines missing here, ...: 7" says there are.
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

TEST(AuditLog, NobodyWritesALineThatIsNotTheirs) {
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
  for (int i = 0; i < 150; ++i) log.add(notice("page " + std::to_string(i), text));
  ASSERT_EQ(log.newest().size(), AuditLog::kRemembered);
  EXPECT_EQ(log.newest().back().who(), "page 149");
  std::size_t bytes = 0;
  for (const wire::Notice& one : log.newest()) bytes += one.ByteSizeLong();
  EXPECT_LT(bytes, 300000U) << "a page that comes gets all of them";
  EXPECT_EQ(lines_of(folder / "audit.jsonl", 150).back()["text"], text);
}

TEST(AuditLog, AFileThatIsFullIsPutAsideAndBegunAnew) {
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

TEST(AuditLog, AFullDiskEndsNothingAndEachLineTriesAgain) {
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

TEST(AuditLog, ALineThatOnlyBeganToBeWrittenSpoilsNoOther) {
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

// A pipe that nobody reads is a disk that takes nothing for as long as one likes.
TEST(AuditLog, ADiskThatIsStuckKeepsNobodyWaitingAndEveryLineIsThereOrMissed) {
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

}  // namespace
}  // namespace phalanx

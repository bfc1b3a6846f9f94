// SPDX-License-Identifier: Apache-2.0
#include "serve/audit_log.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>

#include "record/temporary_folder.h"

namespace phalanx {
namespace {

using testing::read_file;
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

std::vector<nlohmann::json> lines_of(const std::filesystem::path& file) {
  std::istringstream text(read_file(file));
  std::vector<nlohmann::json> lines;
  for (std::string line; std::getline(text, line);) lines.push_back(nlohmann::json::parse(line));
  return lines;
}

TEST(AuditLog, IsAJsonLineForEachWithTimeAndWho) {
  const TemporaryFolder folder;
  AuditLog log(folder / "deep/down/audit.jsonl");
  log.add(notice("page 1 (127.0.0.1), Anna", "rate_hz = 250"));
  const auto lines = lines_of(folder / "deep/down/audit.jsonl");
  ASSERT_EQ(lines.size(), 1U) << "written at once";
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
  const auto lines = lines_of(folder / "audit.jsonl");
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
  EXPECT_EQ(lines_of(folder / "audit.jsonl").back()["text"], text);
}

TEST(AuditLog, AFileThatIsFullIsPutAsideAndBegunAnew) {
  const TemporaryFolder folder;
  const auto file = folder / "audit.jsonl";
  const auto aside = folder / "audit.jsonl.1";
  const auto numbered = [](int i) { return notice("page 1", std::to_string(i) + std::string(300, 'v')); };
  constexpr std::uintmax_t kMost = 4000;  // [bytes]: 9 lines
  for (int run = 0; run < 5; ++run) {     // what an earlier run has written counts
    AuditLog log(file, kMost);
    for (int i = 0; i < 8; ++i) log.add(numbered(8 * run + i));
    EXPECT_FALSE(log.broken());
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

TEST(AuditLog, AFileThatCannotBeWrittenIsRefusedAndOneThatFillsUpIsGivenUp) {
  const TemporaryFolder folder;
  EXPECT_THROW(AuditLog(folder.path()), std::runtime_error) << "a folder";
  AuditLog full("/dev/full");
  full.add(notice("page 1", "x"));
  EXPECT_TRUE(full.broken());
  full.add(notice("page 1", "y"));
  EXPECT_EQ(full.newest().size(), 2U);
}

}  // namespace
}  // namespace phalanx

// SPDX-License-Identifier: Apache-2.0
#include "phalanx/registry/audit.h"

#include <gmock/gmock.h>

#include "registry/registry_files.h"

namespace phalanx {
namespace {

using ::testing::ElementsAre;
using testing::example_patient;
using testing::example_result;
using ::testing::HasSubstr;
using testing::kOwner;
using testing::RegistryFiles;

std::vector<std::string> lines_of(const std::filesystem::path& file) {
  std::istringstream text(testing::read_file(file));
  std::vector<std::string> out;
  for (std::string line; std::getline(text, line);) out.push_back(line);
  return out;
}

void write_lines(const std::filesystem::path& file, const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  testing::write_bytes(file, text);
}

/// A registry with seven lines in its audit log.
struct Logged {
  RegistryFiles files;
  std::string record;
  std::filesystem::path log;

  Logged() : log(files.data() / "audit.jsonl") {
    Registry registry = files.open();
    record = registry.add_patient(kOwner, example_patient()).record;
    static_cast<void>(registry.patients(kOwner));
    static_cast<void>(registry.patient(kOwner, "P07"));
    registry.add_result(kOwner, record, example_result("a.mcap"));
    static_cast<void>(registry.results(kOwner, record));
    registry.add_note(kOwner, record, "text");
    static_cast<void>(registry.notes(kOwner, record));
  }
  [[nodiscard]] AuditCheck check() { return files.open().check_audit(kOwner); }
};

TEST(RegistryAudit, HasALineForEachReadAndChange) {
  Logged logged;
  Registry registry = logged.files.open();
  std::vector<std::string> actions;
  for (const AuditEntry& entry : registry.audit(kOwner)) {
    actions.push_back(entry.action);
    EXPECT_EQ(entry.account, "owner");
    EXPECT_EQ(entry.time, "2026-05-04T09:30:00Z");
    EXPECT_EQ(entry.record, entry.action == "list" ? "*" : logged.record);
    EXPECT_EQ(entry.n, actions.size());
  }
  EXPECT_THAT(actions, ElementsAre("add", "list", "show", "add_result", "results", "add_note", "notes"));
  EXPECT_EQ(testing::read_file(logged.log).find("P07"), std::string::npos);
  EXPECT_EQ(registry.audit(kOwner, 2).front().action, "add_note");
  const AuditCheck check = registry.check_audit(kOwner);
  EXPECT_TRUE(check.whole) << check.text;
  EXPECT_EQ(check.lines, 7U);
}

TEST(RegistryAudit, NamesTheLineThatWasChangedOrRemoved) {
  for (std::size_t i = 0; i < 7; ++i) {
    Logged logged;
    const std::vector<std::string> lines = lines_of(logged.log);
    std::vector<std::string> changed = lines;
    changed[i].replace(changed[i].find("owner"), 5, "admin");
    write_lines(logged.log, changed);
    EXPECT_FALSE(logged.check().whole);
    EXPECT_EQ(logged.check().first_broken, i + 1) << logged.check().text;

    std::vector<std::string> removed = lines;
    removed.erase(removed.begin() + static_cast<std::ptrdiff_t>(i));
    write_lines(logged.log, removed);
    if (i + 1 == lines.size()) continue;  // the newest line comes back from the head
    EXPECT_FALSE(logged.check().whole);
    EXPECT_EQ(logged.check().first_broken, i + 1) << logged.check().text;
  }
}

TEST(RegistryAudit, NamesLinesThatAreMissingAtTheEnd) {
  Logged logged;
  std::vector<std::string> lines = lines_of(logged.log);
  lines.resize(4);
  write_lines(logged.log, lines);
  EXPECT_EQ(logged.check().first_broken, 5U);
  EXPECT_THAT(logged.check().text, HasSubstr("lines 5 to 7"));
  static_cast<void>(logged.files.open().patients(kOwner));  // a further line does not cover the gap
  EXPECT_EQ(logged.check().first_broken, 5U) << logged.check().text;
}

TEST(RegistryAudit, NoticesLinesThatAreMissingTogetherWithTheHead) {
  Logged logged;
  std::vector<std::string> lines = lines_of(logged.log);
  lines.resize(4);
  write_lines(logged.log, lines);
  std::filesystem::remove(logged.files.keys_file().string() + ".heads");
  EXPECT_FALSE(logged.check().whole);
  EXPECT_EQ(logged.check().first_broken, 5U);
  static_cast<void>(logged.files.open().patients(kOwner));  // the new head does not cover it
  EXPECT_EQ(logged.check().first_broken, 5U) << logged.check().text;
}

TEST(RegistryAudit, HasALineForAFailedReadOrChange) {
  Logged logged;
  Registry registry = logged.files.open();
  EXPECT_THROW(static_cast<void>(registry.patient(kOwner, "P99")), RegistryError);
  EXPECT_THROW(registry.add_patient(kOwner, example_patient()), RegistryError);
  EXPECT_THROW(registry.edit_patient(kOwner, registry.patient(kOwner, "P07"), "another base"), RegistryError);
  std::vector<std::string> actions;
  for (const AuditEntry& entry : registry.audit(kOwner, 4))
    actions.push_back(entry.action + " " + (entry.record == "*" ? "*" : "P07"));
  EXPECT_THAT(actions, ElementsAre("show_failed *", "add_failed *", "show P07", "edit_failed *"));
}

TEST(RegistryAudit, BringsBackTheNewestLineAfterAKill) {
  Logged logged;
  const std::string whole = testing::read_file(logged.log);
  const std::string last = lines_of(logged.log).back();
  for (const std::size_t lost : {last.size() + 1, last.size() / 2, std::size_t{1}}) {
    testing::write_bytes(logged.log, whole.substr(0, whole.size() - lost));
    EXPECT_TRUE(logged.check().whole) << logged.check().text;
    EXPECT_EQ(testing::read_file(logged.log), whole);
  }
}

TEST(RegistryAudit, NamesForgedLines) {
  Logged logged;
  std::vector<std::string> lines = lines_of(logged.log);
  lines.push_back(lines.back());
  write_lines(logged.log, lines);
  EXPECT_EQ(logged.check().first_broken, 8U) << logged.check().text;
  static_cast<void>(logged.files.open().patients(kOwner));
  EXPECT_FALSE(logged.check().whole);

  Logged another;  // a whole log of another registry with a right chain
  Logged foreign;
  testing::write_bytes(another.log, testing::read_file(foreign.log));
  EXPECT_FALSE(another.check().whole);
}

TEST(RegistryAudit, NoticesThatTheWholeRegistryIsMissing) {
  Logged logged;
  std::filesystem::remove_all(logged.files.data());
  EXPECT_FALSE(logged.check().whole);
  EXPECT_THAT(logged.check().text, HasSubstr("an earlier registry"));
  EXPECT_THAT(logged.check().text, HasSubstr("7 audit lines"));
  static_cast<void>(logged.files.open().patients(kOwner));
  EXPECT_FALSE(logged.check().whole) << "nor does a further line cover it";
}

}  // namespace
}  // namespace phalanx

// SPDX-License-Identifier: Apache-2.0
// packages/*.txt: what ./run, ./test and scripts/make_packages hand to apt, and what THIRD_PARTY.md must account for.
#include <gtest/gtest.h>

#include <map>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "project/source_tree.h"

namespace phalanx::project {
namespace {

struct Entry {
  std::string package;
  std::string rest;
};

std::vector<Entry> entries_of(const std::string& list) {
  std::vector<Entry> entries;
  for (const auto& line : lines_of("packages/" + list + ".txt")) {
    std::istringstream words(line.substr(0, line.find('#')));
    Entry entry;
    if (!(words >> entry.package)) continue;
    std::getline(words >> std::ws, entry.rest);
    entries.push_back(entry);
  }
  return entries;
}

class PackageList : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Each, PackageList, testing::Values("run", "test", "packaging", "optional"),
                         [](const auto& list) { return std::string(list.param); });

TEST_P(PackageList, HoldsAPackageNameAndAtMostOneCommandALine) {
  // Debian policy 5.6.1: lower case letters, digits, plus, minus and full stop; at least two; the first is a
  // letter or digit.
  const std::regex package("[a-z0-9][a-z0-9+.-]+");
  const std::regex command("[A-Za-z0-9+._-]*");
  const auto entries = entries_of(GetParam());
  EXPECT_FALSE(entries.empty());
  for (const auto& entry : entries) {
    EXPECT_TRUE(std::regex_match(entry.package, package)) << entry.package;
    EXPECT_TRUE(std::regex_match(entry.rest, command)) << entry.package << ": " << entry.rest;
  }
}

// Packages are made without the packages of the tests, so that packaging.txt may name some of them, too.
TEST(PackageLists, NameEachPackageOnce) {
  for (const std::vector<std::string>& lists :
       {std::vector<std::string>{"run", "test", "optional"}, {"run", "packaging"}}) {
    std::map<std::string, std::string> seen;
    for (const std::string& list : lists) {
      for (const auto& entry : entries_of(list)) {
        EXPECT_TRUE(seen.emplace(entry.package, list).second)
            << entry.package << " is in " << seen[entry.package] << ".txt and " << list << ".txt";
      }
    }
  }
}

TEST(PackageLists, AreAccountedForInThirdParty) {
  std::string text;
  for (const auto& line : lines_of("THIRD_PARTY.md")) text += line + "\n";
  for (const auto* list : {"run", "test", "packaging"}) {
    for (const auto& entry : entries_of(list)) {
      EXPECT_NE(text.find("`" + entry.package + "`"), std::string::npos) << entry.package;
    }
  }
}

}  // namespace
}  // namespace phalanx::project

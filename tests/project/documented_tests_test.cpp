// SPDX-License-Identifier: Apache-2.0
// Each `./test -R NAME` in the documents names suites that there are.
#include <gtest/gtest.h>

#include <algorithm>
#include <regex>
#include <set>
#include <string>

#include "project/source_tree.h"

namespace phalanx::project {
namespace {

/// What ctest's names are made of: the suites, and the names that CMake gives to other tests.
std::set<std::string> suites() {
  static const std::regex suite(R"(^(?:TYPED_)?TEST(?:_F|_P)?\(\s*(\w+),.*)");
  static const std::regex other(R"(.*add_test\(\s*NAME ([^\s$]+).*)");
  std::set<std::string> names;
  for (const auto& file : files_below("tests", {".cpp", ".txt"})) {
    for (const std::string& line : lines_of(file)) {
      std::smatch match;
      if (std::regex_match(line, match, suite) || std::regex_match(line, match, other))
        names.insert(match[1].str());
    }
  }
  return names;
}

TEST(DocumentedTests, AreThere) {
  const std::set<std::string> all = suites();
  ASSERT_GT(all.size(), 100U);
  static const std::regex command(R"(\./test -R ([^\s`]+))");
  int commands = 0;
  auto documents = files_below("docs", {".md"});
  for (const char* document : {"README.md", "CONTRIBUTING.md", "bench/README.md"})
    documents.emplace_back(document);
  for (const auto& file : documents) {
    for (const std::string& line : lines_of(file)) {
      for (std::sregex_iterator found(line.begin(), line.end(), command); found != std::sregex_iterator();
           ++found) {
        std::string name = (*found)[1].str();
        std::erase(name, '\'');
        if (name == "NAME") continue;
        ++commands;
        const std::regex wanted(name);
        EXPECT_TRUE(std::any_of(all.begin(), all.end(),
                                [&](const std::string& one) { return std::regex_search(one, wanted); }))
            << file << ": ./test -R " << name << " matches no suite";
      }
    }
  }
  EXPECT_GT(commands, 10);
}

}  // namespace
}  // namespace phalanx::project

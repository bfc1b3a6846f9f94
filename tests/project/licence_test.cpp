// SPDX-License-Identifier: Apache-2.0
// Every file says under which licence it is; every asset says where it comes from.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <string>

#include "project/source_tree.h"

namespace phalanx::project {
namespace {

bool names_our_licence(const std::filesystem::path& file) {
  const auto lines = lines_of(file);
  const auto first = std::min<std::size_t>(lines.size(), 3);
  return std::any_of(lines.begin(), lines.begin() + static_cast<std::ptrdiff_t>(first),
                     [](const std::string& line) {
                       return line.find("SPDX-License-Identifier: Apache-2.0") != std::string::npos;
                     });
}

// The whole text in lower case; of the file itself and, for a format without comments, of FILE.license beside
// it.
std::string statement_of(const std::filesystem::path& file) {
  std::string text;
  auto beside = file;
  beside += ".license";
  for (const auto& part : {file, beside}) {
    if (!std::filesystem::exists(root() / part)) continue;
    for (const auto& line : lines_of(part)) text += line + "\n";
  }
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

TEST(Licence, EverySourceFileNamesItInItsFirstThreeLines) {
  std::size_t files = 0;
  for (const auto* folder :
       {"include", "src", "apps", "tests", "bench", "examples", "cmake", "scripts", "python"}) {
    for (const auto& file : files_below(folder, {".h", ".cpp", ".cmake", ".in", ".sh", ".py", ".pyi"})) {
      EXPECT_TRUE(names_our_licence(file)) << file;
      ++files;
    }
    for (const auto& file : files_below(folder, {".txt"})) {
      if (file.filename() != "CMakeLists.txt") continue;
      EXPECT_TRUE(names_our_licence(file)) << file;
    }
  }
  for (const auto* file : {"CMakeLists.txt", "run", "test", ".ci/run"})
    EXPECT_TRUE(names_our_licence(file)) << file;
  EXPECT_GT(files, 20U) << "the search for source files is broken";
}

TEST(Licence, TheFullTextAndTheNoticesAreThere) {
  for (const auto* file : {"LICENSE", "NOTICE", "THIRD_PARTY.md", "CITATION.cff"}) {
    EXPECT_FALSE(lines_of(file).empty()) << file;
  }
  EXPECT_NE(statement_of("LICENSE").find("version 2.0, january 2004"), std::string::npos);
}

TEST(Licence, EveryAssetAndSceneStatesItsSourceAndLicence) {
  for (const auto* folder : {"assets", "scenes"}) {
    for (const auto& file : files_below(folder)) {
      if (file.extension() == ".license" || file.extension() == ".md") continue;
      const auto text = statement_of(file);
      EXPECT_NE(text.find("source"), std::string::npos)
          << file << " does not say its source; where the format has no comments say it in "
          << file.filename() << ".license";
      EXPECT_TRUE(text.find("licence") != std::string::npos || text.find("license") != std::string::npos)
          << file << " does not say its licence; where the format has no comments say it in "
          << file.filename() << ".license";
    }
  }
}

}  // namespace
}  // namespace phalanx::project

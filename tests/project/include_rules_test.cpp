// SPDX-License-Identifier: Apache-2.0
// Which folder may include which: the table of docs/architecture.md, held against every #include.
#include <gtest/gtest.h>

#include <map>
#include <regex>
#include <set>
#include <string>

#include "project/source_tree.h"

namespace phalanx::project {
namespace {

using Modules = std::set<std::string>;

// A module may always include itself.
const std::map<std::string, Modules>& allowed_includes() {
  static const std::map<std::string, Modules> table = {
      {"core", {}},
      {"mesh", {"core"}},
      {"hand", {"core", "mesh"}},
      {"contact", {"core", "mesh", "hand"}},
      {"force", {"core", "hand", "contact"}},
      {"step", {"core", "mesh", "hand", "contact", "force"}},
      {"device", {"core", "hand", "force", "step"}},
      {"scene", {"core", "mesh", "hand", "contact", "force", "step", "device"}},
      {"station", {"core", "hand", "force", "step", "device", "scene"}},
      {"exercise", {"core", "step"}},
      {"record", {"core", "mesh", "hand", "step", "device", "station", "scene"}},
      {"serve", {"core", "mesh", "hand", "step", "device", "station", "scene", "record", "exercise"}},
      {"study",
       {"core", "mesh", "hand", "contact", "force", "step", "device", "scene", "station", "exercise",
        "record"}},
  };
  return table;
}

// "phalanx/tick.pb.h", which the build makes of proto/phalanx/tick.proto.
bool is_generated(const std::string& path) { return path.ends_with(".pb.h"); }

// The module that a quoted include names, from the project's root of includes ("phalanx/mesh/x.h", or
// "mesh/x.h" below src/); empty for a file beside the one that includes it.
std::string module_of_include(const std::string& path) {
  if (is_generated(path)) return {};
  static const std::regex with_module(R"((?:phalanx/)?([a-z_]+)/.*)");
  std::smatch match;
  return std::regex_match(path, match, with_module) ? match[1].str() : std::string();
}

bool resolves(const std::filesystem::path& from, const std::string& include) {
  namespace fs = std::filesystem;
  if (is_generated(include))
    return fs::exists(root() / "proto" / (include.substr(0, include.size() - 5) + ".proto"));
  return fs::exists(root() / "include" / include) || fs::exists(root() / "src" / include) ||
         fs::exists(root() / from.parent_path() / include);
}

struct Include {
  std::filesystem::path file;
  std::size_t line;
  std::string module;  // of the file
  std::string path;    // as included
};

std::vector<Include> includes_of_modules() {
  static const std::regex directive(R"re(^\s*#\s*include\s*["<]([^">]+)[">].*)re");
  std::vector<Include> includes;
  for (const auto* base : {"include/phalanx", "src"}) {
    for (const auto& [module, unused] : allowed_includes()) {
      for (const auto& file : files_below(std::string(base) + "/" + module, {".h", ".cpp"})) {
        const auto lines = lines_of(file);
        for (std::size_t i = 0; i < lines.size(); ++i) {
          std::smatch match;
          if (!std::regex_match(lines[i], match, directive)) continue;
          const bool quoted = lines[i].find('"') != std::string::npos;
          if (quoted || match[1].str().starts_with("phalanx/"))
            includes.push_back({file, i + 1, module, match[1]});
        }
      }
    }
  }
  return includes;
}

std::string where(const Include& include) {
  return include.file.string() + ":" + std::to_string(include.line) + " includes \"" + include.path + "\"";
}

TEST(IncludeRules, EveryFolderOfSourcesIsInTheTable) {
  for (const auto* base : {"include/phalanx", "src"}) {
    for (const auto& entry : std::filesystem::directory_iterator(root() / base)) {
      if (!entry.is_directory()) continue;
      EXPECT_TRUE(allowed_includes().contains(entry.path().filename().string()))
          << entry.path() << " is a module that this test's table and docs/architecture.md do not know";
    }
  }
}

TEST(IncludeRules, TheTableHasNoCycle) {
  for (const auto& [module, may] : allowed_includes()) {
    for (const auto& used : may) {
      ASSERT_TRUE(allowed_includes().contains(used)) << used;
      EXPECT_FALSE(allowed_includes().at(used).contains(module))
          << module << " and " << used << " include each other";
      for (const auto& further : allowed_includes().at(used)) {
        EXPECT_NE(further, module) << module << " reaches itself through " << used;
      }
    }
  }
}

TEST(IncludeRules, NoModuleIncludesWhatTheTableDoesNotAllow) {
  const auto includes = includes_of_modules();
  ASSERT_GT(includes.size(), 20U) << "the search for #include lines is broken";
  for (const auto& include : includes) {
    const auto target = module_of_include(include.path);
    if (target.empty() || target == include.module) continue;
    EXPECT_TRUE(allowed_includes().at(include.module).contains(target))
        << where(include) << ": " << include.module << " may not include " << target;
  }
}

TEST(IncludeRules, EveryIncludeOfOurOwnNamesAFileOfTheModulesAndNotOfTheProgram) {
  for (const auto& include : includes_of_modules()) {
    if (include.path == "phalanx_commit.h") continue;  // written by the build
    EXPECT_TRUE(resolves(include.file, include.path))
        << where(include) << ", which is in neither include/ nor src/";
    EXPECT_EQ(include.path.find("apps/"), std::string::npos) << where(include);
    EXPECT_EQ(include.path.find("../"), std::string::npos) << where(include);
  }
}

TEST(IncludeRules, PublicHeadersIncludeOnlyPublicHeaders) {
  for (const auto& include : includes_of_modules()) {
    if (!include.file.string().starts_with("include/")) continue;
    EXPECT_TRUE(std::filesystem::exists(root() / "include" / include.path))
        << where(include) << ", which is not installed";
  }
}

}  // namespace
}  // namespace phalanx::project

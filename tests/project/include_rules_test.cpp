// SPDX-License-Identifier: Apache-2.0
// Which folder may include which: the table of docs/architecture.md, held against every #include. And what
// the installed headers may include and name.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <regex>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "project/source_tree.h"

namespace phalanx::project {
namespace {

using Modules = std::set<std::string>;
using Table = std::map<std::string, Modules>;  // what each module may include beside itself

constexpr const char* kHeader = "| folder | holds | may include |";

// The table below kHeader. Throws std::runtime_error that quotes the row if there is none, or a row is not
// "| `module` | words | - or other modules of the table |".
Table table_of(const std::vector<std::string>& lines) {
  static const std::regex row(R"(\| `([a-z_]+)` \| .+ \| (-|[a-z_]+(?:, [a-z_]+)*) \|)");
  static const std::regex name("[a-z_]+");
  const auto header = std::find(lines.begin(), lines.end(), kHeader);
  if (lines.end() - header < 3 || *(header + 1) != "|---|---|---|")
    throw std::runtime_error(std::string("no table below ") + kHeader);
  Table table;
  for (auto line = header + 2; line != lines.end() && line->starts_with("|"); ++line) {
    std::smatch match;
    const bool fits = std::regex_match(*line, match, row);
    if (!fits || table.contains(match[1])) throw std::runtime_error("not a row of the table: " + *line);
    const std::string may = match[2];
    table[match[1]] = Modules(std::sregex_token_iterator(may.begin(), may.end(), name), {});
  }
  for (const auto& [module, may] : table) {
    for (const std::string& other : may)
      if (other == module || !table.contains(other))
        throw std::runtime_error(module + " may include " + other +
                                 ", which is no other module of the table");
  }
  if (table.empty()) throw std::runtime_error(std::string("no rows below ") + kHeader);
  return table;
}

const Table& allowed_includes() {
  static const Table table = table_of(lines_of("docs/architecture.md"));
  return table;
}

constexpr const char* kCHeader = "phalanx/phalanx.h";  // of no folder: it includes nothing of the project

// "phalanx/tick.pb.h", which the build makes of proto/phalanx/tick.proto.
bool is_generated(const std::string& path) { return path.ends_with(".pb.h"); }

// The module that a quoted include names, from the project's root of includes ("phalanx/mesh/x.h", or
// "mesh/x.h" below src/); empty for a file beside the one that includes it.
std::string module_of_include(const std::string& path) {
  if (is_generated(path) || path == kCHeader) return {};
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

TEST(IncludeRules, ATableThatIsMissingOrMalformedIsRefused) {
  const auto with = [](const std::vector<std::string>& rows) {
    std::vector<std::string> lines{"# Architecture", kHeader, "|---|---|---|"};
    lines.insert(lines.end(), rows.begin(), rows.end());
    lines.emplace_back("");
    return lines;
  };
  const std::string core = "| `core` | linear algebra | - |";
  EXPECT_EQ(table_of(with({core, "| `mesh` | triangles; a | in words | core |"})),
            (Table{{"core", {}}, {"mesh", {"core"}}}));
  EXPECT_THROW(table_of({}), std::runtime_error);
  EXPECT_THROW(table_of({"# Architecture", core}), std::runtime_error);
  EXPECT_THROW(table_of(with({})), std::runtime_error);
  for (const char* row :
       {"| core | no code mark | - |", "| `mesh` | no modules | |", "| `mesh` | two cells |",
        "| `mesh` | words in place of modules | all above |", "| `mesh` | core, twice | core;core |",
        "| `mesh` | itself | mesh |", "| `mesh` | unknown | serve |", "| `core` | again | - |"})
    EXPECT_THROW(table_of(with({core, row})), std::runtime_error) << row;
}

TEST(IncludeRules, TheTableAndTheFoldersOfSourcesAreTheSame) {
  for (const auto* base : {"include/phalanx", "src"}) {
    for (const auto& entry : std::filesystem::directory_iterator(root() / base)) {
      if (!entry.is_directory()) continue;
      EXPECT_TRUE(allowed_includes().contains(entry.path().filename().string()))
          << entry.path() << " is not in the table of docs/architecture.md";
    }
  }
  for (const auto& [module, unused] : allowed_includes())
    EXPECT_TRUE(std::filesystem::exists(root() / "include/phalanx" / module) ||
                std::filesystem::exists(root() / "src" / module))
        << module << " has no folder";
}

TEST(IncludeRules, TheTableHasNoCycle) {
  for (const auto& [module, may] : allowed_includes()) {
    for (const auto& used : may) {
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
        << where(include) << ", which is not below include/";
  }
}

// The headers in the list `name` of cmake/public_headers.cmake.
std::set<std::string> installed(const std::string& name) {
  static const std::regex header(R"(\s+([a-z0-9_/]+\.h)\)?)");
  std::set<std::string> headers;
  bool inside = false;
  for (const std::string& line : lines_of("cmake/public_headers.cmake")) {
    std::smatch match;
    if (line.starts_with("set("))
      inside = line.starts_with("set(" + name + " ");
    else if (inside && std::regex_match(line, match, header))
      headers.insert(match[1]);
  }
  return headers;
}

// The lists of the libraries; each library uses those before it.
constexpr std::array kLibraries = {"PHALANX_PUBLIC_HEADERS", "PHALANX_IMPORT_PUBLIC_HEADERS",
                                   "PHALANX_SIMULATION_PUBLIC_HEADERS", "PHALANX_STATION_PUBLIC_HEADERS",
                                   "PHALANX_RECORDING_PUBLIC_HEADERS"};

std::string source_of(const std::string& header) { return "include/phalanx/" + header; }

std::set<std::string> all_installed() {
  std::set<std::string> all;
  for (const char* library : kLibraries) all.merge(installed(library));
  return all;
}

TEST(InstalledHeaders, IncludeOnlyInstalledHeaders) {
  const auto includes = includes_of_modules();
  std::set<std::string> usable;
  for (const char* library : kLibraries) {
    const auto headers = installed(library);
    ASSERT_FALSE(headers.empty()) << library;
    std::set<std::string> files;
    for (const std::string& header : headers) {
      EXPECT_TRUE(std::filesystem::exists(root() / source_of(header))) << header;
      files.insert(source_of(header));
      usable.insert("phalanx/" + header);
    }
    for (const auto& include : includes) {
      if (!files.contains(include.file.string())) continue;
      EXPECT_TRUE(usable.contains(include.path))
          << where(include) << ", which a user of " << library << " does not have";
    }
  }
}

TEST(InstalledHeaders, NeedNoPackageButEigen) {
  static const std::regex foreign(R"re(\s*#\s*include\s*<([^>]+)>.*)re");
  static const std::regex allowed(R"([a-z_]+|(std[a-z]+|time)\.h|Eigen/[A-Za-z]+)");  // of C++, C and Eigen
  for (const std::string& header : all_installed()) {
    for (const std::string& line : lines_of(source_of(header))) {
      std::smatch match;
      if (!std::regex_match(line, match, foreign)) continue;
      EXPECT_TRUE(std::regex_match(match[1].str(), allowed)) << header << ": " << line;
    }
  }
}

TEST(InstalledHeaders, NameOnlyInstalledHeadersInTheirComments) {
  static const std::regex name(R"([A-Za-z0-9_/]+\.h\b)");
  static const std::regex directive(R"(\s*#\s*include\b.*)");
  const auto all = all_installed();
  const auto is_installed = [&](const std::string& named) {
    return std::any_of(all.begin(), all.end(), [&](const std::string& header) {
      return ("/phalanx/" + header).ends_with("/" + named);
    });
  };
  for (const std::string& header : all) {
    for (const std::string& line : lines_of(source_of(header))) {
      if (std::regex_match(line, directive)) continue;
      for (std::sregex_iterator at(line.begin(), line.end(), name); at != std::sregex_iterator(); ++at)
        EXPECT_TRUE(is_installed(at->str())) << header << ": " << line;
    }
  }
}

}  // namespace
}  // namespace phalanx::project

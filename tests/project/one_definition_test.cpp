// SPDX-License-Identifier: Apache-2.0
// One definition of each type in the whole program. The linker keeps one of two destructors of the same name
// without a word, so that two types of one name destroy each other's objects wrongly.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <regex>
#include <string>
#include <utility>
#include <vector>

#include "project/source_tree.h"

namespace phalanx::project {
namespace {

/// @returns the file without comments, texts and preprocessor lines.
std::string code_of(const std::vector<std::string>& lines) {
  std::string code;
  bool in_comment = false;
  bool in_directive = false;
  for (const std::string& line : lines) {
    const std::size_t first = line.find_first_not_of(" \t");
    const bool directive = in_directive || (first != std::string::npos && line[first] == '#');
    in_directive = directive && line.ends_with("\\");
    char quote = 0;
    for (std::size_t i = 0; i < line.size() && !directive; ++i) {
      const std::string two = line.substr(i, 2);
      if (in_comment) {
        if (two == "*/") in_comment = false, ++i;
      } else if (quote != 0) {
        if (line[i] == '\\')
          ++i;
        else if (line[i] == quote)
          quote = 0;
      } else if (two == "//") {
        break;
      } else if (two == "/*") {
        in_comment = true, ++i;
      } else if (line[i] == '"' || (line[i] == '\'' && (i == 0 || std::isalnum(line[i - 1]) == 0))) {
        quote = line[i];
      } else {
        code += line[i];
      }
    }
    code += ' ';
  }
  return code;
}

/// @returns the types that the code defines in named namespaces, with these namespaces.
std::vector<std::string> types_defined_in(const std::string& code) {
  static const std::regex space(R"(^\s*(?:inline\s+)?namespace\s*([A-Za-z0-9_:]*)\s*$)");
  static const std::regex type(
      R"((?:^|\s|>)(?:struct|class|union|enum(?:\s+class|\s+struct)?)\s+(?:\[\[[^\]]*\]\]\s*|alignas\s*\([^)]*\)\s*)*([A-Za-z_][A-Za-z0-9_:]*)(?:\s+final)?\s*(?::[^:].*)?$)");
  std::vector<std::string> found;
  std::vector<std::string> scopes;  // of namespaces; "" is any other
  std::string before;               // of a brace
  for (const char letter : code) {
    if (letter == '{') {
      const bool named = std::ranges::find(scopes, "") == scopes.end();
      const auto names = [&](const char* word) { return before.find(word) != std::string::npos; };
      std::smatch match;
      if (names("namespace") && std::regex_match(before, match, space)) {
        scopes.push_back(match[1]);
      } else {
        const bool may_be = names("struct ") || names("class ") || names("union ") || names("enum ");
        if (named && may_be && std::regex_search(before, match, type)) {
          std::string name;
          for (const std::string& scope : scopes) name += scope + "::";
          found.push_back(name + match[1].str());
        }
        scopes.emplace_back();
      }
      before.clear();
    } else if (letter == '}' || letter == ';') {
      if (letter == '}' && !scopes.empty()) scopes.pop_back();
      before.clear();
    } else {
      before += letter;
    }
  }
  return found;
}

TEST(OneDefinition, FindsTypesInNamedNamespacesAlone) {
  const auto found = types_defined_in(code_of({
      "#include <a{b>  // struct No {",
      "namespace a::b {",
      "/* struct No { */",
      "struct Plain { struct Inner { int x; }; };",
      "class Derived final : public Plain { void f() { struct Local { }; } };",
      "enum class Kind : int { kOne };",
      "template <class T> struct Made { T t = {}; };",
      "struct Declared;",
      "const char* text = \"struct No {\"; char brace = '{'; int big = 1'000;",
      "Plain made() { return {}; }",
      "struct Outer::Impl { };",
      "namespace { struct Hidden { }; }",
      "}",
      "struct Global { };",
  }));
  EXPECT_EQ(found, (std::vector<std::string>{"a::b::Plain", "a::b::Derived", "a::b::Kind", "a::b::Made",
                                             "a::b::Outer::Impl", "Global"}));
}

TEST(OneDefinition, OfEachTypeOfTheProgram) {
  std::map<std::string, std::string> places;
  std::size_t types = 0;
  for (const char* folder : {"include", "src", "apps"}) {
    for (const auto& file : files_below(folder, {".h", ".cpp"})) {
      for (const std::string& type : types_defined_in(code_of(lines_of(file)))) {
        ++types;
        const auto [place, is_new] = places.emplace(type, file.string());
        EXPECT_TRUE(is_new) << type << " is defined in " << place->second << " and in " << file.string()
                            << ": rename one of them, or put it into an anonymous namespace";
      }
    }
  }
  EXPECT_GT(types, 300U) << "so many there were when this was written";
}

}  // namespace
}  // namespace phalanx::project

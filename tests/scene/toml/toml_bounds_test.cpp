// SPDX-License-Identifier: Apache-2.0
// What is parsed has a bounded depth, whichever way a file or an override nests.
#include "scene/toml/toml_bounds.h"

#include <string>

#include "phalanx/scene/calibration_file.h"
#include "phalanx/scene/mapping_file.h"
#include "phalanx/scene/profile_file.h"
#include "phalanx/scene/scene.h"
#include "scene/expect_error.h"
#include "scene/toml/toml_reader.h"

namespace phalanx {
namespace {

/// "a.a.a": so many parts.
std::string dotted(std::size_t parts, const std::string& part = "a") {
  std::string key = part;
  for (std::size_t i = 1; i < parts; ++i) key += "." + part;
  return key;
}
std::string repeated(std::size_t count, const std::string& text) {
  std::string all;
  for (std::size_t i = 0; i < count; ++i) all += text;
  return all;
}
constexpr std::size_t kMany = 40'000;

void expect_refused(const std::string& text, const std::vector<std::string>& words) {
  SCOPED_TRACE(text.substr(0, 60));
  expect_scene_error([&] { static_cast<void>(parse_toml(text, "f.toml")); }, words);
}

TEST(TomlBounds, AKeyOfManyPartsIsRefusedWhereverItStands) {
  const std::vector<std::string> words{"f.toml:2: ", "a key of more than 16 parts"};
  for (const std::string part : {"a", "\"a\"", "'a'", "1", "\"a#\\\"b\"", "'='"}) {
    const std::string key = dotted(kMany, part);
    expect_refused("x = 1\n" + key + " = 1\n", words);
    expect_refused("x = 1\n[" + key + "]\n", words);
    expect_refused("x = 1\n[[" + key + "]]\n", words);
    expect_refused("x = 1\ny = { " + key + " = 1 }\n", words);
    expect_refused("x = 1\ny = [1, { z = 2, " + key + " = 1 }]\n", words);
    expect_refused("x = 1\n" + dotted(17, part + " \t") + " = 1\n", words);
  }
}

// What ends a string is read as the parser reads it: else a key could hide behind it.
TEST(TomlBounds, NoKeyHidesBehindAStringOrAComment) {
  const std::string key = dotted(kMany);
  for (const std::string before :
       {"s = \"\\\"\"\n", "s = '\\'\n", "s = \"\"\n", "s = \"\"\"\"\"\"\n", "s = \"\"\"a\"\"\"\"\n",
        "s = '''a'''''\n", "s = \"\"\"\n\\\"\"\"\\\\\"\"\"\n", "# \"\n", "# '''\n", "s = 1 # \"\"\"\n"})
    expect_refused(before + key + " = 1\n", {"a key of more than 16 parts"});
  for (const std::string before : {"\"\"\"a\"\"\"\"", "'''a'''''", "\"\\\\\"", "'\\'"})
    expect_refused("s = { x = " + before + ", " + key + " = 1 }\n", {"a key of more than 16 parts"});
}

TEST(TomlBounds, BracketsWithinOneAnotherAreCounted) {
  expect_refused("a = " + repeated(kMany, "["), {"f.toml:1: brackets are nested more than 16 deep"});
  expect_refused("a = " + repeated(kMany, "{b="), {"brackets are nested more than 16 deep"});
  expect_refused("a = " + repeated(kMany, "[\n"), {"f.toml:17: brackets are nested more than 16 deep"});
  expect_refused("a = " + repeated(200, "{b=[") + repeated(200, "]}"),
                 {"brackets are nested more than 16 deep"});
}

TEST(TomlBounds, AKeyIsNoLongerThanAThousandBytes) {
  const std::string key(1001, 'k');
  expect_refused("\n" + key + " = 1\n", {"f.toml:2: a key of 1002 bytes; write at most 1000"});
  expect_refused("['" + key + "']\n", {"a key of 1003 bytes"});
  expect_refused("a = { " + key + "=1}\n", {"a key of 1002 bytes"});
}

TEST(TomlBounds, WhatFilesHoldIsLetThrough) {
  for (const std::string& text :
       {dotted(16) + " = 1\n", "[" + dotted(16) + "]\n", std::string(1000, 'k') + "=1\n",
        "a = " + repeated(16, "[") + repeated(16, "]") + "\n",
        "s = \"" + dotted(100) + std::string(2000, '[') + "\"\n", "s = '''\n" + dotted(100) + "\n[[[\n'''\n",
        "# " + dotted(100) + "\n", "n = [" + repeated(500, "1.5, ") + "]\n",
        "n = [\n" + repeated(500, "[1.5, 2.5], # a.b\n") + "]\n",
        "s = [\"" + std::string(2000, 's') + "\", \"=\"]\n", "s = [\"" + std::string(2000, 's') + "\"]\n",
        "s = [[\"" + std::string(2000, 's') + "\"]]\n", "s = {a = [\"" + std::string(2000, 's') + "\"]}\n",
        repeated(500, "[[a]]\n") + "b.c = 1.5\n"}) {
    SCOPED_TRACE(text.substr(0, 60));
    EXPECT_NO_THROW(static_cast<void>(parse_toml(text, "f.toml")));
  }
}

// Each kind of file, and what is laid over a scene.
TEST(TomlBounds, HoldForEveryFileAndOverride) {
  const std::string text = dotted(kMany) + " = 1\n";
  const std::vector<std::string> words{"a key of more than 16 parts"};
  expect_scene_error([&] { static_cast<void>(parse_scene(text, "f.toml", ".")); }, words);
  expect_scene_error([&] { static_cast<void>(parse_profile(text, "f.toml")); }, words);
  expect_scene_error([&] { static_cast<void>(parse_mapping(text, "f.toml")); }, words);
  expect_scene_error([&] { static_cast<void>(parse_calibration(text, "f.toml")); }, words);
  expect_scene_error([&] { static_cast<void>(parse_scene("", "f.toml", ".", {{dotted(kMany), "1"}})); },
                     {"--set a.a.a", "the key has 40000 parts"});
  expect_scene_error(
      [&] { static_cast<void>(parse_scene("", "f.toml", ".", {{"hand", "{" + dotted(kMany) + "=1}"}})); },
      words);
}

}  // namespace
}  // namespace phalanx

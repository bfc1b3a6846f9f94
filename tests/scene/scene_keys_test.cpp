// SPDX-License-Identifier: Apache-2.0
#include "phalanx/scene/scene_keys.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <set>

#include "phalanx/scene/scene.h"

namespace phalanx {
namespace {

TEST(SceneKeys, AppearOnceEachWithAMeaning) {
  std::set<std::string> seen;
  for (const SceneKey& key : scene_keys()) {
    EXPECT_TRUE(seen.insert(key.path).second) << key.path << " is there twice";
    EXPECT_FALSE(key.meaning.empty()) << key.path;
    EXPECT_FALSE(key.type.empty()) << key.path;
  }
  EXPECT_GE(seen.size(), 50U);
}

// Stating every default in a file is the same as stating nothing: the table's defaults are in the table's own
// ranges.
TEST(SceneKeys, HaveDefaultsThatTheReaderAccepts) {
  for (const SceneKey& key : scene_keys()) {
    if (key.default_value.empty() || key.path.find("[]") != std::string::npos) continue;
    EXPECT_NO_THROW(static_cast<void>(parse_scene(key.path + " = " + key.default_value, "test.toml", ".")))
        << key.path;
  }
}

TEST(SceneKeys, AreTheTableOfTheDocumentation) {
  std::ifstream file(PHALANX_SOURCE_DIR "/docs/scenes.md");
  const std::string page{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  EXPECT_NE(page.find(scene_keys_markdown()), std::string::npos)
      << "docs/scenes.md does not hold the table of the code; put this in its place:\n"
      << scene_keys_markdown();
}

}  // namespace
}  // namespace phalanx

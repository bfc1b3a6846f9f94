// SPDX-License-Identifier: Apache-2.0
#include "serve/settings_text.h"

#include <gtest/gtest.h>

namespace phalanx {
namespace {

TEST(SettingsText, NamesKeysAndValuesAsTheyStand) {
  EXPECT_EQ(settings_text({{"force.stiffness_n_per_mm", "0.8"}, {"mirror", "true"}}),
            "force.stiffness_n_per_mm = 0.8, mirror = true");
  EXPECT_EQ(settings_text({{"rate_hz", ""}}), "rate_hz = as in the scene");
  EXPECT_EQ(settings_text({{"description", "no = toml ["}, {"force.law", "\"hooke\""}}),
            "description = no = toml [, force.law = \"hooke\"");
  EXPECT_EQ(settings_text({}), "");
}

// Parsing 40,000 parts uses up the stack.
TEST(SettingsText, LeavesATableAsItStandsThatIsTooDeep) {
  std::string key = "a";
  for (int i = 1; i < 40'000; ++i) key += ".a";
  const std::string table = "{" + key + " = 1}";
  EXPECT_EQ(settings_text({{"objects.0", table}}), "objects.0 = " + table);
}

TEST(SettingsText, ShowsNoFolderOfThisComputer) {
  EXPECT_EQ(settings_text({{"objects.0.file", "\"/srv/meshes/mug-0123456789abcdef.stl\""}}),
            "objects.0.file = mug-0123456789abcdef.stl");
  EXPECT_EQ(settings_text({{"objects.0",
                            R"({kind = "file", file = "/srv/meshes/mug-0123456789abcdef.stl", size_mm = 60,)"
                            R"( position_mm = [0, 1.5, -2]})"}}),
            "objects.0 = mesh mug-0123456789abcdef.stl, position_mm [ 0, 1.5, -2 ], size_mm 60");
}

TEST(SettingsText, SaysWhichObjectTakesThePlaceOfWhichOnceOnly) {
  EXPECT_EQ(settings_text({{"objects.0.size_mm", ""},
                           {"objects.0.kind", ""},
                           {"force.law", ""},
                           {"objects.0", R"({kind = "sphere", diameter_mm = 60})"}}),
            "force.law = as in the scene, objects.0 = sphere, diameter_mm 60");
  EXPECT_EQ(settings_text({{"objects.0", "{diameter_mm = 60}"}, {"objects.0.size_mm", "5"}}),
            "objects.0 = diameter_mm 60, objects.0.size_mm = 5");
}

}  // namespace
}  // namespace phalanx

// SPDX-License-Identifier: Apache-2.0
#include "phalanx/scene/scene_keys.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <set>

#include "phalanx/scene/build_model.h"
#include "phalanx/scene/scene.h"
#include "scene/object_kinds.h"

namespace phalanx {
namespace {

TEST(SceneKeys, AppearOnceEachWithAMeaning) {
  std::set<std::string> seen;
  for (const SceneKey& key : scene_keys()) {
    EXPECT_TRUE(seen.insert(key.path).second) << key.path << " is there twice";
    EXPECT_FALSE(key.meaning.empty()) << key.path;
    EXPECT_FALSE(text_of(key).type.empty()) << key.path;
    EXPECT_EQ(find_scene_key(key.path), &key);
  }
  EXPECT_GE(seen.size(), 50U);
}

// Stating every default in a file is the same as stating nothing: the table's defaults are in the table's own
// ranges.
TEST(SceneKeys, HaveDefaultsThatTheReaderAccepts) {
  for (const SceneKey& key : scene_keys()) {
    if (!key.default_value || key.is_of_objects()) continue;
    const std::string text = key.path + " = " + value_text(key, *key.default_value);
    EXPECT_NO_THROW(static_cast<void>(parse_scene(text, "test.toml", "."))) << text;
  }
}

// The same of each kind of object, which has its mesh as well.
TEST(SceneKeys, HaveDefaultsForEachKindOfObject) {
  for (const ObjectKind& kind : object_kinds()) {
    if (kind.name == "file") continue;
    std::string text = "[[objects]]\nkind = \"" + kind.name + "\"\n";
    for (const SceneKey& key : scene_keys()) {
      if (!key.is_of_objects() || key.path == "objects[].kind" || !key.belongs_to(kind.name)) continue;
      const auto value = key.default_for(kind.name);
      if (value) text += key.path.substr(10) + " = " + value_text(key, *value) + "\n";
    }
    const SceneDescription stated = parse_scene(text, "test.toml", ".");
    const SceneDescription left_out =
        parse_scene("[[objects]]\nkind = \"" + kind.name + "\"\n", "test.toml", ".");
    const TriangleMesh mesh = make_object_mesh(left_out.objects[0]);
    EXPECT_FALSE(mesh.triangles.empty()) << kind.name;
    EXPECT_EQ(make_object_mesh(stated.objects[0]).vertices, mesh.vertices) << text;
  }
}

TEST(SceneKeys, SayWhatAChangeNeeds) {
  for (const char* key :
       {"force.stiffness_n_per_mm", "force.damping_ns_per_m", "smoothing.min_n_per_s", "smoothing.max_n"})
    EXPECT_EQ(change_kind(key), ChangeKind::kInContact) << key;
  for (const char* key : {"force.law", "stabiliser.method", "contact.margin_mm", "description", "force",
                          "smoothing", "no.such.key", "objectsize"})
    EXPECT_EQ(change_kind(key), ChangeKind::kAtZeroTorque) << key;
  for (const char* key : {"objects[].kind", "objects.0.size_mm", "objects.0", "objects"})
    EXPECT_EQ(change_kind(key), ChangeKind::kOtherObject) << key;
  for (const char* key : {"limits.fingertip_force_n", "limits", "rate_hz", "seed", "mirror", "hand.profile",
                          "hand", "motion.file", "device.file", "device.scale.friction", "patient.press_n"})
    EXPECT_EQ(change_kind(key), ChangeKind::kNewStation) << key;
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

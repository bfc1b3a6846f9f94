// SPDX-License-Identifier: Apache-2.0
// load_hand_skin(): what a hand file's skin becomes, and which files are refused.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <string>
#include <vector>

#include "phalanx/scene/hand_meshes.h"
#include "phalanx/scene/profile_file.h"
#include "scene/expect_error.h"
#include "scene/hands/hand_files.h"

namespace phalanx {
namespace {

using test::HandFolder;

const std::string kTable = "collision = \"meshes/{segment}.obj\"\nunit_mm = 1\nskin = \"meshes/skin.json\"\n";

/// The parts of a skin file: a tetrahedron, its last corner half the palm's.
struct SkinText {
  std::string segments = R"(["index-finger-phalanx-distal", "wrist"])";
  std::string vertices = "[[0, 0, 0], [10, 0, 0], [0, 10, 0], [0.5, -20, 123.25]]";
  std::string influences = "[[[0, 1]], [[0, 1.0]], [[1, 1]], [[0, 0.25], [1, 0.7499]]]";
  std::string triangles = "[[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]]";
  [[nodiscard]] std::string all() const {
    return "{\"segments\": " + segments + ", \"vertices_mm\": " + vertices +
           ", \"influences\": " + influences + ", \"triangles\": " + triangles + "}";
  }
};

HandDescription described(const HandFolder& folder, const std::string& skin, const std::string& more = "") {
  std::ofstream(folder.path() / "meshes" / "skin.json", std::ios::binary) << skin;
  HandDescription hand;
  hand.file = folder.write_hand(kTable + more);
  return hand;
}

HandDescription described(const HandFolder& folder, const SkinText& text, const std::string& more = "") {
  return described(folder, text.all(), more);
}

TEST(LoadHandSkin, ReadsVerticesTrianglesAndWeightsOfAFile) {
  const HandFolder folder;
  const HandDescription hand = described(folder, SkinText{});
  const HandSkin skin = load_hand_skin(hand).value();
  const std::vector<Vec3> vertices = {Vec3::Zero(), Vec3(0.010, 0, 0), Vec3(0, 0.010, 0),
                                      Vec3(0.5e-3, -0.020, 0.12325)};
  ASSERT_EQ(skin.mesh.vertices.size(), vertices.size());
  for (std::size_t i = 0; i < vertices.size(); ++i)
    EXPECT_LT((skin.mesh.vertices[i] - vertices[i]).norm(), 1e-15);
  EXPECT_EQ(skin.mesh.triangles, (std::vector<Triangle>{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}));
  const auto tip = static_cast<std::uint8_t>(*find_segment("index-finger-phalanx-distal"));
  EXPECT_EQ(skin.segment[0][0], tip);
  EXPECT_EQ(skin.segment[2][0], kPalm);
  EXPECT_EQ(skin.segment[3][0], tip);
  EXPECT_EQ(skin.segment[3][1], kPalm);
  EXPECT_EQ(skin.weight[0], (std::array<float, 4>{1.0F, 0.0F, 0.0F, 0.0F}));
  EXPECT_NEAR(skin.weight[3][0], 0.25 / 0.9999, 1e-7);
  EXPECT_NEAR(skin.weight[3][0] + skin.weight[3][1], 1.0, 1e-7);
  const auto X_BS = bind_poses(load_hand_file(hand.file), Handedness::kRight);
  for (std::size_t s = 0; s < kSegments; ++s) EXPECT_EQ(skin.X_BS[s].p, X_BS[s].p);
}

TEST(LoadHandSkin, IsNothingWithoutAFileOrWithCapsules) {
  const HandFolder folder;
  HandDescription hand = described(folder, SkinText{});
  hand.mesh_source = HandMeshSource::kCapsules;
  EXPECT_FALSE(load_hand_skin(hand));
  hand.mesh_source = HandMeshSource::kFile;
  EXPECT_TRUE(load_hand_skin(hand));
  hand.file = folder.write_hand("collision = \"meshes/{segment}.obj\"\nunit_mm = 1\n");
  EXPECT_FALSE(load_hand_skin(hand));
}

TEST(LoadHandSkin, OfALeftHandIsTheMirrorImage) {
  const HandFolder folder;
  HandDescription hand = described(folder, SkinText{});
  HandSkin expected = load_hand_skin(hand).value();
  mirror(expected);
  hand.handedness = Handedness::kLeft;
  const HandSkin left = load_hand_skin(hand).value();
  EXPECT_EQ(left.mesh.vertices, expected.mesh.vertices);
  EXPECT_EQ(left.mesh.triangles, expected.mesh.triangles);
  const auto X_BS = bind_poses(load_hand_file(hand.file), Handedness::kLeft);
  for (std::size_t s = 0; s < kSegments; ++s) {
    EXPECT_LT((left.X_BS[s].R - X_BS[s].R).norm() + (left.X_BS[s].p - X_BS[s].p).norm(), 1e-14);
  }
}

TEST(LoadHandSkin, OfFilesThatShowALeftHandIsMirroredToTheRight) {
  const HandFolder folder;
  const HandSkin as_written = load_hand_skin(described(folder, SkinText{})).value();
  const HandDescription hand = described(folder, SkinText{}, "handedness = \"left\"\n");
  const HandSkin right = load_hand_skin(hand).value();
  EXPECT_EQ(right.mesh.vertices[3], Vec3(-as_written.mesh.vertices[3].x(), as_written.mesh.vertices[3].y(),
                                         as_written.mesh.vertices[3].z()));
  EXPECT_EQ(right.mesh.triangles[0], (Triangle{0, 1, 2}));
  for (std::size_t s = 0; s < kSegments; ++s) EXPECT_EQ(right.X_BS[s].p, as_written.X_BS[s].p);
}

TEST(LoadHandSkin, IsFittedToTheProfile) {
  HandDescription hand;
  const HandSkin base = load_hand_skin(hand).value();
  hand.profile = "small-woman";
  const Profile profile = load_profile(hand.profile);
  const HandFile file = read_hand_file(profile.hand, profile.folder);
  const FittedHand fitted = fit_profile(profile, file.parameters);
  HandSkin expected = fitted_skin(file.parameters, fitted.fit, base);
  if (profile.handedness == Handedness::kLeft) mirror(expected);
  const HandSkin skin = load_hand_skin(hand).value();
  EXPECT_EQ(skin.mesh.vertices, expected.mesh.vertices);
  EXPECT_LT(bounds(skin.mesh).max.z() - bounds(skin.mesh).min.z(),
            bounds(base.mesh).max.z() - bounds(base.mesh).min.z());
}

TEST(LoadHandSkin, ThatIsMissingIsRefusedByItsName) {
  const HandFolder folder;
  HandDescription hand;
  hand.file = folder.write_hand(kTable);
  expect_scene_error([&] { (void)load_hand_skin(hand); },
                     {"hand.toml:", "meshes.skin", "skin.json", "cannot be opened"});
  hand.file = folder.write_hand("collision = \"{segment}.obj\"\nunit_mm = 1\nskin = \"meshes\"\n");
  expect_scene_error([&] { (void)load_hand_skin(hand); }, {"meshes.skin", "is a folder"});
  const std::filesystem::path pipe = folder.path() / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  hand.file = folder.write_hand("collision = \"{segment}.obj\"\nunit_mm = 1\nskin = \"pipe\"\n");
  expect_scene_error([&] { (void)load_hand_skin(hand); }, {"meshes.skin", "is not a regular file"});
  const std::string empty = folder.write_hand("collision = \"{segment}.obj\"\nunit_mm = 1\nskin = \"\"\n");
  expect_scene_error([&] { (void)read_hand_file(empty); }, {"meshes.skin = ", "names no file"});
  const std::string number = folder.write_hand("collision = \"{segment}.obj\"\nunit_mm = 1\nskin = 3\n");
  expect_scene_error([&] { (void)read_hand_file(number); }, {"meshes.skin = 3", "string"});
}

void expect_skin_refused(const std::string& skin, std::vector<std::string> words) {
  const HandFolder folder;
  words.insert(words.end(), {"hand.toml:", "meshes.skin", "skin.json"});
  expect_scene_error([&] { (void)load_hand_skin(described(folder, skin)); }, words);
}

TEST(LoadHandSkin, ThatIsNoJsonIsRefused) {
  expect_skin_refused("", {"not valid JSON"});
  expect_skin_refused(SkinText{}.all().substr(0, 150), {"not valid JSON", "line 1"});
  expect_skin_refused("\xff\xfe\x01", {"not valid JSON"});
  expect_skin_refused("[1, 2]", {"is [1,2]", "write an object"});
  expect_skin_refused("{\"segments\": " + std::string(100'000, '[') + std::string(100'000, ']') + "}",
                      {"lists are nested"});
  expect_skin_refused(std::string((16U << 20U) + 1, ' '), {"at most 16 MB"});
}

TEST(LoadHandSkin, WithoutAnEntryIsRefused) {
  expect_skin_refused("{}", {"segments", "is missing"});
  expect_skin_refused(R"({"segments": ["wrist"]})", {"vertices_mm", "is missing"});
  expect_skin_refused(R"({"segments": ["wrist"], "vertices_mm": [[0, 0, 0]]})", {"influences", "is missing"});
  expect_skin_refused(R"({"segments": ["wrist"], "vertices_mm": [[0, 0, 0]], "influences": [[[0, 1]]]})",
                      {"triangles", "is missing"});
  SkinText text;
  text.triangles = "[]";
  expect_skin_refused(text.all(), {"triangles = []", "write a list"});
  text = {};
  text.vertices = "7";
  expect_skin_refused(text.all(), {"vertices_mm = 7", "write a list"});
}

/// Refused once this part of the file is that.
void expect_skin_refused(std::string SkinText::* part, const std::string& value,
                         std::vector<std::string> words) {
  SkinText text;
  text.*part = value;
  expect_skin_refused(text.all(), std::move(words));
}

TEST(LoadHandSkin, OfAnUnknownSegmentIsRefused) {
  expect_skin_refused(&SkinText::segments, R"(["index-finger-phalanx-distal", "wrst"])",
                      {"segments[1] = \"wrst\"", "no such segment", "\"wrist\""});
  expect_skin_refused(&SkinText::segments, "[4]", {"segments[0] = 4", "in quotes"});
  expect_skin_refused(&SkinText::segments, R"(["wrist"])", {"influences[2]", "no segment 1", "0 to 0"});
}

TEST(LoadHandSkin, WithAWrongVertexIsRefused) {
  const std::string rest = "[0, 0, 0], [1, 0, 0], [0, 1, 0]]";
  expect_skin_refused(&SkinText::vertices, "[[0, 0, 301], " + rest, {"vertices_mm[0] = [0,0,301]", "301 mm"});
  expect_skin_refused(&SkinText::vertices, "[[0, 0], " + rest, {"vertices_mm[0] = [0,0]", "three numbers"});
  expect_skin_refused(&SkinText::vertices, "[[0, 0, null], " + rest, {"vertices_mm[0]", "three numbers"});
  expect_skin_refused(&SkinText::vertices, "[[0, 0, NaN], " + rest, {"not valid JSON"});
  expect_skin_refused(&SkinText::vertices, "[[0, 0, 1e999], " + rest, {"not valid JSON", "1e999"});
  expect_skin_refused(&SkinText::vertices, "[[0, 0, 1e308], " + rest, {"vertices_mm[0]", "300 mm"});
}

TEST(LoadHandSkin, WithWrongWeightsIsRefused) {
  const std::string rest = ", [[0, 1]], [[0, 1]], [[0, 1]]]";
  expect_skin_refused(&SkinText::influences, "[[[0, 0.5], [1, 0.4]]" + rest,
                      {"influences[0] = [[0,0.5],[1,0.4]]", "sum is 0.9", "make it 1"});
  expect_skin_refused(&SkinText::influences, "[[[0, 1.5], [1, -0.5]]" + rest,
                      {"influences[0]", "1.5 is no weight"});
  expect_skin_refused(&SkinText::influences, "[[[0, 1], [1, -0.5]]" + rest,
                      {"influences[0]", "-0.5 is no weight"});
  expect_skin_refused(&SkinText::influences, "[[[0, null]]" + rest, {"influences[0]", "null is no weight"});
  expect_skin_refused(&SkinText::influences, "[[[0, \"1\"]]" + rest, {"influences[0]", "is no weight"});
  expect_skin_refused(&SkinText::influences, "[[[2, 1]]" + rest, {"influences[0]", "no segment 2", "0 to 1"});
  expect_skin_refused(&SkinText::influences, "[[[-1, 1]]" + rest, {"influences[0]", "no segment -1"});
  expect_skin_refused(&SkinText::influences, "[[[0.5, 1]]" + rest, {"influences[0]", "no segment 0.5"});
  expect_skin_refused(&SkinText::influences, "[[0, 1]" + rest, {"influences[0]", "write pairs"});
  expect_skin_refused(&SkinText::influences, "[[]" + rest, {"influences[0] = []", "one to four"});
  expect_skin_refused(&SkinText::influences, "[[[0,0.2],[0,0.2],[0,0.2],[0,0.2],[0,0.2]]" + rest,
                      {"influences[0]", "one to four"});
  expect_skin_refused(&SkinText::influences, "[[[0, 1]]]", {"influences", "1 entries for 4 vertices"});
}

// 300 mm from the wrist; weights whose sum is within a thousandth of 1; four influences at a vertex.
TEST(LoadHandSkin, MayReachItsBoundsAndNoFurther) {
  const auto expect_taken = [](std::string SkinText::* part, const std::string& value) {
    const HandFolder folder;
    SkinText text;
    text.*part = value;
    EXPECT_NO_THROW((void)load_hand_skin(described(folder, text))) << value;
  };
  expect_taken(&SkinText::vertices, "[[0, 0, 300], [10, 0, 0], [0, 10, 0], [0, 0, 10]]");
  expect_skin_refused(&SkinText::vertices, "[[0, 0, 300.1], [10, 0, 0], [0, 10, 0], [0, 0, 10]]",
                      {"vertices_mm[0]", "more than 300 mm"});
  const std::string rest = ", [[0, 1]], [[0, 1]], [[0, 1]]]";
  expect_taken(&SkinText::influences, "[[[0, 0.25], [1, 0.25], [0, 0.25], [1, 0.25]]" + rest);
  for (const char* near_enough : {"0.9991", "1.0009"})
    expect_taken(&SkinText::influences, "[[[0, " + std::string(near_enough) + "]]" + rest);
  expect_skin_refused(&SkinText::influences, "[[[0, 1.0011]]" + rest, {"1.0011 is no weight"});
  expect_skin_refused(&SkinText::influences, "[[[0, 0]]" + rest, {"0 is no weight"});
  expect_skin_refused(&SkinText::influences, "[[[0, 0.5], [1, 0.4989]]" + rest, {"sum is 0.9989"});
  expect_skin_refused(&SkinText::influences, "[[[0, 0.5], [1, 0.5011]]" + rest, {"sum is 1.0011"});
}

TEST(LoadHandSkin, WithAnIndexWithoutAVertexIsRefused) {
  expect_skin_refused(&SkinText::triangles, "[[0, 1, 2], [1, 2, 4]]",
                      {"triangles[1] = [1,2,4]", "no vertex 4", "0 to 3"});
  expect_skin_refused(&SkinText::triangles, "[[0, -1, 2]]", {"triangles[0]", "no vertex -1"});
  expect_skin_refused(&SkinText::triangles, "[[0, 1.5, 2]]", {"triangles[0]", "no vertex 1.5"});
  expect_skin_refused(&SkinText::triangles, "[[0, 1]]", {"triangles[0] = [0,1]", "three vertices"});
  expect_skin_refused(&SkinText::triangles, "[[0, 1, 18446744073709551615]]", {"triangles[0]", "no vertex"});
}

}  // namespace
}  // namespace phalanx

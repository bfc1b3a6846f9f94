// SPDX-License-Identifier: Apache-2.0
#include "phalanx/scene/hand_meshes.h"

#include "mesh/import/mesh_files.h"
#include "phalanx/mesh/primitives.h"
#include "phalanx/scene/build_model.h"
#include "scene/expect_error.h"
#include "scene/hands/hand_files.h"

namespace phalanx {
namespace {

using test::HandFolder;

const std::string kCollision = "collision = \"meshes/{segment}.obj\"\nunit_mm = 1\n";

SegmentMeshes capsules(Handedness handedness = Handedness::kRight) {
  return make_capsule_meshes(load_hand_file("adult"), handedness, 800);
}

HandDescription described(const std::string& file, Handedness handedness = Handedness::kRight) {
  HandDescription hand;
  hand.file = file;
  hand.handedness = handedness;
  return hand;
}

/// Largest distance of corresponding corners; the importer's positions have single precision.
double difference(const TriangleMesh& a, const TriangleMesh& b) {
  EXPECT_EQ(a.triangles.size(), b.triangles.size());
  if (a.triangles.size() != b.triangles.size()) return 1.0;
  double largest = 0.0;
  for (std::size_t t = 0; t < a.triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3& va = a.vertices[static_cast<std::size_t>(a.triangles[t][k])];
      const Vec3& vb = b.vertices[static_cast<std::size_t>(b.triangles[t][k])];
      largest = std::max(largest, (va - vb).norm());
    }
  }
  return largest;
}

TEST(HandMeshes, OfAFileAreThoseOfTheFilesInTheirUnit) {
  for (const double unit_mm : {1.0, 10.0, 1000.0}) {
    const HandFolder folder;
    folder.write_meshes(capsules(), 1000.0 / unit_mm);
    const std::string table =
        "collision = \"meshes/{segment}.obj\"\nunit_mm = " + std::to_string(unit_mm) + "\n";
    const LoadedHand hand = load_hand(described(folder.write_hand(table)));
    for (std::size_t s = 0; s < kSegments; ++s) {
      EXPECT_LT(difference(hand.meshes.collision[s], capsules()[s]), 2e-8)
          << segment_name(static_cast<int>(s));
      EXPECT_EQ(difference(hand.meshes.display[s], hand.meshes.collision[s]), 0.0);
    }
  }
}

TEST(HandMeshes, OfALeftHandMirrorThoseOfARightHandExactly) {
  const HandFolder folder;
  folder.write_meshes(capsules());
  const std::string file = folder.write_hand(kCollision);
  const LoadedHand right = load_hand(described(file));
  const LoadedHand left = load_hand(described(file, Handedness::kLeft));
  for (std::size_t s = 0; s < kSegments; ++s) {
    const TriangleMesh& r = right.meshes.collision[s];
    const TriangleMesh& l = left.meshes.collision[s];
    ASSERT_EQ(r.vertices.size(), l.vertices.size());
    for (std::size_t v = 0; v < r.vertices.size(); ++v)
      EXPECT_EQ(Vec3(-r.vertices[v].x(), r.vertices[v].y(), r.vertices[v].z()), l.vertices[v]);
    for (std::size_t t = 0; t < r.triangles.size(); ++t)
      EXPECT_EQ((Triangle{r.triangles[t][0], r.triangles[t][2], r.triangles[t][1]}), l.triangles[t]);
    EXPECT_GT(signed_volume(l), 0.0);
  }
}

TEST(HandMeshes, OfFilesThatShowALeftHandAreMirroredToTheRight) {
  const HandFolder folder;
  folder.write_meshes(capsules(Handedness::kLeft));
  const std::string file = folder.write_hand(kCollision + "handedness = \"left\"\n");
  const LoadedHand right = load_hand(described(file));
  const LoadedHand left = load_hand(described(file, Handedness::kLeft));
  for (std::size_t s = 0; s < kSegments; ++s) {
    EXPECT_LT(difference(right.meshes.collision[s], capsules()[s]), 2e-8);
    EXPECT_LT(difference(left.meshes.collision[s], capsules(Handedness::kLeft)[s]), 2e-8);
  }
}

TEST(HandMeshes, ToShowMayDifferFromThoseThatCollideAndMayBeOpen) {
  const HandFolder folder;
  folder.write_meshes(capsules());
  SegmentMeshes open = capsules();
  for (TriangleMesh& mesh : open) mesh.triangles.resize(mesh.triangles.size() / 2);
  folder.write_meshes(open, 1000.0, "shown ");
  const HandDescription hand =
      described(folder.write_hand(kCollision + "display = \"meshes/shown {segment}.obj\"\n"));
  const LoadedHand loaded = load_hand(hand);
  const LoadedHand colliding = load_hand(hand, HandDetail::kCollision);
  const LoadedHand drawn = load_hand(hand, HandDetail::kDrawn);  // it has no skin
  for (std::size_t s = 0; s < kSegments; ++s) {
    EXPECT_EQ(loaded.meshes.display[s].triangles.size(), open[s].triangles.size());
    EXPECT_EQ(difference(drawn.meshes.display[s], loaded.meshes.display[s]), 0.0);
    EXPECT_EQ(difference(colliding.meshes.collision[s], loaded.meshes.collision[s]), 0.0);
    EXPECT_TRUE(is_closed(loaded.meshes.collision[s]));
    EXPECT_TRUE(colliding.meshes.display[s].vertices.empty());
  }
}

// S1 took .obj files for collision and .3ds files for display.
TEST(HandMeshes, ToShowMayBeOfAnotherFormat) {
  for (const std::string format : {"3ds", "glb"}) {
    const HandFolder folder;
    folder.write_meshes(capsules());
    for (int s = 0; s < kSegments; ++s) {
      TriangleMesh mesh = capsules()[static_cast<std::size_t>(s)];
      for (Vec3& v : mesh.vertices) v *= 1e3;
      std::ofstream(folder.path() / "meshes" / (std::string(segment_name(s)) + "." + format),
                    std::ios::binary)
          << (format == "3ds" ? test::to_3ds(mesh) : test::to_glb(mesh));
    }
    const LoadedHand hand = load_hand(
        described(folder.write_hand(kCollision + "display = \"meshes/{segment}." + format + "\"\n")));
    for (std::size_t s = 0; s < kSegments; ++s) {
      const Bounds shown = bounds(hand.meshes.display[s]);
      const Bounds expected = bounds(capsules()[s]);
      EXPECT_LT((shown.min - expected.min).norm() + (shown.max - expected.max).norm(), 1e-7) << format;
    }
  }
}

TEST(HandMeshes, AreWhatTheModelCollidesWith) {
  const HandFolder folder;
  folder.write_meshes(capsules());
  SceneDescription scene;
  scene.hand = described(folder.write_hand(kCollision));
  int expected = 0;
  for (const TriangleMesh& mesh : capsules()) expected += static_cast<int>(mesh.triangles.size());
  EXPECT_EQ(build_model(scene).hand.triangle_count(), expected);
  scene.hand.mesh_source = HandMeshSource::kCapsules;
  scene.hand.triangles = 4000;
  EXPECT_NEAR(build_model(scene).hand.triangle_count(), 4000, 400);
}

TEST(HandMeshes, AndAStatedNumberOfTrianglesAreRefusedTogether) {
  const HandFolder folder;
  folder.write_meshes(capsules());
  const std::string file = folder.write_hand(kCollision);
  const auto scene = [&](const std::string& more) {
    return parse_scene("hand.file = \"" + file + "\"\n" + more, "test.toml", "/");
  };
  expect_scene_error([&] { (void)build_model(scene("hand.triangles = 3000")); },
                     {"test.toml:2: hand.triangles = 3000", "whose meshes are files", "capsules"});
  EXPECT_EQ(build_model(scene("hand.triangles = 900\nhand.meshes = \"capsules\"")).hand.triangle_count(),
            make_hand_model(load_hand_file("adult"), Handedness::kRight, {}, 900).triangle_count());
}

// The hand file's coupling turns the thumb; "none" leaves its four joints.
TEST(HandMeshes, OfASceneWithoutCouplingHaveTheFourJointsAlone) {
  const HandFolder folder;
  folder.write_meshes(capsules());
  const std::string file = folder.write_hand(kCollision);
  const auto thumb = [&](const std::string& more) {
    const HapticModel model =
        build_model(parse_scene("hand.file = \"" + file + "\"\n" + more, "test.toml", "/"));
    DigitPose pose;
    model.hand.digit_pose(0, {0.5, 0.0, 0.0, 0.0}, pose);
    return pose.segment[0].R;
  };
  HandParameters rigid = load_hand_file("adult");
  const DigitCoupling coupling = rigid.digits[0].coupling;
  ASSERT_GT(coupling.pronation_per_flexion, 0.2);
  for (DigitParameters& digit : rigid.digits) digit.coupling = {};
  DigitPose plain;
  make_hand_model(rigid, Handedness::kRight, {}, 800).digit_pose(0, {0.5, 0.0, 0.0, 0.0}, plain);
  EXPECT_EQ(thumb("hand.coupling = \"none\""), plain.segment[0].R);
  EXPECT_EQ(thumb("hand.coupling = \"file\""), thumb(""));
  const std::string profile = (folder.path() / "patient.toml").string();
  std::ofstream(profile) << "name = \"patient\"\nhandedness = \"right\"\nhand = \"" << file << "\"\n";
  const auto coupling_of_patient = [&](const std::string& more) {
    return build_model(parse_scene("hand.profile = \"" + profile + "\"\n" + more, "test.toml", "/"))
        .hand.coupling(0);
  };
  EXPECT_EQ(coupling_of_patient(""), coupling);
  EXPECT_EQ(coupling_of_patient("hand.coupling = \"none\""), DigitCoupling{});
  const Mat3 turn = thumb("") * plain.segment[0].R.transpose();
  EXPECT_NEAR(turn.trace(), 1.0 + 2.0 * std::cos(coupling.pronation_per_flexion * 0.5), 1e-12);
  EXPECT_LT((turn * plain.segment[0].R.col(2) - plain.segment[0].R.col(2)).norm(), 1e-12) << "about the bone";
}

/// A set of meshes with one spoilt, and what the refusal says.
template <typename Spoil>
void expect_meshes_refused(Spoil&& spoil, const std::vector<std::string>& words,
                           const std::string& table = kCollision) {
  const HandFolder folder;
  SegmentMeshes meshes = capsules();
  spoil(meshes[3]);
  folder.write_meshes(meshes);
  const std::string file = folder.write_hand(table);
  std::vector<std::string> all = words;
  all.push_back(folder.mesh(3).string());
  all.push_back("hand.toml:");
  expect_scene_error([&] { (void)load_hand(described(file)); }, all);
}

TEST(HandMeshes, ThatAreOpenAreRefused) {
  expect_meshes_refused([](TriangleMesh& mesh) { mesh.triangles.pop_back(); },
                        {"is not closed", "phalanx mesh check"});
}

TEST(HandMeshes, ThatLieFarFromTheirJointAreRefused) {
  expect_meshes_refused(
      [](TriangleMesh& mesh) {
        for (Vec3& v : mesh.vertices) v.z() -= 0.4;
      },
      {"mm from the segment's joint", "unit_mm = 1"});
}

TEST(HandMeshes, InAnAbsurdUnitAreRefused) {
  expect_meshes_refused(
      [](TriangleMesh& mesh) {
        for (Vec3& v : mesh.vertices) v *= 1e-3;
      },
      {"mm long, less than 3 mm", "1000 for a file in metres"});
}

// Its longest edge counts. A box of 20 mm whose far corners lie 298 or 301 mm down the z axis and 10 mm
// beside it twice: 298.3 mm, 301.3 mm.
TEST(HandMeshes, MayBeThreeMillimetresLongAndReachThreeHundred) {
  const auto box = [](double edge, double z) {
    TriangleMesh mesh = make_box({edge, edge, edge}, 12);
    for (Vec3& v : mesh.vertices) v.z() += z;
    return mesh;
  };
  for (const TriangleMesh& good :
       {box(3.01e-3, 0.0), box(0.02, -0.288), make_box({2e-3, 2e-3, 3.01e-3}, 12)}) {
    const HandFolder folder;
    SegmentMeshes meshes = capsules();
    meshes[3] = good;
    folder.write_meshes(meshes);
    const std::string file = folder.write_hand(kCollision);
    EXPECT_NO_THROW((void)load_hand(described(file)));
  }
  expect_meshes_refused([&](TriangleMesh& mesh) { mesh = box(2.99e-3, 0.0); },
                        {"is 2.99 mm long, less than 3 mm"});
  expect_meshes_refused([&](TriangleMesh& mesh) { mesh = box(0.02, -0.291); },
                        {"reaches 301.3 mm from the segment's joint, more than 300 mm"});
}

TEST(HandMeshes, ThatAreMissingAreRefusedByTheirName) {
  const HandFolder folder;
  folder.write_meshes(capsules());
  std::filesystem::remove(folder.mesh(kPalm));
  const std::string file = folder.write_hand(kCollision);
  expect_scene_error([&] { (void)load_hand(described(file)); },
                     {"hand.toml:", "meshes", "wrist.obj", "there is no such file"});
}

TEST(HandMeshes, NeedAWellFormedTable) {
  const HandFolder folder;
  const auto refused = [&](const std::string& table, const std::vector<std::string>& words) {
    const std::string file = folder.write_hand(table);
    expect_scene_error([&] { (void)read_hand_file(file); }, words);
  };
  refused("unit_mm = 1", {"meshes.collision", "is missing"});
  refused("collision = \"{segment}.obj\"", {"meshes.unit_mm", "is missing"});
  refused("collision = \"hand.obj\"\nunit_mm = 1", {"meshes.collision", "must hold {segment} once"});
  refused(kCollision + "display = \"{segment}{segment}.glb\"", {"meshes.display", "{segment} once"});
  refused(kCollision + "handedness = \"lft\"", {"meshes.handedness = ", "\"right\" or \"left\""});
  refused(kCollision + "displai = \"x\"", {"meshes.displai", "nearest known one is meshes.display"});
  refused("collision = \"{segment}.obj\"\nunit_mm = 0", {"meshes.unit_mm = 0"});
}

}  // namespace
}  // namespace phalanx

// SPDX-License-Identifier: Apache-2.0
// After import the force is right: whatever is wrong with a file, the hand that is shown stops the margin
// away from the file's OWN triangles, as a second reader and a second distance find them, and on a solid the
// force points out of it.
#include <gmock/gmock.h>

#include <cstdio>
#include <filesystem>
#include <random>

#include "phalanx/mesh/import.h"
#include "phalanx/mesh/primitives.h"
#include "support/dirty_mesh.h"
#include "support/lone_finger.h"
#include "support/reference/raw_triangles.h"
#include "support/sanitized.h"

namespace phalanx {
namespace {

using test::LoneFinger;
using test::Press;
using test::RawTriangle;
using namespace test::dirt;

constexpr double kMargin = 50e-6;
/// How far an import may move a point: 1 um and 1e-5 of the largest extent, here 0.15 m.
constexpr double kMovedByRepair = 1e-6 + 1.5e-6;

/// What is held against the oracle, over all presses on one file.
struct Judged {
  int presses = 0;
  int touching = 0;
  double worst = 0.0;   ///< | clearance - margin | of a stopped segment [m]
  double inward = 1.0;  ///< least cosine between the force and the outward normal
};

Vec3 face_normal(const RawTriangle& t) { return (t[1] - t[0]).cross(t[2] - t[0]).normalized(); }

/// Presses at seeded places of `surface` from the side of its normals, `sides` -1 as well from behind; judges
/// against `raw`.
Judged press_everywhere(LoneFinger& finger, const std::vector<RawTriangle>& raw,
                        const std::vector<RawTriangle>& surface, bool solid, std::uint64_t seed, int places) {
  Judged judged;
  std::mt19937_64 random(seed);
  std::uniform_int_distribution<std::size_t> pick(0, surface.size() - 1);
  std::uniform_real_distribution<double> u(0.0, 1.0);
  for (int n = 0; n < places; ++n) {
    SCOPED_TRACE(::testing::Message() << "seed " << seed << " place " << n);
    const RawTriangle& t = surface[pick(random)];
    const double a = std::sqrt(u(random));
    const double b = u(random);
    const Vec3 place = (1.0 - a) * t[0] + a * (1.0 - b) * t[1] + a * b * t[2];
    const double side = solid || u(random) < 0.5 ? 1.0 : -1.0;
    const Vec3 out = side * face_normal(t);
    if (!(out.norm() > 0.5)) continue;
    const Vec3 heading = rotation_about(out, 6.28 * u(random)) * out.unitOrthogonal();
    std::optional<Press> press;
    try {
      press =
          finger.press({.from = place + 0.014 * out, .along = -out, .heading = heading, .reach = 0.02}, 1e-3);
    } catch (const std::invalid_argument&) {
      continue;  // no room for the finger there
    }
    if (!press) continue;
    ++judged.presses;
    for (int k = 0; k < kSegmentsPerDigit; ++k) {
      const auto s = static_cast<std::size_t>(segment_index(test::kIndex, k));
      const SegmentSnapshot& segment = press->snapshot.segment[s];
      const double gap = test::brute_force_gap(
          test::raw_of(finger.model().hand.mesh(static_cast<int>(s)), press->snapshot.gdp_pose[s]), raw,
          3.0 * kMargin);
      EXPECT_GT(gap, 0.0) << "segment " << k << " goes through the file's triangles";
      EXPECT_TRUE(segment.contact || gap >= kMargin - kMovedByRepair)
          << "segment " << k << " at " << gap * 1e6 << " um";
      if (!segment.contact) continue;
      ++judged.touching;
      EXPECT_LE(std::abs(gap - kMargin), kMargin) << "segment " << k;
      judged.worst = std::max(judged.worst, std::abs(gap - kMargin));
      if (!solid || segment.force == 0.0) continue;
      // Outward there: the mean over the clean solid's faces that the contact is near.
      double nearest = 1.0;
      for (const RawTriangle& f : surface)
        nearest = std::min(
            nearest, (test::nearest_on_triangle(segment.point, f[0], f[1], f[2]) - segment.point).norm());
      Vec3 outward = Vec3::Zero();
      for (const RawTriangle& f : surface) {
        const double apart =
            (test::nearest_on_triangle(segment.point, f[0], f[1], f[2]) - segment.point).norm();
        if (apart <= nearest + 5e-6) outward += face_normal(f);
      }
      judged.inward = std::min(judged.inward, segment.normal.dot(outward.normalized()));
    }
  }
  return judged;
}

struct DirtyCase {
  const char* name;
  TriangleMesh (*make)();
  unsigned dirt;
};

void PrintTo(const DirtyCase& c, std::ostream* out) { *out << c.name; }

TriangleMesh teapot() { return make_teapot(0.15, 1500); }
TriangleMesh mug() { return make_mug(0.08, 0.09, 1500); }
TriangleMesh torus() { return make_torus(0.09, 0.035, 1500); }
TriangleMesh two_balls() {
  TriangleMesh mesh = make_sphere(0.06, 700);
  append(mesh, make_sphere(0.05, 700), Pose{Mat3::Identity(), Vec3(0.07, 0.01, 0.0)});
  return mesh;
}
TriangleMesh through_each_other() {
  TriangleMesh mesh = make_sphere(0.06, 700);
  append(mesh, make_box(Vec3(0.05, 0.03, 0.04), 108), Pose{Mat3::Identity(), Vec3(0.03, 0.005, 0.004)});
  return mesh;
}

constexpr int kPlaces = test::kSlowBuild ? 15 : 100;

class DirtyObject : public ::testing::TestWithParam<DirtyCase> {};

TEST_P(DirtyObject, StopsTheHandTheMarginAwayFromTheFilesOwnTriangles) {
  const DirtyCase& c = GetParam();
  const test::TemporaryFolder folder;
  const TriangleMesh clean = c.make();
  int presses = 0;
  for (const std::uint64_t seed : {1U, 2U}) {
    const auto file = folder / "dirty.obj";
    test::write_dirty(clean, c.dirt, seed, file);
    const std::vector<RawTriangle> raw = test::read_raw(file);
    LoneFinger finger(ObjectModel(import_and_check(file).mesh));
    // Faces that are left out make a surface with holes: no outward side is promised there.
    const bool solid = (c.dirt & kHoles) == 0;
    const Judged judged = press_everywhere(finger, raw, test::raw_of(clean), solid, seed, kPlaces);
    presses += judged.presses;
    EXPECT_GT(judged.inward, 0.0) << "the force points out of the solid";
    std::printf(
        "%s: %d presses, %d segments touching, | clearance - margin | at most %.3f um, force . outward at "
        "least %.3f\n",
        c.name, judged.presses, judged.touching, judged.worst * 1e6, judged.inward);
  }
  EXPECT_GE(presses, 0.6 * kPlaces) << "room for the finger";
}

INSTANTIATE_TEST_SUITE_P(
    Files, DirtyObject,
    ::testing::Values(DirtyCase{"clean teapot", teapot, 0},
                      DirtyCase{"teapot of loose triangles", teapot, kSoup},
                      DirtyCase{"teapot with flipped faces", teapot, kFlipped},
                      DirtyCase{"inside-out teapot", teapot, kInsideOut},
                      DirtyCase{"teapot with duplicate and degenerate faces", teapot,
                                kDuplicated | kDegenerate},
                      DirtyCase{"mug with T-junctions", mug, kTJunctions},
                      DirtyCase{"mug with holes and flipped faces", mug, kHoles | kFlipped},
                      DirtyCase{"torus with all but holes", torus,
                                kSoup | kFlipped | kDuplicated | kDegenerate | kTJunctions | kUnreferenced},
                      DirtyCase{"torus with everything", torus, 255 - kInsideOut},
                      DirtyCase{"two balls, loose and flipped", two_balls, kSoup | kFlipped},
                      DirtyCase{"ball and box through each other", through_each_other, kSoup | kFlipped}),
    [](const auto& which) { return "Case" + std::to_string(which.index); });

constexpr int kFilePlaces = test::kSlowBuild ? 30 : 120;

class TestModel : public ::testing::TestWithParam<const char*> {};

// Debian's assimp-testmodels: as found, some open, some self-intersecting, of several shells.
TEST_P(TestModel, StopsTheHandTheMarginAwayFromTheFilesOwnTriangles) {
  const std::filesystem::path file = std::filesystem::path("/usr/share/assimp/models") / GetParam();
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not there: install assimp-testmodels";
  std::vector<RawTriangle> raw = test::read_raw(file);
  ASSERT_FALSE(raw.empty());
  test::scale_raw(raw, 0.15);
  LoneFinger finger(ObjectModel(import_and_check(file, {.size = 0.15}).mesh));
  const Judged judged = press_everywhere(finger, raw, raw, false, 3, kFilePlaces);
  std::printf("%s: %zu triangles, %d presses, %d segments touching, | clearance - margin | at most %.3f um\n",
              GetParam(), raw.size(), judged.presses, judged.touching, judged.worst * 1e6);
  EXPECT_GE(6 * judged.presses, kFilePlaces);
}

INSTANTIATE_TEST_SUITE_P(Files, TestModel,
                         ::testing::Values("OBJ/spider.obj", "OBJ/WusonOBJ.obj", "OBJ/box.obj",
                                           "STL/Spider_ascii.stl", "PLY/cube.ply", "PLY/Wuson.ply"),
                         [](const auto& which) { return "Case" + std::to_string(which.index); });

}  // namespace
}  // namespace phalanx

// SPDX-License-Identifier: Apache-2.0
// The contact search's answers against all pairs of triangles, measured by other formulas in extended
// precision.
#include <gmock/gmock.h>

#include <iostream>

#include "phalanx/contact/proximity.h"
#include "support/reference/exact_triangles.h"
#include "support/sanitized.h"
#include "support/search_cases.h"

namespace phalanx {
namespace {

/// Where the whole case is put, and how large.
struct Placement {
  const char* name;
  Vec3 shift;
  double scale;
};
const Placement kPlacements[] = {{"at the origin", Vec3::Zero(), 1.0},
                                 {"10 m from the origin", Vec3(10.0, -10.0, 10.0), 1.0},
                                 {"at 1/100 scale", Vec3::Zero(), 0.01}};

TriangleMesh put(TriangleMesh mesh, double scale, const Vec3& shift) {
  for (Vec3& v : mesh.vertices) v = scale * v + shift;
  return mesh;
}

/// The pairs that tie for the contact, and what the search should make of them.
struct ExpectedPatch {
  int surely = 0;    ///< pairs that are within the band beyond doubt
  int possibly = 0;  ///< those and pairs at its very end
  Vec3 on_segment = Vec3::Zero();
  Vec3 on_object = Vec3::Zero();
};

class Checked {
 public:
  Checked(const test::SearchCase& shapes, const Placement& placement)
      : placement_(placement),
        segment_mesh_(put(shapes.segment, placement.scale, Vec3::Zero())),
        object_(put(shapes.object, placement.scale, placement.shift)),
        object_corners_(test::corners_of(object_.mesh())),
        exact_object_(object_corners_),
        segment_(segment_mesh_),
        scratch_(segment_) {
    double largest = 0.0;
    for (const Vec3& v : object_.mesh().vertices) largest = std::max(largest, v.cwiseAbs().maxCoeff());
    // Both distances are functions of corners that rounding moves by an ulp or two of the largest coordinate,
    // and a few dozen operations follow: 2e-13 of it is about a thousand ulps. A pair that is passed over or
    // a wrong feature shows at 1e-9 and more.
    tolerance_ = 2e-13 * (largest + 0.1 * placement.scale);
  }

  void at(Pose X) {
    X.p = placement_.scale * X.p + placement_.shift;
    const PlacedSegment placed{segment_, X, scratch_};
    const std::vector<Corners> mine = test::corners_of(segment_mesh_, X);
    const test::ExactMesh exact_mine(mine);
    const double expected = exact_mine.gap(exact_object_);
    const double far = 4.0;
    const double found = distance(placed, object_.tree(), far);
    ASSERT_NEAR(found, expected, tolerance_);
    EXPECT_EQ(distance(placed, object_.tree(), 1.001 * found + 1e-6), found) << "the cap changes no answer";
    EXPECT_EQ(distance(placed, object_.tree(), 0.5 * found), 0.5 * found) << "a cap below it comes back";
    check_bound(placed, expected);
    if (expected > tolerance_) check_patch(placed, mine, exact_mine, expected);
  }

 private:
  void check_bound(const PlacedSegment& placed, double expected) {
    const double bound = distance_bound(placed, object_.tree(), 4.0);
    EXPECT_LE(bound, expected + tolerance_);
    EXPECT_GE(bound, 0.0);
    const double capped = distance_bound(placed, object_.tree(), 0.1 * bound);
    EXPECT_LE(capped, 0.1 * bound);
    EXPECT_GE(capped, 0.08 * bound) << "at least 0.8 of what is to be had";
  }

  void check_patch(const PlacedSegment& placed, const std::vector<Corners>& mine,
                   const test::ExactMesh& exact_mine, double expected) {
    const ContactPatch patch = contact_patch(placed, object_, expected + 1e-4);
    ASSERT_NEAR(patch.distance, expected, tolerance_);
    // The tied regions are the program's own, of the same corners and the same limit: this is about the
    // pairs.
    const ExpectedPatch brute = brute_patch(mine, exact_mine, patch.distance);
    EXPECT_GE(patch.pairs, brute.surely);
    EXPECT_LE(patch.pairs, brute.possibly);
    // At 1/100 the band is a twentieth of a triangle: which corners of a region tie is decided by an ulp.
    if (placement_.scale == 1.0) {
      EXPECT_LT((patch.on_segment - brute.on_segment).norm(), 1e-3 * kPatchBand);
      EXPECT_LT((patch.on_object - brute.on_object).norm(), 1e-3 * kPatchBand);
    }
    EXPECT_NEAR(patch.direction.norm(), 1.0, 1e-12);
    EXPECT_EQ(contact_patch(placed, object_, 0.999 * expected).pairs, 0) << "nothing is within such a cap";
  }

  [[nodiscard]] ExpectedPatch brute_patch(const std::vector<Corners>& mine, const test::ExactMesh& exact_mine,
                                          double least) const {
    ExpectedPatch out;
    double weight = 0.0;
    const double limit = least + kPatchBand;
    for (const test::ExactPair& pair : exact_mine.pairs_within(exact_object_, limit + tolerance_)) {
      ++out.possibly;
      if (pair.gap <= limit - 2.0 * tolerance_) ++out.surely;
      const Corners& a = mine[pair.a];
      const Corners& b = object_corners_[pair.b];
      if (pair.gap > limit) continue;
      const TiedRegion region = tied_region(a, b, triangle_distance(a, b), limit, kPatchBand);
      const double w = region.weight * (limit - pair.gap) / kPatchBand;
      out.on_segment += w * region.on_a;
      out.on_object += w * region.on_b;
      weight += w;
    }
    out.on_segment /= weight;
    out.on_object /= weight;
    return out;
  }

  Placement placement_;
  TriangleMesh segment_mesh_;
  ObjectModel object_;
  std::vector<Corners> object_corners_;
  test::ExactMesh exact_object_;
  SegmentTree segment_;
  SearchScratch scratch_;
  double tolerance_ = 0.0;
};

void check_all_cases(std::uint64_t seed, int poses) {
  std::cout << "seed " << seed << "\n";
  test::Random random(seed);
  for (const test::SearchCase& shapes : test::search_cases(random)) {
    for (const Placement& placement : kPlacements) {
      Checked checked(shapes, placement);
      for (int i = 0; i < poses; ++i) {
        SCOPED_TRACE(::testing::Message()
                     << "seed " << seed << ", " << shapes.name << ", " << placement.name << ", pose " << i);
        ASSERT_NO_FATAL_FAILURE(checked.at(shapes.pose(random)));
      }
    }
  }
}

TEST(SearchOracle, DistanceBoundAndPatchEqualAllPairsOfTriangles) {
  check_all_cases(404, test::kSlowBuild ? 3 : 15);
}

// A pair that is 1 ulp beside the answer, a lane that was left out, a box too small: seldom, so for long.
TEST(SoakSearchOracle, DistanceBoundAndPatchEqualAllPairsOfTriangles) {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) check_all_cases(seed, 50);
}

TEST(SearchOracle, AnyCapUpToInfinityGivesTheSameDistance) {
  const ObjectModel object(make_sphere(0.05, 100));
  const SegmentTree segment(test::first_triangles(make_sphere(0.01, 60), 9));  // a tree with empty lanes
  SearchScratch scratch(segment);
  const Pose X{Mat3::Identity(), Vec3(0.05, 0.01, 0.0)};
  const double expected = distance({segment, X, scratch}, object.tree(), 1.0);
  for (const double cap : {1e3, 1e6, 1e12, 1e14, 1e15, 1e16, 1e30, 1e150}) {
    EXPECT_EQ(distance({segment, X, scratch}, object.tree(), cap), expected) << cap;
    EXPECT_LE(distance_bound({segment, X, scratch}, object.tree(), cap), expected) << cap;
  }
}

}  // namespace
}  // namespace phalanx

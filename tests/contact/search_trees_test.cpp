// SPDX-License-Identifier: Apache-2.0
// The two trees of the contact search: what their nodes hold.
#include "phalanx/contact/object_tree.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <utility>
#include <vector>

#include "phalanx/contact/proximity.h"
#include "phalanx/contact/segment_tree.h"
#include "support/search_cases.h"

namespace phalanx {
namespace {

/// A flat sheet of 2 n^2 triangles, 1 mm each way, at a slant to every axis.
TriangleMesh slanted_sheet(int n, const Vec3& normal) {
  const Vec3 u = normal.unitOrthogonal();
  const Vec3 v = normal.cross(u);
  TriangleMesh mesh;
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= n; ++j)
      mesh.vertices.push_back(Vec3(0.3, 0.2, 0.1) +
                              1e-3 * (static_cast<double>(i) * u + static_cast<double>(j) * v));
  const auto at = [n](int i, int j) { return i * (n + 1) + j; };
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i, j + 1)});
      mesh.triangles.push_back({at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return mesh;
}

// A box bounds what is in it by a slab across the mean normal, too. Of a flat sheet the slab has no thickness
// but for single precision's rounding, while the boxes are millimetres thick.
TEST(ObjectTree, TheSlabsOfAFlatSheetLieAlongItAndAreThin) {
  const Vec3 normal = Vec3(1.0, 2.0, 3.0).normalized();
  const ObjectTree tree(slanted_sheet(12, normal));
  ASSERT_EQ(tree.size(), 288);
  int lanes = 0;
  for (std::vector<int> open = {0}; !open.empty();) {
    const BoxNode& node = tree.nodes()[open.back()];
    open.pop_back();
    for (int lane = 0; lane < kWide; ++lane) {
      if (node.min[0][lane] > node.max[0][lane]) continue;  // empty
      ++lanes;
      EXPECT_NEAR(node.high[lane] - node.low[lane], 0.0, 1e-7);
      for (int k = 0; k < 3; ++k) EXPECT_NEAR(std::abs(node.axis[k][lane]), normal[k], 1e-6);
      if (node.child[lane] >= 0) open.push_back(node.child[lane]);
    }
  }
  EXPECT_GT(lanes, 288 / kWide);
}

Vec3 lane_of(const float (&vectors)[3][kWide], int lane) {
  return {static_cast<double>(vectors[0][lane]), static_cast<double>(vectors[1][lane]),
          static_cast<double>(vectors[2][lane])};
}

/// Corners of all triangles below a lane of a node.
std::vector<Vec3> corners_below(const ObjectTree& tree, const BoxNode& node, int lane) {
  std::vector<Vec3> found;
  const std::int32_t child = node.child[lane];
  if (child < 0) {
    for (int slot = ~child * kWide; slot < std::min((~child + 1) * kWide, tree.size()); ++slot)
      for (const Vec3& x : tree.corners(slot)) found.push_back(x);
    return found;
  }
  for (int i = 0; i < kWide; ++i) {
    const BoxNode& inner = tree.nodes()[child];
    if (inner.min[0][i] > inner.max[0][i]) continue;
    const std::vector<Vec3> below = corners_below(tree, inner, i);
    found.insert(found.end(), below.begin(), below.end());
  }
  return found;
}

/// At or below x, and by little more than one step of single precision, 2^-23 of x.
void expect_just_below(float bound, double x, double held) {
  EXPECT_LE(static_cast<double>(bound), x);
  EXPECT_GE(static_cast<double>(bound), x - 1.3e-7 * std::abs(x) - 1e-14 * held);
}

// Too small, and a pair is missed; too large, and the search takes longer than it needs.
TEST(ObjectTree, BoxesAndSlabsHoldWhatIsBelowThemAndNothingMore) {
  std::cout << "seed 31\n";
  test::Random random(31);
  for (const Vec3& shift : {Vec3(0, 0, 0), Vec3(3.0, -7.0, 11.0)}) {
    for (const int size : {1, 5, 9, 100}) {
      TriangleMesh mesh;
      append(mesh, test::soup(random, size), Pose{Mat3::Identity(), shift});
      const ObjectTree tree(mesh);
      const Bounds box = bounds(mesh);
      const Vec3 centre = 0.5 * (box.min + box.max);
      EXPECT_EQ(tree.centre(), centre);
      EXPECT_EQ(tree.extent(), 0.5 * (box.max - box.min).maxCoeff());
      const double held = 1.0 + centre.cwiseAbs().maxCoeff();
      int seen = 0;
      for (std::vector<std::pair<int, int>> open = {{0, 0}}; !open.empty();) {
        const auto [at, lane] = open.back();
        open.pop_back();
        const BoxNode& node = tree.nodes()[at];
        const std::vector<Vec3> below = corners_below(tree, node, lane);
        ASSERT_FALSE(below.empty());
        const Vec3 axis = lane_of(node.axis, lane);
        EXPECT_NEAR(axis.norm(), 1.0, 1e-6);
        Vec3 normal = Vec3::Zero();
        for (std::size_t i = 0; i < below.size(); i += 3)
          normal += (below[i + 1] - below[i]).cross(below[i + 2] - below[i]);
        double low = 1e300;
        double high = -1e300;
        for (const Vec3& x : below) {
          low = std::min(low, axis.dot(x - centre));
          high = std::max(high, axis.dot(x - centre));
        }
        expect_just_below(node.low[lane], low, held);
        expect_just_below(-node.high[lane], -high, held);
        for (int k = 0; k < 3; ++k) {
          const auto by = [k](const Vec3& a, const Vec3& b) { return a[k] < b[k]; };
          const double least = (*std::min_element(below.begin(), below.end(), by))[k];
          const double most = (*std::max_element(below.begin(), below.end(), by))[k];
          expect_just_below(node.min[k][lane], least - centre[k], held);
          expect_just_below(-node.max[k][lane], centre[k] - most, held);
        }
        if (node.child[lane] < 0) {
          seen += static_cast<int>(below.size()) / 3;
          // The mean normal of a block's lanes; the last one repeats its last triangle where it is not full.
          if (below.size() == 3 * kWide) {
            EXPECT_NEAR((axis - normal.normalized()).norm(), 0.0, 1e-6);
          }
          continue;
        }
        for (int i = 0; i < kWide; ++i) {
          const BoxNode& inner = tree.nodes()[node.child[lane]];
          if (inner.min[0][i] <= inner.max[0][i]) open.emplace_back(node.child[lane], i);
        }
      }
      EXPECT_EQ(seen, size);
    }
  }
}

// The middle is (1, 1, 3), so that the box ends at -1 and 1, which single precision has, and the slab at 0.
// For what a subtraction rounds the box is larger by 1e-15 of |low| + |high| + 3: along x and y the next
// number outside, along z 9e-15. The slab is larger by four times that, of which only the 3 is not 0.
TEST(ObjectTree, BoxesAndSlabsAreLargerByWhatASubtractionMayRound) {
  TriangleMesh mesh;
  test::add_triangle(mesh, Vec3(0, 0, 3), Vec3(2, 0, 3), Vec3(0, 2, 3));
  const ObjectTree tree(mesh);
  const BoxNode& root = tree.nodes()[0];
  for (int k = 0; k < 2; ++k) {
    EXPECT_EQ(root.min[k][0], std::nextafter(-1.0F, -2.0F)) << k;
    EXPECT_EQ(root.max[k][0], std::nextafter(1.0F, 2.0F)) << k;
  }
  EXPECT_FLOAT_EQ(root.min[2][0], -9e-15F);
  EXPECT_FLOAT_EQ(root.max[2][0], 9e-15F);
  EXPECT_FLOAT_EQ(root.low[0], -12e-15F);
  EXPECT_FLOAT_EQ(root.high[0], 12e-15F);
}

// A search that looks at an empty lane finds a box that is inside out by more than any cap.
TEST(ObjectTree, AnEmptyLaneIsInsideOut) {
  test::Random random(32);
  const ObjectTree tree(test::soup(random, 3));
  for (int lane = 1; lane < kWide; ++lane) {
    for (int k = 0; k < 3; ++k) {
      EXPECT_EQ(tree.nodes()[0].min[k][lane], 1e30F);
      EXPECT_EQ(tree.nodes()[0].max[k][lane], -1e30F);
    }
  }
}

// Four triangles at the heights 0 to 3, each once either way round: their normals cancel out, and both trees
// look along z. From a triangle 5 above the lowest the distance is 5; the next is 3.7 aside and 4 below.
TEST(SearchTrees, LookAlongZWhereTheNormalsCancel) {
  TriangleMesh mesh;
  for (int i = 0; i < 4; ++i) {
    const Vec3 a(4.0 * i, 0.0, i);
    const Vec3 b = a + Vec3::UnitX();
    const Vec3 c = a + Vec3::UnitY();
    test::add_triangle(mesh, a, b, c);
    test::add_triangle(mesh, a, c, b);
  }
  const ObjectTree object(mesh);
  EXPECT_EQ(lane_of(object.nodes()[0].axis, 0), Vec3(Vec3::UnitZ()));
  EXPECT_NEAR(object.nodes()[0].low[0], -1.5, 1e-6);
  EXPECT_NEAR(object.nodes()[0].high[0], 1.5, 1e-6);
  const SegmentTree lenses(mesh);
  EXPECT_EQ(lane_of(lenses.nodes()[0].axis, 0), Vec3(Vec3::UnitZ()));
  EXPECT_NEAR((lane_of(lenses.nodes()[0].centre, 0) - Vec3(6.5, 0.5, 1.5)).norm(), 0.0, 1e-5);
  EXPECT_NEAR(lenses.nodes()[0].half[0], 1.5, 1e-5);

  TriangleMesh above;
  test::add_triangle(above, Vec3(0.2, 0.2, 5.0), Vec3(0.3, 0.2, 5.0), Vec3(0.2, 0.3, 5.0));
  const SegmentTree segment(above);
  SearchScratch scratch(segment);
  const Pose X;
  EXPECT_NEAR(distance({segment, X, scratch}, object, 10.0), 5.0, 1e-12);
  SearchScratch wide(lenses);
  EXPECT_NEAR(distance({lenses, X, wide}, ObjectTree(above), 10.0), 5.0, 1e-12);
}

/// The radius of the smallest circle around a triangle: half its longest edge where the angle opposite is
/// right or more, else of its circumscribed circle, a b c / 4 A.
double smallest_circle(const Corners& t) {
  std::array<double, 3> edge = {(t[1] - t[0]).norm(), (t[2] - t[1]).norm(), (t[0] - t[2]).norm()};
  std::sort(edge.begin(), edge.end());
  if (edge[2] * edge[2] >= edge[0] * edge[0] + edge[1] * edge[1]) return 0.5 * edge[2];
  return edge[0] * edge[1] * edge[2] / (2.0 * (t[1] - t[0]).cross(t[2] - t[0]).norm());
}

std::vector<int> triangles_below(const SegmentTree& tree, const LensNode& node, int lane) {
  if (node.child[lane] < 0) return {~node.child[lane]};
  std::vector<int> found;
  for (int i = 0; i < kWide; ++i) {
    const LensNode& inner = tree.nodes()[node.child[lane]];
    if (inner.radius[i] < 0.0F) continue;
    const std::vector<int> below = triangles_below(tree, inner, i);
    found.insert(found.end(), below.begin(), below.end());
  }
  return found;
}

void expect_just_above(float bound, double x) {
  EXPECT_GE(static_cast<double>(bound), x);
  EXPECT_LE(static_cast<double>(bound), x * (1.0 + 2e-6) + 1e-9);
}

TEST(SegmentTree, LensesHoldWhatIsBelowThemAndLittleMore) {
  std::cout << "seed 33\n";
  test::Random random(33);
  for (const int size : {1, 2, 9, 100}) {
    const TriangleMesh mesh = test::soup(random, size);
    const SegmentTree tree(mesh);
    double farthest = 0.0;
    for (const Vec3& v : mesh.vertices) farthest = std::max(farthest, v.norm());
    EXPECT_EQ(tree.extent(), farthest);
    int seen = 0;
    int nodes = 1;
    for (std::vector<std::pair<int, int>> open = {{0, 0}}; !open.empty();) {
      const auto [at, lane] = open.back();
      open.pop_back();
      const LensNode& node = tree.nodes()[at];
      const Vec3 centre = lane_of(node.centre, lane);
      const Vec3 axis = lane_of(node.axis, lane);
      const Vec3 u = axis.unitOrthogonal();
      const Vec3 v = axis.cross(u);
      const std::vector<int> below = triangles_below(tree, node, lane);
      Vec3 normal = Vec3::Zero();
      Vec3 low = Vec3::Constant(1e300);
      Vec3 high = -low;
      double radius = 0.0;
      double half = 0.0;
      for (const int i : below) {
        const Corners t = tree.corners(i);
        normal += (t[1] - t[0]).cross(t[2] - t[0]);
        for (const Vec3& x : t) {
          const Vec3 local((x - centre).dot(u), (x - centre).dot(v), (x - centre).dot(axis));
          low = low.cwiseMin(local);
          high = high.cwiseMax(local);
          radius = std::max(radius, (x - centre).norm());
          half = std::max(half, std::abs((x - centre).dot(axis)));
        }
      }
      EXPECT_NEAR((axis - normal.normalized()).norm(), 0.0, 1e-5);
      expect_just_above(node.radius[lane], radius);
      expect_just_above(node.half[lane], half);
      if (below.size() == 1) {
        EXPECT_NEAR(radius, smallest_circle(tree.corners(below[0])), 1e-7);
      } else {
        EXPECT_NEAR((low + high).norm(), 0.0, 1e-6) << "in the middle of the box along and across its axis";
      }
      if (node.child[lane] < 0) {
        ++seen;
        continue;
      }
      ++nodes;
      for (int i = 0; i < kWide; ++i)
        if (tree.nodes()[node.child[lane]].radius[i] >= 0.0F) open.emplace_back(node.child[lane], i);
    }
    EXPECT_EQ(seen, size);
    EXPECT_EQ(tree.node_count(), nodes);
  }
}

// 3, 4, 5: right-angled. 6, 5, 5: acute, and its circumscribed circle has the radius 6 * 5 * 5 / (4 * 12). 8,
// 5, 5: obtuse.
TEST(SegmentTree, TheLensOfATriangleIsItsSmallestCircle) {
  TriangleMesh right;
  test::add_triangle(right, Vec3(0, 0, 0), Vec3(3, 0, 0), Vec3(0, 4, 0));
  TriangleMesh acute;
  test::add_triangle(acute, Vec3(0, 0, 0), Vec3(6, 0, 0), Vec3(3, 4, 0));
  TriangleMesh obtuse;
  test::add_triangle(obtuse, Vec3(4, 3, 0), Vec3(0, 0, 0), Vec3(8, 0, 0));
  EXPECT_NEAR(SegmentTree(right).nodes()[0].radius[0], 2.5, 1e-5);
  EXPECT_NEAR(SegmentTree(acute).nodes()[0].radius[0], 3.125, 1e-5);
  EXPECT_NEAR(SegmentTree(obtuse).nodes()[0].radius[0], 4.0, 1e-5);
  EXPECT_NEAR(SegmentTree(acute).nodes()[0].centre[0][0], 3.0, 1e-6);
  EXPECT_NEAR(SegmentTree(acute).nodes()[0].centre[1][0], 4.0 - 3.125, 1e-6);
  EXPECT_NEAR(SegmentTree(obtuse).nodes()[0].centre[0][0], 4.0, 1e-6);
  EXPECT_NEAR(SegmentTree(obtuse).nodes()[0].centre[1][0], 0.0, 1e-6);
}

}  // namespace
}  // namespace phalanx

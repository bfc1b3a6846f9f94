// SPDX-License-Identifier: Apache-2.0
#include "contact/search/wide_ranges.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <numeric>
#include <set>

#include "support/search_cases.h"

namespace phalanx {
namespace {

using ::testing::ElementsAreArray;

/// A small triangle around the point.
void add_at(TriangleMesh& mesh, const Vec3& x) {
  test::add_triangle(mesh, x + Vec3(1e-4, 0, 0), x + Vec3(0, 1e-4, 0), x - Vec3(1e-4, 1e-4, 0));
}

std::set<std::int32_t> triangles_of(const WideRanges& ranges, const WideRanges::Lane& lane) {
  const auto first = ranges.order.begin() + lane.first;
  return {first, first + lane.count};
}

/// Each lane's children hold what it holds, in the same order; leaves are full but for the last.
void expect_a_tree(const WideRanges& ranges, int size, int leaf_size) {
  std::vector<std::int32_t> all(static_cast<std::size_t>(size));
  std::iota(all.begin(), all.end(), 0);
  std::vector<std::int32_t> found = ranges.order;
  std::sort(found.begin(), found.end());
  EXPECT_EQ(found, all) << "every triangle once";

  ASSERT_FALSE(ranges.nodes.empty());
  EXPECT_EQ(ranges.nodes[0][0].first, 0);
  EXPECT_EQ(ranges.nodes[0][0].count, size);
  for (std::size_t lane = 1; lane < kWide; ++lane) EXPECT_EQ(ranges.nodes[0][lane].count, 0);
  std::set<std::int32_t> children;
  std::set<std::int32_t> leaves;
  for (std::size_t n = 0; n < ranges.nodes.size(); ++n) {
    for (const WideRanges::Lane& lane : ranges.nodes[n]) {
      if (lane.count == 0) continue;
      if (lane.child < 0) {
        EXPECT_EQ(lane.first, ~lane.child * leaf_size);
        EXPECT_EQ(lane.count, std::min(leaf_size, size - lane.first));
        EXPECT_TRUE(leaves.insert(~lane.child).second);
        continue;
      }
      EXPECT_GT(lane.count, leaf_size);
      EXPECT_GT(lane.child, static_cast<std::int32_t>(n)) << "behind its parent";
      EXPECT_TRUE(children.insert(lane.child).second) << "one parent each";
      std::int32_t next = lane.first;
      for (const WideRanges::Lane& part : ranges.nodes.at(static_cast<std::size_t>(lane.child))) {
        if (part.count == 0) continue;
        EXPECT_EQ(part.first, next);
        next += part.count;
      }
      EXPECT_EQ(next, lane.first + lane.count);
    }
  }
  EXPECT_EQ(children.size(), ranges.nodes.size() - 1);
  EXPECT_EQ(static_cast<int>(leaves.size()), (size + leaf_size - 1) / leaf_size);
}

TEST(WideRanges, HoldEveryTriangleOnceInFullLeavesBehindTheirParents) {
  for (const int leaf_size : {1, kWide}) {
    for (const int size : {1, 2, 7, 8, 9, 63, 64, 65, 500, 513}) {
      SCOPED_TRACE(::testing::Message() << size << " triangles, " << leaf_size << " a leaf");
      test::Random random(17);
      expect_a_tree(wide_ranges(test::soup(random, size), leaf_size), size, leaf_size);
    }
  }
  EXPECT_TRUE(wide_ranges({}, 1).nodes.empty());
}

// 512 leaves of eight under one root need 1 + 1 + 8 + 64 nodes: all full, but for the root's own.
TEST(WideRanges, HaveFullNodes) {
  test::Random random(18);
  EXPECT_EQ(wide_ranges(test::soup(random, 4096), kWide).nodes.size(), 74U);
}

// Eight groups of eight at the corners of a box of 60 x 40 x 20 cm, whichever of its edges lies along x:
// split across the longest first, each group is a leaf. The mesh has the groups' triangles in turn.
TEST(WideRanges, SplitAtTheMedianAcrossTheLongestEdge) {
  const std::array<Vec3, 3> boxes = {Vec3(0.3, 0.2, 0.1), Vec3(0.1, 0.3, 0.2), Vec3(0.2, 0.1, 0.3)};
  for (const Vec3& box : boxes) {
    TriangleMesh mesh;
    for (int i = 0; i < 8; ++i) {
      for (int corner = 0; corner < 8; ++corner) {
        const Vec3 side(corner & 1 ? 1.0 : -1.0, corner & 2 ? 1.0 : -1.0, corner & 4 ? 1.0 : -1.0);
        add_at(mesh, box.cwiseProduct(side) + 1e-3 * Vec3(i, i % 3, i % 5));
      }
    }
    const WideRanges ranges = wide_ranges(mesh, 8);
    ASSERT_EQ(ranges.nodes.size(), 2U);
    for (const WideRanges::Lane& lane : ranges.nodes[1]) {
      const std::set<std::int32_t> group = triangles_of(ranges, lane);
      ASSERT_EQ(group.size(), 8U);
      for (const std::int32_t t : group) EXPECT_EQ(t % 8, *group.begin() % 8);
    }
  }
}

// By the middles of their boxes, not by a corner: every second triangle reaches far to the left.
TEST(WideRanges, SortTrianglesByTheMiddlesOfTheirBoxes) {
  TriangleMesh mesh;
  for (int i = 0; i < 16; ++i) {
    const double half = i % 2 == 0 ? 100.0 : 0.1;
    test::add_triangle(mesh, Vec3(i - half, 0, 0), Vec3(i + half, 1e-3, 0), Vec3(i - half, 2e-3, 0));
  }
  const WideRanges ranges = wide_ranges(mesh, 8);
  ASSERT_EQ(ranges.nodes.size(), 2U);
  EXPECT_THAT(triangles_of(ranges, ranges.nodes[1][0]), ElementsAreArray({0, 1, 2, 3, 4, 5, 6, 7}));
  EXPECT_THAT(triangles_of(ranges, ranges.nodes[1][1]), ElementsAreArray({8, 9, 10, 11, 12, 13, 14, 15}));
}

TEST(WideRanges, KeepTheMeshsOrderInATie) {
  TriangleMesh mesh;
  for (int i = 0; i < 16; ++i) add_at(mesh, Vec3::Zero());
  const WideRanges ranges = wide_ranges(mesh, 8);
  EXPECT_THAT(triangles_of(ranges, ranges.nodes[1][0]), ElementsAreArray({0, 1, 2, 3, 4, 5, 6, 7}));
}

}  // namespace
}  // namespace phalanx

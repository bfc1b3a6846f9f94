// SPDX-License-Identifier: Apache-2.0
#include "phalanx/contact/segment_tree.h"

#include <algorithm>
#include <cmath>

#include "contact/search/wide_ranges.h"
#include "phalanx/core/index.h"

namespace phalanx {
namespace {

struct Lens {
  Vec3 centre;
  Vec3 axis;
};

/// Returns the centre of the triangle's smallest enclosing circle. This is its circumcentre or, if a corner
/// is right or obtuse, the midpoint of the opposite edge.
Vec3 middle_of(const Corners& t) noexcept {
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 u = t[(i + 1) % 3] - t[i];
    const Vec3 v = t[(i + 2) % 3] - t[i];
    if (u.dot(v) <= 0.0) return 0.5 * (t[(i + 1) % 3] + t[(i + 2) % 3]);
  }
  const Vec3 u = t[1] - t[0];
  const Vec3 v = t[2] - t[0];
  const Vec3 n = u.cross(v);
  const double squared = n.squaredNorm();
  if (!(squared > 0.0)) return (t[0] + t[1] + t[2]) / 3.0;
  return t[0] + (u.squaredNorm() * v.cross(n) + v.squaredNorm() * n.cross(u)) / (2.0 * squared);
}

Vec3 normal_of(const Corners& t) noexcept { return (t[1] - t[0]).cross(t[2] - t[0]); }

/// Returns a lens with the triangles' mean normal as its axis. Across it the centre is the middle of their
/// box, along it halfway between the outermost.
Lens lens_around(const SegmentTree& tree, const std::vector<std::int32_t>& order,
                 const WideRanges::Lane& lane) {
  Vec3 axis = Vec3::Zero();
  for (std::int32_t i = lane.first; i < lane.first + lane.count; ++i)
    axis += normal_of(tree.corners(order[idx(i)]));
  const double length = axis.norm();
  axis = length > 0.0 ? Vec3(axis / length) : Vec3(Vec3::UnitZ());
  if (lane.count == 1) return {middle_of(tree.corners(order[idx(lane.first)])), axis};
  const Vec3 u = axis.unitOrthogonal();
  const Vec3 v = axis.cross(u);
  Vec3 low = Vec3::Constant(1e300);
  Vec3 high = -low;
  for (std::int32_t i = lane.first; i < lane.first + lane.count; ++i) {
    for (const Vec3& x : tree.corners(order[idx(i)])) {
      const Vec3 local(x.dot(u), x.dot(v), x.dot(axis));
      low = low.cwiseMin(local);
      high = high.cwiseMax(local);
    }
  }
  const Vec3 middle = 0.5 * (low + high);
  return {middle.x() * u + middle.y() * v + middle.z() * axis, axis};
}

/// Returns one vector of a node, whose lanes lie side by side for each axis.
Vec3 lane_of(const float (&node)[3][kWide], int at) noexcept {
  return Eigen::Vector3f(node[0][at], node[1][at], node[2][at]).cast<double>();
}
void set_lane(float (&node)[3][kWide], int at, const Vec3& v) noexcept {
  node[0][at] = static_cast<float>(v.x());
  node[1][at] = static_cast<float>(v.y());
  node[2][at] = static_cast<float>(v.z());
}

/// Sets the largest distances of the lane's corners from the lens's centre and from its plane, both as stored
/// in single precision. It must not be inlined: from -O2 on GCC 12 omits the rounding to single precision
/// where a number is used in double again (two numbers at a time).
[[gnu::noinline]] void set_extent(const SegmentTree& tree, const std::vector<std::int32_t>& order,
                                  const WideRanges::Lane& lane, LensNode& node, int at) {
  const Vec3 centre = lane_of(node.centre, at);
  const Vec3 axis = lane_of(node.axis, at);
  double radius = 0.0;
  double half = 0.0;
  for (std::int32_t i = lane.first; i < lane.first + lane.count; ++i) {
    for (const Vec3& x : tree.corners(order[idx(i)])) {
      const Vec3 r = x - centre;
      radius = std::max(radius, r.norm());
      half = std::max(half, std::abs(r.dot(axis)));
    }
  }
  node.radius[at] = static_cast<float>(radius * (1.0 + 1e-6));
  node.half[at] = static_cast<float>(half * (1.0 + 1e-6));
}

/// Writes a lens in single precision, large enough to cover the rounding.
void set_lens(const SegmentTree& tree, const std::vector<std::int32_t>& order, const WideRanges::Lane& lane,
              LensNode& node, int at) {
  const Lens lens = lens_around(tree, order, lane);
  set_lane(node.centre, at, lens.centre);
  set_lane(node.axis, at, lens.axis);
  set_extent(tree, order, lane, node, at);
  node.child[at] = lane.child >= 0 ? lane.child : ~order[idx(lane.first)];
}

void set_empty(LensNode& node, int at) noexcept {
  set_lane(node.centre, at, Vec3::Zero());
  set_lane(node.axis, at, Vec3::Zero());
  node.radius[at] = -1e15F;  // its square is finite; radius + cap stays negative
  node.half[at] = -1e15F;
  node.child[at] = 0;
}

}  // namespace

SegmentTree::SegmentTree(const TriangleMesh& mesh) {
  triangles_.reserve(mesh.triangles.size());
  for (const Triangle& t : mesh.triangles) {
    SegmentTriangle& triangle = triangles_.emplace_back();
    for (std::size_t c = 0; c < 3; ++c) {
      const Vec3& v = mesh.vertices[idx(t[c])];
      extent_ = std::max(extent_, v.norm());
      for (int i = 0; i < 3; ++i) triangle.corner[c][i] = v[i];
    }
  }
  const WideRanges ranges = wide_ranges(mesh, 1);
  nodes_.resize(ranges.nodes.size());
  for (std::size_t n = 0; n < nodes_.size(); ++n) {
    for (int i = 0; i < kWide; ++i) {
      const WideRanges::Lane& lane = ranges.nodes[n][static_cast<std::size_t>(i)];
      if (lane.count == 0) {
        set_empty(nodes_[n], i);
      } else {
        set_lens(*this, ranges.order, lane, nodes_[n], i);
      }
    }
  }
}

Corners SegmentTree::corners(int i) const noexcept {
  const SegmentTriangle& t = triangles_[idx(i)];
  Corners corners;
  for (std::size_t c = 0; c < 3; ++c) corners[c] = Vec3(t.corner[c][0], t.corner[c][1], t.corner[c][2]);
  return corners;
}

SearchScratch::SearchScratch(const SegmentTrees& trees) {
  for (const SegmentTree& tree : trees) grow(tree);
}

void SearchScratch::grow(const SegmentTree& tree) {
  const auto nodes = static_cast<std::size_t>(tree.node_count());
  const auto triangles = static_cast<std::size_t>(tree.size());
  if (lenses_.size() < nodes) lenses_.resize(nodes);
  if (triangles_.size() < triangles) triangles_.resize(triangles);
}

}  // namespace phalanx

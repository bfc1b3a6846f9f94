// SPDX-License-Identifier: Apache-2.0
#include "phalanx/contact/object_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "contact/search/wide_ranges.h"
#include "phalanx/core/index.h"

namespace phalanx {
namespace {

/// Converts to single precision, rounded down or up.
float below(double x) noexcept {
  const auto f = static_cast<float>(x);
  return static_cast<double>(f) > x ? std::nextafterf(f, -std::numeric_limits<float>::infinity()) : f;
}
float above(double x) noexcept { return -below(-x); }

/// Returns the block of a leaf's triangles.
TriangleBlock block_of(const TriangleMesh& mesh, const WideRanges& ranges, const WideRanges::Lane& lane) {
  TriangleBlock block;
  for (int i = 0; i < kWide; ++i) {
    const std::int32_t at = lane.first + std::min(i, lane.count - 1);
    const Triangle& t = mesh.triangles[idx(ranges.order[idx(at)])];
    for (int c = 0; c < 3; ++c) {
      const Vec3& v = mesh.vertices[idx(t[static_cast<std::size_t>(c)])];
      for (int axis = 0; axis < 3; ++axis) block.corner[c][axis][i] = v[axis];
    }
  }
  return block;
}

void set_empty(BoxNode& node, int lane) noexcept {
  for (int axis = 0; axis < 3; ++axis) {
    node.min[axis][lane] = 1e30F;
    node.max[axis][lane] = -1e30F;
    node.axis[axis][lane] = 0.0F;
  }
  node.low[lane] = node.high[lane] = 0.0F;
  node.child[lane] = 0;
}

/// Computes the bounds of the nodes' lanes.
class Bounder {
 public:
  Bounder(const std::vector<TriangleBlock>& blocks, const Vec3& centre) : blocks_(blocks), centre_(centre) {}

  /// Sets the bounds of one lane.
  /// @param first, last  the lane's blocks, [first, last)
  void set(BoxNode& node, int lane, std::size_t first, std::size_t last) const {
    Vec3 low = Vec3::Constant(1e300);
    Vec3 high = -low;
    Vec3 normal = Vec3::Zero();
    for (std::size_t b = first; b < last; ++b) {
      for (int i = 0; i < kWide; ++i) {
        const Corners t = triangle(blocks_[b], i);
        for (const Vec3& x : t) {
          low = low.cwiseMin(x);
          high = high.cwiseMax(x);
        }
        normal += (t[1] - t[0]).cross(t[2] - t[0]);
      }
    }
    for (int k = 0; k < 3; ++k) {
      // The difference is rounded once more. The slack covers this error.
      const double slack = rounding(low[k], high[k]);
      node.min[k][lane] = below(low[k] - centre_[k] - slack);
      node.max[k][lane] = above(high[k] - centre_[k] + slack);
    }
    const double length = normal.norm();
    const Vec3 axis = length > 0.0 ? Vec3(normal / length) : Vec3(Vec3::UnitZ());
    for (int k = 0; k < 3; ++k) node.axis[k][lane] = static_cast<float>(axis[k]);
    set_heights(node, lane, first, last);
  }

 private:
  static Corners triangle(const TriangleBlock& block, int lane) noexcept {
    Corners t;
    for (std::size_t c = 0; c < 3; ++c)
      t[c] = Vec3(block.corner[c][0][lane], block.corner[c][1][lane], block.corner[c][2][lane]);
    return t;
  }
  double rounding(double low, double high) const noexcept {
    return 1e-15 * (std::abs(low) + std::abs(high) + centre_.cwiseAbs().maxCoeff());
  }

  /// Sets the heights between which the blocks lie along the node's axis, which is the axis as stored in
  /// single precision. This is a function of its own for the reason at set_extent() in segment_tree.cpp.
  [[gnu::noinline]] void set_heights(BoxNode& node, int lane, std::size_t first, std::size_t last) const {
    Vec3 axis;
    for (int k = 0; k < 3; ++k) axis[k] = static_cast<double>(node.axis[k][lane]);
    double low = 1e300;
    double high = -low;
    for (std::size_t b = first; b < last; ++b) {
      for (int i = 0; i < kWide; ++i) {
        for (const Vec3& x : triangle(blocks_[b], i)) {
          const double height = axis.dot(x - centre_);
          low = std::min(low, height);
          high = std::max(high, height);
        }
      }
    }
    const double slack = 4.0 * rounding(low, high);
    node.low[lane] = below(low - slack);
    node.high[lane] = above(high + slack);
  }

  const std::vector<TriangleBlock>& blocks_;
  const Vec3& centre_;
};

}  // namespace

ObjectTree::ObjectTree(const TriangleMesh& mesh) {
  if (mesh.triangles.empty()) return;
  WideRanges ranges = wide_ranges(mesh, kWide);
  const Bounds box = bounds(mesh);
  centre_ = 0.5 * (box.min + box.max);
  extent_ = 0.5 * (box.max - box.min).maxCoeff();
  nodes_.resize(ranges.nodes.size());
  blocks_.resize((mesh.triangles.size() + kWide - 1) / kWide);
  for (const WideRanges::Node& node : ranges.nodes) {
    for (const WideRanges::Lane& lane : node) {
      if (lane.count > 0 && lane.child < 0) blocks_[idx(~lane.child)] = block_of(mesh, ranges, lane);
    }
  }
  const Bounder bounder(blocks_, centre_);
  for (std::size_t n = 0; n < nodes_.size(); ++n) {
    for (int i = 0; i < kWide; ++i) {
      const WideRanges::Lane& lane = ranges.nodes[n][static_cast<std::size_t>(i)];
      if (lane.count == 0) {
        set_empty(nodes_[n], i);
        continue;
      }
      nodes_[n].child[i] = lane.child;
      bounder.set(nodes_[n], i, idx(lane.first) / kWide, (idx(lane.first + lane.count) + kWide - 1) / kWide);
    }
  }
  source_ = std::move(ranges.order);
}

Corners ObjectTree::corners(int slot) const noexcept {
  const TriangleBlock& block = blocks_[idx(slot / kWide)];
  Corners corners;
  for (int c = 0; c < 3; ++c) {
    for (int axis = 0; axis < 3; ++axis)
      corners[static_cast<std::size_t>(c)][axis] = block.corner[c][axis][slot % kWide];
  }
  return corners;
}

std::size_t ObjectTree::bytes() const noexcept {
  return nodes_.capacity() * sizeof(BoxNode) + blocks_.capacity() * sizeof(TriangleBlock) +
         source_.capacity() * sizeof(std::int32_t);
}

}  // namespace phalanx

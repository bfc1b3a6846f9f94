// SPDX-License-Identifier: Apache-2.0
#include "phalanx/contact/object_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "contact/search/wide_ranges.h"

namespace phalanx {
namespace {

constexpr std::size_t idx(std::int32_t i) noexcept { return static_cast<std::size_t>(i); }

float below(double x) noexcept {
  const auto f = static_cast<float>(x);
  return static_cast<double>(f) > x ? std::nextafterf(f, -std::numeric_limits<float>::infinity()) : f;
}
float above(double x) noexcept { return -below(-x); }

/// Fills the blocks and, leaf by leaf, the boxes of those lanes that are leaves.
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
  }
  node.child[lane] = 0;
}

void set_box_of_block(const TriangleBlock& block, const Vec3& centre, BoxNode& node, int lane) noexcept {
  for (int axis = 0; axis < 3; ++axis) {
    double low = block.corner[0][axis][0];
    double high = low;
    for (int c = 0; c < 3; ++c) {
      for (int i = 0; i < kWide; ++i) {
        low = std::min(low, block.corner[c][axis][i]);
        high = std::max(high, block.corner[c][axis][i]);
      }
    }
    // The difference is rounded once more: away from the box by a step more than that.
    const double slack = 1e-15 * (std::abs(low) + std::abs(high) + std::abs(centre[axis]));
    node.min[axis][lane] = below(low - centre[axis] - slack);
    node.max[axis][lane] = above(high - centre[axis] + slack);
  }
}

void set_box_of_node(const BoxNode& child, BoxNode& node, int lane) noexcept {
  for (int axis = 0; axis < 3; ++axis) {
    node.min[axis][lane] = *std::min_element(child.min[axis], child.min[axis] + kWide);
    node.max[axis][lane] = *std::max_element(child.max[axis], child.max[axis] + kWide);
  }
}

}  // namespace

ObjectTree::ObjectTree(const TriangleMesh& mesh) {
  if (mesh.triangles.empty()) return;
  WideRanges ranges = wide_ranges(mesh, kWide);
  const Bounds box = bounds(mesh);
  centre_ = 0.5 * (box.min + box.max);
  extent_ = 0.5 * (box.max - box.min).maxCoeff();
  nodes_.resize(ranges.nodes.size());
  blocks_.resize((mesh.triangles.size() + kWide - 1) / kWide);
  for (std::size_t n = nodes_.size(); n-- > 0;) {  // children stand behind their parent
    for (int i = 0; i < kWide; ++i) {
      const WideRanges::Lane& lane = ranges.nodes[n][static_cast<std::size_t>(i)];
      if (lane.count == 0) {
        set_empty(nodes_[n], i);
        continue;
      }
      nodes_[n].child[i] = lane.child;
      if (lane.child < 0) {
        blocks_[idx(~lane.child)] = block_of(mesh, ranges, lane);
        set_box_of_block(blocks_[idx(~lane.child)], centre_, nodes_[n], i);
      } else {
        set_box_of_node(nodes_[idx(lane.child)], nodes_[n], i);
      }
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

// SPDX-License-Identifier: Apache-2.0
#include "contact/search/wide_ranges.h"

#include <algorithm>

namespace phalanx {
namespace {

struct Item {
  Vec3 middle;
  std::int32_t triangle;
};

class Builder {
 public:
  Builder(const TriangleMesh& mesh, int leaf_size) : leaf_size_(leaf_size) {
    items_.reserve(mesh.triangles.size());
    for (const Triangle& t : mesh.triangles) {
      const Vec3& a = mesh.vertices[static_cast<std::size_t>(t[0])];
      const Vec3& b = mesh.vertices[static_cast<std::size_t>(t[1])];
      const Vec3& c = mesh.vertices[static_cast<std::size_t>(t[2])];
      const Vec3 middle = 0.5 * (a.cwiseMin(b).cwiseMin(c) + a.cwiseMax(b).cwiseMax(c));
      items_.push_back({middle, static_cast<std::int32_t>(items_.size())});
    }
  }

  WideRanges build() {
    if (!items_.empty()) {
      const auto count = static_cast<std::int32_t>(items_.size());
      nodes_.emplace_back();
      const std::int32_t child = child_of(0, count);
      nodes_[0][0] = {0, count, child};
    }
    WideRanges ranges;
    ranges.nodes = std::move(nodes_);
    ranges.order.reserve(items_.size());
    for (const Item& item : items_) ranges.order.push_back(item.triangle);
    return ranges;
  }

 private:
  std::int32_t child_of(std::int32_t first, std::int32_t count) {
    if (count <= leaf_size_) return ~(first / leaf_size_);
    const auto node = static_cast<std::int32_t>(nodes_.size());
    nodes_.emplace_back();
    // Children are full trees, all but the last, so that few nodes have empty lanes.
    std::int32_t full = leaf_size_;
    while (full < (count + kWide - 1) / kWide) full *= kWide;
    std::array<WideRanges::Lane, kWide> lanes{};
    std::size_t used = 0;
    split(first, count, full, lanes, used);
    for (std::size_t i = 0; i < used; ++i) lanes[i].child = child_of(lanes[i].first, lanes[i].count);
    nodes_[static_cast<std::size_t>(node)] = lanes;
    return node;
  }

  void split(std::int32_t first, std::int32_t count, std::int32_t full,
             std::array<WideRanges::Lane, kWide>& lanes, std::size_t& used) {
    const std::int32_t parts = (count + full - 1) / full;
    if (parts == 1) {
      lanes[used++] = {first, count, 0};
      return;
    }
    const std::int32_t left = parts / 2 * full;
    partition(first, count, left);
    split(first, left, full, lanes, used);
    split(first + left, count - left, full, lanes, used);
  }

  void partition(std::int32_t first, std::int32_t count, std::int32_t left) {
    const auto begin = items_.begin() + first;
    Vec3 low = begin->middle;
    Vec3 high = begin->middle;
    for (auto item = begin; item != begin + count; ++item) {
      low = low.cwiseMin(item->middle);
      high = high.cwiseMax(item->middle);
    }
    Eigen::Index axis = 0;
    (high - low).maxCoeff(&axis);
    std::nth_element(begin, begin + left, begin + count, [axis](const Item& a, const Item& b) {
      return a.middle[axis] < b.middle[axis] || (a.middle[axis] == b.middle[axis] && a.triangle < b.triangle);
    });
  }

  std::int32_t leaf_size_;
  std::vector<Item> items_;
  std::vector<WideRanges::Node> nodes_;
};

}  // namespace

WideRanges wide_ranges(const TriangleMesh& mesh, int leaf_size) { return Builder(mesh, leaf_size).build(); }

}  // namespace phalanx

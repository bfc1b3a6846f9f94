// SPDX-License-Identifier: Apache-2.0
#include "phalanx/contact/triangle_tree.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace phalanx {
namespace {

Aabb empty_box() noexcept {
  const double inf = std::numeric_limits<double>::infinity();
  return {Vec3::Constant(inf), Vec3::Constant(-inf)};
}

void grow(Aabb& box, const Vec3& p) noexcept {
  box.min = box.min.cwiseMin(p);
  box.max = box.max.cwiseMax(p);
}

Aabb box_around(const std::vector<Corners>& corners, std::int32_t first, std::int32_t count) noexcept {
  Aabb box = empty_box();
  for (std::int32_t i = first; i < first + count; ++i) {
    for (const Vec3& p : corners[static_cast<std::size_t>(i)]) grow(box, p);
  }
  return box;
}

/// Splits at the median centroid along the widest axis of the centroids; ties keep the mesh's order, so that
/// the tree is reproducible.
class Builder {
 public:
  Builder(const TriangleMesh& mesh, int leaf_size) : leaf_size_(leaf_size), order_(mesh.triangles.size()) {
    std::iota(order_.begin(), order_.end(), 0);
    centroid_.reserve(mesh.triangles.size());
    for (const Triangle& t : mesh.triangles) {
      centroid_.push_back((mesh.vertices[static_cast<std::size_t>(t[0])] +
                           mesh.vertices[static_cast<std::size_t>(t[1])] +
                           mesh.vertices[static_cast<std::size_t>(t[2])]) /
                          3.0);
    }
    nodes_.reserve(2 * order_.size());
    build(0, static_cast<std::int32_t>(order_.size()));
  }

  std::vector<TriangleTree::Node> nodes_;
  std::vector<std::int32_t> order() { return order_; }

 private:
  void build(std::int32_t first, std::int32_t count) {
    const std::size_t node = nodes_.size();
    nodes_.emplace_back();
    if (count <= leaf_size_) {
      nodes_[node].first = first;
      nodes_[node].count = count;
      return;
    }
    Aabb spread = empty_box();
    for (std::int32_t i = first; i < first + count; ++i) grow(spread, centroid(i));
    Eigen::Index axis = 0;
    (spread.max - spread.min).maxCoeff(&axis);
    const auto begin = order_.begin() + first;
    const auto middle = begin + count / 2;
    std::nth_element(begin, middle, begin + count, [&](std::int32_t a, std::int32_t b) {
      const double ca = centroid_[static_cast<std::size_t>(a)][axis];
      const double cb = centroid_[static_cast<std::size_t>(b)][axis];
      return ca < cb || (ca == cb && a < b);
    });
    build(first, count / 2);
    nodes_[node].right = static_cast<std::int32_t>(nodes_.size());
    build(first + count / 2, count - count / 2);
  }
  [[nodiscard]] const Vec3& centroid(std::int32_t i) const {
    return centroid_[static_cast<std::size_t>(order_[static_cast<std::size_t>(i)])];
  }

  int leaf_size_;
  std::vector<std::int32_t> order_;
  std::vector<Vec3> centroid_;
};

}  // namespace

TriangleTree::TriangleTree(const TriangleMesh& mesh, int leaf_size) {
  if (mesh.triangles.empty()) return;
  Builder builder(mesh, leaf_size);
  nodes_ = std::move(builder.nodes_);
  source_ = builder.order();
  corners_.reserve(source_.size());
  for (const std::int32_t t : source_) {
    const Triangle& triangle = mesh.triangles[static_cast<std::size_t>(t)];
    corners_.push_back({mesh.vertices[static_cast<std::size_t>(triangle[0])],
                        mesh.vertices[static_cast<std::size_t>(triangle[1])],
                        mesh.vertices[static_cast<std::size_t>(triangle[2])]});
  }
  refit();
}

void TriangleTree::refit() noexcept {
  // Children stand behind their parent, so that walking backwards meets them first.
  for (std::size_t i = nodes_.size(); i-- > 0;) {
    Node& node = nodes_[i];
    if (node.count > 0) {
      node.box = box_around(corners_, node.first, node.count);
    } else {
      const Aabb& left = nodes_[i + 1].box;
      const Aabb& right = nodes_[static_cast<std::size_t>(node.right)].box;
      node.box = {left.min.cwiseMin(right.min), left.max.cwiseMax(right.max)};
    }
  }
}

void TriangleTree::place(const TriangleTree& at_rest, const Pose& X) noexcept {
  for (std::size_t i = 0; i < corners_.size(); ++i) {
    for (std::size_t c = 0; c < 3; ++c) corners_[i][c] = X * at_rest.corners_[i][c];
  }
  refit();
}

}  // namespace phalanx

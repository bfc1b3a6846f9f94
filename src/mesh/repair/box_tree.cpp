// SPDX-License-Identifier: Apache-2.0
#include "mesh/repair/box_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace phalanx::mesh {
namespace {

constexpr float kInf = std::numeric_limits<float>::infinity();

float down(double x) noexcept {
  const auto f = static_cast<float>(x);
  return static_cast<double>(f) <= x ? f : std::nextafter(f, -kInf);
}
float up(double x) noexcept {
  const auto f = static_cast<float>(x);
  return static_cast<double>(f) >= x ? f : std::nextafter(f, kInf);
}

}  // namespace

FloatBox outward(const Vec3& min, const Vec3& max) noexcept {
  return {{down(min.x()), down(min.y()), down(min.z())}, {up(max.x()), up(max.y()), up(max.z())}};
}

FloatBox box_of(const TriangleMesh& mesh, std::size_t triangle, double wider) noexcept {
  const Triangle& t = mesh.triangles[triangle];
  const Vec3& a = mesh.vertices[static_cast<std::size_t>(t[0])];
  const Vec3& b = mesh.vertices[static_cast<std::size_t>(t[1])];
  const Vec3& c = mesh.vertices[static_cast<std::size_t>(t[2])];
  const Vec3 more = Vec3::Constant(wider);
  return outward(a.cwiseMin(b).cwiseMin(c) - more, a.cwiseMax(b).cwiseMax(c) + more);
}

BoxTree::BoxTree(std::vector<FloatBox> boxes) : boxes_(std::move(boxes)), items_(boxes_.size()) {
  if (boxes_.empty()) return;
  std::iota(items_.begin(), items_.end(), 0U);
  nodes_.reserve(boxes_.size());
  build(0, static_cast<std::uint32_t>(boxes_.size()));
}

void BoxTree::build(std::uint32_t first, std::uint32_t count) {
  const std::size_t at = nodes_.size();
  nodes_.emplace_back();
  FloatBox box = boxes_[items_[first]];
  for (std::uint32_t i = first; i < first + count; ++i) {
    const FloatBox& b = boxes_[items_[i]];
    for (std::size_t k = 0; k < 3; ++k) {
      box.min[k] = std::min(box.min[k], b.min[k]);
      box.max[k] = std::max(box.max[k], b.max[k]);
    }
  }
  nodes_[at].box = box;
  if (count <= kLeaf) {
    nodes_[at].first = first;
    nodes_[at].count = count;
    return;
  }
  std::size_t axis = 0;
  for (std::size_t k = 1; k < 3; ++k)
    if (box.max[k] - box.min[k] > box.max[axis] - box.min[axis]) axis = k;
  const auto middle_of = [&](std::uint32_t i) {
    return 0.5F * boxes_[i].min[axis] + 0.5F * boxes_[i].max[axis];
  };
  const auto begin = items_.begin() + first;
  std::nth_element(begin, begin + count / 2, begin + count, [&](std::uint32_t a, std::uint32_t b) {
    const float ca = middle_of(a);
    const float cb = middle_of(b);
    return ca < cb || (ca == cb && a < b);
  });
  build(first, count / 2);
  nodes_[at].first = static_cast<std::uint32_t>(nodes_.size());
  build(first + count / 2, count - count / 2);
}

BoxTree triangle_boxes(const TriangleMesh& mesh) {
  std::vector<FloatBox> boxes(mesh.triangles.size());
  for (std::size_t t = 0; t < boxes.size(); ++t) boxes[t] = box_of(mesh, t);
  return BoxTree(std::move(boxes));
}

}  // namespace phalanx::mesh

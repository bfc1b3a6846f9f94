// SPDX-License-Identifier: Apache-2.0
#include "grasp/object_shape.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

namespace phalanx {
namespace {

struct Corners3 {
  Vec3 a, b, c;
};
Corners3 corners_of(const TriangleMesh& mesh, const Triangle& t) {
  const auto at = [&](std::size_t k) { return mesh.vertices[static_cast<std::size_t>(t[k])]; };
  return {at(0), at(1), at(2)};
}

constexpr int kNormals = 24;  // as axes

}  // namespace

ObjectShape shape_of(const TriangleMesh& mesh) {
  ObjectShape shape;
  double area = 0.0;
  Vec3 first = Vec3::Zero();
  Mat3 second = Mat3::Zero();
  const Vec3 origin = mesh.vertices[static_cast<std::size_t>(mesh.triangles.front()[0])];
  for (const Triangle& t : mesh.triangles) {
    auto [a, b, c] = corners_of(mesh, t);
    a -= origin;
    b -= origin;
    c -= origin;
    const double twice = (b - a).cross(c - a).norm();
    const Vec3 sum = a + b + c;
    area += twice;
    first += twice / 3.0 * sum;
    second +=
        twice / 12.0 * (a * a.transpose() + b * b.transpose() + c * c.transpose() + sum * sum.transpose());
  }
  if (area > 0.0) {
    first /= area;
    second = second / area - first * first.transpose();
    const Eigen::SelfAdjointEigenSolver<Mat3> solver(second);
    for (int i = 0; i < 3; ++i) shape.axis[static_cast<std::size_t>(i)] = solver.eigenvectors().col(2 - i);
  }
  std::array<double, 3> low{};
  std::array<double, 3> high{};
  low.fill(std::numeric_limits<double>::infinity());
  high.fill(-std::numeric_limits<double>::infinity());
  for (const Triangle& t : mesh.triangles) {
    for (const std::int32_t v : t) {
      for (std::size_t i = 0; i < 3; ++i) {
        const double along = shape.axis[i].dot(mesh.vertices[static_cast<std::size_t>(v)]);
        low[i] = std::min(low[i], along);
        high[i] = std::max(high[i], along);
      }
    }
  }
  for (std::size_t i = 0; i < 3; ++i) {
    shape.centre += 0.5 * (low[i] + high[i]) * shape.axis[i];
    shape.half[i] = 0.5 * (high[i] - low[i]);
  }
  std::array<std::size_t, 3> order = {0, 1, 2};
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t i, std::size_t j) { return shape.half[i] > shape.half[j]; });
  const ObjectShape unsorted = shape;
  for (std::size_t i = 0; i < 3; ++i) {
    shape.axis[i] = unsorted.axis[order[i]];
    shape.half[i] = unsorted.half[order[i]];
  }
  shape.axis[2] = shape.axis[0].cross(shape.axis[1]);
  for (const Triangle& t : mesh.triangles)
    for (const std::int32_t v : t)
      shape.radius =
          std::max(shape.radius, (mesh.vertices[static_cast<std::size_t>(v)] - shape.centre).norm());
  Random random(kNormals);
  for (const SurfacePoint& point : surface_points(mesh, kNormals, random)) {
    double low_along = kInfinity;
    double high_along = -kInfinity;
    for (const Triangle& t : mesh.triangles)
      for (const std::int32_t v : t) {
        const double along = point.normal.dot(mesh.vertices[static_cast<std::size_t>(v)]);
        low_along = std::min(low_along, along);
        high_along = std::max(high_along, along);
      }
    if (point.normal.allFinite() && point.normal.norm() > 0.5)
      shape.normal.push_back({point.normal, 0.5 * (high_along - low_along)});
  }
  return shape;
}

std::vector<SurfacePoint> surface_points(const TriangleMesh& mesh, int count, Random& random) {
  std::vector<double> until;
  until.reserve(mesh.triangles.size());
  double area = 0.0;
  for (const Triangle& t : mesh.triangles) {
    const auto [a, b, c] = corners_of(mesh, t);
    area += (b - a).cross(c - a).norm();
    until.push_back(area);
  }
  std::vector<SurfacePoint> points;
  for (int i = 0; i < count; ++i) {
    const double at = area * random.uniform();
    const double u = std::sqrt(random.uniform());
    const double v = random.uniform();
    const auto it = std::upper_bound(until.begin(), until.end(), at);
    if (it == until.end()) continue;
    const auto [a, b, c] = corners_of(mesh, mesh.triangles[static_cast<std::size_t>(it - until.begin())]);
    points.push_back({(1.0 - u) * a + u * (1.0 - v) * b + u * v * c, (b - a).cross(c - a).normalized()});
  }
  return points;
}

}  // namespace phalanx

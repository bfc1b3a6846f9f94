// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>

#include "mesh/shapes/stitched_solid.h"

namespace phalanx::mesh {
namespace {

/// Returns where the increasing function f is 0 between a and b, to the last bit.
double bisect(double a, double b, const std::function<double(double)>& f) {
  for (;;) {
    const double middle = 0.5 * (a + b);
    if (!(middle > a && middle < b)) return middle;
    (f(middle) < 0.0 ? a : b) = middle;
  }
}

Eigen::Vector2d quarter_turns(const Eigen::Vector2d& c, int turns) {
  switch (turns & 3) {
    case 0:
      return c;
    case 1:
      return {0.0 - c.y(), c.x()};
    case 2:
      return {0.0 - c.x(), 0.0 - c.y()};
    default:
      return {c.y(), 0.0 - c.x()};
  }
}

}  // namespace

Eigen::Vector2d RevolvedSurface::section(double w) const {
  const double quarters = 4.0 * w;
  const double whole = std::floor(quarters);
  return quarter_turns(quarter(quarters - whole), static_cast<int>(whole));
}

Vec3 RevolvedSurface::point(double w, double t) const {
  const Eigen::Vector2d rz = profile(t);
  const Eigen::Vector2d c = section(w);
  return {rz.x() * c.x(), rz.x() * c.y(), rz.y()};
}

Eigen::Vector2d RevolvedSurface::locate_on_wall(const Vec3& p) const {
  // p is turned into the first quarter; then q is found with c(q) parallel to it.
  const Eigen::Vector2d xy = p.head<2>();
  int turns = 0;
  if (xy.x() <= 0.0 && xy.y() > 0.0) turns = 1;
  if (xy.x() < 0.0 && xy.y() <= 0.0) turns = 2;
  if (xy.x() >= 0.0 && xy.y() < 0.0) turns = 3;
  const Eigen::Vector2d d = quarter_turns(xy, 4 - turns);
  const double q = bisect(0.0, 1.0, [&](double s) {
    const Eigen::Vector2d c = quarter(s);
    return d.x() * c.y() - d.y() * c.x();
  });
  const double w = 0.25 * (turns + q);
  const double t0 = wall_begin;
  const double t1 = wall_end;
  const double sign = profile(t1).y() > profile(t0).y() ? 1.0 : -1.0;
  const double t = bisect(t0, t1, [&](double s) { return sign * (profile(s).y() - p.z()); });
  return {w > 0.5 ? w - 1.0 : w, t};
}

double RevolvedSurface::outside_wall(const Vec3& p) const {
  const Eigen::Vector2d wt = locate_on_wall(p);
  return p.head<2>().norm() - profile(wt.y()).x() * section(wt.x()).norm();
}

double arc_length(const std::function<Vec3(double)>& curve, double a, double b) {
  constexpr int kParts = 64;
  double length = 0.0;
  Vec3 last = curve(a);
  for (int i = 1; i <= kParts; ++i) {
    const Vec3 p = curve(a + (b - a) * i / kParts);
    length += (p - last).norm();
    last = p;
  }
  return length;
}

std::vector<double> equal_arcs(const std::function<Vec3(double)>& curve, double a, double b, int n) {
  const int parts = std::max(64, 4 * n);
  std::vector<double> length{0.0};
  Vec3 last = curve(a);
  for (int i = 1; i <= parts; ++i) {
    const Vec3 p = curve(a + (b - a) * i / parts);
    length.push_back(length.back() + (p - last).norm());
    last = p;
  }
  std::vector<double> parameters{a};
  std::size_t k = 1;
  for (int i = 1; i < n; ++i) {
    const double wanted = length.back() * i / n;
    while (k + 1 < length.size() && length[k] < wanted) ++k;
    const double within = (wanted - length[k - 1]) / (length[k] - length[k - 1]);
    parameters.push_back(a + (b - a) * (static_cast<double>(k - 1) + within) / parts);
  }
  parameters.push_back(b);
  return parameters;
}

}  // namespace phalanx::mesh

// SPDX-License-Identifier: Apache-2.0
#include "mesh/import/polygon_cut.h"

#include <cmath>
#include <limits>

namespace phalanx::mesh {
namespace {

using Point = Eigen::Vector2d;

/// Returns twice the signed area.
double area(const Point& a, const Point& b, const Point& c) noexcept {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

/// Projects the corners along the largest axis of the polygon's vector area, so that
/// it runs counter-clockwise.
std::vector<Point> flattened(const std::vector<Vec3>& corners) {
  Vec3 normal = Vec3::Zero();
  for (std::size_t i = 0; i < corners.size(); ++i)
    normal += (corners[i] - corners[0]).cross(corners[(i + 1) % corners.size()] - corners[0]);
  Eigen::Index drop = 0;
  normal.cwiseAbs().maxCoeff(&drop);
  const Eigen::Index u = (drop + 1) % 3;
  const Eigen::Index v = (drop + 2) % 3;
  const double turn = normal[drop] < 0.0 ? -1.0 : 1.0;
  std::vector<Point> points;
  points.reserve(corners.size());
  for (const Vec3& p : corners) points.emplace_back(turn * p[u], p[v]);
  return points;
}

class EarClipper {
 public:
  explicit EarClipper(const std::vector<Point>& points) : p_(points), n_(points.size()) {
    for (std::size_t i = 0; i < n_; ++i) {
      previous_.push_back((i + n_ - 1) % n_);
      next_.push_back((i + 1) % n_);
    }
    for (std::size_t i = 0; i < n_; ++i) {
      if (!(turn_at(i) > 0.0)) reflex_.push_back(i);
    }
  }

  std::vector<std::array<int, 3>> cut() {
    std::vector<std::array<int, 3>> triangles;
    std::size_t at = 0;
    std::size_t tried = 0;
    for (std::size_t left = n_; left > 3;) {
      std::size_t ear = at;
      if (tried == left) {
        ear = flattest(at);  // no ear is left: flat corners, or a polygon that crosses itself
      } else if (!is_ear(at)) {
        at = next_[at];
        ++tried;
        continue;
      }
      triangles.push_back(triangle(ear));
      next_[previous_[ear]] = next_[ear];
      previous_[next_[ear]] = previous_[ear];
      at = next_[next_[ear]];  // skips a corner, because a fan from one corner makes needles
      std::erase_if(reflex_, [&](std::size_t i) { return i == ear || turn_at(i) > 0.0; });
      tried = 0;
      --left;
    }
    triangles.push_back(triangle(at));
    return triangles;
  }

 private:
  [[nodiscard]] double turn_at(std::size_t i) const noexcept {
    return area(p_[previous_[i]], p_[i], p_[next_[i]]);
  }
  [[nodiscard]] std::array<int, 3> triangle(std::size_t i) const noexcept {
    return {static_cast<int>(previous_[i]), static_cast<int>(i), static_cast<int>(next_[i])};
  }

  /// @returns true if the corner turns left and its triangle contains no other corner that does not. Corners
  /// at the places of the triangle's own are twins of a bridge and do not count.
  [[nodiscard]] bool is_ear(std::size_t i) const noexcept {
    const Point& a = p_[previous_[i]];
    const Point& b = p_[i];
    const Point& c = p_[next_[i]];
    if (!(area(a, b, c) > 0.0)) return false;
    for (const std::size_t r : reflex_) {
      const Point& q = p_[r];
      if (q == a || q == b || q == c) continue;
      if (area(a, b, q) >= 0.0 && area(b, c, q) >= 0.0 && area(c, a, q) >= 0.0) return false;
    }
    return true;
  }

  [[nodiscard]] std::size_t flattest(std::size_t from) const noexcept {
    std::size_t best = from;
    double least = std::numeric_limits<double>::infinity();
    std::size_t i = from;
    do {
      if (const double turn = std::abs(turn_at(i)); turn < least) {
        least = turn;
        best = i;
      }
      i = next_[i];
    } while (i != from);
    return best;
  }

  const std::vector<Point>& p_;
  std::size_t n_;
  std::vector<std::size_t> previous_, next_;
  std::vector<std::size_t> reflex_;  ///< corners that do not turn left
};

}  // namespace

std::vector<std::array<int, 3>> cut_polygon(const std::vector<Vec3>& corners) {
  if (corners.size() == 3) return {{0, 1, 2}};
  const std::vector<Point> points = flattened(corners);
  if (corners.size() == 4) {
    const bool along =
        area(points[0], points[1], points[2]) > 0.0 && area(points[0], points[2], points[3]) > 0.0;
    if (along) return {{0, 1, 2}, {0, 2, 3}};
  }
  return EarClipper(points).cut();
}

}  // namespace phalanx::mesh

// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "mesh/shapes/spun_solid.h"

namespace phalanx::mesh {
namespace {

using RZ = Eigen::Vector2d;
constexpr double kQuarter = 0.5 * std::numbers::pi;

/// Returns `inner` with its ends replaced by the exact end points.
std::function<RZ(double)> exact_ends(const RZ& from, const RZ& to, std::function<RZ(double)> inner) {
  return [=, inner = std::move(inner)](double f) -> RZ {
    if (f == 0.0) return from;
    if (f == 1.0) return to;
    return inner(f);
  };
}

}  // namespace

SpunShape& SpunShape::add(ProfilePiece piece, double r, double z) {
  piece.lobes_from = depth_;
  piece.lobes_to = depth_;
  piece.rz = exact_ends(at_, {r, z}, std::move(piece.rz));
  pieces_.push_back(std::move(piece));
  at_ = {r, z};
  return *this;
}

SpunShape& SpunShape::line_to(double r, double z) {
  const RZ from = at_;
  // A coordinate that both ends share keeps its bits.
  return add(
      {.rz = [=](double f) { return RZ{from.x() + f * (r - from.x()), from.y() + f * (z - from.y())}; }}, r,
      z);
}

SpunShape& SpunShape::arc_along_r(double r, double z) {
  const RZ from = at_;
  return add({.rz =
                  [=](double f) {
                    return RZ{from.x() + (r - from.x()) * std::sin(kQuarter * f),
                              from.y() + (z - from.y()) * (1.0 - std::cos(kQuarter * f))};
                  },
              .turn = kQuarter},
             r, z);
}

SpunShape& SpunShape::arc_along_z(double r, double z) {
  const RZ from = at_;
  return add({.rz =
                  [=](double f) {
                    return RZ{from.x() + (r - from.x()) * (1.0 - std::cos(kQuarter * f)),
                              from.y() + (z - from.y()) * std::sin(kQuarter * f)};
                  },
              .turn = kQuarter},
             r, z);
}

SpunShape& SpunShape::wave_to(double r, double z) {
  const RZ from = at_;
  const double steepest = kQuarter * std::abs(r - from.x()) / std::abs(z - from.y());
  return add({.rz =
                  [=](double f) {
                    return RZ{from.x() + (r - from.x()) * 0.5 * (1.0 - std::cos(2.0 * kQuarter * f)),
                              from.y() + f * (z - from.y())};
                  },
              .turn = 2.0 * std::atan(steepest)},
             r, z);
}

SpunShape& SpunShape::dome_to(double z) {
  const RZ from = at_;
  const double steepest = kQuarter * std::abs(z - from.y()) / from.x();
  return add({.rz =
                  [=](double f) {
                    return RZ{from.x() * (1.0 - f),
                              from.y() + (z - from.y()) * 0.5 * (1.0 - std::cos(2.0 * kQuarter * f))};
                  },
              .turn = 2.0 * std::atan(steepest)},
             0.0, z);
}

SpunShape& SpunShape::lobes_to(double depth) {
  pieces_.back().lobes_to = depth;
  depth_ = depth;
  return *this;
}

bool SpunShape::has_lobes() const {
  return std::any_of(pieces_.begin(), pieces_.end(), [](const ProfilePiece& p) { return p.lobes_to > 0.0; });
}

Vec3 SpunShape::point(const Eigen::Vector2d& c, std::size_t piece, double f) const {
  const ProfilePiece& p = pieces_[piece];
  const RZ rz = p.rz(f);
  const double depth = p.lobes_from + f * (p.lobes_to - p.lobes_from);
  const double xy = c.x() * c.y();
  const double r = rz.x() * (1.0 - depth * 4.0 * xy * xy);  // (1 - cos 4a) / 2 = 4 cos^2 a sin^2 a
  return {r * c.x(), r * c.y(), rz.y()};
}

}  // namespace phalanx::mesh

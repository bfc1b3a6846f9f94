// SPDX-License-Identifier: Apache-2.0
// A solid around the z axis from a profile of lines and quarter arcs; its section is a circle or has four
// lobes. Internal to src/mesh and its tests.
#pragma once

#include <functional>
#include <vector>

#include "phalanx/mesh/triangle_mesh.h"

namespace phalanx::mesh {

/// One piece of the profile, (radius, z) over f in [0, 1]; both ends are met exactly.
struct ProfilePiece {
  std::function<Eigen::Vector2d(double f)> rz;
  double turn = 0.0;        ///< by how much the tangent turns along it, in total [rad]
  double lobes_from = 0.0;  ///< depth of the lobes at f = 0 [-]
  double lobes_to = 0.0;    ///< and at f = 1, linear in between
};

/// The profile runs from the lower pole on the axis to the upper one, with the outside to its right. A point
/// of the surface in the direction c = (cos a, sin a) is
///   (r k c, z),  k = 1 - depth (1 - cos 4a) / 2,
/// so lobes reach r at +-x and +-y and r (1 - depth) between them.
class SpunShape {
 public:
  explicit SpunShape(double lowest_z) : at_(0.0, lowest_z) {}

  SpunShape& line_to(double r, double z);
  /// A quarter of an ellipse with upright and level axes that leaves in the direction of r, or of z.
  SpunShape& arc_along_r(double r, double z);
  SpunShape& arc_along_z(double r, double z);
  /// Half a period of a cosine to the axis, level at both ends.
  SpunShape& dome_to(double z);
  /// Half a period of a cosine, upright at both ends.
  SpunShape& wave_to(double r, double z);
  /// The lobes' depth grows or shrinks to `depth` over the piece added last, and stays so for those that
  /// follow.
  SpunShape& lobes_to(double depth);

  [[nodiscard]] const std::vector<ProfilePiece>& pieces() const { return pieces_; }
  [[nodiscard]] bool has_lobes() const;
  [[nodiscard]] Vec3 point(const Eigen::Vector2d& c, std::size_t piece, double f) const;

 private:
  SpunShape& add(ProfilePiece piece, double r, double z);

  Eigen::Vector2d at_;  ///< where the profile has got to
  double depth_ = 0.0;
  std::vector<ProfilePiece> pieces_;
};

/// The grid whose triangle count is nearest to `triangles`. Where the count allows it, round parts are cut so
/// finely that neighbouring triangles meet at less than 30 degrees. Extents along x and y are twice the
/// largest radius exactly. `maker` names the object in messages.
[[nodiscard]] TriangleMesh make_spun_solid(const SpunShape& shape, int triangles, const char* maker);

}  // namespace phalanx::mesh

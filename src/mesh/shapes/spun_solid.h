// SPDX-License-Identifier: Apache-2.0
// Solid around the z axis from a profile of lines and quarter arcs. Its section is a circle or has four
// lobes. Internal to src/mesh and its tests.
#pragma once

#include <functional>
#include <vector>

#include "phalanx/mesh/triangle_mesh.h"

namespace phalanx::mesh {

/// One piece of the profile, (radius, z) over f in [0, 1], exact at both ends.
struct ProfilePiece {
  std::function<Eigen::Vector2d(double f)> rz;
  double turn = 0.0;        ///< total rotation of the tangent along it [rad]
  double lobes_from = 0.0;  ///< depth of the lobes at f = 0 [-]
  double lobes_to = 0.0;    ///< depth at f = 1, linear in between
};

/// Shape of a spun solid. The profile runs from the lower pole on the axis to the upper one, with the outside
/// to its right. A point of the surface in the direction c = (cos a, sin a) is
///   (r k c, z),  k = 1 - depth (1 - cos 4a) / 2.
/// So lobes reach r at +-x and +-y, and r (1 - depth) between them.
class SpunShape {
 public:
  explicit SpunShape(double lowest_z) : at_(0.0, lowest_z) {}

  SpunShape& line_to(double r, double z);
  /// Adds a quarter of an ellipse with vertical and horizontal axes, which starts in the direction of r,
  /// or of z.
  SpunShape& arc_along_r(double r, double z);
  SpunShape& arc_along_z(double r, double z);
  /// Adds half a period of a cosine to the axis, horizontal at both ends.
  SpunShape& dome_to(double z);
  /// Adds half a period of a cosine, vertical at both ends.
  SpunShape& wave_to(double r, double z);
  /// Changes the lobes' depth to `depth` over the last added piece. The depth then holds for
  /// the following pieces.
  SpunShape& lobes_to(double depth);

  [[nodiscard]] const std::vector<ProfilePiece>& pieces() const { return pieces_; }
  [[nodiscard]] bool has_lobes() const;
  [[nodiscard]] Vec3 point(const Eigen::Vector2d& c, std::size_t piece, double f) const;

 private:
  SpunShape& add(ProfilePiece piece, double r, double z);

  Eigen::Vector2d at_;  ///< end of the profile so far
  double depth_ = 0.0;
  std::vector<ProfilePiece> pieces_;
};

/// Makes the solid with the grid whose triangle count is nearest to `triangles`. If the count allows it,
/// neighbouring triangles of round parts meet at less than 30 degrees. Extents along x and y are exactly
/// twice the largest radius. `maker` names the object in messages.
[[nodiscard]] TriangleMesh make_spun_solid(const SpunShape& shape, int triangles, const char* maker);

}  // namespace phalanx::mesh

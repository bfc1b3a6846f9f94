// SPDX-License-Identifier: Apache-2.0
// The normals that an object offers at one contact, and the one among them that the force takes.
#pragma once

#include <array>
#include <cstddef>

#include "phalanx/contact/object_model.h"
#include "phalanx/contact/triangle_distance.h"

namespace phalanx {

/// The triangles of the object that tie for a contact, in the order in which they came. What runs over is
/// left out: so many tie only where a flat face is cut finely, and they all say the same.
class TiedTriangles {
 public:
  /// @param position  in the object's tree. Real-time: O(kMost).
  void add(int position) noexcept;
  [[nodiscard]] const int* begin() const noexcept { return position_.data(); }
  [[nodiscard]] const int* end() const noexcept { return position_.data() + count_; }

 private:
  static constexpr std::size_t kMost = 24;
  std::array<int, kMost> position_;
  std::size_t count_ = 0;
};

/// The mean direction of tied pairs. Neighbouring triangles see one place several times: near an edge the far
/// side's nearest point is the edge, and its direction leans back. So pairs whose points lie together count
/// by their weights, but in the direction of the nearest of them.
class MeanDirection {
 public:
  /// @param radius  points nearer to each other than this, on both bodies, are one place [m]
  explicit MeanDirection(double radius) noexcept : radius_squared_(radius * radius) {}
  /// Real-time: O(kMost).
  void add(const TriangleDistance& closest, const Vec3& direction, double weight) noexcept;
  /// Unit; where opposite directions cancel out, that of the nearest pair among the first kMost places.
  [[nodiscard]] Vec3 unit() const noexcept;

 private:
  struct Place {
    TriangleDistance nearest;
    Vec3 direction;
    double weight;
  };
  static constexpr std::size_t kMost = 32;
  double radius_squared_;
  std::array<Place, kMost> place_;
  std::size_t count_ = 0;
  Vec3 others_ = Vec3::Zero();  ///< of the places that run over: a flat touch, whose directions agree
  double others_weight_ = 0.0;
};

/// The convex cone of a few unit vectors.
class NormalFan {
 public:
  void add(const Vec3& unit) noexcept;
  /// The unit vector of the cone that is nearest to `n`; `n` itself if it lies in the cone or the fan is
  /// empty. Continuous in `n` and in the vectors. Real-time: O(count^3), count <= kMost.
  [[nodiscard]] Vec3 nearest(const Vec3& n) const noexcept;

 private:
  static constexpr std::size_t kMost = 12;
  std::array<Vec3, kMost> unit_;
  std::size_t count_ = 0;
};

/// The object's normal at a contact, on n_c's side: the direction nearest to n_c in the fan of
/// - the interpolated normals of the tied triangles, each at its point nearest to the contact, as far as that
/// is where the contact is (to
///   10 um). Inside a smooth surface they are one; at a crease they span what lies between its faces, and
///   n_c, turning from one face to the other as a finger goes over the edge, takes the normal with it;
/// - where the contact is on an open edge (SurfaceNormals::open_edges), the direction that points out of the
/// triangle across
///   that edge: a sheet's rim pushes a finger sideways.
/// @param contact  on the object, in W [m]
/// Real-time: no allocation, lock, throw or I/O.
[[nodiscard]] Vec3 normal_at_contact(const ObjectModel& object, const TiedTriangles& tied,
                                     const Vec3& contact, const Vec3& n_c) noexcept;

}  // namespace phalanx

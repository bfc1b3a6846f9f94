// SPDX-License-Identifier: Apache-2.0
// Normals of the object at one contact, and the choice of the force's normal among them.
#pragma once

#include <array>
#include <cstddef>

#include "phalanx/contact/object_model.h"
#include "phalanx/contact/triangle_distance.h"

namespace phalanx {

/// Distance from an edge below which a contact counts as partly on it [m]. Where n_c leans out over an edge,
/// the contact is on it to rounding.
inline constexpr double kEdgeBand = 10e-6;

/// Triangles of the object that tie for a contact, in order of arrival. Triangles beyond the capacity are
/// dropped: so many tie only on a finely cut flat face, where all have the same normal.
class TiedTriangles {
 public:
  /// Adds a triangle once. Real-time: O(kMost).
  /// @param position  slot in the object's tree
  void add(int position) noexcept;
  [[nodiscard]] const int* begin() const noexcept { return position_.data(); }
  [[nodiscard]] const int* end() const noexcept { return position_.data() + count_; }

 private:
  static constexpr std::size_t kMost = 24;
  std::array<int, kMost> position_;
  std::size_t count_ = 0;
};

/// Mean direction of tied pairs. Neighbouring triangles show one place several times. Near an edge the far
/// side's nearest point is the edge, and its direction leans back. So pairs whose points lie together add
/// their weights, but take the direction of the nearest of them.
class MeanDirection {
 public:
  /// @param radius  pairs whose points on both bodies are within this distance are one place [m]
  explicit MeanDirection(double radius) noexcept : radius_squared_(radius * radius) {}
  /// Adds a pair of triangles. Real-time: O(kMost).
  void add(const TriangleDistance& closest, const Vec3& direction, double weight) noexcept;
  /// Returns the mean as a unit vector. Where opposite directions cancel out, returns the direction of the
  /// nearest pair among the first kMost places.
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
  Vec3 others_ = Vec3::Zero();  ///< sum over places beyond kMost: a flat touch, whose directions agree
  double others_weight_ = 0.0;
};

/// Convex cone of a few unit vectors.
class NormalFan {
 public:
  /// Adds a vector, unless it is there already or the fan is full.
  void add(const Vec3& unit) noexcept;
  /// Returns the unit vector of the cone that is nearest to `n`. This is `n` itself if it lies in the cone or
  /// the fan is empty. Continuous in `n` and in the vectors. Real-time: O(count^3), count <= kMost.
  [[nodiscard]] Vec3 nearest(const Vec3& n) const noexcept;

 private:
  /// @returns true if vector i is clearly the cone's nearest to n: the plane across n's way from it separates the other
  /// vectors from n
  [[nodiscard]] bool is_nearest_vector(std::size_t i, const Vec3& n) const noexcept;

  static constexpr std::size_t kMost = 12;
  std::array<Vec3, kMost> unit_;
  std::size_t count_ = 0;
};

/// Returns the object's normal at a contact, on n_c's side: the direction nearest to n_c in the fan of
/// - the interpolated normals of the tied triangles, each at its point nearest to the contact. A triangle
///   counts to the extent that this point is at the contact (to 10 um). Inside a smooth surface these normals
///   agree. At a crease they span the directions between its faces. As a finger goes over the edge, n_c turns
///   from one face to the other, and the normal turns with it;
/// - where the contact is on an open edge (SurfaceNormals::open_edges), the direction in the triangle's plane
///   out across that edge. A sheet's rim thus pushes a finger sideways.
/// @param contact  point on the object, in W [m]
/// Real-time: no allocation, lock, throw or I/O.
[[nodiscard]] Vec3 normal_at_contact(const ObjectModel& object, const TiedTriangles& tied,
                                     const Vec3& contact, const Vec3& n_c) noexcept;

/// Returns n, turned towards n_c until it is within 30 degrees of it. See docs/architecture.md "The GDP,
/// exactly", Direction of the force.
[[nodiscard]] Vec3 within_cone(const Vec3& n, const Vec3& n_c) noexcept;

}  // namespace phalanx

// SPDX-License-Identifier: Apache-2.0
// Objects and hand segments made by the program: closed 2-manifold meshes with exact dimensions at any
// resolution, in metres, z up, without self-intersection or degenerate triangles. All are centred at the
// origin unless stated. Vertices lie on the named surface to rounding. `triangles`, 1 to 50,000,000, asks for
// about that many: each maker takes the grid that comes nearest and never less than a valid solid. All throw
// std::invalid_argument (maker, value, remedy) for a length that is not finite and above 0, a count out of
// range, or proportions that make no solid. Deterministic; set-up only.
#pragma once

#include "phalanx/mesh/triangle_mesh.h"

namespace phalanx {

/// Latitude-longitude sphere; every vertex lies on the sphere, all three extents are `diameter` exactly.
[[nodiscard]] TriangleMesh make_sphere(double diameter, int triangles);

/// Axis-aligned box of full edge lengths `size`.
[[nodiscard]] TriangleMesh make_box(const Vec3& size, int triangles);

/// Cylinder along z, from -length/2 to length/2; the caps are flat.
[[nodiscard]] TriangleMesh make_cylinder(double diameter, double length, int triangles);

/// Torus around z; `ring_diameter` is that of the tube's centre line. tube_diameter < ring_diameter.
[[nodiscard]] TriangleMesh make_torus(double ring_diameter, double tube_diameter, int triangles);

/// A hollow mug, open at the top (+z), its handle on the +x side; one closed surface of genus 1. Outer
/// diameter and height of the body [m], which is centred at the origin; wall, floor, fillets and handle
/// follow in proportion (src/mesh/mug_shape.h). Height from 0.5 to 3 diameters. From about 300 triangles.
[[nodiscard]] TriangleMesh make_mug(double diameter, double height, int triangles);

/// The Utah teapot from Newell's patches (M. E. Newell, PhD thesis, University of Utah, 1975), closed into
/// one solid of genus 1. Body, lid, handle and spout are Newell's surfaces; ours are the flat ring that
/// bridges the gap between lid and rim and the flat disc in the spout's mouth. It is a full solid, not a
/// vessel. Spout to +x; `length` is the full extent from handle to spout [m], the height is 0.4896 of it;
/// centred at the middle of its bounding box. From about 300 triangles.
[[nodiscard]] TriangleMesh make_teapot(double length, int triangles);

/// Tapered capsule along -z from the origin: spheres of radius_base at the origin and radius_tip at z =
/// -length, joined by the tangent cone. length > |radius_base - radius_tip|. Grid: `around` (>= 3) sides,
/// `cap_rings` (>= 1) rings a cap, `side_rings` (>= 1) bands along the side; 2 around (2 cap_rings +
/// side_rings - 1) triangles.
[[nodiscard]] TriangleMesh make_tapered_capsule(double length, double radius_base, double radius_tip,
                                                int around, int cap_rings, int side_rings);

/// An ellipse; full breadth along x and full thickness along y [m].
struct EllipticSection {
  double breadth;
  double thickness;
};

/// A rounded slab along -z from the origin: the section `base` at z = 0, `tip` at z = -length, straight in
/// between, each end closed by a half ellipsoid that bulges by half its section's thickness. Grid as
/// make_tapered_capsule().
[[nodiscard]] TriangleMesh make_rounded_slab(double length, EllipticSection base, EllipticSection tip,
                                             int around, int cap_rings, int side_rings);

}  // namespace phalanx

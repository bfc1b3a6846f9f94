// SPDX-License-Identifier: Apache-2.0
// Generated primitives and hand segments: closed 2-manifold meshes with exact dimensions at any resolution,
// in metres, z up, without self-intersection or degenerate triangles. All are centred at the origin unless
// stated. Vertices are on the named surface to rounding.
// `triangles`, 1 to 50,000,000, is the approximate count. Each maker uses the grid with the nearest count,
// but at least a valid solid. All throw std::invalid_argument (maker, value, remedy) if a length is not
// finite and above 0, or if a count or the proportions are out of range. Deterministic; set-up only.
#pragma once

#include "phalanx/mesh/triangle_mesh.h"

namespace phalanx {

/// Makes a latitude-longitude sphere. Every vertex is on the sphere, and all three extents are
/// exactly `diameter` [m].
[[nodiscard]] TriangleMesh make_sphere(double diameter, int triangles);

/// Makes an axis-aligned box with full edge lengths `size` [m].
[[nodiscard]] TriangleMesh make_box(const Vec3& size, int triangles);

/// Makes a cylinder along z, from -length/2 to length/2, with flat caps [m].
[[nodiscard]] TriangleMesh make_cylinder(double diameter, double length, int triangles);

/// Makes a torus around z [m]; `ring_diameter` is that of the tube's centre line.
/// tube_diameter < ring_diameter.
[[nodiscard]] TriangleMesh make_torus(double ring_diameter, double tube_diameter, int triangles);

/// Makes a hollow mug, open at the top (+z), its handle on the +x side: one closed surface of genus 1.
/// Diameter and height are the body's outer ones [m]; the body is centred at the origin. Wall, floor,
/// fillets and handle are in proportion. height from 0.5 to 3 diameters. From about 300 triangles.
[[nodiscard]] TriangleMesh make_mug(double diameter, double height, int triangles);

/// Makes the Utah teapot from Newell's patches (M. E. Newell, PhD thesis, University of Utah, 1975), closed
/// into one full solid of genus 1. Body, lid, handle and spout are Newell's surfaces. Ours are the flat ring
/// that bridges the gap between lid and rim, and the flat disc in the spout's mouth. The spout points to +x.
/// `length` is the full extent from handle to spout [m], and the height is 0.4896 of it. Centred at the
/// middle of its bounding box. From about 300 triangles.
[[nodiscard]] TriangleMesh make_teapot(double length, int triangles);

/// Makes a tapered capsule along -z from the origin [m]: spheres of radius_base at the origin and radius_tip
/// at z = -length, joined by the tangent cone. length > |radius_base - radius_tip|.
/// Its grid has `around` (>= 3) sides, `cap_rings` (>= 1) rings a cap and `side_rings` (>= 1) bands along the
/// side: 2 around (2 cap_rings + side_rings - 1) triangles.
[[nodiscard]] TriangleMesh make_tapered_capsule(double length, double radius_base, double radius_tip,
                                                int around, int cap_rings, int side_rings);

/// Ellipse with full breadth along x and full thickness along y [m].
struct EllipticSection {
  double breadth;
  double thickness;
};

/// Makes a rounded slab along -z from the origin [m]: the section `base` at z = 0, `tip` at z = -length,
/// straight in between. A half ellipsoid closes each end and bulges by half its section's thickness. The grid
/// is that of make_tapered_capsule().
[[nodiscard]] TriangleMesh make_rounded_slab(double length, EllipticSection base, EllipticSection tip,
                                             int around, int cap_rings, int side_rings);

}  // namespace phalanx

// SPDX-License-Identifier: Apache-2.0
// Objects of daily life and of hand therapy, made by the program. As the primitives: closed 2-manifold meshes
// in metres without self-intersection or degenerate triangles, z up, their bounding box centred at the
// origin, vertices on the named surface to rounding, the dimensions named here exact to rounding (1e-12 m),
// everything else in proportion (src/mesh/object_shapes.h). `triangles`, 1 to 50,000,000, asks for about that
// many; from the stated number on the count is met within 15 %, below it the coarsest valid solid comes out.
// Each also states from which count on it is round: from there neighbouring triangles of its round parts meet
// at less than 30 degrees, so that normals are interpolated over them, while edges stay edges. Counts hold
// for the default proportions of docs/scenes.md. All throw std::invalid_argument (maker, value, remedy) for a
// length that is not finite and above 0, a count out of range, or proportions out of the stated range.
// Deterministic; set-up only.
#pragma once

#include "phalanx/mesh/triangle_mesh.h"

namespace phalanx {

/// A full, capped bottle, the cap at +z: diameter of the body, `length` from the bottom to the cap's top [m].
/// Body, shoulder, neck and cap are round about z. length from 1.5 to 8 diameters. Genus 0.
/// From 300 triangles; round from 1,000.
[[nodiscard]] TriangleMesh make_bottle(double diameter, double length, int triangles);

/// A door key that lies flat: `length` along x from the bow's end to the tip of the blade (+x), `breadth` of
/// the bow, a disc with a round hole, along y, `thickness` along z [m]. Five cuts in the blade's -y edge.
/// length from 1.8 to 4 breadths, thickness from 0.02 to 0.3. Genus 1. From 500 triangles, round at all
/// counts.
[[nodiscard]] TriangleMesh make_key(double length, double breadth, double thickness, int triangles);

/// A pen along z, its tip at -z: diameter of the round barrel, `length` over all [m]. length from 4 to 40
/// diameters. Genus 0. From 300 triangles; round from 1,000.
[[nodiscard]] TriangleMesh make_pen(double diameter, double length, int triangles);

/// A hollow beaker without a handle, open at +z: diameter over the rim, which is its widest place, and height
/// `length` [m]; the wall runs straight to the bottom, 0.7 diameters wide before its edge is rounded. length
/// from 0.5 to 3 diameters. One closed surface of genus 0. From 500 triangles; round from 1,500.
[[nodiscard]] TriangleMesh make_cup(double diameter, double length, int triangles);

/// A ball for squeezing and massage: `diameter` over the tops of its 50 round bumps, `bump` the bumps' height
/// [m], 0 for a smooth ball, at most 0.15 diameters. Bumps at +-z, 12 around the equator (one at +x) and
/// around each latitude of 30 degrees, 6 around each of 60 degrees; every top is a vertex. Genus 0.
/// From 300 triangles; the bumps are pointed at low counts and round from 40,000.
[[nodiscard]] TriangleMesh make_therapy_ball(double diameter, double bump, int triangles);

/// A bar of therapy putty: full extents `size` [m] along x, y and z; edges and corners are rounded with 0.3
/// of the smallest. Ratio of the largest to the smallest at most 10. Genus 0. From 500 triangles, round at
/// all counts.
[[nodiscard]] TriangleMesh make_putty_bar(const Vec3& size, int triangles);

/// A peg of a pegboard along z: a dowel of `diameter` and `length` over all, its ends chamfered by 45
/// degrees; with `head_diameter` > 0 the upper 0.4 of its length is a thicker grip of that diameter [m].
/// length from 1 to 20 diameters, head_diameter 0 or from 1.2 to 6 diameters. Genus 0. From 300 triangles;
/// round from 300.
[[nodiscard]] TriangleMesh make_peg(double diameter, double length, double head_diameter, int triangles);

/// A jar with its lid screwed on, one full solid, the lid at +z: diameter of the body, `length` from bottom
/// to the lid's top, `lid_diameter` [m]. length from 0.7 to 5 diameters, lid_diameter from 0.5 to 1.05. Genus
/// 0. From 300 triangles; round from 1,000.
[[nodiscard]] TriangleMesh make_jar(double diameter, double length, double lid_diameter, int triangles);

/// The handle of a tap, a knob with four round lobes to +-x and +-y on a stem to -z: `diameter` over opposite
/// lobes, `length` along z with the stem [m]. length from 0.3 to 2 diameters. Genus 0. From 400 triangles;
/// round from 2,500.
[[nodiscard]] TriangleMesh make_tap_handle(double diameter, double length, int triangles);

}  // namespace phalanx

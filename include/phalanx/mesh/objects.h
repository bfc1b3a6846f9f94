// SPDX-License-Identifier: Apache-2.0
// Generated objects of daily life and of hand therapy. As the primitives they are closed 2-manifold meshes in
// metres, z up, without self-intersection or degenerate triangles. Their bounding box is centred at the
// origin. Vertices are on the named surface to rounding. The named dimensions are exact to 1e-12 m; all
// others are in proportion to them.
// `triangles`, 1 to 50,000,000, is the approximate count. From the stated number on it is met within 15 %;
// below that the result is the coarsest valid solid. "Round from" states the count from which neighbouring
// triangles of round parts meet at less than 30 degrees. Then normals are interpolated over them, while edges
// stay edges. These counts hold for the default proportions of docs/scenes.md.
// All throw std::invalid_argument (maker, value, remedy) if a length is not finite and above 0, or if a count
// or proportion is out of range. Deterministic; set-up only.
#pragma once

#include "phalanx/mesh/triangle_mesh.h"

namespace phalanx {

/// Makes a full, capped bottle, the cap at +z: diameter of the body, `length` from the bottom to the cap's
/// top [m]. Body, shoulder, neck and cap are round about z. length from 1.5 to 8 diameters. Genus 0. From 300
/// triangles; round from 1,000.
[[nodiscard]] TriangleMesh make_bottle(double diameter, double length, int triangles);

/// Makes a door key that lies flat [m]: `length` along x from the bow's end to the tip of the blade (+x),
/// `breadth` of the bow along y, `thickness` along z. The bow is a disc with a round hole. The blade's -y
/// edge has five cuts. length from 1.8 to 4 breadths, thickness from 0.02 to 0.3 breadths. Genus 1. From 500
/// triangles, round at all counts.
[[nodiscard]] TriangleMesh make_key(double length, double breadth, double thickness, int triangles);

/// Makes a pen along z, its tip at -z [m]: diameter of the round barrel, `length` over all. length from 4 to
/// 40 diameters. Genus 0. From 300 triangles; round from 1,000.
[[nodiscard]] TriangleMesh make_pen(double diameter, double length, int triangles);

/// Makes a hollow beaker without a handle, open at +z [m]: diameter over the rim, which is its widest
/// place, and height `length`. The wall is straight down to the bottom, which is 0.7 diameters wide before
/// its edge is rounded. length from 0.5 to 3 diameters. One closed surface of genus 0. From 500 triangles;
/// round from 1,500.
[[nodiscard]] TriangleMesh make_cup(double diameter, double length, int triangles);

/// Makes a ball for squeezing and massage [m]: `diameter` over the tops of its 50 round bumps, and `bump`,
/// the bumps' height. A bump of 0 gives a smooth ball; it is at most 0.15 diameters. There are bumps at +-z,
/// 12 around the equator (one at +x) and around each latitude of 30 degrees, and 6 around each latitude of
/// 60 degrees. Each top is a vertex. Genus 0. From 300 triangles; the bumps are pointed at low counts and
/// round from 40,000.
[[nodiscard]] TriangleMesh make_therapy_ball(double diameter, double bump, int triangles);

/// Makes a bar of therapy putty: full extents `size` [m] along x, y and z. Edges and corners are rounded with
/// 0.3 of the smallest extent. The ratio of the largest to the smallest extent is at most 10. Genus 0. From
/// 500 triangles, round at all counts.
[[nodiscard]] TriangleMesh make_putty_bar(const Vec3& size, int triangles);

/// Makes a peg of a pegboard along z [m]: a dowel of `diameter` and `length` over all, its ends chamfered by
/// 45 degrees. With `head_diameter` > 0 the upper 0.4 of its length is a thicker grip of that diameter.
/// length from 1 to 20 diameters, head_diameter 0 or from 1.2 to 6 diameters. Genus 0. From 300 triangles,
/// round at all these counts.
[[nodiscard]] TriangleMesh make_peg(double diameter, double length, double head_diameter, int triangles);

/// Makes a jar with its lid screwed on, one full solid, the lid at +z [m]: diameter of the body, `length`
/// from the bottom to the lid's top, and `lid_diameter`. length from 0.7 to 5 diameters, lid_diameter from
/// 0.5 to 1.05 diameters. Genus 0. From 300 triangles; round from 1,000.
[[nodiscard]] TriangleMesh make_jar(double diameter, double length, double lid_diameter, int triangles);

/// Makes the handle of a tap [m]: a knob with four round lobes at +-x and +-y, on a stem at -z. `diameter` is
/// over opposite lobes, `length` along z with the stem. length from 0.3 to 2 diameters. Genus 0. From 400
/// triangles; round from 2,500.
[[nodiscard]] TriangleMesh make_tap_handle(double diameter, double length, int triangles);

}  // namespace phalanx

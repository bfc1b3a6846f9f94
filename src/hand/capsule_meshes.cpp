// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "phalanx/hand/hand_meshes.h"
#include "phalanx/hand/hand_model.h"
#include "phalanx/mesh/primitives.h"

namespace phalanx {
namespace {

/// Grid of a capsule, of 2 around (2 cap_rings + side_rings - 1) triangles.
struct Grid {
  int around;
  int cap_rings;
  int side_rings;
  [[nodiscard]] int triangles() const noexcept { return 2 * around * (2 * cap_rings + side_rings - 1); }
};

/// Returns the grid whose count is nearest to `triangles` among those of good proportions (about 10 sides
/// to 7 rings).
Grid grid_for(int triangles) {
  Grid best{6, 2, 1};
  double best_cost = std::numeric_limits<double>::infinity();
  const int widest = 8 + static_cast<int>(2.0 * std::sqrt(static_cast<double>(triangles)));
  for (int around = 6; around <= widest; ++around) {
    for (int cap = 2; cap <= widest; ++cap) {
      // A phalanx's side is about as long as a cap's arc: this gives bands of nearly equal height.
      const int side = std::max(1, cap - 1);
      const Grid grid{around, cap, side};
      const double rings = grid.triangles() / (2.0 * around);
      const double cost = std::abs(grid.triangles() - triangles) / static_cast<double>(triangles) +
                          0.05 * std::abs(std::log(around / (rings * 10.0 / 7.0)));
      if (cost < best_cost) {
        best_cost = cost;
        best = grid;
      }
    }
  }
  return best;
}

}  // namespace

SegmentMeshes make_capsule_meshes(const HandParameters& parameters, Handedness handedness, int triangles) {
  if (triangles < 800 || triangles > 2'000'000) {
    throw std::invalid_argument("hand '" + parameters.name + "': " + std::to_string(triangles) +
                                " triangles asked for; choose between 800 and 2000000");
  }
  const Grid grid = grid_for(triangles / kSegments);
  SegmentMeshes meshes;
  for (std::size_t s = 0; s + 1 < kSegments; ++s) {
    const SegmentShape& shape = parameters.segments[s];
    meshes[s] = make_tapered_capsule(shape.length, shape.radius_base, shape.radius_tip, grid.around,
                                     grid.cap_rings, grid.side_rings);
  }
  // The palm gets the triangles that the fifteen other segments leave.
  const Grid palm_grid = grid_for(triangles - (kSegments - 1) * grid.triangles());
  const PalmShape& palm = parameters.palm;
  append(meshes[kPalm],
         make_rounded_slab(palm.length, {palm.wrist_breadth, palm.wrist_thickness},
                           {palm.knuckle_breadth, palm.knuckle_thickness}, palm_grid.around,
                           palm_grid.cap_rings, palm_grid.side_rings),
         Pose{Mat3::Identity(), palm.offset});
  if (handedness == Handedness::kLeft) mirror(meshes);
  return meshes;
}

HandModel make_hand_model(const HandParameters& parameters, Handedness handedness, const Pose& X_WH,
                          int triangles) {
  return HandModel(parameters, handedness, X_WH, make_capsule_meshes(parameters, handedness, triangles));
}

}  // namespace phalanx

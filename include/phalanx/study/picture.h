// SPDX-License-Identifier: Apache-2.0
// A rendered image of one tick: the shown hand, the measured hand as a ghost, the object, and the forces.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "phalanx/hand/hand_model.h"
#include "phalanx/mesh/triangle_mesh.h"
#include "phalanx/step/snapshot.h"

namespace phalanx {

/// 8-bit sRGB, rows from top to bottom, three bytes a pixel.
struct Image {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgb;
};

struct PictureOptions {
  int width = 1280;
  int height = 960;
  int samples = 5;  ///< per pixel and direction: samples * samples rays a pixel
  double full_force =
      0.0;  ///< force at the hot end of the colour scale [N]; 0: the largest in the snapshot, rounded up
  bool force_scale = true;  ///< draw the scale at the left edge, where there is a force
};

/// Ray-traced on the CPU, no display or GPU: the GDP hand tinted by the force on each segment, the HCP hand
/// as a translucent ghost where it differs, contact points with force arrows (drawn through what hides them),
/// a colour scale. The meshes are drawn with their edges rounded by their own normals. The camera is the one,
/// of a fixed set around the scene, that sees most of the contacts. World z is up. Same input and options,
/// same pixels, for any number of threads.
/// @param hand    what is drawn of each segment, in its frame; the poses come from `snapshot`
/// @param object  in world frame [m]; may be empty
/// @throws std::invalid_argument for a size below 16 or above 16384 pixels, or samples outside 1..32;
/// std::runtime_error if
///         the ray tracer cannot start.
[[nodiscard]] Image render_picture(const SegmentMeshes& hand, const TriangleMesh& object,
                                   const Snapshot& snapshot, const PictureOptions& options = {});

/// @throws std::runtime_error naming the file if it cannot be written.
void write_png(const Image& image, const std::filesystem::path& file);

}  // namespace phalanx

// SPDX-License-Identifier: Apache-2.0
// A ray-traced image of one tick: the displayed hand, the measured hand as a ghost, the object,
// and the forces.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <variant>
#include <vector>

#include "phalanx/hand/hand_model.h"
#include "phalanx/hand/hand_skin.h"
#include "phalanx/mesh/triangle_mesh.h"
#include "phalanx/scene/hand_meshes.h"
#include "phalanx/step/snapshot.h"

namespace phalanx {

/// The hand's drawn surface: its segments, each in its frame, or its continuous skin.
using DrawnHand = std::variant<SegmentMeshes, HandSkin>;

/// @returns the hand that the cockpit draws: its skin, or its display meshes if it has none.
/// @param hand  from load_hand() with HandDetail::kDrawn or kAll
[[nodiscard]] DrawnHand drawn_hand(LoadedHand hand);

/// Image in 8-bit sRGB, rows from top to bottom, three bytes a pixel.
struct Image {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgb;
};

/// Options of a picture.
struct PictureOptions {
  int width = 1280;
  int height = 960;
  int samples = 5;  ///< per pixel and direction: samples * samples rays a pixel
  double full_force =
      0.0;  ///< force at the upper end of the colour scale [N]; 0: the largest in the snapshot, rounded up
  bool force_scale = true;  ///< draws the scale at the left edge if there is a force
  /// Direction in which the camera looks, in W, of any length and not vertical; none: the best of a fixed set.
  std::optional<Vec3> view = std::nullopt;
};

/// Ray-traces a picture on the CPU, without a display or GPU. It shows the displayed hand (GDP, graphic
/// display position), tinted by the force on each segment. The measured hand (HCP, haptic device controlled
/// position) is a translucent ghost where it differs. Contact points have force arrows, drawn through what
/// hides them, and a colour scale. The meshes' edges are rounded by their own normals. Unless `options` state
/// the view, the camera is the one, of a fixed set around the scene, that sees most of the contacts. World z is
/// up. Equal input and options give equal pixels, for any number of threads.
/// @param hand    the poses come from `snapshot`
/// @param object  in world frame [m]; may be empty
/// @throws std::invalid_argument for a size below 16 or above 16384 pixels, samples outside 1..32,
/// or a view that is vertical, zero or not finite
/// @throws std::runtime_error if the ray tracer cannot start
[[nodiscard]] Image render_picture(const DrawnHand& hand, const TriangleMesh& object,
                                   const Snapshot& snapshot, const PictureOptions& options = {});

/// Writes a PNG file.
/// @throws std::runtime_error naming the file if it cannot be written.
void write_png(const Image& image, const std::filesystem::path& file);

}  // namespace phalanx

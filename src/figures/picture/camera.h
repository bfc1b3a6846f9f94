// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "figures/picture/ray_scene.h"

namespace phalanx::picture {

/// A pinhole camera. Image coordinates: x to the right, y down, in pixels.
struct Camera {
  Vec3f eye;
  Vec3f right, up, forward;  ///< unit vectors
  float focal;               ///< [pixels]
  float centre_x, centre_y;  ///< [pixels]

  [[nodiscard]] Ray ray(float x, float y) const {
    return {.origin = eye,
            .direction =
                (forward + ((x - centre_x) / focal) * right - ((y - centre_y) / focal) * up).normalized()};
  }
  /// @returns the image coordinates of a point. @pre the point is in front of the camera
  [[nodiscard]] Eigen::Vector2f project(const Vec3f& p) const {
    const Vec3f d = p - eye;
    const float scale = focal / d.dot(forward);
    return {centre_x + scale * d.dot(right), centre_y - scale * d.dot(up)};
  }
};

/// A contact that the camera should show.
struct Sight {
  Vec3f point;
  Vec3f normal;
  float weight;
};

/// Makes a camera that looks along `forward`, at the least distance at which all vertices fit the image.
/// @param forward  unit vector, not vertical
[[nodiscard]] Camera camera_along(const Vec3f& forward, const std::vector<const RenderMesh*>& meshes,
                                  int width, int height);

/// Chooses a camera from 48 azimuths x 4 elevations, each at the least distance at which everything fits the
/// image. The best one shows most of the contacts, with their forces across the image. It shows much of the
/// fingers and of the object, little of the palm, and the object's long side and its ends. It looks at the
/// hand from the thumb's side, where thumb and fingers are best seen.
/// @param scene       hand and object; parts as in RenderMesh: segment numbers, then the object
/// @param also        further meshes that have to fit
/// @param thumb_side  unit vector across the palm, from the little finger to the thumb
[[nodiscard]] Camera choose_camera(const RayScene& scene, const std::vector<const RenderMesh*>& also,
                                   const std::vector<Sight>& contacts, const Vec3f& thumb_side, int width,
                                   int height);

}  // namespace phalanx::picture

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "study/picture/ray_scene.h"

namespace phalanx::picture {

/// A pinhole camera. Image coordinates: x to the right, y down, in pixels.
struct Camera {
  Vec3f eye;
  Vec3f right, up, forward;  ///< unit
  float focal;               ///< [pixels]
  float centre_x, centre_y;  ///< [pixels]

  [[nodiscard]] Ray ray(float x, float y) const {
    return {.origin = eye,
            .direction =
                (forward + ((x - centre_x) / focal) * right - ((y - centre_y) / focal) * up).normalized()};
  }
  /// @pre the point is in front of the camera
  [[nodiscard]] Eigen::Vector2f project(const Vec3f& p) const {
    const Vec3f d = p - eye;
    const float scale = focal / d.dot(forward);
    return {centre_x + scale * d.dot(right), centre_y - scale * d.dot(up)};
  }
};

/// What the camera should show.
struct Sight {
  Vec3f point;
  Vec3f normal;
  float weight;
};

/// Of 48 azimuths x 4 elevations, each as near as lets everything fit the image, the one that best shows what
/// happens: most of the contacts, with their forces across the image; much of the fingers and of the object,
/// little of the palm; the object's long side and its ends; and the hand from the thumb's side, where thumb
/// and fingers stand out.
/// @param scene       hand and object; parts as in RenderMesh: segment numbers, then the object
/// @param also        what else has to fit
/// @param thumb_side  unit vector across the palm, from the little finger to the thumb
[[nodiscard]] Camera choose_camera(const RayScene& scene, const std::vector<const RenderMesh*>& also,
                                   const std::vector<Sight>& contacts, const Vec3f& thumb_side, int width,
                                   int height);

}  // namespace phalanx::picture

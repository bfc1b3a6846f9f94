// SPDX-License-Identifier: Apache-2.0
#include "study/picture/camera.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "phalanx/hand/joints.h"

namespace phalanx::picture {
namespace {

constexpr float kDeg = std::numbers::pi_v<float> / 180.0F;
constexpr float kFieldOfView = 19.0F * kDeg;  // vertical; long enough a lens to keep proportions
constexpr float kFill = 0.86F;                // share of the image that the scene fills

/// A camera that looks along `forward` and just holds all vertices.
Camera fitted(const std::vector<const RenderMesh*>& meshes, const Vec3f& forward, int width, int height) {
  Camera camera;
  camera.forward = forward;
  camera.right = forward.cross(Vec3f::UnitZ()).normalized();
  camera.up = camera.right.cross(forward);
  camera.focal = 0.5F * static_cast<float>(height) / std::tan(0.5F * kFieldOfView);
  camera.centre_x = 0.5F * static_cast<float>(width);
  camera.centre_y = 0.5F * static_cast<float>(height);
  // In the camera's axes a vertex (x, y, z) is inside if |x - ex| <= tx (z - ez): the nearest apex for each
  // pair of planes.
  const float tx = kFill * camera.centre_x / camera.focal;
  const float ty = kFill * camera.centre_y / camera.focal;
  float x_high = -1e9F, x_low = -1e9F, y_high = -1e9F, y_low = -1e9F;
  for (const RenderMesh* mesh : meshes) {
    for (const Vec3f& v : mesh->vertices) {
      const float x = v.dot(camera.right), y = v.dot(camera.up), z = v.dot(forward);
      x_high = std::max(x_high, x - tx * z);
      x_low = std::max(x_low, -x - tx * z);
      y_high = std::max(y_high, y - ty * z);
      y_low = std::max(y_low, -y - ty * z);
    }
  }
  const float ex = 0.5F * (x_high - x_low);
  const float ey = 0.5F * (y_high - y_low);
  const float ez = std::min(-0.5F * (x_high + x_low) / tx, -0.5F * (y_high + y_low) / ty);
  camera.eye = ex * camera.right + ey * camera.up + ez * forward;
  return camera;
}

float score(const RayScene& scene, const Camera& camera, const std::vector<Sight>& contacts, int width,
            int height, float elevation) {
  float seen = 0.0F, weight = 0.0F;
  for (const Sight& contact : contacts) {
    const Vec3f to_point = contact.point - camera.eye;
    const float distance = to_point.norm();
    const Vec3f direction = to_point / distance;
    const auto hit = scene.closest({.origin = camera.eye, .direction = direction});
    // The finger itself lies over its contact: what hides the point may be as thick as a finger, no more.
    const float clearance = hit ? std::max(0.0F, distance - hit->distance) : 0.0F;
    const float visible = std::clamp(1.0F - (clearance - 0.010F) / 0.015F, 0.0F, 1.0F);
    const float along = direction.dot(contact.normal);
    seen += contact.weight * visible * (1.0F - 0.7F * along * along);
    weight += contact.weight;
  }
  constexpr int kColumns = 40, kRows = 30;
  int fingers = 0, palm = 0, object = 0;
  for (int j = 0; j < kRows; ++j) {
    for (int i = 0; i < kColumns; ++i) {
      const auto hit =
          scene.closest(camera.ray((static_cast<float>(i) + 0.5F) * static_cast<float>(width) / kColumns,
                                   (static_cast<float>(j) + 0.5F) * static_cast<float>(height) / kRows));
      if (hit) ++(hit->part >= kSegments ? object : hit->part == kPalm ? palm : fingers);
    }
  }
  const auto share = [](int count) { return std::sqrt(static_cast<float>(count) / (kColumns * kRows)); };
  const float tilt = (elevation - 25.0F) / 60.0F;
  return (weight > 0.0F ? 2.5F * seen / weight : 0.0F) + share(fingers) + share(object) - 0.5F * share(palm) -
         0.5F * tilt * tilt;
}

}  // namespace

Camera choose_camera(const RayScene& scene, const std::vector<const RenderMesh*>& also,
                     const std::vector<Sight>& contacts, int width, int height) {
  std::vector<const RenderMesh*> all = also;
  all.push_back(&scene.mesh());
  Camera best{};
  float best_score = -1e9F;
  for (const float elevation : {12.0F, 25.0F, 40.0F, 55.0F}) {
    for (int i = 0; i < 24; ++i) {
      const float azimuth = static_cast<float>(i) * 15.0F * kDeg;
      const Vec3f forward(-std::cos(elevation * kDeg) * std::cos(azimuth),
                          -std::cos(elevation * kDeg) * std::sin(azimuth), -std::sin(elevation * kDeg));
      const Camera camera = fitted(all, forward, width, height);
      const float value = score(scene, camera, contacts, width, height, elevation);
      if (value > best_score) {
        best_score = value;
        best = camera;
      }
    }
  }
  return best;
}

}  // namespace phalanx::picture

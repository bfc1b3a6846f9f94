// SPDX-License-Identifier: Apache-2.0
#include "figures/picture/camera.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "phalanx/hand/joints.h"

namespace phalanx::picture {
namespace {

constexpr float kDegree = std::numbers::pi_v<float> / 180.0F;
constexpr float kFieldOfView = 19.0F * kDegree;  // vertical; a long focal length keeps proportions
constexpr float kSceneLeft = 0.10F,
                kSceneRight = 0.95F;  // part of the width for the scene: the force scale is left of it
constexpr float kFill = 0.86F;        // part of the height for the scene

/// @returns the weighted part of the contacts that the camera sees, from 0 to 1. A force towards or away from
/// the camera has less weight.
float contacts_seen(const RayScene& scene, const Camera& camera, const std::vector<Sight>& contacts) {
  float seen = 0.0F, weight = 0.0F;
  for (const Sight& contact : contacts) {
    const Vec3f to_point = contact.point - camera.eye;
    const float distance = to_point.norm();
    const Vec3f direction = to_point / distance;
    const auto hit = scene.closest({.origin = camera.eye, .direction = direction});
    // The finger itself covers its contact: what hides the point may be as thick as a finger,
    // but not thicker.
    const float clearance = hit ? std::max(0.0F, distance - hit->distance) : 0.0F;
    const float visible = std::clamp(1.0F - (clearance - 0.010F) / 0.015F, 0.0F, 1.0F);
    const float along = direction.dot(contact.normal);
    seen += contact.weight * visible * (1.0F - along * along);
    weight += contact.weight;
  }
  return weight > 0.0F ? seen / weight : 0.0F;
}

/// Finds points at the object's ends, where its handles and spouts are. These are vertices at four fifths of
/// the largest distance from the centre or farther, thinned out.
std::vector<Vec3f> object_ends(const RenderMesh& mesh) {
  constexpr std::size_t kMost = 96;
  std::vector<Vec3f> points;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    if (mesh.part[t] >= kSegments) points.push_back(mesh.vertices[mesh.triangles[t][0]]);
  if (points.empty()) return points;
  Eigen::AlignedBox3f box;
  for (const Vec3f& p : points) box.extend(p);
  float largest = 0.0F;
  for (const Vec3f& p : points) largest = std::max(largest, (p - box.center()).norm());
  std::erase_if(points, [&](const Vec3f& p) { return (p - box.center()).norm() < 0.8F * largest; });
  const std::size_t stride = (points.size() + kMost - 1) / kMost;
  std::vector<Vec3f> thinned;
  for (std::size_t i = 0; i < points.size(); i += stride) thinned.push_back(points[i]);
  return thinned;
}

/// @returns the part of the points that the camera sees, or that less than a few millimetres of
/// the object hide.
float share_seen(const RayScene& scene, const Camera& camera, const std::vector<Vec3f>& points) {
  if (points.empty()) return 0.0F;
  int seen = 0;
  for (const Vec3f& point : points) {
    const float distance = (point - camera.eye).norm();
    const auto hit = scene.closest({.origin = camera.eye, .direction = (point - camera.eye) / distance});
    if (!hit || (hit->part >= kSegments && distance - hit->distance < 0.008F)) ++seen;
  }
  return static_cast<float>(seen) / static_cast<float>(points.size());
}

/// Parts of the image: square roots of the areas, and the spread of the object's visible pixels from left to
/// right (standard deviation over the image's width). A long object seen end-on is hard to recognise.
struct Shown {
  float fingers, palm, object, object_spread;
};
Shown shown(const RayScene& scene, const Camera& camera, int width, int height) {
  constexpr int kColumns = 40, kRows = 30;
  int fingers = 0, palm = 0, object = 0;
  float sum = 0.0F, squares = 0.0F;
  for (int j = 0; j < kRows; ++j) {
    for (int i = 0; i < kColumns; ++i) {
      const float x = (static_cast<float>(i) + 0.5F) / kColumns;
      const float y = (static_cast<float>(j) + 0.5F) / kRows;
      const auto hit =
          scene.closest(camera.ray(x * static_cast<float>(width), y * static_cast<float>(height)));
      if (!hit) continue;
      ++(hit->part >= kSegments ? object : hit->part == kPalm ? palm : fingers);
      if (hit->part < kSegments) continue;
      sum += x;
      squares += x * x;
    }
  }
  const auto share = [](int count) { return std::sqrt(static_cast<float>(count) / (kColumns * kRows)); };
  const float n = static_cast<float>(std::max(object, 1));
  return {.fingers = share(fingers),
          .palm = share(palm),
          .object = share(object),
          .object_spread = std::sqrt(std::max(0.0F, squares / n - (sum / n) * (sum / n)))};
}

}  // namespace

Camera camera_along(const Vec3f& forward, const std::vector<const RenderMesh*>& meshes, int width,
                    int height) {
  Camera camera;
  camera.forward = forward;
  camera.right = forward.cross(Vec3f::UnitZ()).normalized();
  camera.up = camera.right.cross(forward);
  camera.focal = 0.5F * static_cast<float>(height) / std::tan(0.5F * kFieldOfView);
  camera.centre_x = 0.5F * (kSceneLeft + kSceneRight) * static_cast<float>(width);
  camera.centre_y = 0.5F * static_cast<float>(height);
  // In the camera's axes, a vertex (x, y, z) is inside if |x - ex| <= tx (z - ez). For each pair of planes,
  // this finds the nearest apex.
  const float tx = 0.5F * (kSceneRight - kSceneLeft) * static_cast<float>(width) / camera.focal;
  const float ty = 0.5F * kFill * static_cast<float>(height) / camera.focal;
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

Camera choose_camera(const RayScene& scene, const std::vector<const RenderMesh*>& also,
                     const std::vector<Sight>& contacts, const Vec3f& thumb_side, int width, int height) {
  std::vector<const RenderMesh*> all = also;
  all.push_back(&scene.mesh());
  const std::vector<Vec3f> ends = object_ends(scene.mesh());
  Camera best{};
  float best_score = -1e9F;
  for (const float elevation : {17.0F, 26.0F, 38.0F, 52.0F}) {
    for (int i = 0; i < 48; ++i) {
      const float azimuth = static_cast<float>(i) * 7.5F * kDegree;
      const Vec3f forward(-std::cos(elevation * kDegree) * std::cos(azimuth),
                          -std::cos(elevation * kDegree) * std::sin(azimuth), -std::sin(elevation * kDegree));
      const Camera camera = camera_along(forward, all, width, height);
      const Shown image = shown(scene, camera, width, height);
      const float tilt = (elevation - 20.0F) / 60.0F;
      const float value = contacts_seen(scene, camera, contacts) + 2.0F * share_seen(scene, camera, ends) +
                          image.fingers + image.object - 0.5F * image.palm + 4.0F * image.object_spread -
                          forward.dot(thumb_side) - 4.0F * tilt * tilt;
      if (value > best_score) {
        best_score = value;
        best = camera;
      }
    }
  }
  return best;
}

}  // namespace phalanx::picture

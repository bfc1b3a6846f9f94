// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <utility>

#include "c_api/objects.h"
#include "c_api/poses.h"
#include "phalanx/core/index.h"
#include "phalanx/hand/fit.h"
#include "phalanx/scene/build_model.h"
#include "phalanx/scene/resolved_scene.h"

namespace phalanx::c_api {
namespace {

constexpr int kHandTriangles = 2250;

bool same_meshes(const SegmentMeshes& a, const SegmentMeshes& b) {
  for (std::size_t s = 0; s < a.size(); ++s)
    if (a[s].vertices != b[s].vertices || a[s].triangles != b[s].triangles) return false;
  return true;
}

std::shared_ptr<const BuiltModel> model_of(const Scene& scene) {
  ResolvedScene resolved = resolve(scene.read.scene, {.hand = HandDetail::kDisplay});
  std::optional<SegmentMeshes> display;
  if (!same_meshes(resolved.hand.meshes.display, resolved.hand.meshes.collision))
    display = std::move(resolved.hand.meshes.display);
  std::vector<ObjectFriction> friction = resolved.friction;
  return std::make_shared<const BuiltModel>(BuiltModel{.haptic = build_model(std::move(resolved)),
                                                       .display = std::move(display),
                                                       .friction = std::move(friction),
                                                       .scene = scene.name.empty() ? "text" : scene.name});
}

/// @returns a right hand of the stated size, from straight_hand().
HandParameters parameters_of(const phalanx_hand& hand) {
  const HandParameters base = straight_hand();
  HandSize size;
  if (hand.length != 0.0) size.hand_length = hand.length;
  if (hand.breadth != 0.0) size.hand_breadth = hand.breadth;
  for (const auto& [value, name] : {std::pair{hand.length, "length"}, {hand.breadth, "breadth"}})
    if (!(value >= 0.0 && value <= 1.0))
      throw std::invalid_argument(fmt::format("hand.{} = {}: must be 0 .. 1 m", name, value));
  return hand.length == 0.0 && hand.breadth == 0.0 ? base : fitted_parameters(base, fit_hand(base, size));
}

HandModel hand_of(const phalanx_hand& hand) {
  if (hand.left > 1) throw std::invalid_argument(fmt::format("hand.left = {}: must be 0 or 1", hand.left));
  if (hand.triangles > static_cast<unsigned>(std::numeric_limits<int>::max()))
    throw std::invalid_argument(fmt::format("hand.triangles = {}: must be 800 .. 2000000", hand.triangles));
  phalanx_pose pose = hand.pose;
  if (std::all_of(std::begin(pose.rotation), std::end(pose.rotation), [](double x) { return x == 0.0; }))
    pose.rotation[0] = pose.rotation[4] = pose.rotation[8] = 1.0;
  if (!is_rotation(pose))
    throw std::invalid_argument("hand.pose.rotation: must be a rotation, orthonormal to 1e-6");
  return make_hand_model(parameters_of(hand), hand.left == 0 ? Handedness::kRight : Handedness::kLeft,
                         pose_from(pose),
                         hand.triangles == 0 ? kHandTriangles : static_cast<int>(hand.triangles));
}

/// Copies a mesh of the caller. @throws std::invalid_argument as mesh_from_arrays(), or if it is too large
TriangleMesh mesh_of(const double* vertices, std::size_t vertex_count, const std::int32_t* triangles,
                     std::size_t triangle_count) {
  constexpr std::size_t kMostVertices = 3 * kMostSceneTriangles;
  if (vertex_count > kMostVertices || triangle_count > kMostSceneTriangles)
    throw std::invalid_argument(fmt::format("{} vertices and {} triangles: at most {} and {} are allowed",
                                            vertex_count, triangle_count, kMostVertices,
                                            kMostSceneTriangles));
  return mesh_from_arrays({vertices, 3 * vertex_count}, {triangles, 3 * triangle_count});
}

/// @returns the mesh that is asked for; null if kind or segment is out of range.
const TriangleMesh* mesh_in(const BuiltModel& model, std::int32_t kind, std::int32_t segment) noexcept {
  if (kind == PHALANX_MESH_OBJECTS) return &model.haptic.object.mesh();
  if (segment < 0 || segment >= kSegments) return nullptr;
  if (kind == PHALANX_MESH_DISPLAY && model.display) return &(*model.display)[idx(segment)];
  const bool of_segment = kind == PHALANX_MESH_SEGMENT || kind == PHALANX_MESH_DISPLAY;
  return of_segment ? &model.haptic.hand.mesh(segment) : nullptr;
}

}  // namespace
}  // namespace phalanx::c_api

using namespace phalanx::c_api;

phalanx_result phalanx_model_create(const phalanx_scene* scene, phalanx_model** model) {
  const auto* const object = object_of<Scene>(scene);
  if (object == nullptr) return wrong_handle("scene");
  if (model == nullptr) return null_argument("model");
  return guarded([&] {
    make_handle(std::make_unique<Model>(Model{model_of(*object)}), model);
    return PHALANX_OK;
  });
}

phalanx_result phalanx_model_create_from_mesh(const phalanx_hand* hand, const double* vertices,
                                              size_t vertex_count, const int32_t* triangles,
                                              size_t triangle_count, phalanx_model** model) {
  if (model == nullptr) return null_argument("model");
  if (vertices == nullptr && vertex_count > 0) return null_argument("vertices");
  if (triangles == nullptr && triangle_count > 0) return null_argument("triangles");
  phalanx_hand with{};
  if (hand != nullptr) {
    const phalanx_result read = read_struct(hand, 8, with, "phalanx_hand");
    if (read != PHALANX_OK) return read;
  }
  return guarded([&] {
    const bool empty = vertex_count == 0 && triangle_count == 0;
    phalanx::HapticModel haptic(
        hand_of(with),
        empty ? phalanx::ObjectModel()
              : phalanx::ObjectModel(mesh_of(vertices, vertex_count, triangles, triangle_count)));
    make_handle(std::make_unique<Model>(Model{std::make_shared<const BuiltModel>(BuiltModel{
                    .haptic = std::move(haptic), .display = {}, .friction = {}, .scene = "arrays"})}),
                model);
    return PHALANX_OK;
  });
}

phalanx_result phalanx_model_get_info(const phalanx_model* model, phalanx_model_info* info) {
  const auto* const object = object_of<Model>(model);
  if (object == nullptr) return wrong_handle("model");
  const phalanx::HapticModel& haptic = object->built->haptic;
  const phalanx::HandParameters& hand = haptic.hand.parameters();
  phalanx_model_info full{};
  full.left = haptic.hand.handedness() == phalanx::Handedness::kLeft ? 1 : 0;
  full.hand_triangles = static_cast<std::uint64_t>(haptic.hand.triangle_count());
  full.object_triangles = static_cast<std::uint64_t>(haptic.object.triangle_count());
  std::copy(hand.min_angle.begin(), hand.min_angle.end(), full.min_angle);
  std::copy(hand.max_angle.begin(), hand.max_angle.end(), full.max_angle);
  std::copy(hand.open_angle.begin(), hand.open_angle.end(), full.open_angle);
  full.palm = pose_to(haptic.hand.palm_pose());
  return write_struct(full, sizeof full, info, "phalanx_model_info");
}

phalanx_result phalanx_model_get_mesh(const phalanx_model* model, int32_t kind, int32_t segment,
                                      phalanx_mesh* mesh) {
  const auto* const object = object_of<Model>(model);
  if (object == nullptr) return wrong_handle("model");
  const phalanx::TriangleMesh* found = mesh_in(*object->built, kind, segment);
  if (found == nullptr)
    return failed(PHALANX_ERROR_INDEX,
                  "there is no such mesh: kind is one of PHALANX_MESH_*, segment is 0 .. 15");
  phalanx_mesh full{};
  full.vertex_count = found->vertices.size();
  full.triangle_count = found->triangles.size();
  static_assert(sizeof(phalanx::Vec3) == 3 * sizeof(double));
  static_assert(sizeof(phalanx::Triangle) == 3 * sizeof(int32_t));
  full.vertices = found->vertices.empty() ? nullptr : found->vertices.front().data();
  full.triangles = found->triangles.empty() ? nullptr : found->triangles.front().data();
  return write_struct(full, sizeof full, mesh, "phalanx_mesh");
}

phalanx_result phalanx_model_destroy(phalanx_model* model) { return destroy<Model>(model, "model"); }

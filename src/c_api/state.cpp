// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <memory>
#include <utility>

#include "c_api/objects.h"
#include "c_api/poses.h"
#include "c_api/samples.h"
#include "station/station_build.h"

namespace phalanx::c_api {
namespace {

/// Takes a new value over. @returns PHALANX_ERROR_NOT_NOW for a key that needs a new state
phalanx_result change(State& state, const std::string& key, const std::string& value) {
  const std::lock_guard lock(state.mutex);
  Scene next = state.scene;
  next.set({{key, value}});
  // As a station whose hand a device moves.
  if (change_kind({{key, value}}, HandSource::kDevice, state.scene.read.scene, next.read.scene) !=
      ChangeKind::kInContact)
    return failed(PHALANX_ERROR_NOT_NOW,
                  fmt::format("{}: needs a new state; set it in the scene, and make a state of that", key));
  const std::uint64_t number = state.changes + 1;
  if (state.keeps_changes.load(std::memory_order_relaxed))
    state.unrecorded.push_back({.number = number, .values = next.read.values});
  else
    state.unrecorded.clear();
  state.scene = std::move(next);
  state.changes = number;
  state.wanted.write({.parameters = state.scene.read.scene.parameters, .number = number});
  return PHALANX_OK;
}

/// Makes a step. Real-time.
Status step_once(State& state) noexcept {
  if (state.recorder == nullptr) state.keeps_changes.store(false, std::memory_order_relaxed);
  state.changed = 0;
  if (state.wanted.update()) {
    state.changed = state.wanted.value().number;
    state.ramp.go_to(state.wanted.value().parameters);
  }
  state.confirmed_for = std::exchange(state.confirmed, 0U);
  state.withdrawn_for = std::exchange(state.withdrawn, false);
  state.ramp.advance();
  return step(state.built->haptic, state.ramp.parameters(), state.sample, state.haptic);
}

}  // namespace
}  // namespace phalanx::c_api

using namespace phalanx::c_api;

phalanx_result phalanx_state_create(const phalanx_model* model, const phalanx_scene* scene,
                                    phalanx_state** state) {
  const auto* const of_model = object_of<Model>(model);
  if (of_model == nullptr) return wrong_handle("model");
  const auto* const of_scene = object_of<Scene>(scene);
  if (of_scene == nullptr && scene != nullptr) return wrong_handle("scene");
  if (state == nullptr) return null_argument("state");
  return guarded([&] {
    make_handle(std::make_unique<State>(of_model->built, of_scene == nullptr ? default_scene() : *of_scene),
                state);
    return PHALANX_OK;
  });
}

phalanx_result phalanx_step(phalanx_state* state, const phalanx_sample* sample, uint32_t* status) {
  auto* const object = object_of<State>(state);
  if (object == nullptr) return wrong_handle("state");
  phalanx_sample full = empty_sample();
  const phalanx_result read = read_struct(sample, kSmallestSample, full, "phalanx_sample");
  if (read != PHALANX_OK) return read;
  take_sample(full, object->sample);
  const phalanx::Status bits = step_once(*object);
  if (status != nullptr) *status = static_cast<uint32_t>(bits);
  return PHALANX_OK;
}

phalanx_result phalanx_state_set(phalanx_state* state, const char* key, const char* value) {
  auto* const object = object_of<State>(state);
  if (object == nullptr) return wrong_handle("state");
  if (key == nullptr) return null_argument("key");
  if (value == nullptr) return null_argument("value");
  return guarded([&] { return change(*object, key, value); });
}

phalanx_result phalanx_state_get(phalanx_state* state, const char* key, char* text, size_t size,
                                 size_t* needed) {
  auto* const object = object_of<State>(state);
  if (object == nullptr) return wrong_handle("state");
  if (key == nullptr) return null_argument("key");
  return guarded([&] {
    const std::lock_guard lock(object->mutex);
    return copy_text(object->scene.value(key), text, size, needed);
  });
}

phalanx_result phalanx_state_get_rate(const phalanx_state* state, double* rate_hz) {
  const auto* const object = object_of<State>(state);
  if (object == nullptr) return wrong_handle("state");
  if (rate_hz == nullptr) return null_argument("rate_hz");
  *rate_hz = object->ramp.parameters().rate_hz;
  return PHALANX_OK;
}

phalanx_result phalanx_state_confirm_opening(phalanx_state* state, int32_t digit) {
  auto* const object = object_of<State>(state);
  if (object == nullptr) return wrong_handle("state");
  if (digit < 0 || digit >= PHALANX_DIGITS) return failed(PHALANX_ERROR_INDEX, "digit: must be 0 .. 4");
  if (!object->haptic.confirm_opening(digit))
    return failed(PHALANX_ERROR_NOT_NOW, "the digit did not start inside an object, or has no contact");
  object->confirmed |= 1U << static_cast<unsigned>(digit);
  return PHALANX_OK;
}

phalanx_result phalanx_state_withdraw_openings(phalanx_state* state) {
  auto* const object = object_of<State>(state);
  if (object == nullptr) return wrong_handle("state");
  object->haptic.withdraw_openings();
  object->confirmed = 0;
  object->withdrawn = true;
  return PHALANX_OK;
}

phalanx_result phalanx_state_get_snapshot(const phalanx_state* state, phalanx_snapshot* snapshot) {
  const auto* const object = object_of<State>(state);
  if (object == nullptr) return wrong_handle("state");
  phalanx_snapshot full{};
  fill_snapshot(object->built->haptic, object->haptic.snapshot(), object->ramp.parameters().force.stiffness,
                full);
  return write_struct(full, kSmallestSnapshot, snapshot, "phalanx_snapshot");
}

phalanx_result phalanx_state_get_contact_point(const phalanx_state* state, int32_t index,
                                               phalanx_contact_point* point) {
  const auto* const object = object_of<State>(state);
  if (object == nullptr) return wrong_handle("state");
  const phalanx::ContactPoints& all = object->haptic.snapshot().contact_points;
  if (index < 0 || index >= all.count)
    return failed(PHALANX_ERROR_INDEX, "index: must be below phalanx_snapshot.contact_points");
  const phalanx::ContactPoint& from = all.point[static_cast<std::size_t>(index)];
  phalanx_contact_point full{};
  full.segment = static_cast<uint32_t>(from.segment);
  copy_vector(from.point, full.point);
  copy_vector(from.normal, full.normal);
  full.force = from.force;
  copy_vector(from.friction, full.friction);
  full.spin = from.spin;
  full.coefficient = from.coefficient;
  full.slips = from.slips ? 1 : 0;
  return write_struct(full, sizeof full, point, "phalanx_contact_point");
}

phalanx_result phalanx_pose_get_quaternion(const phalanx_pose* pose, double quaternion[4]) {
  if (pose == nullptr) return null_argument("pose");
  if (quaternion == nullptr) return null_argument("quaternion");
  if (!is_rotation(*pose))
    return failed(PHALANX_ERROR_REFUSED, "pose.rotation: must be a rotation, orthonormal to 1e-6");
  Eigen::Quaterniond q(pose_from(*pose).R);
  q.normalize();
  if (q.w() < 0.0) q.coeffs() = -q.coeffs();
  const double parts[4] = {q.x(), q.y(), q.z(), q.w()};
  std::copy(std::begin(parts), std::end(parts), quaternion);
  return PHALANX_OK;
}

phalanx_result phalanx_state_destroy(phalanx_state* state) {
  const auto* const object = object_of<State>(state);
  if (object != nullptr && object->recorder != nullptr)
    return failed(PHALANX_ERROR_NOT_NOW, "destroy the state's recorder before the state");
  return destroy<State>(state, "state");
}

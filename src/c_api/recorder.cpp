// SPDX-License-Identifier: Apache-2.0
#include <memory>
#include <utility>

#include "c_api/objects.h"
#include "phalanx/record/session_recorder.h"

namespace phalanx::c_api {
namespace {

SessionGeometry geometry_of(const BuiltModel& model, double rate_hz) {
  SessionGeometry geometry;
  geometry.handedness = model.haptic.hand.handedness();
  geometry.hand = model.haptic.hand.parameters();
  geometry.X_WH = model.haptic.hand.palm_pose();
  geometry.segment = model.haptic.hand.meshes();
  geometry.display = model.display.value_or(geometry.segment);
  geometry.object = model.haptic.object.mesh();
  geometry.friction = model.friction;
  geometry.rate_hz = rate_hz;
  return geometry;
}

std::unique_ptr<Recorder> begin_recorder(State& state, const char* path) {
  // Values that were set since are changes, which the first step begins.
  auto recorder = std::make_unique<Recorder>(
      state, StepRecorder(path, geometry_of(*state.built, state.ramp.parameters().rate_hz),
                          {.scene = state.built->scene,
                           .values = state.first_values,
                           .metadata = recording_metadata(PHALANX_VERSION)}));
  state.recorder = recorder.get();
  return recorder;
}

phalanx_result already_finished() { return failed(PHALANX_ERROR_NOT_NOW, "the recording is finished"); }

/// Writes the changes up to that of the last step.
void record_changes(Recorder& recorder) {
  State& state = recorder.state;
  const std::lock_guard lock(state.mutex);
  while (!state.unrecorded.empty() && state.unrecorded.front().number <= state.changed) {
    recorder.file.change(state.unrecorded.front().number, state.unrecorded.front().values);
    state.unrecorded.erase(state.unrecorded.begin());
  }
}

}  // namespace
}  // namespace phalanx::c_api

using namespace phalanx::c_api;

phalanx_result phalanx_recorder_create(phalanx_state* state, const char* path, phalanx_recorder** recorder) {
  auto* const object = object_of<State>(state);
  if (object == nullptr) return wrong_handle("state");
  if (path == nullptr) return null_argument("path");
  if (recorder == nullptr) return null_argument("recorder");
  if (object->recorder != nullptr) return failed(PHALANX_ERROR_NOT_NOW, "the state has a recorder already");
  if (object->haptic.snapshot().tick != 0)
    return failed(
        PHALANX_ERROR_NOT_NOW,
        "the state has made a step; begin the recording before the first one, so that it can be replayed");
  return guarded([&] {
    make_handle(begin_recorder(*object, path), recorder);
    return PHALANX_OK;
  });
}

phalanx_result phalanx_recorder_add(phalanx_recorder* recorder) {
  auto* const object = object_of<Recorder>(recorder);
  if (object == nullptr) return wrong_handle("recorder");
  if (object->finished) return already_finished();
  const State& state = object->state;
  const phalanx::Snapshot& snapshot = state.haptic.snapshot();
  if (snapshot.tick == object->tick)
    return failed(PHALANX_ERROR_NOT_NOW, "the state has made no step since the last one that was added");
  return guarded([&] {
    record_changes(*object);
    object->tick = snapshot.tick;
    object->file.add({.sample = state.sample,
                      .snapshot = snapshot,
                      .stiffness = state.ramp.parameters().force.stiffness,
                      .confirmed = state.confirmed_for,
                      .withdrawn = state.withdrawn_for,
                      .changed = state.changed});
    return PHALANX_OK;
  });
}

phalanx_result phalanx_recorder_event(phalanx_recorder* recorder, const char* code, const char* text) {
  auto* const object = object_of<Recorder>(recorder);
  if (object == nullptr) return wrong_handle("recorder");
  if (code == nullptr) return null_argument("code");
  if (text == nullptr) return null_argument("text");
  if (object->finished) return already_finished();
  return guarded([&] {
    object->file.event(code, "", text);
    return PHALANX_OK;
  });
}

phalanx_result phalanx_recorder_finish(phalanx_recorder* recorder) {
  auto* const object = object_of<Recorder>(recorder);
  if (object == nullptr) return wrong_handle("recorder");
  return guarded([&] {
    {
      State& state = object->state;
      const std::lock_guard lock(state.mutex);
      state.keeps_changes.store(false, std::memory_order_relaxed);
      state.unrecorded.clear();
    }
    object->file.finish();
    object->finished = true;
    return PHALANX_OK;
  });
}

phalanx_result phalanx_recorder_destroy(phalanx_recorder* recorder) {
  return destroy<Recorder>(recorder, "recorder");
}

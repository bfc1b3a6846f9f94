// SPDX-License-Identifier: Apache-2.0
// The objects behind the handles of the C interface.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "c_api/calls.h"
#include "phalanx/core/latest.h"
#include "phalanx/device/motion.h"
#include "phalanx/record/step_recorder.h"
#include "phalanx/scene/scene.h"
#include "phalanx/scene/scene_file.h"
#include "phalanx/step/haptic_step.h"
#include "station/parameter_ramp.h"

namespace phalanx::c_api {

/// A scene's file with the values that replace those of the file.
struct Scene {
  SceneFile file;
  Overrides overrides;
  SceneWithValues read;
  std::string name;  ///< as given; empty for a text

  /// Takes values over. @throws as SceneFile::with_values(); the scene is then as before
  void set(const Overrides& changes);
  /// @returns the value of a key as written in a file. @throws SceneError for an unknown key
  [[nodiscard]] std::string value(const std::string& key) const;
};

/// @returns a scene with the default of every key.
[[nodiscard]] Scene default_scene();

/// A model, with what is shown and recorded of it besides.
struct BuiltModel {
  HapticModel haptic;
  std::optional<SegmentMeshes> display;  ///< none: those of the contact search
  std::vector<ObjectFriction> friction;
  std::string scene;  ///< its name, "text" or "arrays"
};

struct Model {
  std::shared_ptr<const BuiltModel> built;
};

struct TimedMotion {
  Motion motion;
  double seconds = 0.0;
};

/// Parameters that the next step begins to go over to.
struct WantedParameters {
  HapticParameters parameters;
  std::uint64_t number = 0;  ///< from 1 on
};

/// The state of a hand, with what its recorder needs of the last step.
struct State {
  /// @throws as HapticState
  State(std::shared_ptr<const BuiltModel> of_model, Scene with_scene)
      : built(std::move(of_model)),
        scene(std::move(with_scene)),
        first_values(scene.read.values),
        ramp(scene.read.scene.parameters),
        haptic(built->haptic, ramp.parameters()) {}

  const std::shared_ptr<const BuiltModel> built;

  // ---- of any thread, under the lock
  std::mutex mutex;
  Scene scene;
  const Overrides first_values;  ///< of the scene at the beginning
  std::uint64_t changes = 0;     ///< so far
  struct Change {
    std::uint64_t number = 0;
    Overrides values;
  };
  std::vector<Change> unrecorded;  ///< changes that no step of the recorder has named yet

  /// Until the first step without a recorder: it is too late for one then.
  std::atomic<bool> keeps_changes{true};

  Latest<WantedParameters> wanted;  ///< from that thread to the one that steps

  // ---- of the thread that steps
  ParameterRamp ramp;
  HapticState haptic;
  Sample sample;
  std::uint64_t changed = 0;   ///< number of the change that the last step began; 0: none
  unsigned confirmed = 0;      ///< digits whose opening was confirmed since the last step: bit d for digit d
  unsigned confirmed_for = 0;  ///< those of the last step
  bool withdrawn = false;      ///< openings were withdrawn since the last step
  bool withdrawn_for = false;  ///< before the last step
  Recorder* recorder = nullptr;
};

struct Recorder {
  Recorder(State& of_state, StepRecorder begun) : state(of_state), file(std::move(begun)) {}
  ~Recorder() { state.recorder = nullptr; }
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  State& state;
  StepRecorder file;
  std::uint64_t tick = 0;  ///< of the newest step in the file
  bool finished = false;   ///< the file has its end
};

}  // namespace phalanx::c_api

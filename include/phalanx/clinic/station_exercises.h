// SPDX-License-Identifier: Apache-2.0
// Exercises of patients on the station of `phalanx run`.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "phalanx/clinic/exercise_host.h"
#include "phalanx/record/run_recorder.h"
#include "phalanx/registry/registry.h"
#include "phalanx/scene/scene.h"
#include "phalanx/station/session.h"

namespace phalanx {

/// Settings of StationExercises.
struct StationExercisesSettings {
  /// Of each recording, without encryption: the patient's key encrypts it
  RecorderSettings recording = {};
  Overrides overrides = {};    ///< that hold for each exercise's scene, such as the loop's rate
  std::string clinician = {};  ///< SessionSettings::clinician
  /// Largest stable stiffness, as the person who answers for the device states it [N/m]
  std::optional<double> stable_stiffness = {};
  /// File into which the station writes its steps in plain text (--log). While there is one, no exercise begins; empty: none
  std::string plain_log = {};
  std::function<double()> utc = {};  ///< UTC [s since 1970]; empty: the system's clock. For tests
  /// Gets messages for people, without a code of a patient. The owner's thread
  std::function<void(const std::string& text, bool warning)> say = {};
};

/// Carries out exercises of patients, one after the other, on a station that goes on running.
///
/// Begin: forces stop; the station is replaced by that of the exercise (scene, limits, the patient's hand, calibration and
/// range), which begins stopped; with its first step another recording begins, encrypted with the patient's key. The
/// exercise waits for ExerciseInput::kBegin.
/// While it runs: ExerciseControl. After a stop by any person (Session::stops()), a fault or a lost device the exercise
/// pauses, and the torque stays at zero until input(kResume). A fault needs reset() first.
/// End: the station is replaced by the same one, stopped, so that the exercise's recording ends. Its result is made from
/// the recording on a thread of its own and kept in the registry. What is recorded after that is encrypted with the same
/// key until another patient's exercise, or until release_key(): no plain text of a patient reaches the disk.
///
/// The key is in use (Registry::use_key()) until all recordings with it are closed. release_key() stops forces, and
/// makes the station as it was before the exercises, stopped, without the patient's calibration and range. A scene or
/// calibration that was loaded since is kept. With its first step a recording without a patient begins. If that is
/// refused, nothing is recorded until the next exercise, and say() gets the reason.
///
/// begin(), input(), reset(), release_key(), status(), busy() and keeps_private(): any thread, release_key() not the
/// owner's. The others: the owner's thread of the Session. Not real-time.
class StationExercises final : public ExerciseHost {
 public:
  /// @param session, recorder  outlive end(); the session keeps its changes
  /// @param registry  of the patients
  StationExercises(Session& session, RunRecorder& recorder, std::shared_ptr<Registry> registry,
                   StationExercisesSettings settings);
  ~StationExercises() override;  ///< end()

  std::uint32_t begin(const Actor& actor, const ExerciseOrder& order) override;
  using ExerciseHost::input;
  void input(const ExerciseInput& input, const InputOrigin& origin) override;
  void reset() override;
  void release_key(const std::string& record) override;
  [[nodiscard]] ExerciseStatus status() const override;

  /// @returns true from begin() until the station is free again: others must not change scene, source or calibration
  [[nodiscard]] bool busy() const;
  /// @returns true once a patient's exercise was ordered: fault reports must not be written in plain text
  [[nodiscard]] bool keeps_private() const;

  /// Serves the exercise. Call it after Session::poll(), each between_ticks().
  void tick();
  /// @returns the longest time to the next tick() [s]
  [[nodiscard]] double between_ticks() const;
  /// Refuses further exercises, and completes the last one: its result is made. Call it after Session::shut_down() and
  /// RunRecorder::finish(), which end the recording of an exercise that runs. It may take minutes.
  void end();

 private:
  struct Impl;
  const std::shared_ptr<Impl> impl_;  ///< the recorder's and the session's answers share it
};

}  // namespace phalanx

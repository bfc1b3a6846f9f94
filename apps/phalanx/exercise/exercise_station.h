// SPDX-License-Identifier: Apache-2.0
// The station of `phalanx exercise run`, from its begin to the end of its recording.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "exercise/exercise_options.h"
#include "exercise/exercise_participant.h"
#include "phalanx/record/live_exercise.h"
#include "phalanx/station/session.h"
#include "run/disk_messages.h"
#include "run/run_console.h"
#include "run/run_recorder.h"
#include "terminal/typed_lines.h"

namespace phalanx {

/// What an exercise needs before its station begins.
struct ExercisePlan {
  ExerciseStart
      start;  ///< without conditions; the digits with an own sensor are found when the device is open
  SessionSettings session;
  RecorderSettings recording;
  std::optional<double> seconds = {};  ///< after which it is ended; none: at its own end
  /// Person without measured force and range: those of the simulated participant's hand are assumed.
  bool assume_person = false;
  std::optional<ParticipantSkill> skill = {};  ///< simulated participant; none: a person
  /// Called when the device is open and before forces are wanted. @throws what refuses the exercise
  std::function<void(const SessionInfo&)> on_open = {};
  /// Called with the recording's file before it has a step. @throws what refuses the exercise
  std::function<void(const std::filesystem::path&)> on_recording = {};
};

/// Station with one exercise. Forces are off until the exercise wants them, and while it pauses. This thread
/// waits for neither the terminal nor the disk.
class ExerciseStation {
 public:
  static constexpr double kFaultPatience =
      60.0;  ///< for which a fault may last before the exercise is ended [s]
  /// Longest time without a step that the exercise has evaluated: a disk that does not take data holds the
  /// steps back. Then forces are off until steps come again [s]
  static constexpr double kLongestStall = 0.15;

  /// @param clock  of the process; outlives the station
  ExerciseStation(ExercisePlan plan, const Clock& clock, RunConsole& console);

  /// Runs the exercise. In every case the station first ends at zero torque, and the recording
  /// is then finished.
  /// @returns true if the recording has its end
  /// @throws what refuses the exercise, or SceneError, DeviceError and others as Session
  [[nodiscard]] bool go();

  /// @returns the recording; empty before it began
  [[nodiscard]] const std::filesystem::path& recording() const noexcept { return file_; }
  /// @returns the exercise while the station ran; null before go(), or if its device did not open
  [[nodiscard]] const LiveExercise* live() const noexcept { return live_.get(); }

 private:
  void serve();
  void begin();
  void introduce();
  void watch();
  void drain();
  void write_report(FaultReport report);
  void handle_typed();
  void handle(const std::string& line);
  void give(const ExerciseInput& input);
  void serve_demand();
  void serve_torque(bool wanted);
  void serve_scene(const ExerciseDemand& demand);
  void take_part();
  void watch_fault();
  void watch_steps();
  void show();

  ExercisePlan plan_;
  const Clock& clock_;
  RunConsole& console_;
  std::unique_ptr<Session> session_;
  std::unique_ptr<LiveExercise> live_;  ///< before recorder_, whose thread uses it
  RunRecorder recorder_;
  std::optional<TypedLines> typed_;
  std::optional<ExerciseParticipant> participant_;
  DiskMessages disk_messages_;
  std::filesystem::path file_;
  std::string said_;            ///< the newest instruction that was written
  std::string noted_;           ///< the newest note that was written
  bool torque_allowed_ = true;  ///< no person and no fault has stopped it since
  bool quit_ = false;
  std::uint64_t stops_ = 0;  ///< of the session, before the typed lines were handled
  bool stalled_ = false;     ///< no step has been evaluated for kLongestStall
  std::uint64_t steps_ = 0;  ///< that the exercise had evaluated at stepped_at_
  double stepped_at_ = 0.0;  ///< of the newest evaluated step, or of the newest change of the scene [s]
  bool setting_ = false;     ///< a change of the scene is being made
  std::optional<double> stiffness_;  ///< that was asked for last [N/m]
  std::optional<int> object_;        ///< that was asked for last
  std::string object_place_;         ///< keys of the scene's first object that the exercise's objects keep
  double scene_stiffness_ = 0.0;     ///< at the station's begin [N/m]
  double paused_since_ = 0.0;        ///< without a person's doing, in a demonstration [s]
  double fault_since_ = 0.0;         ///< of the present fault, or of a missing station; 0: none [s]
  double next_line_ = 0.0;           ///< of the status [s]
};

}  // namespace phalanx

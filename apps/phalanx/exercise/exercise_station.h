// SPDX-License-Identifier: Apache-2.0
// The station of `phalanx exercise run`, from its begin to the end of its recording.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "phalanx/clinic/exercise_control.h"
#include "phalanx/clinic/exercise_plan.h"
#include "phalanx/record/live_exercise.h"
#include "phalanx/record/run_recorder.h"
#include "phalanx/station/session.h"
#include "run/disk_messages.h"
#include "run/run_console.h"
#include "terminal/typed_lines.h"

namespace phalanx {

/// What the station of an exercise needs.
struct ExerciseStationPlan {
  ExercisePlan exercise;
  SessionSettings session;
  RecorderSettings recording;
  std::optional<double> seconds = {};  ///< after which it is ended; none: at its own end
  /// Called when the device is open and before forces are wanted. @throws what refuses the exercise
  std::function<void(const SessionInfo&)> on_open = {};
  /// Called with the recording's file before it has a step. @throws what refuses the exercise
  std::function<void(const std::filesystem::path&)> on_recording = {};
};

/// Station with one exercise. Forces are off until the exercise wants them, and while it pauses. This thread
/// waits for neither the terminal nor the disk.
class ExerciseStation {
 public:
  /// @param clock  of the process; outlives the station
  ExerciseStation(ExerciseStationPlan plan, const Clock& clock, RunConsole& console);

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
  void show();

  ExerciseStationPlan plan_;
  const Clock& clock_;
  RunConsole& console_;
  std::unique_ptr<Session> session_;
  std::unique_ptr<LiveExercise> live_;  ///< before recorder_, whose thread uses it
  RunRecorder recorder_;
  std::optional<TypedLines> typed_;
  std::optional<ExerciseControl> control_;
  DiskMessages disk_messages_;
  std::filesystem::path file_;
  std::string said_;   ///< the newest instruction that was written
  std::string noted_;  ///< the newest note that was written
  bool quit_ = false;
  double next_line_ = 0.0;  ///< of the status [s]
};

}  // namespace phalanx

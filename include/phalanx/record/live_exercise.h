// SPDX-License-Identifier: Apache-2.0
// An exercise that is carried out while a station runs and is recorded.
#pragma once

#include <atomic>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "phalanx/exercise/exercise_run.h"
#include "phalanx/record/hand_observer.h"
#include "phalanx/record/recorded_exercise.h"

namespace phalanx {

/// An exercise on a running station. The recorder's thread hands it each step, any thread gives inputs
/// and reads what it shows. It writes what a replay needs into the recording: its beginning, each input
/// with the step before which it took effect, and its result. Not real-time: nothing here is called by
/// the station's loop.
class LiveExercise {
 public:
  /// Writes an event into the recording: SessionRecorder::event() with an empty `who`.
  using Write = std::function<void(const std::string& code, const std::string& text)>;

  /// @param number  of the exercise in its recording, from 1
  /// @throws ExerciseError as ExerciseRun
  LiveExercise(ExerciseStart start, int number, Write write);

  // ---- the recorder's thread
  /// Takes a step, after the inputs that wait. @throws std::bad_alloc
  void step(const StepRecord& record);
  /// Ends the exercise after the last step: inputs that wait take effect, an exercise that is not done is
  /// aborted, and the result is written if it is not yet. It may be called again.
  void finish();

  // ---- any thread
  // Only result() waits for a step that is evaluated. The others hold a lock only to copy.
  /// Adds an input, which takes effect before the next step.
  void input(const ExerciseInput& input);
  /// @returns the refusals of inputs since the last call, in words
  [[nodiscard]] std::vector<std::string> take_refusals();
  [[nodiscard]] ExerciseView view() const;
  [[nodiscard]] ExerciseDemand demand() const;
  [[nodiscard]] bool done() const noexcept { return done_; }
  /// @returns what was measured so far. It waits for a step that is evaluated, which may score a trial
  [[nodiscard]] ExerciseResult result() const;
  /// @returns the newest observation; none before the first step
  [[nodiscard]] std::optional<Observation> newest() const;
  /// @returns the number of steps that step() has evaluated
  [[nodiscard]] std::uint64_t steps() const noexcept { return steps_; }
  [[nodiscard]] const ExerciseStart& start() const noexcept { return start_; }

 private:
  void take_inputs(std::uint64_t station, std::uint64_t tick);
  void write_result();
  void publish(const std::optional<Observation>& observation);
  [[nodiscard]] std::optional<ExerciseInput> next_input();
  void refuse(std::string refusal);

  const ExerciseStart start_;
  const int number_;
  const Write write_;

  mutable std::mutex run_mutex_;  ///< of the exercise; held over a step. It is taken before mutex_
  ExerciseRun run_;
  HandObserver observer_;
  std::uint64_t station_ = 0;
  std::uint64_t tick_ = 0;
  bool written_ = false;  ///< the result is in the recording

  mutable std::mutex mutex_;  ///< of inputs, refusals and the copies; held only to copy
  std::deque<ExerciseInput> inputs_;
  std::vector<std::string> refusals_;
  std::optional<Observation> newest_;
  ExerciseView view_;
  ExerciseDemand demand_;
  std::atomic<bool> done_;
  std::atomic<std::uint64_t> steps_ = 0;
};

}  // namespace phalanx

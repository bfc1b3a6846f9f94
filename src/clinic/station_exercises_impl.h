// SPDX-License-Identifier: Apache-2.0
// Inside of StationExercises. Read clinic/station_exercises.h first.
#pragma once

#include <atomic>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "clinic/exercise_order.h"
#include "phalanx/clinic/exercise_control.h"
#include "phalanx/clinic/station_exercises.h"
#include "phalanx/record/live_exercise.h"

namespace phalanx {

/// One replacement of the station, with the recording that begins with it. The recorder's thread and Session::poll()
/// report into it.
struct StationChange {
  std::mutex mutex;            ///< of the reports
  std::filesystem::path file;  ///< the recording's, when it is open; empty: not yet
  bool entered = false;        ///< the registry has taken or refused the recording's name
  bool opened = false;         ///< the station runs
  bool begun = false;          ///< the recording has its first step
  std::string refused;         ///< by the recorder or the registry; empty: by neither
  std::string unopened;        ///< why the session makes no such station; empty: it has not refused
  // ---- the owner's thread
  std::uint64_t recording = 0;
  bool ordered = false;  ///< Session::replace() was called
};

/// Copy of the reports of a StationChange.
struct ChangeReports {
  std::filesystem::path file = {};
  bool entered = false;
  bool opened = false;
  bool begun = false;
  std::string refused = {};
  std::string unopened = {};
};

[[nodiscard]] ChangeReports reports_of(StationChange& change);

/// Makes the order of a recording that reports into a change.
[[nodiscard]] NextRecording reporting(const std::shared_ptr<StationChange>& change,
                                      RecorderSettings settings);

/// The recording of one exercise, as the recorder's thread sees it.
struct CarriedExercise {
  std::mutex mutex;
  std::shared_ptr<LiveExercise> live;   ///< null: it has not begun
  std::filesystem::path file;           ///< empty: not yet
  std::optional<EndedRecording> ended;  ///< its recording is finished

  void step(const StepRecord& record);
  void finish();
  [[nodiscard]] std::shared_ptr<LiveExercise> exercise();
};

/// State and functions of StationExercises. Members that `mutex_` does not guard belong to the owner's thread.
struct StationExercises::Impl : std::enable_shared_from_this<StationExercises::Impl> {
  Impl(Session& session, RunRecorder& recorder, std::shared_ptr<Registry> registry,
       StationExercisesSettings settings);
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  ~Impl() = default;

  using Stage = ExerciseStatus::Stage;

  // ---- any thread: station_exercises.cpp
  std::uint32_t begin(const Actor& actor, const ExerciseOrder& order);
  void input(const ExerciseInput& input, const InputOrigin& origin);
  void reset();
  void release_key(const std::string& record);
  [[nodiscard]] bool uses(const std::string& record);
  void forget(const std::string& record);
  void keep_loaded(const SessionInfo& info);
  [[nodiscard]] ExerciseStatus status() const;
  [[nodiscard]] bool busy() const;
  void say(const std::string& text, bool warning);

  // ---- the owner's thread: exercise_stages.cpp
  void tick();
  void end();
  void say_words();
  void tick_opening();
  void ask_opening();
  void enter_recording(const std::filesystem::path& file);
  void tick_ordered(const ChangeReports& reports);
  void leave_station(const std::string& why);
  [[nodiscard]] bool abort_waits() const;
  [[nodiscard]] std::uint64_t stops_of_opening() const;
  void start();
  void tick_running();
  void handle_inputs();
  void watch_success(const ExerciseView& view);
  void begin_closing();
  void tick_closing();
  void ask_closing();
  void refused_closing(const ChangeReports& reports);
  [[nodiscard]] std::optional<HandSource> source_of_hand() const;
  void order_station(const std::shared_ptr<StationChange>& change, const StationOrder& order);
  void keep();
  void conclude(std::optional<ExerciseResult> result, const std::string& trouble);
  [[nodiscard]] std::optional<UnscoredExercise> unscored() const;
  [[nodiscard]] RecorderSettings encrypted() const;
  [[nodiscard]] std::shared_ptr<const KeyUse> use_of_key() const;
  void set_recorded();
  bool tries_again(const std::string& why);
  [[nodiscard]] Stage stage_now() const;

  // ---- the owner's thread: own_recording.cpp
  void tick_free();
  void ask_own();
  void conclude_own(const std::string& why);

  Session& session_;
  RunRecorder& recorder_;
  const std::shared_ptr<Registry> registry_;
  const StationExercisesSettings settings_;

  std::mutex begin_mutex_;            ///< held over begin(), taken before mutex_
  std::atomic<bool> ending_ = false;  ///< end() has begun: begin() returns soon

  /// An input with Session::stops() at the time when it was given.
  struct Given {
    ExerciseInput input = {};
    std::uint64_t stops = 0;
    bool stopped = false;  ///< with it the torque was stopped
    std::string account = {};
  };
  struct Words {
    std::string text = {};
    bool warning = false;
  };
  mutable std::mutex mutex_;  ///< of the members up to the next mark
  Stage stage_ = Stage::kNone;
  std::uint32_t number_ = 0;
  bool ended_ = false;  ///< no further exercise begins
  bool keeps_private_ = false;
  std::shared_ptr<const PreparedExercise> prepared_;  ///< of the newest exercise
  std::shared_ptr<CarriedExercise> carried_;          ///< likewise
  std::deque<Given> inputs_;
  bool reset_asked_ = false;
  std::vector<Words> words_;
  std::string trouble_;
  std::string refusal_;  ///< of the newest input that was refused; empty: none lately
  std::optional<ExerciseResult> result_;
  bool last_success_ = false;
  bool forces_off_ = false;
  /// Session::stops() when the exercise was ordered; after end(): as they were then
  std::uint64_t stops_ = 0;
  std::shared_ptr<const KeyUse> use_;  ///< of the exercise's key, from its order to its result
  /// All uses of keys, with the record of each: those of recordings last until the recording is closed.
  std::vector<std::pair<std::string, std::weak_ptr<const KeyUse>>> uses_;
  std::string recorded_;    ///< record whose key encrypts the present recording; empty: none
  StationOrder exercised_;  ///< the station as that recording began
  /// The station before the first exercise since is_own_ was true, with what was loaded until release_key()
  StationOrder own_;
  bool is_own_ = true;   ///< no exercise has had the station since the program began, or since release_key()
  bool leaves_ = false;  ///< the station's own recording is to begin

  // ---- the owner's thread
  std::shared_ptr<StationChange> opening_;
  std::shared_ptr<StationChange> closing_;
  std::shared_ptr<StationChange> leaving_;  ///< to the station's own recording
  std::optional<ExerciseControl> control_;
  std::shared_ptr<LiveExercise> live_;
  double began_utc_ = 0.0;   ///< [s]
  double done_at_ = 0.0;     ///< the exercise was done; 0: not yet [s]
  double refused_at_ = 0.0;  ///< newest refusal of an input [s]
  double next_close_ = 0.0;  ///< no try to close before [s]
  int counted_ = 0;
  int successes_ = 0;
  /// Why the exercise whose station opened is not recorded: another recording follows, and then its end. Empty: it is
  std::string unrecorded_;
  std::thread entry_;  ///< hands the name of the recording to the registry, which may wait
  std::thread keeper_;
  /// Outcome of the keeper's thread; shared with it.
  struct Kept {
    std::mutex mutex;
    std::optional<KeptExercise> made;
  };
  std::shared_ptr<Kept> kept_;
};

}  // namespace phalanx

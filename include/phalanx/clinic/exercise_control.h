// SPDX-License-Identifier: Apache-2.0
// What a station does for an exercise: torque, scene, and what a fault, a stop or a stall means for it.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "phalanx/clinic/exercise_participant.h"
#include "phalanx/clinic/exercise_plan.h"
#include "phalanx/record/live_exercise.h"
#include "phalanx/station/session.h"

namespace phalanx {

/// Controls a station for an exercise. The exercise stops forces at once. It brings them back only if neither a person nor
/// a fault has stopped them since. Forces are also off while no step is evaluated: then the exercise can stop nothing,
/// its trials do not end, and no limit of it acts.
///
/// Constructor and functions are for the owner's thread of the Session; forces_off() for any. Not real-time.
class ExerciseControl {
 public:
  static constexpr double kFaultPatience =
      60.0;  ///< for which a fault may last before the exercise is to be ended [s]
  /// Longest time without a step that the exercise has evaluated: a disk that does not take data holds the
  /// steps back. Then forces are off until steps come again [s]
  static constexpr double kLongestStall = 0.15;
  static constexpr double kBetweenLooks = 0.02;       ///< largest interval of tick() [s]
  static constexpr double kBetweenMovements = 0.005;  ///< the same with a simulated participant [s]

  /// Messages for people.
  struct Words {
    std::function<void(const std::string& text)> say;
    std::function<void(const std::string& text, bool error)> complain;
    const char* to_reset = "type reset when the cause is gone, or quit";
    std::function<bool()> ends = {};  ///< true: the program ends, and brings no forces back. Empty: never
  };

  /// @param session, live   outlive it
  /// @param pauses_at_stop  a stop by another person or page, and a fault, pause the exercise; torque then comes back only
  /// with resume(). false: the owner handles stops
  /// @param known_stops     Session::stops() that the station's opening itself has made: look() notices each later one.
  /// none: those until now
  ExerciseControl(Session& session, LiveExercise& live, const ExercisePlan& plan, Words words,
                  bool pauses_at_stop, std::optional<std::uint64_t> known_stops = {});

  /// Notices the stops until now: tick() ends no stop that comes from here on. Call it before the inputs are handled.
  void look() { look(session_.stops()); }
  /// The same with Session::stops() as it was read before.
  void look(std::uint64_t stops);
  /// Counts a Session::stop() that an input has made before it comes here: look() does not take it for one of another person.
  void count_stop();
  /// Serves the exercise. Call it each kBetweenLooks.
  void tick();

  /// Hands an input to the exercise. One that ends it stops forces here: the exercise itself takes it only at its next
  /// step, which may wait for the disk. A refused rating does so, too: a person who enters "pain 12" does not want forces.
  void give(const ExerciseInput& input);
  void pause();  ///< stops forces, and pauses the exercise
  /// Allows forces again, and resumes the exercise.
  void resume();
  /// Resumes for a person who saw the session's stops until number `stops`.
  /// @returns false, with no effect, if another person or page has stopped since, or a fault is not reset
  [[nodiscard]] bool resume(std::uint64_t stops);
  void reset();          ///< resets the station's fault; forces stay off
  void forbid_torque();  ///< stops forces, until allow_torque() or resume()
  void allow_torque();   ///< forces may come back without resume(), as the exercise wants them

  /// @returns true if a rating, answer or abort is one at which forces stop
  [[nodiscard]] static bool stops_forces(const ExerciseInput& input, const RatingLimits& limits) noexcept;

  /// @returns true once a fault has lasted kFaultPatience: the exercise is to be ended
  [[nodiscard]] bool fault_lasts() const noexcept { return fault_lasts_; }
  /// @returns true while a person, a fault or a stall keeps the torque at zero. Any thread
  [[nodiscard]] bool forces_off() const noexcept { return forces_off_; }
  [[nodiscard]] double between_ticks() const noexcept {
    return participant_ ? kBetweenMovements : kBetweenLooks;
  }

 private:
  void stop();
  void give_pause();
  [[nodiscard]] bool pause_waits() const;
  void serve_demand();
  void serve_torque(bool wanted);
  void serve_scene(const ExerciseDemand& demand);
  void take_part();
  void watch_fault();
  void watch_steps();

  Session& session_;
  LiveExercise& live_;
  const Words words_;
  const bool pauses_at_stop_;
  std::optional<ExerciseParticipant> participant_;
  /// Shared with the answers of the session, which may come when this object is gone.
  struct Change {
    bool waits = false;  ///< a change of the scene is being made
    std::string refused;
  };
  const std::shared_ptr<Change> change_ = std::make_shared<Change>();
  bool torque_allowed_ = true;            ///< no person and no fault has stopped it since
  std::uint64_t stops_ = 0;               ///< of the session, up to which all is known
  std::uint64_t newest_stop_ = 0;         ///< number of the newest one by another person or page
  std::optional<std::uint64_t> pausing_;  ///< steps when a pause was given that is perhaps not taken yet
  bool stalled_ = false;                  ///< no step has been evaluated for kLongestStall
  std::uint64_t steps_ = 0;               ///< that the exercise had evaluated at stepped_at_
  double stepped_at_ = 0.0;  ///< of the newest evaluated step, or of the newest change of the scene [s]
  std::optional<double> stiffness_;  ///< that was asked for last [N/m]
  std::optional<int> object_;        ///< that was asked for last
  std::string object_place_;         ///< keys of the scene's first object that the exercise's objects keep
  double scene_stiffness_ = 0.0;     ///< at the station's begin [N/m]
  double paused_since_ = 0.0;        ///< without a person's doing, in a demonstration [s]
  double fault_since_ = 0.0;         ///< of the present fault, or of a missing station; 0: none [s]
  bool fault_lasts_ = false;
  std::atomic<bool> forces_off_{false};
};

}  // namespace phalanx

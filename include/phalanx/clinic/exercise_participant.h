// SPDX-License-Identifier: Apache-2.0
// Simulated participant of a demonstration (`phalanx exercise run --demo`, or chosen on the page of patients). It sees what a
// participant sees, and moves the hand.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "phalanx/exercise/exercise_run.h"
#include "phalanx/exercise/observation.h"
#include "phalanx/exercise/simulated_participant.h"
#include "phalanx/hand/hand_model.h"
#include "phalanx/scene/scene.h"

namespace phalanx {

/// Reads --demo: the name of a preset, or a number from 0 (severe) to 1 (healthy).
/// @throws std::invalid_argument naming the text and what is known
[[nodiscard]] ParticipantSkill demo_skill(const std::string& text);

/// Reads the posture that a scene states for its grasp (`motion.name = "posture"`): the digits press the object.
/// @param values  SessionInfo::values
/// @returns one angle for each joint [rad]; none: the scene states another motion, or not all joints
[[nodiscard]] std::optional<JointArray> grasp_posture(const Overrides& values);

/// Participant at an exercise. It has no clock.
class ExerciseParticipant {
 public:
  /// @param hand      of the station
  /// @param exercise  that it does
  /// @param grasp     grasp_posture(): in a pinch, thumb and finger close through it, as a person who sees the object. None:
  /// they close to the fist, and may miss it
  ExerciseParticipant(const HandModel& hand, const ExerciseDescription& exercise,
                      const ParticipantSkill& skill, std::uint64_t seed,
                      const std::optional<JointArray>& grasp);

  /// What it does: where the hand goes, and an answer to give.
  struct Act {
    JointArray angle{};  ///< [rad]
    std::optional<ExerciseInput> input;
  };
  /// Advances to `now` [s].
  /// @param felt    newest observation; none before the first step
  /// @param object  ExerciseDemand::object: it says whether an answer is right, and is not seen
  [[nodiscard]] Act act(double now, const ExerciseView& view, const std::optional<Observation>& felt,
                        const std::optional<int>& object);

 private:
  [[nodiscard]] ParticipantTarget target_of(const ExerciseView& view, const std::optional<int>& object) const;
  [[nodiscard]] JointArray touching(const std::array<bool, kDigits>& digits) const;
  void number(ParticipantTarget& target, const ExerciseView& view);

  const ExerciseDescription exercise_;
  ParticipantHand hand_;
  JointArray opened_{};  ///< as far as possible, with the abduction of the open hand [rad]
  std::array<JointArray, kDigits>
      opposition_{};  ///< posture in which the thumb's pad is nearest each finger's pad [rad]
  SimulatedParticipant participant_;
  ExercisePhase phase_ = ExercisePhase::kReady;
  int trial_ = 0;
  ExerciseTarget::Kind kind_ = ExerciseTarget::Kind::kNone;
  std::array<bool, kDigits> digits_{};
  std::optional<ExerciseInput::Kind> asks_ = {};
  int presses_ = 0;  ///< explorations since the newest answer
  std::uint64_t number_ = 0;
  std::uint64_t followed_ = 0;  ///< number of the target that it follows
  double follows_since_ = 0.0;  ///< [s]
};

}  // namespace phalanx

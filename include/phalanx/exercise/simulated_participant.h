// SPDX-License-Identifier: Apache-2.0
// A simulated participant: follows targets and answers questions, with seeded human errors. For
// tests and demonstrations.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "phalanx/core/random.h"
#include "phalanx/exercise/participant_skill.h"
#include "phalanx/hand/joints.h"

namespace phalanx {

/// What a participant is asked to do now.
struct ParticipantTarget {
  enum class Kind : std::uint8_t {
    kRest,     ///< the open hand, relaxed
    kAngles,   ///< the joints of `digits` go to `angle`; a target that moves is followed
    kForce,    ///< each of `digits` presses with `force`
    kDepth,    ///< `digits` press until the felt depth (force over stiffness) reaches `depth`, and hold
    kSofter,   ///< answer: which of the last two sponges was softer, 0 or 1
    kObject,   ///< answer: the number of the object in the hand
    kPain,     ///< answer: 0 .. 10
    kFatigue,  ///< answer: 0 .. 10
  };
  Kind kind = Kind::kRest;
  std::uint64_t number =
      0;  ///< another number: a new target, to which the participant reacts after its reaction time
  std::array<bool, kDigits> digits{};
  JointArray angle{};                   ///< [rad]
  std::array<double, kDigits> force{};  ///< [N]
  double depth = 0.0;                   ///< [m]
  int sponge = -1;  ///< 0 or 1: what is felt now belongs to the first or second sponge; -1: to none
  int options = 2;  ///< of kObject: number of objects
  int truth = -1;   ///< of kObject: the object; a host tells it, no participant sees it. -1: it guesses
};

/// What a participant feels.
struct ParticipantFelt {
  std::array<double, kDigits> force{};  ///< sent to each digit [N]
  /// Observation::sent_stiffness; NaN where it is not known [N/m]
  std::array<double, kDigits> stiffness{};
};

/// What a participant does.
struct ParticipantAction {
  JointArray angle{};         ///< of the hand [rad]
  std::optional<int> answer;  ///< once for each question
};

/// Hand of a simulated participant.
struct ParticipantHand {
  JointArray least{};   ///< range of motion [rad]
  JointArray most{};    ///< range of motion [rad]
  JointArray open{};    ///< relaxed, open hand [rad]
  JointArray closed{};  ///< fist: each digit's curl goes from `open` (0) to `closed` (1) [rad]
};

/// Simulated participant. It knows no clock: the same seed, targets and felt forces at the same times give
/// the same actions. It allocates only when constructed.
class SimulatedParticipant {
 public:
  /// @throws std::invalid_argument for a skill that check_skill() refuses, or a hand with an angle that is
  /// not finite or an empty range
  SimulatedParticipant(const ParticipantHand& hand, const ParticipantSkill& skill, std::uint64_t seed);

  /// Advances to time `now`. A time that does not increase changes nothing; a step of more than 0.1 s counts
  /// as 0.1 s of movement. Forces that are not finite count as 0.
  /// @param now  [s]
  [[nodiscard]] ParticipantAction step(double now, const ParticipantTarget& target,
                                       const ParticipantFelt& felt);

  /// @returns the used share of the reserve of force, 0 .. 1: forces and speed decrease with it
  [[nodiscard]] double fatigue() const noexcept { return fatigue_; }
  [[nodiscard]] const ParticipantSkill& skill() const noexcept { return skill_; }
  /// Rests between two sessions: fatigue is gone, and abilities may have changed. @throws as the constructor
  void new_session(const ParticipantSkill& skill);

 private:
  /// A moment of what was asked and felt: a participant acts on moments that are past.
  struct Moment {
    double time = 0.0;
    ParticipantTarget target;
    std::array<double, kDigits> force{};  ///< [N]
    std::array<double, kDigits> depth{};  ///< force over stiffness; 0: not felt [m]
  };

  [[nodiscard]] const Moment* moment_before(double time) const noexcept;
  void notice(double now, const ParticipantTarget& target, const ParticipantFelt& felt);
  void begin(const ParticipantTarget& target);
  void move(double dt, const ParticipantTarget& target);
  void press(double dt, const ParticipantTarget& target, const Moment& felt, const ParticipantFelt& present);
  void bend(double dt, int digit);
  void tire(double dt, const ParticipantFelt& felt) noexcept;
  [[nodiscard]] double closure(int joint, double angle) const noexcept;
  [[nodiscard]] double able(int joint, double angle) const noexcept;
  [[nodiscard]] int answer(const ParticipantTarget& target);
  [[nodiscard]] JointArray shown(double dt);

  ParticipantHand hand_;
  ParticipantSkill skill_;
  Random random_;

  bool begun_ = false;
  double now_ = 0.0;
  std::vector<Moment> moments_;  ///< ring of the last two seconds
  std::size_t newest_ = 0;
  std::size_t kept_ = 0;
  double delay_ = 0.0;                 ///< from the present target to the reaction [s]
  std::uint64_t asked_ = 0;            ///< number of the newest target
  ParticipantTarget acts_on_;          ///< target that it has noticed
  double acted_at_ = 0.0;              ///< time of the moment that it acts on [s]
  bool acts_ = false;                  ///< it has noticed a target
  bool answered_ = false;              ///< the question that it has noticed
  std::array<bool, kDigits> moves_{};  ///< digits that it believes to be instructed

  JointArray angle_{};                   ///< without tremor [rad]
  JointArray speed_{};                   ///< [rad/s]
  JointArray output_{};                  ///< last action [rad]
  JointArray offset_{};                  ///< of a pressing digit's joint from its curl, decaying [rad]
  std::array<bool, kDigits> presses_{};  ///< the digit's angles follow from `curl_`
  std::array<double, kDigits> curl_{};   ///< 0 open, 1 closed
  std::array<double, kDigits> noise_{};  ///< of the intended force [-]
  std::array<double, kDigits> phase_{};  ///< of the tremor [rad]
  std::array<double, 2> felt_log_{};     ///< sums of the logarithms of felt stiffnesses, of each sponge
  std::array<double, 2> felt_count_{};
  double fatigue_ = 0.0;
};

}  // namespace phalanx

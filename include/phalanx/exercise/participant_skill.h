// SPDX-License-Identifier: Apache-2.0
// Abilities of a simulated participant, and the presets that --demo knows.
#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "phalanx/core/random.h"

namespace phalanx {

/// Abilities of a simulated participant. The default is a healthy adult. docs/exercises.md, "Simulated
/// participant", has equations and sources.
struct ParticipantSkill {
  double reaction_time = 0.25;     ///< mean, from a new target to the first movement [s]
  double reaction_sd = 0.04;       ///< its standard deviation; drawn for each target [s]
  double movement_time = 0.35;     ///< time constant's scale: a step of the target is 90 % done after it [s]
  double strength = 30.0;          ///< largest force of a digit without fatigue [N]
  double tremor = 0.003;           ///< amplitude in each digit's flexion, as a share of its range [-]
  double tremor_hz = 9.0;          ///< [Hz]
  double force_noise = 0.03;       ///< standard deviation of the intended force over that force [-]
  double enslaving = 0.05;         ///< flexion of a neighbour over that of an instructed digit [-]
  double extension_deficit = 0.0;  ///< share of the range that is missing at the open end, 0 .. 1 [-]
  double flexion_deficit = 0.0;    ///< likewise at the closed end; together with it < 1 [-]
  double fatigue_time = 600.0;     ///< effort at full force after which all reserve is used [s]
  double recovery_time = 300.0;    ///< time constant of the recovery at rest [s]
  double mistakes = 0.01;    ///< probability that a target is misunderstood: another digit moves, or none [-]
  double lapses = 0.02;      ///< probability that an answer is a guess [-]
  double weber = 0.15;       ///< stiffness discrimination threshold (StiffnessThreshold::weber) [-]
  double slope = 1.0;        ///< exponent of the psychometric function; 1: as the assessment assumes [-]
  double recognition = 0.9;  ///< probability that an object in the hand is recognised [-]
  double pain = 0.0;         ///< that it states when asked, without effort, 0 .. 10
};

/// @throws std::invalid_argument naming the number, its value and the range
void check_skill(const ParticipantSkill& skill);

/// Names of the presets: "healthy", "mild", "moderate", "severe", "tremor", "weak".
[[nodiscard]] std::array<std::string_view, 6> participant_skill_names() noexcept;
[[nodiscard]] std::optional<ParticipantSkill> find_participant_skill(std::string_view name);

/// Returns abilities between two: share 0 is `from`, 1 is `to`. Times and thresholds are interpolated
/// geometrically, all else linearly. For a patient who recovers from session to session.
[[nodiscard]] ParticipantSkill between_skills(const ParticipantSkill& from, const ParticipantSkill& to,
                                              double share);

/// Returns a judgement of a pair: true if the first of two sponges is called softer.
///   P = lapses / 2 + (1 - lapses) Phi(sign(r) (|r| / theta)^slope),  r = ln(second / first),  theta = ln(1 + weber)
/// @param first, second  felt stiffnesses [N/m]; if one is not above 0, the answer is a guess
[[nodiscard]] bool calls_first_softer(const ParticipantSkill& skill, double first, double second,
                                      Random& random);

}  // namespace phalanx

// SPDX-License-Identifier: Apache-2.0
#include "phalanx/exercise/participant_skill.h"

#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <stdexcept>

#include "exercise/distributions.h"
#include "phalanx/core/number_range.h"

namespace phalanx {
namespace {

/// One number of a skill: its name and range, and how it is interpolated.
struct SkillNumber {
  const char* name;
  double ParticipantSkill::* value;
  NumberRange range;
  bool geometric;  ///< interpolated geometrically; its range is above 0
};

constexpr std::array kSkillNumbers{
    SkillNumber{"reaction_time", &ParticipantSkill::reaction_time, between(0.1, 1.5), true},
    SkillNumber{"reaction_sd", &ParticipantSkill::reaction_sd, between(0.0, 0.5), false},
    SkillNumber{"movement_time", &ParticipantSkill::movement_time, between(0.1, 5.0), true},
    SkillNumber{"strength", &ParticipantSkill::strength, above(0.0, 200.0), true},
    SkillNumber{"tremor", &ParticipantSkill::tremor, between(0.0, 0.2), false},
    SkillNumber{"tremor_hz", &ParticipantSkill::tremor_hz, between(1.0, 15.0), true},
    SkillNumber{"force_noise", &ParticipantSkill::force_noise, between(0.0, 1.0), false},
    SkillNumber{"enslaving", &ParticipantSkill::enslaving, between(0.0, 1.0), false},
    SkillNumber{"extension_deficit", &ParticipantSkill::extension_deficit, between(0.0, 0.95), false},
    SkillNumber{"flexion_deficit", &ParticipantSkill::flexion_deficit, between(0.0, 0.95), false},
    SkillNumber{"fatigue_time", &ParticipantSkill::fatigue_time, between(1.0, 1e6), true},
    SkillNumber{"recovery_time", &ParticipantSkill::recovery_time, between(1.0, 1e6), true},
    SkillNumber{"mistakes", &ParticipantSkill::mistakes, between(0.0, 1.0), false},
    SkillNumber{"lapses", &ParticipantSkill::lapses, between(0.0, 1.0), false},
    SkillNumber{"weber", &ParticipantSkill::weber, above(0.0, 100.0), true},
    SkillNumber{"slope", &ParticipantSkill::slope, between(0.1, 10.0), true},
    SkillNumber{"recognition", &ParticipantSkill::recognition, between(0.0, 1.0), false},
    SkillNumber{"pain", &ParticipantSkill::pain, between(0.0, 10.0), false},
};

constexpr std::array<std::string_view, 6> kSkillNames{"healthy", "mild",   "moderate",
                                                      "severe",  "tremor", "weak"};

constexpr ParticipantSkill kSevere{.reaction_time = 0.7,
                                   .reaction_sd = 0.2,
                                   .movement_time = 1.5,
                                   .strength = 3.0,
                                   .tremor = 0.01,
                                   .tremor_hz = 7.0,
                                   .force_noise = 0.2,
                                   .enslaving = 0.5,
                                   .extension_deficit = 0.3,
                                   .flexion_deficit = 0.3,
                                   .fatigue_time = 90.0,
                                   .recovery_time = 240.0,
                                   .mistakes = 0.1,
                                   .lapses = 0.1,
                                   .weber = 0.8,
                                   .slope = 1.0,
                                   .recognition = 0.4,
                                   .pain = 2.0};

}  // namespace

void check_skill(const ParticipantSkill& skill) {
  for (const SkillNumber& number : kSkillNumbers) {
    if (number.range.contains(skill.*number.value)) continue;
    throw std::invalid_argument(fmt::format("simulated participant: {} = {}; give a number {}", number.name,
                                            skill.*number.value, number.range.text()));
  }
  if (skill.extension_deficit + skill.flexion_deficit > 0.95) {
    throw std::invalid_argument(
        fmt::format("simulated participant: extension_deficit {} and flexion_deficit {} leave no range; give "
                    "numbers whose sum is at most 0.95",
                    skill.extension_deficit, skill.flexion_deficit));
  }
}

std::array<std::string_view, 6> participant_skill_names() noexcept { return kSkillNames; }

std::optional<ParticipantSkill> find_participant_skill(std::string_view name) {
  const ParticipantSkill healthy;
  if (name == "healthy") return healthy;
  if (name == "mild") return between_skills(healthy, kSevere, 0.33);
  if (name == "moderate") return between_skills(healthy, kSevere, 0.67);
  if (name == "severe") return kSevere;
  ParticipantSkill skill = healthy;
  if (name == "tremor") {
    skill.tremor = 0.04;
    skill.tremor_hz = 5.0;
    skill.force_noise = 0.15;
    return skill;
  }
  if (name == "weak") {
    skill.strength = 2.0;
    skill.fatigue_time = 60.0;
    return skill;
  }
  return std::nullopt;
}

ParticipantSkill between_skills(const ParticipantSkill& from, const ParticipantSkill& to, double share) {
  ParticipantSkill out;
  for (const SkillNumber& number : kSkillNumbers) {
    const double a = from.*number.value;
    const double b = to.*number.value;
    out.*number.value = number.geometric ? a * std::pow(b / a, share) : a + share * (b - a);
  }
  return out;
}

bool calls_first_softer(const ParticipantSkill& skill, double first, double second, Random& random) {
  const double lapse = random.uniform();
  const double choice = random.uniform();
  if (lapse < skill.lapses || !(first > 0.0) || !(second > 0.0)) return choice < 0.5;
  const double difference = std::log(second / first);
  const double size = std::pow(std::abs(difference) / std::log1p(skill.weber), skill.slope);
  return choice < normal_probability(std::copysign(size, difference));
}

}  // namespace phalanx

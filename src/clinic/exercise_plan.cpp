// SPDX-License-Identifier: Apache-2.0
#include "phalanx/clinic/exercise_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <random>
#include <stdexcept>
#include <utility>

#include "phalanx/clinic/exercise_limits.h"
#include "phalanx/clinic/exercise_participant.h"
#include "phalanx/clinic/exercise_patient.h"
#include "phalanx/core/index.h"
#include "phalanx/scene/exercise_file.h"
#include "phalanx/scene/scene_file.h"
#include "phalanx/station/safety_settings.h"
#include "phalanx/step/haptic_step.h"

namespace phalanx {
namespace {

constexpr std::uint64_t kLargestSeed = 1'000'000'000;  // a seed that a person can type again

std::uint64_t drawn_seed() {
  std::random_device source;
  return source() % kLargestSeed;
}

/// @returns the overrides for the patient's hand
Overrides hand_of(const Patient& patient) {
  if (patient.profile.empty()) return {{"hand.side", toml_string(std::string(side_name(patient.side)))}};
  return {{"hand.profile", toml_string(patient.profile)}};
}

/// Takes the patient's limits, dose and files.
void take_patient(const KnownPatient& known, const PlannedStation& station, ExercisePlan& plan) {
  const Patient& patient = known.patient;
  const bool own = is_own_simulation(station.device);
  // A device on a wire that is not open yet states later whether it is simulated.
  const bool simulated =
      plan.start.simulated || (!own && !station.simulated.has_value() && is_simulated(patient));
  refuse_patient(patient, plan.start.exercise, simulated, known.today);
  plan.start.exercise = exercise_of(patient, std::move(plan.start.exercise));
  plan.start.person = person_of(patient, plan.start.exercise, known.results, known.today);
  plan.start.record = patient.record;
  const Overrides hand = hand_of(patient);
  plan.overrides.insert(plan.overrides.end(), hand.begin(), hand.end());
  if (own) return;
  plan.calibration = patient.calibration;
  if (!plan.calibration.empty()) plan.range = patient.range;
}

/// What is assumed of a person who has no measured force and range: those of the simulated participant.
PersonLimits assumed_person(PersonLimits person, const HandParameters& hand, const ParticipantSkill& skill) {
  for (int d = 0; d < kDigits; ++d)
    if (!person.own_force[idx(d)]) person.own_force[idx(d)] = std::min(skill.strength, person.force_cap);
  for (std::size_t j = 0; j < kJoints; ++j) {
    const double closed = hand.closed_angle[j].value_or(hand.max_angle[j]);
    const double range = closed - hand.open_angle[j];
    if (!person.own_range[j] && range > 0.0)
      person.own_range[j] = OwnRange{.min = hand.open_angle[j] + skill.extension_deficit * range,
                                     .max = closed - skill.flexion_deficit * range};
  }
  return person;
}

}  // namespace

bool is_own_simulation(const std::string& device) { return device == "simulated" || device == "sliders"; }

ExercisePlan plan_exercise(const ExerciseWish& wish, const PlannedStation& station,
                           const KnownPatient* known) {
  ExercisePlan plan;
  const bool own = is_own_simulation(station.device);
  plan.start.exercise = load_exercise(wish.exercise);
  plan.start.seed = wish.seed ? *wish.seed : drawn_seed();
  plan.start.simulated = !wish.demo.empty() || own || station.simulated.value_or(false);
  if (!wish.demo.empty()) {
    plan.skill = demo_skill(wish.demo);
    plan.assume_person = known == nullptr;
  }
  if (known != nullptr) take_patient(*known, station, plan);
  plan.overrides.insert(plan.overrides.end(), station.overrides.begin(), station.overrides.end());
  if (!station.clinician.empty())
    plan.start.person.force_cap = std::min(
        kForceWithClinician,
        known != nullptr ? known->patient.force_limit_n.value_or(kForceWithClinician) : kForceWithClinician);
  const std::string& scene = plan.start.exercise.scene;
  const KnownStability stability = {.stated = station.stable_stiffness,
                                    .sliders = station.sliders || !wish.demo.empty(),
                                    .simulated = station.device == "simulated"};
  plan.start.person.stable_stiffness = stable_stiffness(stability, load_scene(scene, plan.overrides));
  const Overrides lowered = lowered_limits(scene, plan.overrides, plan.start.exercise, plan.start.person);
  plan.overrides.insert(plan.overrides.end(), lowered.begin(), lowered.end());
  plan.start.person = within_scene(plan.start.person, load_scene(scene, plan.overrides), plan.start.exercise);
  if (!plan.assume_person) check_person(plan.start.exercise, plan.start.person);
  return plan;
}

ExerciseStart start_on(const ExercisePlan& plan, const SessionInfo& info) {
  ExerciseStart start = plan.start;
  start.person.felt = felt_digits(info);
  // A simulated device's own values are exact; those of a real one are nominal.
  start.person.calibration_independent = info.device.simulated || !info.calibration.empty();
  start.simulated = start.simulated || info.device.simulated;
  start.conditions =
      conditions_of(info, plan.methods ? *plan.methods : methods_of_calibration(info.calibration));
  if (plan.assume_person && plan.skill)
    start.person = assumed_person(start.person, info.geometry->model->hand.parameters(), *plan.skill);
  if (std::string protocol = assessment_protocol(start.exercise, start.person, info.values);
      !protocol.empty())
    start.conditions["protocol"] = std::move(protocol);
  return start;
}

void refuse_on_station(const KnownPatient& known, const ExercisePlan& plan, const SessionInfo& info) {
  refuse_patient(known.patient, plan.start.exercise, plan.skill.has_value() || info.device.simulated,
                 known.today);
  refuse_other_hand(known.patient, info.geometry->handedness);
}

void refuse_other_code(const Patient& patient, const std::string& typed) {
  if (typed == patient.code) return;
  throw std::invalid_argument(
      fmt::format("'{}' is not the code of patient {}; no exercise begins", typed, patient.code));
}

}  // namespace phalanx

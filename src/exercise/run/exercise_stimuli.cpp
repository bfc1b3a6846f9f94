// SPDX-License-Identifier: Apache-2.0
#include "exercise/run/exercise_stimuli.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "exercise/run/exercise_trial.h"
#include "phalanx/core/index.h"
#include "phalanx/exercise/reasons.h"

namespace phalanx {
namespace {

constexpr double kNPerMm = 1e-3;  ///< [N/mm] over [N/m]

DiscriminationSettings discrimination_settings(const ExerciseDescription& exercise,
                                               const PersonLimits& person) {
  DiscriminationSettings settings;
  settings.trials = exercise.trials;
  settings.presentations = exercise.trials + exercise.trials / 2;
  settings.softest = exercise.feel.softest;
  settings.stiffest =
      std::min({exercise.feel.stiffest, person.stiffness_cap,
                person.stable_stiffness.value_or(0.0),  // check_person() refuses an unknown one
                exercise.limits.stiffness.value_or(exercise.feel.stiffest)});
  settings.largest_force = std::min({exercise.feel.largest_force, kReachableForce * person.force_cap,
                                     exercise.limits.force.value_or(exercise.feel.largest_force)});
  settings.deep = exercise.feel.deep;
  return settings;
}

Score stimulus_score(std::string name, std::string unit, double value, std::string invalid = {}) {
  if (!std::isfinite(value)) value = 0.0;
  return {.name = std::move(name),
          .unit = std::move(unit),
          .value = invalid.empty() ? value : 0.0,
          .origin = ScoreOrigin::kRendered,
          .invalid = std::move(invalid)};
}

/// Verdict on one press, and the reason in words.
struct PressVerdict {
  PairVerdict verdict = PairVerdict::kCounted;
  std::string reason = {};
};

PressVerdict press_verdict(const std::optional<SentStiffness>& press) {
  if (!press || !std::isfinite(press->mean()))
    return {.verdict = PairVerdict::kSentNotKnown, .reason = reason_text<Reason::kNoStiffnessWhilePressed>()};
  std::string reason = press->reason();
  if (reason.empty()) return {};
  // A fault, a ramp and a short press come before a stiffness that differs.
  const bool differs = press->differs() && reason.find("samples were not within") != std::string::npos;
  return {.verdict = differs ? PairVerdict::kSentDiffers : PairVerdict::kPressInvalid,
          .reason = std::move(reason)};
}

}  // namespace

ExerciseStimuli::ExerciseStimuli(const ExerciseDescription& exercise, const PersonLimits& person,
                                 std::uint64_t seed)
    : digits_(exercise.digits) {
  try {
    if (exercise.measure == ExerciseMeasure::kFeelAndFind) {
      discrimination_.emplace(discrimination_settings(exercise, person), seed);
      choices_ = {"the first", "the second"};
      planned_ = exercise.trials;
    } else {
      identification_.emplace(static_cast<int>(exercise.objects.size()), exercise.trials, seed);
      for (const ObjectChoice& object : exercise.objects) choices_.push_back(object.title);
      planned_ = exercise.trials * static_cast<int>(exercise.objects.size());
    }
  } catch (const std::invalid_argument& error) {
    throw ExerciseError(fmt::format("{}: {}", exercise.name, error.what()));
  }
}

bool ExerciseStimuli::finished() const {
  return discrimination_ ? discrimination_->finished() : identification_->finished();
}

std::optional<double> ExerciseStimuli::stiffness(int part) const {
  if (!discrimination_) return std::nullopt;
  const auto pair = discrimination_->pair();
  return pair ? std::optional(pair->stiffness[idx(part)]) : std::nullopt;
}

double ExerciseStimuli::depth(int part) const {
  if (!discrimination_) return 0.0;
  const auto pair = discrimination_->pair();
  return pair ? pair->end_position[idx(part)] : 0.0;
}

std::optional<int> ExerciseStimuli::object() const {
  return identification_ ? identification_->object() : std::nullopt;
}

void ExerciseStimuli::begin(int part) {
  part_ = part;
  if (part == 0) sent_ = {};
  if (const auto commanded = stiffness(part)) sent_[idx(part)].emplace(*commanded, digits_);
}

bool ExerciseStimuli::add(const Observation& observation) {
  std::optional<SentStiffness>& sent = sent_[idx(part_)];
  if (!sent) return false;
  sent->add(observation);
  return sent->deepest() >= depth(part_);
}

ExerciseTrial ExerciseStimuli::answer(int choice) {
  ExerciseTrial trial = discrimination_ ? answer_pair(choice) : answer_object(choice);
  trial.number = number_++;
  return trial;
}

std::array<double, 2> ExerciseStimuli::sent_means() const {
  std::array<double, 2> sent = {std::numeric_limits<double>::quiet_NaN(),
                                std::numeric_limits<double>::quiet_NaN()};
  for (std::size_t part = 0; part < 2; ++part)
    if (sent_[part]) sent[part] = sent_[part]->mean();
  return sent;
}

std::vector<Score> ExerciseStimuli::pair_scores() const {
  std::vector<Score> scores;
  const std::array<double, 2> sent = sent_means();
  for (int part = 0; part < 2; ++part) {
    const char* which = part == 0 ? "first" : "second";
    scores.push_back(stimulus_score(fmt::format("commanded_{}_n_per_mm", which), "N/mm",
                                    stiffness(part).value_or(0.0) * kNPerMm));
    const bool known = std::isfinite(sent[idx(part)]);
    scores.push_back(stimulus_score(fmt::format("sent_{}_n_per_mm", which), "N/mm", sent[idx(part)] * kNPerMm,
                                    known ? std::string() : reason_text<Reason::kNoStiffness>()));
  }
  return scores;
}

ExerciseTrial ExerciseStimuli::answer_pair(int choice) {
  ExerciseTrial trial;
  trial.condition = fmt::format("pair {}", number_);
  trial.scores = pair_scores();
  trial.scores.push_back(stimulus_score("answer", "-", choice));
  const PressVerdict first = press_verdict(sent_[0]);
  const PressVerdict second = press_verdict(sent_[1]);
  const PressVerdict& worst = first.verdict != PairVerdict::kCounted ? first : second;
  const PairVerdict verdict = discrimination_->answer(choice - 1, sent_means(), worst.verdict);
  if (verdict == PairVerdict::kCounted) return trial;
  const std::string reason =
      worst.reason.empty() ? reason_text<Reason::kSentStiffnessDiffers>() : worst.reason;
  trial.invalid = reason_text<Reason::kNotCounted>(reason);
  return trial;
}

ExerciseTrial ExerciseStimuli::answer_object(int choice) {
  ExerciseTrial trial;
  const int shown = identification_->object().value_or(0);
  trial.condition = choices_[idx(shown)];
  trial.scores.push_back(stimulus_score("answer", "-", choice));
  trial.scores.push_back(stimulus_score("right", "-", choice - 1 == shown ? 1.0 : 0.0));
  identification_->answer(choice - 1);
  return trial;
}

ExerciseTrial ExerciseStimuli::skip(const std::string& reason) {
  ExerciseTrial trial;
  trial.number = number_++;
  trial.condition = discrimination_ ? fmt::format("pair {}", trial.number)
                                    : choices_[idx(identification_->object().value_or(0))];
  trial.invalid = reason;
  if (discrimination_) {
    trial.scores = pair_scores();
    discrimination_->skip(sent_means());
  } else {
    identification_->discard();
  }
  sent_ = {};
  return trial;
}

std::vector<Score> ExerciseStimuli::scores() const {
  return discrimination_ ? threshold_scores(discrimination_->threshold())
                         : identification_scores(identification_->result());
}

}  // namespace phalanx

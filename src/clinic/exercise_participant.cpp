// SPDX-License-Identifier: Apache-2.0
#include "phalanx/clinic/exercise_participant.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string_view>
#include <system_error>

#include "phalanx/core/constants.h"
#include "phalanx/core/index.h"
#include "phalanx/core/random.h"
#include "phalanx/hand/pad.h"

namespace phalanx {
namespace {

constexpr double kSqueeze =
    4.5;  // force of a squeeze as strongly as comfortable, below the limit without a clinician [N]
constexpr double kExploreDepth = 7e-3;  // beyond each end position, at which the instruction is to stop [m]
constexpr double kExploreSpeed = 4e-3;  // "press slowly" [m/s]
constexpr double kBeyondGrasp = 1.6;  // closed hand of a pinch: so many times the way from open to the grasp
constexpr int kPostures = 4000;       // postures that are compared for the opposition of one finger
constexpr std::uint64_t kPostureSeed = 1;

ParticipantHand participant_hand(const HandParameters& hand) {
  ParticipantHand out{.least = hand.min_angle, .most = hand.max_angle, .open = hand.open_angle, .closed = {}};
  for (std::size_t j = 0; j < kJoints; ++j) out.closed[j] = hand.closed_angle[j].value_or(hand.max_angle[j]);
  return out;
}

/// @returns the hand whose thumb and pinching fingers close through a grasp. A fist's thumb passes beside the object, or
/// slides off it.
ParticipantHand pinching(ParticipantHand hand, const ExerciseDescription& exercise,
                         const std::optional<JointArray>& grasp) {
  if (exercise.measure != ExerciseMeasure::kPinch || !grasp) return hand;
  for (int joint = 0; joint < kJoints; ++joint) {
    const auto j = idx(joint);
    const int digit = digit_of_joint(joint);
    if (digit != 0 && !exercise.digits[idx(digit)]) continue;
    hand.closed[j] =
        std::clamp(hand.open[j] + kBeyondGrasp * ((*grasp)[j] - hand.open[j]), hand.least[j], hand.most[j]);
  }
  return hand;
}

/// Finds the posture in which the thumb's pad is nearest the finger's: drawn postures first, then smaller and smaller steps.
JointArray opposition_posture(const HandModel& hand, int finger) {
  const HandParameters& numbers = hand.parameters();
  Random random(kPostureSeed);
  JointArray best = numbers.open_angle;
  const auto distance = [&](const JointArray& angle) {
    return (pad_at(hand, 0, digit_angles(angle, 0)) - pad_at(hand, finger, digit_angles(angle, finger)))
        .norm();
  };
  double least = distance(best);
  for (int i = 0; i < kPostures; ++i) {
    const double width = i < kPostures / 4 ? 1.0 : std::pow(0.997, i - kPostures / 4);  // of the range
    JointArray angle = best;
    for (const int digit : {0, finger})
      for (int k = 0; k < kJointsPerDigit; ++k) {
        const std::size_t j = idx(joint_index(digit, k));
        const double range = numbers.max_angle[j] - numbers.min_angle[j];
        angle[j] = std::clamp(angle[j] + width * range * (random.uniform() - 0.5), numbers.min_angle[j],
                              numbers.max_angle[j]);
      }
    if (const double found = distance(angle); found < least) {
      least = found;
      best = angle;
    }
  }
  return best;
}

}  // namespace

ParticipantSkill demo_skill(const std::string& text) {
  if (const auto preset = find_participant_skill(text)) return *preset;
  try {
    std::size_t read = 0;
    const double share = std::stod(text, &read);
    if (read == text.size() && share >= 0.0 && share <= 1.0)
      return between_skills(*find_participant_skill("severe"), *find_participant_skill("healthy"), share);
  } catch (const std::logic_error&) {  // no number
  }
  throw std::invalid_argument(
      fmt::format("demo {}: state a number from 0 (severe) to 1 (healthy), or one of {}", text,
                  fmt::join(participant_skill_names(), ", ")));
}

std::optional<JointArray> grasp_posture(const Overrides& values) {
  constexpr std::string_view kPrefix = "motion.angle_deg.";
  JointArray angle{};
  std::array<bool, kJoints> stated{};
  bool posture = false;
  for (const auto& [key, value] : values) {
    if (key == "motion.name") posture = value == "\"posture\"";
    if (!key.starts_with(kPrefix)) continue;
    const auto joint = find_joint(key.substr(kPrefix.size()));
    double degrees = 0.0;
    const char* const end = value.data() + value.size();
    const auto read = std::from_chars(value.data(), end, degrees);
    if (!joint || read.ec != std::errc{} || read.ptr != end || !std::isfinite(degrees)) continue;
    angle[idx(*joint)] = kDeg * degrees;
    stated[idx(*joint)] = true;
  }
  const bool whole = std::all_of(stated.begin(), stated.end(), [](bool known) { return known; });
  return posture && whole ? std::optional(angle) : std::nullopt;
}

ExerciseParticipant::ExerciseParticipant(const HandModel& hand, const ExerciseDescription& exercise,
                                         const ParticipantSkill& skill, std::uint64_t seed,
                                         const std::optional<JointArray>& grasp)
    : exercise_(exercise),
      hand_(pinching(participant_hand(hand.parameters()), exercise, grasp)),
      participant_(hand_, skill, seed) {
  opened_ = hand_.open;
  for (int joint = 0; joint < kJoints; ++joint)
    if (joint % kJointsPerDigit != kAbductionJoint) opened_[idx(joint)] = hand_.least[idx(joint)];
  if (exercise.measure != ExerciseMeasure::kOpposition) return;
  for (int finger = 1; finger < kDigits; ++finger)
    if (exercise.digits[idx(finger)]) opposition_[idx(finger)] = opposition_posture(hand, finger);
}

JointArray ExerciseParticipant::touching(const std::array<bool, kDigits>& digits) const {
  for (int finger = 1; finger < kDigits; ++finger)
    if (digits[idx(finger)]) return opposition_[idx(finger)];
  return hand_.open;
}

/// Numbers the targets: another phase, trial, kind or digit is another target. A target that moves keeps its number.
void ExerciseParticipant::number(ParticipantTarget& target, const ExerciseView& view) {
  const bool other = view.phase != phase_ || view.trial != trial_ || view.target.kind != kind_ ||
                     view.target.digits != digits_ || view.asks != asks_;
  if (other) {
    ++number_;
    if (view.trial != trial_) presses_ = 0;
    if (view.target.kind == ExerciseTarget::Kind::kExplore) ++presses_;
    if (view.phase == ExercisePhase::kAnswer) presses_ = 0;
  }
  phase_ = view.phase;
  trial_ = view.trial;
  kind_ = view.target.kind;
  digits_ = view.target.digits;
  asks_ = view.asks;
  target.number = number_;
}

ParticipantTarget ExerciseParticipant::target_of(const ExerciseView& view,
                                                 const std::optional<int>& object) const {
  ParticipantTarget target;
  target.digits = view.target.digits;
  if (view.asks) {
    target.kind = *view.asks == ExerciseInput::Kind::kPain ? ParticipantTarget::Kind::kPain
                                                           : ParticipantTarget::Kind::kFatigue;
    return target;
  }
  switch (view.target.kind) {
    case ExerciseTarget::Kind::kNone:
      break;
    case ExerciseTarget::Kind::kForce:
      target.kind = ParticipantTarget::Kind::kForce;
      for (int d = 0; d < kDigits; ++d)
        target.force[idx(d)] = std::isfinite(view.target.force[idx(d)]) ? view.target.force[idx(d)] : 0.0;
      break;
    case ExerciseTarget::Kind::kSqueeze:
      target.kind = ParticipantTarget::Kind::kForce;
      target.force.fill(kSqueeze);
      break;
    case ExerciseTarget::Kind::kAngle:
    case ExerciseTarget::Kind::kOpen:
    case ExerciseTarget::Kind::kClose:
    case ExerciseTarget::Kind::kTouch:
      target.kind = ParticipantTarget::Kind::kAngles;
      target.angle = view.target.kind == ExerciseTarget::Kind::kClose   ? hand_.closed
                     : view.target.kind == ExerciseTarget::Kind::kTouch ? touching(view.target.digits)
                                                                        : hand_.open;
      if (view.target.kind == ExerciseTarget::Kind::kTouch) target.digits[0] = true;
      if (view.target.kind == ExerciseTarget::Kind::kOpen) target.angle = opened_;
      if (view.target.kind == ExerciseTarget::Kind::kAngle)
        for (std::size_t j = 0; j < kJoints; ++j)
          if (std::isfinite(view.target.angle[j])) target.angle[j] = view.target.angle[j];
      break;
    case ExerciseTarget::Kind::kExplore:
      target.kind = ParticipantTarget::Kind::kDepth;
      break;
    case ExerciseTarget::Kind::kChoose:
      target.kind = exercise_.measure == ExerciseMeasure::kObjectInHand ? ParticipantTarget::Kind::kObject
                                                                        : ParticipantTarget::Kind::kSofter;
      target.options = std::max(2, static_cast<int>(view.choices.size()));
      target.truth = object.value_or(-1);
      break;
  }
  return target;
}

ExerciseParticipant::Act ExerciseParticipant::act(double now, const ExerciseView& view,
                                                  const std::optional<Observation>& felt,
                                                  const std::optional<int>& object) {
  ParticipantTarget target = target_of(view, object);
  number(target, view);
  if (target.number != followed_) {
    followed_ = target.number;
    follows_since_ = now;
  }
  if (target.kind == ParticipantTarget::Kind::kDepth) {
    target.sponge = std::max(0, presses_ - 1) % 2;
    target.depth = std::min(kExploreDepth, kExploreSpeed * (now - follows_since_));
  }
  ParticipantFelt feels;
  feels.stiffness.fill(std::numeric_limits<double>::quiet_NaN());
  if (felt) {
    feels.force = felt->force;
    feels.stiffness = felt->sent_stiffness;
  }
  const ParticipantAction action = participant_.step(now, target, feels);
  Act out{.angle = action.angle, .input = {}};
  if (action.answer && view.phase == ExercisePhase::kAnswer)
    out.input = ExerciseInput{.kind = ExerciseInput::Kind::kAnswer, .value = *action.answer + 1.0};
  if (action.answer && view.asks)
    out.input = ExerciseInput{.kind = *view.asks, .value = static_cast<double>(*action.answer)};
  return out;
}

}  // namespace phalanx

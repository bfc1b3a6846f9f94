// SPDX-License-Identifier: Apache-2.0
#include "phalanx/exercise/simulated_participant.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <stdexcept>

#include "phalanx/core/constants.h"
#include "phalanx/core/index.h"

namespace phalanx {
namespace {

constexpr std::size_t kMoments = 512;     ///< kept moments
constexpr double kMomentSpacing = 0.004;  ///< at least, between two of them [s]
constexpr double kLongestStep = 0.1;      ///< of movement, however long a step is [s]
constexpr double kFeedbackDelay = 0.08;   ///< of felt forces [s]
constexpr double kTouch = 0.02;           ///< force that is felt as contact [N]
constexpr double kApproach = 0.3;         ///< curl a second towards an object, of a healthy hand [1/s]
constexpr double kPressGain = 2.5;        ///< of the force's and depth's control [1/s]
constexpr double kTravel = 0.09;  ///< way of a pad from open to closed, as the participant expects it [m]
constexpr double kUnknownStiffness = 1600.0;  ///< assumed before one is felt [N/m]
constexpr double kBrake =
    3.0;  ///< the object's force slows the approach from two thirds of the wanted force on
constexpr double kRelease = 3.0;           ///< speed of opening over that of the approach
constexpr double kNoiseTime = 0.2;         ///< correlation time of the intended force [s]
constexpr double kOffsetTime = 0.2;        ///< in which a digit takes the posture of pressing [s]
constexpr double kNinetyPercent = 3.89;    ///< w t at which a critically damped step is 90 % done
constexpr double kHealthyMovement = 0.35;  ///< ParticipantSkill::movement_time of the default [s]
constexpr double kWeakerByFatigue = 0.6;   ///< share of the strength that fatigue takes
constexpr double kSlowerByFatigue = 0.3;   ///< share of the speed that fatigue takes
constexpr double kMovingEffort = 0.1;      ///< of a free movement at 2 rad/s

bool is_question(ParticipantTarget::Kind kind) noexcept {
  return kind == ParticipantTarget::Kind::kSofter || kind == ParticipantTarget::Kind::kObject ||
         kind == ParticipantTarget::Kind::kPain || kind == ParticipantTarget::Kind::kFatigue;
}

bool is_press(ParticipantTarget::Kind kind) noexcept {
  return kind == ParticipantTarget::Kind::kForce || kind == ParticipantTarget::Kind::kDepth;
}

double finite_or(double value, double otherwise) noexcept { return std::isfinite(value) ? value : otherwise; }

void check_hand(const ParticipantHand& hand) {
  for (int joint = 0; joint < kJoints; ++joint) {
    const auto j = idx(joint);
    const bool finite = std::isfinite(hand.least[j]) && std::isfinite(hand.most[j]) &&
                        std::isfinite(hand.open[j]) && std::isfinite(hand.closed[j]);
    if (!finite || hand.least[j] > hand.most[j]) {
      throw std::invalid_argument(fmt::format(
          "simulated participant: {}: range {} to {} rad, open {}, closed {}; give finite angles and a "
          "range whose end is not below its begin",
          joint_name(joint), hand.least[j], hand.most[j], hand.open[j], hand.closed[j]));
    }
  }
}

}  // namespace

SimulatedParticipant::SimulatedParticipant(const ParticipantHand& hand, const ParticipantSkill& skill,
                                           std::uint64_t seed)
    : hand_(hand), random_(seed), moments_(kMoments) {
  check_hand(hand);
  new_session(skill);
  for (double& phase : phase_) phase = random_.between(0.0, 2.0 * kPi);
  for (int joint = 0; joint < kJoints; ++joint) angle_[idx(joint)] = able(joint, hand_.open[idx(joint)]);
  output_ = angle_;
}

void SimulatedParticipant::new_session(const ParticipantSkill& skill) {
  check_skill(skill);
  skill_ = skill;
  fatigue_ = 0.0;
}

ParticipantAction SimulatedParticipant::step(double now, const ParticipantTarget& target,
                                             const ParticipantFelt& felt) {
  ParticipantAction action{.angle = output_, .answer = {}};
  if (!std::isfinite(now) || (begun_ && now <= now_)) return action;
  const double dt = begun_ ? std::min(now - now_, kLongestStep) : 0.0;
  notice(now, target, felt);
  begun_ = true;
  now_ = now;

  const Moment* asked = moment_before(now - delay_);
  if (asked != nullptr &&
      (!acts_ || asked->time >= acted_at_)) {  // a longer delay brings no older target back
    acted_at_ = asked->time;
    if (!acts_ || asked->target.number != acts_on_.number) begin(asked->target);
    acts_on_ = asked->target;
  }

  const bool presses = acts_ && is_press(acts_on_.kind);
  if (presses) {
    const Moment* past = moment_before(now - kFeedbackDelay);
    press(dt, acts_on_, past != nullptr ? *past : moments_[newest_], felt);
  }
  move(dt, acts_on_);
  tire(dt, felt);
  if (acts_ && is_question(acts_on_.kind) && !answered_) {
    answered_ = true;
    action.answer = answer(acts_on_);
  }
  action.angle = shown(dt);
  return action;
}

const SimulatedParticipant::Moment* SimulatedParticipant::moment_before(double time) const noexcept {
  for (std::size_t back = 0; back < kept_; ++back) {
    const Moment& moment = moments_[(newest_ + kMoments - back) % kMoments];
    if (moment.time <= time) return &moment;
  }
  return nullptr;
}

void SimulatedParticipant::notice(double now, const ParticipantTarget& target, const ParticipantFelt& felt) {
  const bool other = kept_ == 0 || target.number != asked_;
  if (other) {
    asked_ = target.number;
    const double slower = 1.0 + kSlowerByFatigue * fatigue_;
    delay_ = std::max(0.1, slower * (skill_.reaction_time + skill_.reaction_sd * random_.normal()));
    if (target.sponge == 0 || target.sponge == 1) {
      felt_log_[idx(target.sponge)] = 0.0;
      felt_count_[idx(target.sponge)] = 0.0;
    }
    if (target.sponge == 0) felt_count_[1] = felt_log_[1] = 0.0;
  }
  if (other || kept_ == 0 || now - moments_[newest_].time >= kMomentSpacing) {
    newest_ = kept_ == 0 ? 0 : (newest_ + 1) % kMoments;
    kept_ = std::min(kept_ + 1, kMoments);
    Moment& moment = moments_[newest_];
    moment.time = now;
    moment.target = target;
    for (std::size_t d = 0; d < idx(kDigits); ++d) {
      moment.force[d] = std::max(0.0, finite_or(felt.force[d], 0.0));
      const double stiffness = felt.stiffness[d];
      moment.depth[d] = std::isfinite(stiffness) && stiffness > 1.0 ? moment.force[d] / stiffness : 0.0;
    }
  }
  if (target.sponge != 0 && target.sponge != 1) return;
  for (std::size_t d = 0; d < idx(kDigits); ++d) {
    const double stiffness = felt.stiffness[d];
    if (!target.digits[d] || !std::isfinite(stiffness) || stiffness <= 0.0) continue;
    felt_log_[idx(target.sponge)] += std::log(stiffness);
    felt_count_[idx(target.sponge)] += 1.0;
  }
}

void SimulatedParticipant::begin(const ParticipantTarget& target) {
  acts_ = true;
  acts_on_ = target;
  answered_ = false;
  moves_ = target.digits;
  if (random_.uniform() < skill_.mistakes) {  // the digit beside the instructed one moves, or none
    const bool none = random_.uniform() < 0.5;
    for (std::size_t d = 0; d < idx(kDigits); ++d) {
      moves_[d] = !none && target.digits[(d + idx(kDigits) - 1) % idx(kDigits)];
    }
  }
  for (int digit = 0; digit < kDigits; ++digit) {
    const bool presses = is_press(target.kind) && moves_[idx(digit)];
    if (presses && !presses_[idx(digit)]) {  // begins at the curl that is nearest to the present posture
      double along = 0.0;
      double length = 0.0;
      for (int i = 0; i < kJointsPerDigit; ++i) {
        const auto j = idx(joint_index(digit, i));
        const double way = hand_.closed[j] - hand_.open[j];
        along += way * (angle_[j] - hand_.open[j]);
        length += way * way;
      }
      curl_[idx(digit)] = length > 0.0 ? std::clamp(along / length, 0.0, 1.0) : 0.0;
      for (int i = 0; i < kJointsPerDigit; ++i) {
        const auto j = idx(joint_index(digit, i));
        offset_[j] = angle_[j] - hand_.open[j] - curl_[idx(digit)] * (hand_.closed[j] - hand_.open[j]);
      }
    }
    presses_[idx(digit)] = presses;
  }
}

double SimulatedParticipant::able(int joint, double angle) const noexcept {
  const auto j = idx(joint);
  const double range = hand_.most[j] - hand_.least[j];
  double low = hand_.least[j] + skill_.extension_deficit * range;
  double high = hand_.most[j] - skill_.flexion_deficit * range;
  if (joint % kJointsPerDigit == kAbductionJoint) {
    const double left = 1.0 - skill_.flexion_deficit;
    const double open = std::clamp(hand_.open[j], hand_.least[j], hand_.most[j]);
    low = open - left * (open - hand_.least[j]);
    high = open + left * (hand_.most[j] - open);
  }
  return std::clamp(angle, low, std::max(low, high));
}

double SimulatedParticipant::closure(int joint, double angle) const noexcept {
  const double way = hand_.closed[idx(joint)] - hand_.open[idx(joint)];
  return way == 0.0 ? 0.0 : (angle - hand_.open[idx(joint)]) / way;
}

void SimulatedParticipant::move(double dt, const ParticipantTarget& target) {
  const bool to_angles = acts_ && target.kind == ParticipantTarget::Kind::kAngles;
  const double rate = kNinetyPercent / skill_.movement_time *
                      (1.0 - kSlowerByFatigue * fatigue_);  // of the damped step [1/s]
  for (int joint = 0; joint < kJoints; ++joint) {
    const int digit = digit_of_joint(joint);
    const auto j = idx(joint);
    if (presses_[idx(digit)]) continue;
    double wanted = hand_.open[j];
    if (to_angles && moves_[idx(digit)]) {
      wanted = finite_or(target.angle[j], hand_.open[j]);
    } else {  // it follows the instructed digits by the largest of their shares
      double share = 0.0;
      for (int other = 0; other < kDigits; ++other) {
        if (other == digit || !moves_[idx(other)] || !(to_angles || presses_[idx(other)])) continue;
        const auto same = joint_index(other, joint % kJointsPerDigit);
        const double closed = presses_[idx(other)] ? curl_[idx(other)] : closure(same, angle_[idx(same)]);
        const double pulled = skill_.enslaving / std::abs(other - digit) * closed;
        if (std::abs(pulled) > std::abs(share)) share = pulled;
      }
      wanted += share * (hand_.closed[j] - hand_.open[j]);
    }
    wanted = able(joint, wanted);
    const double away = angle_[j] - wanted;
    const double push = speed_[j] + rate * away;
    const double decay = std::exp(-rate * dt);
    angle_[j] = wanted + (away + push * dt) * decay;
    speed_[j] = (push - rate * (away + push * dt)) * decay;
  }
}

void SimulatedParticipant::press(double dt, const ParticipantTarget& target, const Moment& felt,
                                 const ParticipantFelt& present) {
  for (int digit = 0; digit < kDigits; ++digit) {
    const auto d = idx(digit);
    const double decay = std::exp(-dt / kNoiseTime);
    noise_[d] = decay * noise_[d] + std::sqrt(1.0 - decay * decay) * skill_.force_noise * random_.normal();
    if (!presses_[d]) continue;
    const double strength = skill_.strength * (1.0 - kWeakerByFatigue * fatigue_);
    const double stiffness = felt.depth[d] > 0.0 ? felt.force[d] / felt.depth[d] : kUnknownStiffness;
    double wanted = std::max(0.0, finite_or(target.force[d], 0.0));
    if (target.kind == ParticipantTarget::Kind::kDepth) {
      wanted = std::max(0.0, finite_or(target.depth, 0.0)) * stiffness;
    }
    wanted = std::min(wanted, strength) * std::max(0.0, 1.0 + noise_[d]);
    const double approach = kApproach * kHealthyMovement / skill_.movement_time;
    double rate = wanted > 0.0 ? approach : 0.0;
    if (felt.force[d] > kTouch) {  // the felt stiffness says how much curl the missing force needs
      const double missing = (wanted - felt.force[d]) / (stiffness * kTravel);
      rate = std::clamp(kPressGain * missing, -kRelease * approach, approach);
    }
    if (rate > 0.0) {  // muscles of the wanted force are slowed by the object's force, without a delay
      const double against = std::max(0.0, finite_or(present.force[d], 0.0)) / wanted;
      rate *= std::clamp(kBrake * (1.0 - against), 0.0, 1.0);
    }
    curl_[d] = std::clamp(curl_[d] + rate * dt, 0.0, 1.0);
    bend(dt, digit);
  }
}

void SimulatedParticipant::bend(double dt, int digit) {
  const auto d = idx(digit);
  for (int i = 0; i < kJointsPerDigit; ++i) {
    const int joint = joint_index(digit, i);
    const auto j = idx(joint);
    offset_[j] *= std::exp(-dt / kOffsetTime);
    const double before = angle_[j];
    angle_[j] = able(joint, hand_.open[j] + curl_[d] * (hand_.closed[j] - hand_.open[j]) + offset_[j]);
    speed_[j] = dt > 0.0 ? (angle_[j] - before) / dt : 0.0;
  }
}

void SimulatedParticipant::tire(double dt, const ParticipantFelt& felt) noexcept {
  double effort = 0.0;
  for (const double force : felt.force) {
    effort = std::max(effort, std::min(1.0, std::abs(finite_or(force, 0.0)) / skill_.strength));
  }
  double fastest = 0.0;
  for (const double speed : speed_) fastest = std::max(fastest, std::abs(speed));
  effort = std::max(effort, kMovingEffort * std::min(1.0, fastest / 2.0));
  const double change = effort / skill_.fatigue_time - (1.0 - effort) * fatigue_ / skill_.recovery_time;
  fatigue_ = std::clamp(fatigue_ + change * dt, 0.0, 1.0);
}

int SimulatedParticipant::answer(const ParticipantTarget& target) {
  switch (target.kind) {
    case ParticipantTarget::Kind::kSofter: {
      const auto felt = [&](std::size_t sponge) {
        return felt_count_[sponge] > 0.0 ? std::exp(felt_log_[sponge] / felt_count_[sponge]) : 0.0;
      };
      return calls_first_softer(skill_, felt(0), felt(1), random_) ? 0 : 1;
    }
    case ParticipantTarget::Kind::kObject: {
      const int options = std::max(1, target.options);
      const auto one_of = [&](int count) {
        return std::min(count - 1, static_cast<int>(random_.uniform() * count));
      };
      const bool knows = target.truth >= 0 && target.truth < options;
      if (!knows || options == 1 || random_.uniform() < skill_.lapses) return one_of(options);
      if (random_.uniform() < skill_.recognition) return target.truth;
      const int other = one_of(options - 1);
      return other < target.truth ? other : other + 1;
    }
    case ParticipantTarget::Kind::kPain:
      return static_cast<int>(std::lround(std::clamp(skill_.pain + 3.0 * fatigue_, 0.0, 10.0)));
    case ParticipantTarget::Kind::kFatigue:
      return static_cast<int>(std::lround(10.0 * fatigue_));
    case ParticipantTarget::Kind::kRest:
    case ParticipantTarget::Kind::kAngles:
    case ParticipantTarget::Kind::kForce:
    case ParticipantTarget::Kind::kDepth:
      break;
  }
  return 0;
}

JointArray SimulatedParticipant::shown(double dt) {
  for (int digit = 0; digit < kDigits; ++digit) {
    const auto d = idx(digit);
    // The frequency wanders by a tenth, so that digits do not stay in step.
    phase_[d] += 2.0 * kPi * skill_.tremor_hz * dt * (1.0 + 0.1 * random_.normal());
    if (phase_[d] > 2.0 * kPi) phase_[d] -= 2.0 * kPi;
    const double shake = skill_.tremor * std::sin(phase_[d]);
    for (int i = 0; i < kJointsPerDigit; ++i) {
      const int joint = joint_index(digit, i);
      const auto j = idx(joint);
      const double way = i == kAbductionJoint ? 0.0 : hand_.closed[j] - hand_.open[j];
      output_[j] = std::clamp(angle_[j] + shake * way, hand_.least[j], hand_.most[j]);
    }
  }
  return output_;
}

}  // namespace phalanx

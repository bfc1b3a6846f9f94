// SPDX-License-Identifier: Apache-2.0
#include "phalanx/simulation/plant.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <string>

#include "phalanx/core/index.h"
#include "simulation/natural_frequency.h"

namespace phalanx {
namespace {

/// @returns the sliding friction at this speed; at rest the breakaway friction.
double dry_friction(const DryFriction& friction, double speed) noexcept {
  const double coulomb = friction.coulomb;
  if (friction.static_ratio == 1.0) return coulomb;
  if (speed == 0.0) return coulomb * friction.static_ratio;
  const double u = std::abs(speed) / friction.stribeck_speed;
  if (u > 6.0) return coulomb;  // exp(-36) is negligible
  return coulomb * (1.0 + (friction.static_ratio - 1.0) * std::exp(-u * u));
}

double finite_or_0(double value) noexcept { return std::isfinite(value) ? value : 0.0; }

void check_step(double step, const Exoskeleton& exoskeleton, const PatientParameters& patient) {
  if (!(step >= 1e-7 && step <= 1e-3))
    throw std::invalid_argument(fmt::format(
        "integration step = {} s: must be in 1e-7 .. 1e-3; the default is {}", step, Plant::kDefaultStep));
  const FastestFrequency fastest = fastest_frequency(exoskeleton, patient);
  const double frequency = std::sqrt(fastest.square);
  if (!(step * frequency > 1.0)) return;
  const auto joint = std::ranges::find(exoskeleton.joints, fastest.joint, &ExoJoint::joint);
  const double inertia = joint == exoskeleton.joints.end() ? 0.0 : joint->inertia;
  const bool tendon = fastest.motor >= 0;
  const std::string spring = tendon ? "motor " + exoskeleton.motors[idx(fastest.motor)].name
                                    : std::string("the patient's stiffness");
  throw std::invalid_argument(fmt::format(
      "device {}: {} on joint {} (inertia {} kg m^2) has a natural frequency of {:.4g} rad/s, too fast for "
      "the integration step of {} s; make {}the inertia larger, {} softer, or the step at most {:.3g} s",
      exoskeleton.name, spring, joint_name(fastest.joint), inertia, frequency, step,
      tendon ? "the motor's mass or " : "", tendon ? "the tendon" : "the patient", 1.0 / frequency));
}

}  // namespace

Plant::Plant(const Exoskeleton& exoskeleton, const PatientParameters& patient, const JointArray& start,
             double step)
    : step_(step), angle_(start) {
  check_exoskeleton(exoskeleton);
  check_patient(patient);
  check_step(step, exoskeleton, patient);
  for (const ExoJoint& joint : exoskeleton.joints) {
    const auto j = static_cast<std::size_t>(joint.joint);
    if (!std::isfinite(start[j]))
      throw std::invalid_argument(fmt::format("start of {} = {} rad: must be finite; change the value",
                                              joint_name(joint.joint), start[j]));
    joints_.push_back({joint.joint, bodies_.size(), patient.stiffness[j], patient.damping[j], joint.damping});
    bodies_.push_back({.mass = joint.inertia,
                       .damping = joint.damping + patient.damping[j],
                       .friction = joint.friction,
                       .position = start[j]});
  }
  for (const ExoMotor& motor : exoskeleton.motors) {
    Tendon tendon{.rotor = bodies_.size(),
                  .first_arm = arms_.size(),
                  .last_arm = arms_.size(),
                  .stiffness = motor.tendon_stiffness,
                  .damping = motor.tendon_damping,
                  .play = 0.5 * motor.backlash,
                  .pull_only = motor.pull_only,
                  .capstan = motor.sheath.capstan,
                  .lag = motor.lag,
                  .limit = motor.force_limit};
    double wound = 0.0;
    for (const Joint& joint : joints_) {
      const double arm = motor.arm[static_cast<std::size_t>(joint.joint)];
      if (arm == 0.0) continue;
      if (const JointLinkage* linkage = linkage_of(motor, joint.joint)) {
        curves_.push_back({arms_.size(), tendons_.size(), *linkage});
        wound += excursion(*linkage, bodies_[joint.body].position);
      } else {
        wound += arm * bodies_[joint.body].position;
      }
      arms_.push_back({joint.body, arm});
    }
    tendon.last_arm = arms_.size();
    tendons_.push_back(tendon);
    bodies_.push_back(
        {.mass = motor.mass, .damping = motor.damping, .friction = motor.sheath, .position = wound});
  }
  follow_linkages();
  patient_torque_.resize(joints_.size());
  pulled_.resize(joints_.size());
}

/// Takes the moment arms of linkages at the present angles. Around them  e(q) = r q + bend.
void Plant::follow_linkages() noexcept {
  for (const Curve& curve : curves_) tendons_[curve.tendon].bend = 0.0;
  for (const Curve& curve : curves_) {
    Arm& arm = arms_[curve.arm];
    const double q = bodies_[arm.body].position;
    arm.arm = moment_arm(curve.linkage, q);
    tendons_[curve.tendon].bend += excursion(curve.linkage, q) - arm.arm * q;
  }
}

// These three are used only here, on every tendon of every sweep.

inline double Plant::stretch(const Tendon& tendon) const noexcept {
  double s = bodies_[tendon.rotor].position - tendon.bend;
  for (std::size_t a = tendon.first_arm; a < tendon.last_arm; ++a)
    s -= arms_[a].arm * bodies_[arms_[a].body].position;
  return s;
}

inline double Plant::mean_stretch_speed(const Tendon& tendon) const noexcept {
  const auto mean = [&](std::size_t b) { return 0.5 * (bodies_[b].speed + bodies_[b].next_speed); };
  double u = mean(tendon.rotor);
  for (std::size_t a = tendon.first_arm; a < tendon.last_arm; ++a) u -= arms_[a].arm * mean(arms_[a].body);
  return u;
}

inline double Plant::elastic_tension(const Tendon& tendon, double stretch) noexcept {
  if (stretch > tendon.play) return tendon.stiffness * (stretch - tendon.play);
  if (stretch < -tendon.play && !tendon.pull_only) return tendon.stiffness * (stretch + tendon.play);
  return 0.0;
}

/// Computes the forces of a tendon and its motor in this step.
void Plant::pull(Tendon& tendon, double command) noexcept {
  const double wanted = std::clamp(finite_or_0(command), -tendon.limit, tendon.limit);
  tendon.drive = wanted + (tendon.motor_force - wanted) * tendon.half_decay;
  tendon.motor_force = wanted + (tendon.motor_force - wanted) * tendon.half_decay * tendon.half_decay;

  tendon.elastic = elastic_tension(tendon, stretch(tendon));
  const bool never_slack = tendon.play == 0.0 && !tendon.pull_only;
  tendon.active_damping = tendon.elastic != 0.0 || never_slack ? tendon.damping : 0.0;
  tendon.released = false;

  Body& rotor = bodies_[tendon.rotor];
  rotor.drive = tendon.drive - tendon.elastic;
  rotor.drag = rotor.damping + tendon.active_damping;
  const double dry = dry_friction(rotor.friction, rotor.speed);
  const double against = tendon.capstan * std::abs(tendon.elastic);  // the motor pulls: T (exp(mu theta) - 1)
  const double with = against / (1.0 + tendon.capstan);  // the joint pulls: T (1 - exp(-mu theta))
  rotor.holds_winding = dry + (tendon.elastic >= 0.0 ? against : with);
  rotor.holds_unwinding = dry + (tendon.elastic >= 0.0 ? with : against);
  for (std::size_t a = tendon.first_arm; a < tendon.last_arm; ++a) {
    Body& joint = bodies_[arms_[a].body];
    joint.drive += arms_[a].arm * tendon.elastic;
    joint.drag += arms_[a].arm * arms_[a].arm * tendon.active_damping;
  }
}

/// Computes all forces that do not depend on this step's speeds, at the positions in its middle.
void Plant::load(const PlantInput& input, double h, double t) noexcept {
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    const Joint& joint = joints_[i];
    const auto j = static_cast<std::size_t>(joint.joint);
    Body& body = bodies_[joint.body];
    const double intended = input.intended[j] + input.intended_speed[j] * (t + 0.5 * h);
    const double patient =
        joint.stiffness * (intended - body.position) + joint.patient_damping * input.intended_speed[j];
    patient_torque_[i] =
        std::clamp(finite_or_0(patient) + finite_or_0(input.push[j]), -kLargestTorque, kLargestTorque);
    body.drive = patient_torque_[i];
    body.drag = body.damping;
    body.holds_winding = dry_friction(body.friction, body.speed);
    body.holds_unwinding = body.holds_winding;
  }
  for (std::size_t i = 0; i < tendons_.size(); ++i)
    pull(tendons_[i], i < input.motor_force.size() ? input.motor_force[i] : 0.0);
  for (Body& body : bodies_) body.next_speed = body.speed;
}

/// Makes one sweep over the speeds at the end of the step. @returns true if one has changed by more than
/// its last digits.
bool Plant::sweep(double h) noexcept {
  bool changed = false;
  const auto solve = [h, &changed](Body& body, double others) {
    // `others`: force of the tendons' dampers on it beyond its own drag
    const double momentum = body.momentum + h * others;
    body.stopping = std::clamp(momentum, -h * body.holds_unwinding, h * body.holds_winding);
    const double next = (momentum - body.stopping) * body.inverse;
    changed = changed || std::abs(next - body.next_speed) > 1e-9 * std::abs(next);
    body.next_speed = next;
  };
  std::fill(pulled_.begin(), pulled_.end(), 0.0);
  for (const Tendon& tendon : tendons_) {
    Body& rotor = bodies_[tendon.rotor];
    if (tendon.active_damping == 0.0) {
      solve(rotor, 0.0);
      continue;
    }
    const double own = 0.5 * (rotor.speed + rotor.next_speed);
    solve(rotor, tendon.active_damping * (own - mean_stretch_speed(tendon)));
    const double u = mean_stretch_speed(tendon);
    for (std::size_t a = tendon.first_arm; a < tendon.last_arm; ++a) {
      const Body& joint = bodies_[arms_[a].body];
      const double self = arms_[a].arm * 0.5 * (joint.speed + joint.next_speed);
      pulled_[arms_[a].body] += arms_[a].arm * tendon.active_damping * (u + self);
    }
  }
  for (std::size_t b = 0; b < joints_.size(); ++b) solve(bodies_[b], pulled_[b]);
  return changed;
}

/// Removes the forces of pull-only tendons that would push in this step.
/// @returns true if there were any.
bool Plant::release_pushing() noexcept {
  bool any = false;
  for (Tendon& tendon : tendons_) {
    if (!tendon.pull_only || tendon.active_damping == 0.0) continue;
    if (tendon.elastic + tendon.active_damping * mean_stretch_speed(tendon) >= 0.0) continue;
    bodies_[tendon.rotor].drive += tendon.elastic;
    bodies_[tendon.rotor].drag -= tendon.active_damping;
    for (std::size_t a = tendon.first_arm; a < tendon.last_arm; ++a) {
      Body& joint = bodies_[arms_[a].body];
      joint.drive -= arms_[a].arm * tendon.elastic;
      joint.drag -= arms_[a].arm * arms_[a].arm * tendon.active_damping;
    }
    tendon.active_damping = 0.0;
    tendon.released = true;
    any = true;
  }
  return any;
}

/// Solves for the speeds. It ends, because each round but the last releases at least one tendon.
void Plant::solve_speeds(double h) noexcept {
  do {
    for (Body& body : bodies_) {
      body.momentum = body.mass * body.speed + h * body.drive - 0.5 * h * body.drag * body.speed;
      body.inverse = 1.0 / (body.mass + 0.5 * h * body.drag);
    }
    for (int i = 0; i < kMostSweeps && sweep(h); ++i) {
    }
  } while (release_pushing());
}

/// Adds the work of each force of the step: its impulse times the mean speed.
void Plant::book(double h) noexcept {
  EnergyLedger step;  // in registers until the end: each sum waits for the one before
  const auto add = [&step](double& account, double work) {
    account += work;
    step.turned_over += std::abs(work);
  };
  tendon_torque_.fill(0.0);
  for (Tendon& tendon : tendons_) {
    const Body& rotor = bodies_[tendon.rotor];
    const double turned = 0.5 * (rotor.speed + rotor.next_speed);
    add(step.motors, h * tendon.drive * turned);
    add(step.dissipated, h * rotor.damping * turned * turned);
    const double u = mean_stretch_speed(tendon);
    // Released: the damper balances the spring and takes its energy.
    const double damper = tendon.released ? -tendon.elastic : tendon.active_damping * u;
    tendon.tension = tendon.elastic + damper;
    add(step.dissipated, h * damper * u);
    for (std::size_t a = tendon.first_arm; a < tendon.last_arm; ++a)
      tendon_torque_[static_cast<std::size_t>(joints_[arms_[a].body].joint)] += arms_[a].arm * tendon.tension;
  }
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    const Body& body = bodies_[joints_[i].body];
    const double mean = 0.5 * (body.speed + body.next_speed);
    add(step.patient, h * (patient_torque_[i] - joints_[i].patient_damping * mean) * mean);
    add(step.dissipated, h * joints_[i].damping * mean * mean);
  }
  for (const Body& body : bodies_) add(step.dissipated, body.stopping * 0.5 * (body.speed + body.next_speed));
  energy_.motors += step.motors;
  energy_.patient += step.patient;
  energy_.dissipated += step.dissipated;
  energy_.turned_over += step.turned_over;
}

void Plant::one_step(const PlantInput& input, double h, double t) noexcept {
  for (Body& body : bodies_) body.position += 0.5 * h * body.speed;
  follow_linkages();
  load(input, h, t);
  solve_speeds(h);
  book(h);
  for (Body& body : bodies_) {
    body.speed = body.next_speed;
    body.position += 0.5 * h * body.speed;
  }
  follow_linkages();
}

void Plant::advance(const PlantInput& input, double duration) noexcept {
  assert(input.motor_force.size() == tendons_.size());
  if (!(duration > 0.0)) return;
  duration = std::min(duration, kLongest);
  const auto steps = std::max(std::int64_t{1}, static_cast<std::int64_t>(std::ceil(duration / step_ - 1e-9)));
  const double h = duration / static_cast<double>(steps);
  for (Tendon& tendon : tendons_)
    tendon.half_decay = tendon.lag > 0.0 ? std::exp(-0.5 * h / tendon.lag) : 0.0;
  for (std::int64_t i = 0; i < steps; ++i) one_step(input, h, static_cast<double>(i) * h);
  for (const Joint& joint : joints_) {
    angle_[static_cast<std::size_t>(joint.joint)] = bodies_[joint.body].position;
    speed_[static_cast<std::size_t>(joint.joint)] = bodies_[joint.body].speed;
  }
}

TendonState Plant::tendon(std::size_t motor) const noexcept {
  assert(motor < tendons_.size());
  const Tendon& tendon = tendons_[motor];
  const Body& rotor = bodies_[tendon.rotor];
  return {rotor.position, rotor.speed, tendon.motor_force, tendon.tension};
}

double Plant::stored_energy() const noexcept {
  double energy = 0.0;
  for (const Body& body : bodies_) energy += 0.5 * body.mass * body.speed * body.speed;
  for (const Tendon& tendon : tendons_) {
    const double tension = elastic_tension(tendon, stretch(tendon));
    energy += 0.5 * tension * tension / tendon.stiffness;
  }
  return energy;
}

}  // namespace phalanx

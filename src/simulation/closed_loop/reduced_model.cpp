// SPDX-License-Identifier: Apache-2.0
#include "phalanx/simulation/closed_loop/reduced_model.h"

#include <algorithm>

#include "phalanx/core/random.h"
#include "phalanx/simulation/closed_loop/stability_criterion.h"
#include "phalanx/simulation/simulated_exoskeleton.h"

namespace phalanx {
namespace {

constexpr int kJoint = joint_index(static_cast<int>(Digit::kIndex), 0);
constexpr int kSegment = segment_index(static_cast<int>(Digit::kIndex), 2);
constexpr auto kJ = static_cast<std::size_t>(kJoint);
constexpr auto kS = static_cast<std::size_t>(kSegment);

/// Makes the press plan for the wall, which is the plane x = 0 with the normal -x.
PressPlan plan_on_wall(const PatientParameters& patient) {
  DigitPress press;
  press.segment = kSegment;
  press.normal = -Vec3::UnitX();
  press.g[kJ] = -1.0;
  press.into[kJ] = 1.0;
  press.stiffness = patient.stiffness[kJ];
  PressPlan plan;
  plan.digit[static_cast<std::size_t>(Digit::kIndex)] = press;
  return plan;
}

/// Makes a hand of one joint without limits.
HandParameters unbounded() {
  HandParameters hand;
  hand.min_angle.fill(-1.0);
  hand.max_angle.fill(1.0);
  return hand;
}

/// Makes the host's step: depth, force, stabiliser.
void press_on_wall(const ReducedModel& model, const StabiliserParameters& stabiliser, double stiffness,
                   double x, Snapshot& snapshot) {
  SegmentSnapshot& segment = snapshot.segment[kS];
  segment.contact = x > 0.0;
  segment.depth = std::max(0.0, x);
  segment.force_raw = std::min(model.force_cap, stiffness * segment.depth);
  StabiliserMemory unused;  // these methods do not use it
  segment.force = stabilised_force(stabiliser,
                                   {.force = segment.force_raw,
                                    .depth = segment.depth,
                                    .sent = segment.force,
                                    .pressing = segment.contact,
                                    .period = 1.0 / model.rate_hz},
                                   unused);
  segment.normal = segment.contact || segment.force > 0.0 ? Vec3(-Vec3::UnitX()) : Vec3::Zero();
  snapshot.hcp_pose[kS].p = x * Vec3::UnitX();
  snapshot.gdp_pose[kS].p = std::min(0.0, x) * Vec3::UnitX();
  snapshot.torque[kJ] = -segment.force;
}

}  // namespace

ReducedModel make_reduced_model() {
  ReducedModel model;
  ExoJoint joint;
  joint.joint = kJoint;
  joint.inertia = 0.04;
  joint.damping = 0.8;
  joint.friction = {.coulomb = 0.06, .static_ratio = 1.05, .stribeck_speed = 2e-3, .capstan = 0.0};
  joint.sensor_lsb = 25e-6;
  joint.sensor_noise = 10e-6;
  model.exoskeleton.joints = {joint};
  ExoMotor motor;
  motor.name = "wall";
  motor.arm[kJ] = -1.0;
  motor.lag = 4e-3;
  motor.force_limit = 10.0;
  motor.mass = 0.20;
  motor.damping = 0.8;
  motor.tendon_stiffness = 10e3;
  motor.tendon_damping = 5.0;
  motor.backlash = 0.1e-3;
  motor.sheath = {.coulomb = 0.34, .static_ratio = 1.05, .stribeck_speed = 2e-3, .capstan = 0.0};
  model.exoskeleton.motors = {motor};
  model.exoskeleton.controller.compute_delay = 4.5e-3;
  model.exoskeleton.controller.return_delay = 1e-3;
  model.patient.stiffness[kJ] = 700.0;
  model.patient.damping[kJ] = 2.8;
  return model;
}

TrialResult run_reduced_trial(const ReducedModel& model, const StabiliserParameters& stabiliser,
                              double stiffness, std::uint64_t seed) {
  const TrialSchedule schedule;
  const PressPlan plan = plan_on_wall(model.patient);
  const HandParameters hand = unbounded();
  const PressIntent intent(plan, model.patient, hand, stiffness, model.patient.press, seed, schedule);
  SimulatedExoskeleton device(model.exoskeleton, model.patient, hand.open_angle, intent.angle(0.0),
                              sensor_seed(seed));
  TrialObserver watching(plan, schedule);
  watching.expect(intent);
  Snapshot snapshot;
  const double period = 1.0 / model.rate_hz;
  double host = clock_phase(seed) * period;
  IntendedMove move{.from = intent.angle(0.0), .to = {}, .push = {}};
  for (;;) {
    device.begin_tick();
    const double now = device.time_s();
    if (now >= schedule.end) return watching.result();
    const double next = now + device.period();
    for (; host < next; host += period) {
      press_on_wall(model, stabiliser, stiffness, device.sample().angle[kJ], snapshot);
      device.send(snapshot, host + model.exoskeleton.controller.compute_delay);
      watching.add(host, snapshot, device.rendered().torque);
    }
    move.to = intent.angle(next);
    move.push = intent.push(now);
    device.end_tick(move);
    move.from = move.to;
  }
}

}  // namespace phalanx

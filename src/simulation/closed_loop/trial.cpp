// SPDX-License-Identifier: Apache-2.0
#include "phalanx/simulation/closed_loop/trial.h"

#include <cmath>
#include <stdexcept>

#include "phalanx/simulation/closed_loop/closed_loop.h"

namespace phalanx {

TrialResult run_trial(const TrialSetup& setup, double stiffness, double press, std::uint64_t seed,
                      const TickObserver& observer) {
  if (!std::isnan(stiffness) && !(stiffness > 0.0 && std::isfinite(stiffness)))
    throw std::invalid_argument("stiffness: must be > 0 and finite [N/m]; NaN takes the scene's");
  if (!std::isnan(press) && !(press >= 0.0 && std::isfinite(press)))
    throw std::invalid_argument("press: must be >= 0 and finite [N]; NaN takes the patient's");
  HapticParameters parameters = setup.parameters;
  if (!std::isnan(stiffness)) parameters.force.stiffness = stiffness;
  const double force = std::isnan(press) ? setup.patient.press : press;
  const HandParameters& hand = setup.model.hand.parameters();
  const PressIntent intent(setup.plan, setup.patient, hand, parameters.force.stiffness, force, seed,
                           setup.schedule);
  SimulatedExoskeleton device(setup.exoskeleton, setup.patient, hand.open_angle, intent.angle(0.0),
                              sensor_seed(seed), setup.step);
  TrialObserver watching(setup.plan, setup.schedule);
  watching.expect(intent);
  run_closed_loop(
      setup.model, parameters, device,
      {.angle = [&](double t) { return intent.angle(t); }, .push = [&](double t) { return intent.push(t); }},
      setup.schedule.end, clock_phase(seed),
      [&](double t, const Snapshot& snapshot, const SimulatedExoskeleton& exoskeleton) {
        watching.add(t, snapshot, exoskeleton.rendered().torque, exoskeleton.rendered().unrendered);
        if (observer) observer(t, snapshot, exoskeleton);
      });
  return watching.result();
}

}  // namespace phalanx

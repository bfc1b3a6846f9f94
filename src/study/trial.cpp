// SPDX-License-Identifier: Apache-2.0
#include "phalanx/study/trial.h"

#include <fmt/format.h>

#include <cmath>
#include <deque>
#include <mutex>
#include <stdexcept>
#include <utility>

#include "phalanx/scene/build_model.h"
#include "phalanx/scene/resolved_scene.h"
#include "phalanx/scene/scene_file.h"
#include "phalanx/simulation/closed_loop/closed_loop.h"

namespace phalanx {
namespace {

/// The last set-ups, by their overrides: a point of a study runs many trials on one set-up.
class Setups {
 public:
  explicit Setups(std::string scene) : scene_(std::move(scene)) {}

  std::shared_ptr<const TrialSetup> get(const Overrides& overrides) {
    {
      const std::lock_guard lock(mutex_);
      for (const auto& [key, setup] : kept_)
        if (key == overrides) return setup;
    }
    auto made = make_trial_setup(SceneFile(scene_).scene(overrides));
    const std::lock_guard lock(mutex_);
    kept_.emplace_back(overrides, made);
    if (kept_.size() > kMost) kept_.pop_front();
    return made;
  }

 private:
  static constexpr std::size_t kMost = 32;
  std::string scene_;
  std::mutex mutex_;
  std::deque<std::pair<Overrides, std::shared_ptr<const TrialSetup>>> kept_;
};

/// Refuses a bump that reaches into the window. @throws std::invalid_argument
void refuse_bump_in_window(const PatientParameters& patient, const TrialSchedule& schedule) {
  const double end = patient.bump_start + patient.bump_duration;
  if (patient.bump == 0.0 || end <= schedule.window_begin) return;
  throw std::invalid_argument(
      fmt::format("patient: the bump from {} to {} s reaches into the window from {} s on in which a trial "
                  "is judged; let "
                  "it end before",
                  patient.bump_start, end, schedule.window_begin));
}

}  // namespace

std::shared_ptr<const TrialSetup> make_trial_setup(const SceneDescription& scene) {
  ResolvedScene resolved = resolve(scene, {.device = true, .motion = true});
  const Motion motion = resolved.motion.value();
  const Exoskeleton exoskeleton = resolved.exoskeleton.value();
  const PatientParameters patient = resolved.patient.value();
  auto setup = std::make_shared<TrialSetup>(TrialSetup{.model = build_model(std::move(resolved)),
                                                       .parameters = scene.parameters,
                                                       .exoskeleton = exoskeleton,
                                                       .patient = patient,
                                                       .plan = {},
                                                       .schedule = {}});
  refuse_bump_in_window(setup->patient, setup->schedule);
  setup->plan = plan_press(setup->model, setup->parameters, motion, setup->exoskeleton, setup->patient);
  return setup;
}

TrialResult run_trial(const TrialSetup& setup, double stiffness, double press, std::uint64_t seed,
                      const TickObserver& observer) {
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

TrialFunction make_trial_function(const std::string& scene) {
  auto setups = std::make_shared<Setups>(scene);
  return [setups](const Overrides& overrides, double stiffness, double press, std::uint64_t seed) {
    return run_trial(*setups->get(overrides), stiffness, press, seed);
  };
}

}  // namespace phalanx

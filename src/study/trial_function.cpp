// SPDX-License-Identifier: Apache-2.0
#include "phalanx/study/trial_function.h"

#include <deque>
#include <memory>
#include <mutex>
#include <utility>

#include "phalanx/mesh/import_cache.h"
#include "phalanx/scene/resolved_scene.h"
#include "phalanx/scene/scene_file.h"
#include "phalanx/scene/scene_trial.h"
#include "phalanx/simulation/closed_loop/trial.h"

namespace phalanx {
namespace {

/// The last set-ups, by their overrides: a point of a study runs many trials on one set-up, which is constant. The
/// points share the imported meshes.
class Setups {
 public:
  explicit Setups(std::string scene) : scene_(std::move(scene)) {}

  std::shared_ptr<const TrialSetup> get(const Overrides& overrides) {
    {
      const std::lock_guard lock(mutex_);
      for (const auto& [key, setup] : kept_)
        if (key == overrides) return setup;
    }
    auto made = make_trial_setup(
        resolve(SceneFile(scene_).scene(overrides), {.device = true, .motion = true, .imports = &imports_}));
    const std::lock_guard lock(mutex_);
    kept_.emplace_back(overrides, made);
    if (kept_.size() > kMost) kept_.pop_front();
    return made;
  }

 private:
  static constexpr std::size_t kMost = 32;
  std::string scene_;
  ImportCache imports_;
  std::mutex mutex_;
  std::deque<std::pair<Overrides, std::shared_ptr<const TrialSetup>>> kept_;
};

}  // namespace

TrialFunction make_trial_function(const std::string& scene) {
  auto setups = std::make_shared<Setups>(scene);
  return [setups](const Overrides& overrides, double stiffness, double press, std::uint64_t seed) {
    return run_trial(*setups->get(overrides), stiffness, press, seed);
  };
}

}  // namespace phalanx

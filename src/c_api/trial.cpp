// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include "c_api/objects.h"
#include "phalanx/scene/scene_trial.h"
#include "phalanx/simulation/closed_loop/trial.h"

using namespace phalanx::c_api;

namespace {

constexpr std::size_t kSmallestTrial = 32;
static_assert(sizeof(phalanx_trial) == kSmallestTrial);

/// Copies as much of a text as there is room for, with its zero byte.
template <std::size_t N>
void copy_short(const std::string& from, char (&into)[N]) noexcept {
  const std::size_t size = std::min(from.size(), N - 1);
  std::copy_n(from.data(), size, into);
  into[size] = '\0';
}

/// @returns what is wrong with the numbers of a trial; null: nothing
const char* wrong_number(const phalanx_trial& trial) noexcept {
  if (!std::isnan(trial.stiffness) && !(trial.stiffness > 0.0 && trial.stiffness <= 1e5))
    return "stiffness: must be > 0, <= 1e5 N/m; NaN takes the scene's";
  if (!std::isnan(trial.press) && !(trial.press >= 0.0 && trial.press <= 1000.0))
    return "press: must be 0 .. 1000 N; NaN takes the patient's";
  return nullptr;
}

}  // namespace

phalanx_result phalanx_trial_run(const phalanx_scene* scene, const phalanx_trial* trial,
                                 phalanx_trial_result* result) {
  const auto* const object = object_of<Scene>(scene);
  if (object == nullptr) return wrong_handle("scene");
  phalanx_trial with{};
  const phalanx_result read = read_struct(trial, kSmallestTrial, with, "phalanx_trial");
  if (read != PHALANX_OK) return read;
  phalanx_trial_result full{};
  if (result == nullptr) return null_argument("result");
  const phalanx_result size =
      check_size(result->struct_size, sizeof full, sizeof full, "phalanx_trial_result");
  if (size != PHALANX_OK) return size;
  if (const char* const why = wrong_number(with)) return failed(PHALANX_ERROR_REFUSED, why);
  return guarded([&] {
    const auto setup = phalanx::make_trial_setup(object->read.scene);
    const phalanx::TrialResult ran = phalanx::run_trial(*setup, with.stiffness, with.press, with.seed);
    full.valid = ran.valid ? 1 : 0;
    full.stable = ran.stable ? 1 : 0;
    full.force_swing = ran.force_swing;
    full.position_swing = ran.position_swing;
    full.peak_depth = ran.peak_depth;
    full.mean_force = ran.mean_force;
    full.mean_depth = ran.mean_depth;
    full.ghost_s = ran.ghost_s;
    full.ghost_energy = ran.ghost_energy;
    copy_short(ran.why_invalid, full.why_invalid);
    return write_struct(full, sizeof full, result, "phalanx_trial_result");
  });
}

// SPDX-License-Identifier: Apache-2.0
// Samples and snapshots between the C interface and the library. Real-time.
#pragma once

#include <cstddef>

#include "phalanx/phalanx.h"
#include "phalanx/step/haptic_step.h"

namespace phalanx::c_api {

// Sizes of the first members, which every program has (phalanx.h).
inline constexpr std::size_t kSmallestSample = offsetof(phalanx_sample, measured_torque);
inline constexpr std::size_t kSmallestSnapshot = offsetof(phalanx_snapshot, hcp_angle);

/// @returns a sample without optional channels; struct_size is 0.
[[nodiscard]] phalanx_sample empty_sample() noexcept;
/// Sets all of `into`. An origin out of range counts as unknown.
void take_sample(const phalanx_sample& from, Sample& into) noexcept;
/// Sets all of `into` but struct_size. @param stiffness  of the force law at this step [N/m]
void fill_snapshot(const HapticModel& model, const Snapshot& from, double stiffness,
                   phalanx_snapshot& into) noexcept;

}  // namespace phalanx::c_api

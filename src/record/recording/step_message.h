// SPDX-License-Identifier: Apache-2.0
// Steps between the station's types and proto/phalanx/recording.proto.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "phalanx/recording.pb.h"
#include "phalanx/station/station_view.h"

namespace phalanx {

/// Writes a step with its samples. `out` is cleared first.
/// @param channels     of the device
/// @param with_angles  also the measured and the shown angles, which can be computed again
void write_step(const StepRecord& record, std::span<const DeviceSample> samples, std::size_t channels,
                bool with_angles, wire::Step& out);

/// @returns the input of a recorded step, without its samples
[[nodiscard]] StepInput read_input(const wire::Step& step);
/// Reads the samples of a recorded step.
void read_samples(const wire::Step& step, std::vector<DeviceSample>& out);

/// @returns Step.channel_check: two bytes for each channel, a hash of its raw values
[[nodiscard]] std::string channel_check(std::span<const DeviceSample> samples, std::size_t channels);

}  // namespace phalanx

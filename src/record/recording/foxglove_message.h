// SPDX-License-Identifier: Apache-2.0
// What tools that read Foxglove's schemas show in 3D. Frames: "world", and one for each segment with the name of segment_name().
#pragma once

#include <cstdint>

#include "foxglove/scene.pb.h"

namespace phalanx {

struct SessionGeometry;
struct StationView;

/// Writes the frames of the shown hand's segments. `out` is cleared first. @param time  UTC [ns since 1970]
void write_frames(const StationView& view, std::uint64_t time, foxglove::FrameTransforms& out);

/// Writes the meshes of objects and hand; the hand's move with its frames. `out` is cleared first. Set-up only.
void write_meshes(const SessionGeometry& geometry, std::uint64_t time, foxglove::SceneUpdate& out);

/// Writes an arrow for each force that is asked of the motors, from the contact's point on, 10 mm for 1 N. `out` is cleared
/// first. @returns the number of arrows; without any, the message removes those that are shown
int write_forces(const StationView& view, std::uint64_t time, foxglove::SceneUpdate& out);

}  // namespace phalanx

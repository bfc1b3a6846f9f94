// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "phalanx/geometry.pb.h"

namespace phalanx {

struct SessionGeometry;

/// Writes the meshes of hand and object in the form of proto/phalanx/geometry.proto. `out` is cleared first. Set-up only.
void write_geometry(const SessionGeometry& geometry, wire::Geometry& out);

}  // namespace phalanx

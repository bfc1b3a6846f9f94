// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "phalanx/station/station_host.h"

namespace phalanx {

/// The bytes of a wire::Geometry: what a page fetches once for each revision. Set-up only.
[[nodiscard]] std::string geometry_message(const HostGeometry& geometry);

}  // namespace phalanx

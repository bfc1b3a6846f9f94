// SPDX-License-Identifier: Apache-2.0
// A driver in one file: replace what stands in my_device.cpp by your device's own.
#pragma once

#include <memory>

#include "phalanx/device/device.h"

/// A device that is not there: two potentiometers on an index finger that closes and opens, 500 samples a
/// second, and no motors. Its counts are those of a 12-bit converter.
[[nodiscard]] std::unique_ptr<phalanx::Device> make_my_device();

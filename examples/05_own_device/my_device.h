// SPDX-License-Identifier: Apache-2.0
// A driver in one file. Replace the content of my_device.cpp by that of your device.
#pragma once

#include <memory>

#include "phalanx/device/device.h"

/// Makes an invented device: two potentiometers on an index finger that closes and opens, 500 samples a
/// second, no motors. Its counts are those of a 12-bit converter.
[[nodiscard]] std::unique_ptr<phalanx::Device> make_my_device();

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "phalanx/device/opengloves/opengloves_device.h"

namespace phalanx::test {

/// Learns a glove's full scale in 0.1 s, and waits for its first line as long as a busy machine makes it
/// late.
inline OpenGlovesSettings quick() {
  return {.full_scale = 0, .hello_timeout = 60.0, .learn_for = 0.1, .serial = ""};
}

}  // namespace phalanx::test

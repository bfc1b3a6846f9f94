// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "support/held_clock/page.h"

namespace phalanx::test {

/// From here on this process tells and waits for the page's time. Before it has a second thread.
/// @param page  in memory that processes share; for ever
void hold(ClockPage* page) noexcept;

}  // namespace phalanx::test

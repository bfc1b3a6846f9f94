// SPDX-License-Identifier: Apache-2.0
// Header of the Arduino library that make_library makes: the IDE finds a library by the headers in its src/.
#pragma once

#include "phalanx/device/link/phalanx_link.h"

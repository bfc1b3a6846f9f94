// SPDX-License-Identifier: Apache-2.0
// The example's sketch, as an Arduino core compiles it: Arduino.h first, then the .ino.
#include <Arduino.h>

#pragma GCC diagnostic ignored "-Wold-style-cast"  // the sketch is of the style of its readers
#include "haptic_finger.ino"

#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# compile_test.sh SOURCE_DIR WORK_DIR SIZE CC CXX [FLAG...]: the library of examples/arduino and its sketch compile without a warning
# against the stand-in for Arduino.h, as an Arduino core compiles them: gnu++17, -Os. It prints their code and static memory.
set -euo pipefail
source=$1 work=$2 size=$3 cc=$4 cxx=$5
shift 5
rm -rf "$work"
mkdir -p "$work"
"$source/examples/arduino/make_library" "$work/PhalanxLink" > /dev/null
# The IDE finds a library by a header in its src/, not below that.
grep -qx 'includes=PhalanxLink.h' "$work/PhalanxLink/library.properties"
test -e "$work/PhalanxLink/src/PhalanxLink.h"
warnings=(-Wall -Wextra -Werror)
"$cc" "$@" -std=gnu11 -Os "${warnings[@]}" -I"$work/PhalanxLink/src" -c "$work/PhalanxLink/src/phalanx_link.c" -o "$work/phalanx_link.o"
"$cxx" "$@" -std=gnu++17 -Os -fno-exceptions "${warnings[@]}" -I"$work/PhalanxLink/src" -I"$source/tests/apps/device/conform/arduino" \
  -include Arduino.h -x c++ -c "$source/examples/arduino/haptic_finger/haptic_finger.ino" -o "$work/sketch.o"
"$size" "$work/phalanx_link.o" "$work/sketch.o"

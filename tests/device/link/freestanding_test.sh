#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# freestanding_test.sh SOURCE_DIR WORK_DIR NM COMPILER [FLAG...]: phalanx_link.c and the firmware example compile without a warning and
# without an operating system, and need nothing at link time but memcpy, memset and the compiler's own arithmetic.
set -euo pipefail
source=$1 work=$2 nm=$3
shift 3
mkdir -p "$work"
strict=(-std=c99 -ffreestanding -fno-stack-protector -Wall -Wextra -Wpedantic -Wconversion -Wsign-conversion -Wshadow
  -Wdouble-promotion -Werror)
for optimise in -O0 -Os -O2; do
  objects=()
  for file in src/device/link/phalanx_link.c tests/device/link/firmware_example.c; do
    object=$work/$(basename "$file" .c)$optimise.o
    "$@" "${strict[@]}" "$optimise" -I"$source/include" -c "$source/$file" -o "$object"
    objects+=("$object")
  done
  needs=$("$nm" -u "${objects[0]}" | awk '{print $NF}' | grep -vE '^(memcpy|memset|memmove|memcmp|__aeabi_.*|_GLOBAL_OFFSET_TABLE_)$' |
    grep -v ':$' || true)
  if [[ -n $needs ]]; then
    echo "phalanx_link.c at $optimise needs: $needs"
    exit 1
  fi
  echo "$optimise: $("$nm" -u "${objects[0]}" | awk '{print $NF}' | tr '\n' ' ')"
done

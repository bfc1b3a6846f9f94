#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# run_fuzzer.sh FUZZER SEEDS WORK : one libFuzzer target for PHALANX_FUZZ_SECONDS (30). What it learns stays in WORK/corpus, an input
# that breaks something is kept in WORK/artifacts and named in the output; `FUZZER FILE` repeats it.
set -euo pipefail
fuzzer=$1 seeds=$2 work=$3
mkdir -p "$work/corpus" "$work/artifacts"
exec "$fuzzer" -max_total_time="${PHALANX_FUZZ_SECONDS:-30}" -rss_limit_mb=2048 -timeout=60 -print_final_stats=1 \
  -artifact_prefix="$work/artifacts/" "$work/corpus" "$seeds"

#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# safety_table.sh BUILD : runs the fault suite of a build folder and writes the table of docs/safety.md again from its output.
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
printed=$(mktemp)
trap 'rm -f "$printed" "$printed.table" "$printed.docs"' EXIT
"${1:-$root/build/release}/bin/faults_test" --gtest_filter='Faults.*' > "$printed" ||
  { echo "safety_table.sh: a test failed; the table stays as it was" >&2; grep -A8 Failure "$printed" >&2 || true; exit 1; }
{
  printf '| fault | required | seen |\n| --- | --- | --- |\n'
  grep '^| ' "$printed"
} > "$printed.table"
awk -v table="$printed.table" '
  /<!-- end of fault table -->/ { inside = 0 }
  !inside { print }
  /<!-- fault table -->/ { inside = 1; print ""; while ((getline line < table) > 0) print line; print "" }
' "$root/docs/safety.md" > "$printed.docs"
cp "$printed.docs" "$root/docs/safety.md"

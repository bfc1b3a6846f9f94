#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# update_mesh_table.sh BUILD : writes the corpus table of docs/meshes.md again with the test program of a build folder.
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
table=$(mktemp)
trap 'rm -f "$table" "$table.docs"' EXIT
PHALANX_WRITE_CORPUS_TABLE=$table "${1:-$root/build/release}/bin/step_test" --gtest_filter='MeshCorpus.*' > /dev/null || true # the old table may differ
[ -s "$table" ] || { echo "update_mesh_table.sh: no table; build step_test and install assimp-testmodels" >&2; exit 1; }
awk -v table="$table" '
  /<!-- end of corpus table -->/ { inside = 0 }
  !inside { print }
  /<!-- corpus table -->/ { inside = 1; print ""; while ((getline line < table) > 0) print line; print "" }
' "$root/docs/meshes.md" > "$table.docs"
cp "$table.docs" "$root/docs/meshes.md"

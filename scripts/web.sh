# SPDX-License-Identifier: Apache-2.0
# The cockpit's page: npm packages as web/package-lock.json says, then web/dist. Sourced after packages.sh; needs `root` (the checkout).

# What web/dist is made from, as one number.
web_sources() {
  (cd "$root/web" && find index.html patient.html people.html recording.html src vite.config.ts package-lock.json ../proto -type f -not -path 'src/gen/*' -print0 |
    LC_ALL=C sort -z | xargs -0 sha256sum | sha256sum)
}

# install_web: the npm packages, if the lock file is not the one that they were installed from.
install_web() {
  local web=$root/web
  if cmp -s "$web/package-lock.json" "$web/node_modules/.lock-installed"; then return 0; fi
  local version
  version=$(node -p 'process.versions.node' 2>/dev/null || echo none)
  if ! node -e 'const [a, b] = process.versions.node.split("."); process.exit(a > 18 || (a == 18 && b >= 19) ? 0 : 1)' 2>/dev/null; then
    say "phalanx: the page needs Node 18.19 or newer, here is $version"
    return 1
  fi
  say "phalanx: installing the page's npm packages"
  (cd "$web" && npm ci --ignore-scripts --no-audit --no-fund --loglevel=error) </dev/null >&2 || return 1
  cp "$web/package-lock.json" "$web/node_modules/.lock-installed"
}

# build_web: web/dist, if one of its sources has changed.
build_web() {
  local web=$root/web sources
  install_web || return 1
  sources=$(web_sources)
  if [ -f "$web/dist/index.html" ] && [ "$(cat "$web/dist/.sources" 2>/dev/null)" = "$sources" ] && [ -d "$web/src/gen" ]; then return 0; fi
  say "phalanx: building the page"
  mkdir -p "$web/src/gen"
  (cd "$web" && npm run --silent proto && npm run --silent build -- --logLevel warn) </dev/null >&2 || return 1
  printf '%s\n' "$sources" >"$web/dist/.sources"
}

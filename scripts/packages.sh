# SPDX-License-Identifier: Apache-2.0
# Finds what is missing and installs it. Sourced by ./run, ./test and .ci/run; needs `root` (the checkout).

say() { printf '%s\n' "$*" >&2; }

# say_installed : names an installed phalanx, which needs no build. The checkout is built all the same.
say_installed() {
  local program
  program=$(command -v phalanx) || return 0
  say "phalanx: a package is installed, too: \`phalanx run\` starts $program without a build; this is the checkout $root"
}

# missing_packages LIST... : one name a line, in the order of packages/LIST.txt.
missing_packages() {
  local list line name command
  local -a names=()
  for list in "$@"; do
    while IFS= read -r line || [ -n "$line" ]; do
      line=${line%%#*}
      read -r name command <<<"$line"
      [ -n "$name" ] || continue
      if [ -n "$command" ] && command -v "$command" >/dev/null 2>&1; then continue; fi
      names+=("$name")
    done <"$root/packages/$list.txt"
  done
  [ ${#names[@]} -gt 0 ] || return 0
  if ! command -v dpkg >/dev/null 2>&1; then
    say "phalanx: no dpkg here, so this is not Debian; going on. Needed are the equivalents of: ${names[*]}"
    return 0
  fi
  # One dpkg call for all. A removed package whose configuration stayed is known to dpkg, but not installed.
  local installed
  installed=$(dpkg -s "${names[@]}" 2>/dev/null |
    while IFS= read -r line; do
      case $line in
        "Package: "*) name=${line#Package: } ;;
        "Status: "*" ok installed") printf ' %s ' "$name" ;;
      esac
    done) || true
  for name in "${names[@]}"; do
    case $installed in *" $name "*) ;; *) printf '%s\n' "$name" ;; esac
  done
}

# ask_root LINE : says that packages are missing and which line root must type, and exits with 2.
ask_root() {
  say "phalanx: packages are missing, and installing them needs root. Type this line as root, then again: $0"
  say "$1"
  exit 2
}

# ensure_packages LIST... : installs what is missing, as root or through sudo; nothing missing means no apt call. Without either
# it prints the one line that root must type and exits with 2. It never prompts unless there is a terminal to answer on. What
# apt-get says goes to build/packages.log, and is shown only if the installation fails.
ensure_packages() {
  local missing
  missing=$(missing_packages "$@")
  [ -n "$missing" ] || return 0
  local -a packages as_root=()
  mapfile -t packages <<<"$missing"
  local line="apt-get update && apt-get install -y --no-install-recommends ${packages[*]}"
  if ! command -v apt-get >/dev/null 2>&1; then
    say "phalanx: no apt-get here; install these packages or their equivalents, then try again: ${packages[*]}"
    exit 2
  fi
  if [ "$(id -u)" -ne 0 ]; then
    if ! command -v sudo >/dev/null 2>&1; then ask_root "$line"; fi
    as_root=(sudo -n)
    if [ -t 0 ] && [ -t 2 ]; then
      say "phalanx: to install: ${packages[*]}"
      as_root=(sudo)
    fi
    if ! "${as_root[@]}" true 2>/dev/null; then ask_root "$line"; fi
  fi
  local log=$root/build/packages.log
  mkdir -p "$root/build"
  say "phalanx: installing ${#packages[@]} packages (this takes some minutes; the log is $log): ${packages[*]}"
  local -a apt=("${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -o DPkg::Lock::Timeout=600 -q)
  # A package source that does not answer is no reason to stop here: the install decides.
  "${apt[@]}" update </dev/null >"$log" 2>&1 || say "phalanx: apt-get update had errors; trying to install all the same"
  if ! "${apt[@]}" install -y --no-install-recommends "${packages[@]}" </dev/null >>"$log" 2>&1; then
    cat "$log" >&2
    say "phalanx: the installation failed (see above). By hand, as root: $line"
    exit 1
  fi
}

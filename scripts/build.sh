# SPDX-License-Identifier: Apache-2.0
# Configures and builds a preset into build/PRESET. Sourced after packages.sh; needs `root` (the checkout).

# As many compilers at once as there are cores and memory for: 1.5 GiB each.
build_jobs() {
  local cores kib=0 limit field value
  cores=$(nproc 2>/dev/null || echo 1)
  if [ -r /proc/meminfo ]; then
    while read -r field value _; do
      if [ "$field" = MemAvailable: ]; then kib=$value; break; fi
    done </proc/meminfo
  fi
  if [ -r /sys/fs/cgroup/memory.max ] && read -r limit </sys/fs/cgroup/memory.max && [ "$limit" != max ]; then
    if [ $((limit / 1024)) -lt "$kib" ]; then kib=$((limit / 1024)); fi
  fi
  local by_memory=$((kib / 1572864))
  if [ "$kib" -eq 0 ] || [ "$by_memory" -ge "$cores" ]; then echo "$cores"
  elif [ "$by_memory" -lt 1 ]; then echo 1
  else echo "$by_memory"; fi
}

# One set-up at a time in a checkout; a second waits. Released by unlock_build or the end of the script.
lock_build() {
  mkdir -p "$root/build"
  exec 9>"$root/build/.lock"
  if ! flock -n 9; then
    say "phalanx: another set-up is at work in $root; waiting for it"
    flock 9
  fi
}
unlock_build() { exec 9>&-; }

# cached FILE NAME : a variable's value in a CMakeCache.txt.
cached() {
  local line
  while IFS= read -r line; do
    case $line in "$2":*=*) printf '%s\n' "${line#*=}"; return ;; esac
  done <"$1"
}

# configure PRESET [-DNAME=VALUE...] : only if needed, that is: never configured to the end, the presets changed, or a value
# differs. A tree that was moved or copied is configured from nothing, for CMake's cache holds absolute paths.
configure() {
  local preset=$1; shift
  local build=$root/build/$preset define
  local cache=$build/CMakeCache.txt
  if [ -f "$cache" ] && ! { [ "$(cached "$cache" CMAKE_HOME_DIRECTORY)" -ef "$root" ] &&
                            [ "$(cached "$cache" CMAKE_CACHEFILE_DIR)" -ef "$build" ]; }; then
    say "phalanx: build/$preset was made elsewhere; making it again"
    rm -rf "$build"
  fi
  local needed=false
  local -a fresh=()
  # Changed presets may name another compiler, which an old cache would only half take over.
  if [ "$root/CMakePresets.json" -nt "$build/build.ninja" ]; then fresh=(--fresh); fi
  if [ ! -f "$cache" ] || [ ! -f "$build/build.ninja" ] || [ "$root/CMakePresets.json" -nt "$build/build.ninja" ]; then needed=true; fi
  if ! $needed; then
    for define in "$@"; do
      define=${define#-D}
      if [ "$(cached "$cache" "${define%%=*}")" != "${define#*=}" ]; then needed=true; fi
    done
  fi
  $needed || return 0
  say "phalanx: configuring build/$preset"
  local log=$root/build/configure-$preset.log
  local -a cmake=(cmake "${fresh[@]}" -S "$root" --preset "$preset" "$@")
  if (cd "$root" && "${cmake[@]}") >"$log" 2>&1; then return 0; fi
  # A half-written cache, or one that remembers a package that is gone: once more from nothing.
  if [ -f "$cache" ] && (cd "$root" && cmake --fresh "${cmake[@]:1}") >"$log" 2>&1; then return 0; fi
  cat "$log" >&2
  say "phalanx: CMake could not configure the build (its messages are above and in $log)"
  exit 1
}

# build PRESET [TARGET...] : Ninja's own progress line on a terminal, plain lines elsewhere; nothing if there is nothing to do.
build() {
  local preset=$1 jobs; shift
  local dir=$root/build/$preset
  case $(cd "$dir" && ninja -n "$@" 2>/dev/null) in *"no work to do"*) return 0 ;; esac
  jobs=$(build_jobs)
  if ! (cd "$dir" && ninja -j"$jobs" "$@") >&2; then
    say "phalanx: the build of build/$preset failed; the first error is above"
    exit 1
  fi
}

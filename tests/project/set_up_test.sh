#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# set_up_test.sh ROOT : what ./run does about packages, with stand-ins for dpkg, apt-get, sudo and id on the PATH that write down how
# they were called. Nothing is installed.
set -euo pipefail
source_root=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failures=0

# stub NAME BODY : a command that logs its call, then runs BODY.
stub() {
  printf '#!/bin/bash\nprintf "%%s\\n" "%s $*" >>"%s/calls"\n%s\n' "$1" "$work" "$2" >"$work/bin/$1"
  chmod +x "$work/bin/$1"
}

# A machine: user id, what dpkg says is installed, and whether sudo lets one in (yes, no) or is not there (none).
machine() {
  local uid=$1 installed=$2 sudo=$3
  rm -rf "$work/bin" "$work/calls" "$work/tree with spaces"
  mkdir -p "$work/bin" "$work/tree with spaces/packages"
  : >"$work/calls"
  ln -s "$(type -P bash)" "$work/bin/bash"
  ln -s "$(type -P env)" "$(type -P mkdir)" "$(type -P cat)" "$work/bin/"
  ln -s "$(type -P true)" "$work/bin/present-command"
  ln -s "$(type -P true)" "$work/bin/true"
  printf '# a comment\n\nlib-one # another\nlib-two\ntool present-command\nother-tool absent-command\n' >"$work/tree with spaces/packages/run.txt"
  stub id "echo $uid"
  stub apt-get ":"
  if [ "$sudo" = yes ]; then stub sudo '[ "$1" = -n ] && shift; exec "$@"'; fi
  if [ "$sudo" = no ]; then stub sudo 'echo "sudo: a password is required" >&2; exit 1'; fi
  stub dpkg "for p in \$2 \$3 \$4 \$5 \$6; do case ' $installed ' in
      *\" \$p \"*) printf 'Package: %s\nStatus: install ok installed\n\n' \$p ;;
      *) printf 'Package: %s\nStatus: deinstall ok config-files\n\n' \$p ;; esac; done"
}

# What ensure_packages printed goes to $work/out and $work/err, its exit status to $status.
ensure() {
  status=0
  (
    PATH=$work/bin
    root="$work/tree with spaces"
    . "$source_root/scripts/packages.sh"
    ensure_packages run
  ) </dev/null >"$work/out" 2>"$work/err" || status=$?
}

check() {
  local what=$1; shift
  if ! "$@"; then
    failures=$((failures + 1))
    printf 'FAILED: %s\n  status %s\n' "$what" "$status"
    sed 's/^/  out: /' "$work/out"; sed 's/^/  err: /' "$work/err"; sed 's/^/  call: /' "$work/calls"
  fi
}
called() { grep -q -- "$1" "$work/calls"; }
not_called() { ! called "$1"; }
said_before_line() { sed -n 1p "$work/err" | grep -q '^phalanx: packages are missing'; }
root_line='^apt-get update && apt-get install -y --no-install-recommends lib-two'

machine 0 "lib-one lib-two other-tool" none
ensure
check "nothing missing: succeeds" [ "$status" -eq 0 ]
check "nothing missing: apt is not called" not_called apt-get
check "nothing missing: one look at dpkg" called '^dpkg -s lib-one lib-two other-tool$'
check "nothing missing: says nothing" [ ! -s "$work/err" ]

machine 0 "lib-one other-tool" none
ensure
check "root: succeeds" [ "$status" -eq 0 ]
check "root: fetches the lists first" called '^apt-get .*update$'
check "root: installs what is missing and nothing else" called '^apt-get .*install -y --no-install-recommends lib-two$'
check "root: standard output stays clean" [ ! -s "$work/out" ]

machine 0 "lib-one other-tool" none
stub apt-get 'for i in 1 2 3; do echo "Get:$i http://deb"; echo "E: warning" >&2; done'
ensure
check "an installation that succeeds: one line" [ "$(wc -l <"$work/err")" -eq 1 ]
check "an installation that succeeds: apt's output is kept" [ "$(wc -l <"$work/tree with spaces/build/packages.log")" -eq 12 ]

machine 1000 "lib-one other-tool" yes
ensure
check "sudo without a terminal: succeeds" [ "$status" -eq 0 ]
check "sudo without a terminal: always -n" called '^sudo -n '
check "sudo without a terminal: never without -n" [ "$(grep '^sudo' "$work/calls" | grep -vc '^sudo -n ')" = 0 ]
check "sudo: installs" called '^apt-get .*install -y --no-install-recommends lib-two$'

for sudo in no none; do
  machine 1000 "lib-one other-tool" "$sudo"
  ensure
  check "neither root nor sudo ($sudo): exit status 2" [ "$status" -eq 2 ]
  check "neither root nor sudo ($sudo): says first that packages are missing" said_before_line
  check "neither root nor sudo ($sudo): and one line to type" [ "$(wc -l <"$work/err")" -eq 2 ]
  check "neither root nor sudo ($sudo): the line for root" grep -q "$root_line" "$work/err"
  check "neither root nor sudo ($sudo): no apt call" not_called apt-get
done

machine 0 "lib-one lib-two" none
ensure
check "a missing command that dpkg does not know either is installed" called 'install -y --no-install-recommends other-tool$'

machine 0 "lib-one other-tool" none
stub apt-get 'case $* in *install*) echo "E: Unable to locate"; exit 100 ;; esac'
ensure
check "a failed installation: exit status 1" [ "$status" -eq 1 ]
check "a failed installation: shows what apt said" grep -q '^E: Unable to locate' "$work/err"
check "a failed installation: says how to do it by hand" grep -q 'as root: apt-get update' "$work/err"

# What ./run says where a package of Phalanx is installed.
said_installed() {
  status=0
  (
    PATH=$work/bin
    root=/checkout
    . "$source_root/scripts/packages.sh"
    say_installed
  ) >"$work/out" 2>"$work/err" || status=$?
}
machine 1000 "" none
said_installed
check "no package of Phalanx: says nothing" [ "$status,$(cat "$work/out" "$work/err")" = "0," ]
stub phalanx ':'
said_installed
check "a package of Phalanx: one line with the command" [ "$(grep -c "\`phalanx run\` starts $work/bin/phalanx without a build" "$work/err")" = 1 ]
check "a package of Phalanx: it is not run" not_called '^phalanx'
check "a package of Phalanx: standard output stays clean" [ ! -s "$work/out" ]

# ./run --help on a bare machine: no package is looked for, nothing is built.
machine 1000 "" none
mkdir "$work/clone"
cp "$source_root/run" "$work/clone/"
ln -s "$(type -P sed)" "$(type -P dirname)" "$(type -P readlink)" "$work/bin/"
status=0
PATH=$work/bin "$work/clone/run" --help </dev/null >"$work/out" 2>"$work/err" || status=$?
check "run --help before the first build: succeeds" [ "$status" -eq 0 ]
check "run --help before the first build: says what there is" grep -q '^./run COMMAND' "$work/out"
check "run --help before the first build: calls nothing" [ ! -s "$work/calls" ]

if [ "$failures" -gt 0 ]; then echo "$failures checks failed"; exit 1; fi
echo "all checks passed"

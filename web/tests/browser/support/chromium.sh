#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# Debian's Chromium. As root it would raise its renderer above all other programs; it may not. Where no launcher holds the clock of the
# stations, it runs behind everything else on the computer, so that their loops come first.
chromium=${CHROMIUM:-/usr/bin/chromium}
behind=
[ -n "$PHALANX_LAUNCHER" ] || behind="nice -n 10"
if [ "$(id -u)" = 0 ]; then
  exec $behind setpriv --bounding-set=-sys_nice --inh-caps=-sys_nice "$chromium" "$@"
fi
exec $behind "$chromium" "$@"

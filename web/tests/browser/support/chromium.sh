#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# Debian's Chromium behind everything else on the computer: where the processor draws, the station's loop comes first. As root
# Chromium would raise its renderer above all others; it may not.
chromium=${CHROMIUM:-/usr/bin/chromium}
if [ "$(id -u)" = 0 ]; then
  exec nice -n 10 setpriv --bounding-set=-sys_nice --inh-caps=-sys_nice "$chromium" "$@"
fi
exec nice -n 10 "$chromium" "$@"

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "phalanx/cockpit.pb.h"
#include "phalanx/station/station_host.h"
#include "serve/seats.h"

namespace phalanx {

/// Everything about the station that a page shows beside the hand: proto/phalanx/cockpit.proto;
/// but for the place of a fault's report.
void write_state(const StationHost& host, wire::State& out);

/// The device's counters.
void write_link(const LinkStatistics& link, wire::Link& out);

/// Who is here.
void write_seats(const Seats& seats, double now, wire::State& out);

/// Keys, scenes and profiles: what does not change while the program runs. Set-up only.
void write_choices(wire::Welcome& out);

}  // namespace phalanx

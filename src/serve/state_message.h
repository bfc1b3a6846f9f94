// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "phalanx/cockpit.pb.h"
#include "phalanx/station/session.h"
#include "serve/participants.h"

namespace phalanx {

/// Writes all that a page shows of the station beside the hand, in the form of proto/phalanx/cockpit.proto.
/// Does not write the file of a fault report.
void write_state(const Session& session, wire::State& out);

/// Writes the counters of the device's link.
void write_link(const LinkStatistics& link, wire::Link& out);

/// Writes the operator and the number of pages.
void write_participants(const Participants& participants, double now, wire::State& out);

/// Writes keys, scenes and profiles, which do not change while the program runs. Set-up only.
void write_choices(wire::Welcome& out);

}  // namespace phalanx

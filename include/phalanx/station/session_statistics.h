// SPDX-License-Identifier: Apache-2.0
// What all stations of a host have done, from the first one's start on.
#pragma once

#include <cstdint>

#include "phalanx/station/station_view.h"

namespace phalanx {

/// A session's sums, over each station that a change of rate, scene or device has ended. Not real-time.
struct SessionStatistics {
  DeadlineStatistics deadlines;    ///< its period is the last station's
  LinkStatistics link;             ///< what the controller counts, it counts from its own start: not summed
  std::uint64_t records_lost = 0;  ///< StationView::records_lost

  /// Adds one station. @param last  its newest view
  void add(const DeadlineStatistics& station, const StationView& last) noexcept {
    deadlines.append(station);
    link.received += last.link.received;
    link.lost += last.link.lost;
    link.outdated += last.link.outdated;
    link.corrupt += last.link.corrupt;
    link.refused += last.link.refused;
    link.overflowed += last.link.overflowed;
    link.sent += last.link.sent;
    link.device_corrupt = last.link.device_corrupt;
    link.device_refused = last.link.device_refused;
    link.device_outdated = last.link.device_outdated;
    records_lost += last.records_lost;
  }
};

}  // namespace phalanx

// SPDX-License-Identifier: Apache-2.0
// Statistics over all stations of a session, from the start of the first one.
#pragma once

#include <cstdint>

#include "phalanx/station/station_view.h"

namespace phalanx {

/// Sums over all stations of a session; a change of rate, scene or device ends one station. Not real-time.
struct SessionStatistics {
  DeadlineStatistics deadlines;  ///< the period is that of the last station
  LinkStatistics link;           ///< counters of the controller are not summed: they count from its own start
  std::uint64_t records_lost = 0;  ///< sum of StationView::records_lost, and records of stations that
                                   ///< were freed unread

  /// Adds one station.
  /// @param last  its newest view
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

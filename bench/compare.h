// SPDX-License-Identifier: Apache-2.0
// Whether a peer's tick says the same as ours, and where not, whether both are right.
#pragma once

#include <string>
#include <vector>

#include "peer_gdp.h"
#include "phalanx/step/haptic_step.h"
#include "replay.h"

namespace phalanx::bench {

inline constexpr double kSameAngle = 1e-6;  ///< [rad]
inline constexpr double kSamePoint = 1e-6;  ///< [m]
/// A stop may lie anywhere in the band below the margin that docs/architecture.md allows [m].
inline constexpr double kStopBand = 10e-9;
/// Flags may differ for a segment that is this near to the margin and does not press [m].
inline constexpr double kTouchBand = 1e-6;

/// How a tick went.
enum class Verdict { kSame, kGrazing, kDifferent };

struct Agreement {
  long ticks = 0;
  long records = 0;    ///< made in these ticks by both
  long unique = 0;     ///< of them with one place only within 5 um of the least distance: compared by point
  double angle = 0.0;  ///< largest difference of the ticks that are the same [rad]
  double point = 0.0;  ///< of unique contacts [m]
  double depth = 0.0;  ///< of unique contacts [m]
  std::vector<std::string> grazing;    ///< one line each
  std::vector<std::string> different;  ///< one line each

  void add(const Agreement& other);
};

/// Holds one tick of a peer against ours, digit by digit, both begun from the same state:
/// - the same: angles within kSameAngle, the same segments in contact, and every record made in this tick
///   whose place is unique within kSamePoint, in point and in depth;
/// - grazing: a digit whose two answers both keep the rules to within their stated band. That is (a) the one
///   that stopped earlier has a segment within kStopBand of the margin there, and the other one, if it
///   stopped too, likewise, and nowhere between the two answers is a segment nearer than the band allows:
///   both stops are right, and nobody went through anything; or (b) only flags differ, of segments that are
///   within kTouchBand of the margin in both answers and are not pressed deeper than that;
/// - else different.
/// @param engine  exact distances, to judge with
/// @param where   names the tick in the lists
Verdict compare(const HapticModel& model, const HapticParameters& parameters, const GdpValues& before,
                const GdpValues& ours, const GdpValues& peer, const PeerGdp& gdp, DistanceEngine& engine,
                const std::string& where, Agreement& agreement);

}  // namespace phalanx::bench

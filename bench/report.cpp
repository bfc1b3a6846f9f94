// SPDX-License-Identifier: Apache-2.0
#include "report.h"

#include <algorithm>

namespace phalanx::bench {
namespace {

TimesRow row_of(std::string_view phase, const std::vector<double>& least, double raw_max) {
  return {std::string(phase), least.size(), step_times(least), raw_max};
}

/// Rows out of (phase, least, greatest) of ticks, empty phases left out, all ticks last.
struct Rows {
  std::array<std::vector<double>, kPhases + 1> us;
  std::array<double, kPhases + 1> raw_max{};

  void add(Phase phase, double least, double greatest) {
    for (const std::size_t row : {static_cast<std::size_t>(phase), kPhases}) {
      us[row].push_back(least);
      raw_max[row] = std::max(raw_max[row], greatest);
    }
  }
  [[nodiscard]] std::vector<TimesRow> rows() const {
    std::vector<TimesRow> out;
    for (std::size_t row = 0; row <= kPhases; ++row) {
      if (us[row].empty()) continue;
      out.push_back(row_of(row < kPhases ? kPhaseName[row] : "all", us[row], raw_max[row]));
    }
    return out;
  }
};

}  // namespace

std::vector<TimesRow> warm_rows(const std::vector<Phase>& phases, const OurTimes& times) {
  const std::vector<double> least = times.least(kRepeats);
  const std::vector<double> greatest = times.greatest();
  Rows rows;
  for (std::size_t i = 0; i < phases.size(); ++i) rows.add(phases[i], least[i], greatest[i]);
  return rows.rows();
}

std::vector<TimesRow> cold_rows(const std::vector<Phase>& phases, const std::vector<ColdTime>& times) {
  Rows rows;
  for (const ColdTime& time : times) rows.add(phases[time.tick], time.us, time.us);
  return rows.rows();
}

PeerRow peer_row(const PeerTimes& peer, const OurTimes& ours, const std::vector<PeerTick>& pruned) {
  PeerRow row{.plan = peer.plan, .ticks = peer.ticks.size(), .agreement = peer.agreement};
  const std::vector<double> our_us = ours.least(peer.plan.repeats);
  std::vector<double> theirs_all;
  std::vector<double> ours_all;
  std::vector<double> theirs_asked;
  std::vector<double> ours_asked;
  std::vector<double> theirs_idle;
  std::vector<double> ours_idle;
  for (const PeerTick& tick : peer.ticks) {
    theirs_all.push_back(tick.us);
    ours_all.push_back(our_us[tick.tick]);
    const bool idle = pruned[tick.tick].questions == 0;
    (idle ? theirs_idle : theirs_asked).push_back(tick.us);
    (idle ? ours_idle : ours_asked).push_back(our_us[tick.tick]);
  }
  row.with_queries = theirs_asked.size();
  row.p50 = step_times(theirs_asked).p50;
  row.our_p50 = step_times(ours_asked).p50;
  row.idle_p50 = step_times(theirs_idle).p50;
  row.our_idle_p50 = step_times(ours_idle).p50;
  row.p999 = step_times(theirs_all).p999;
  row.our_p999 = step_times(ours_all).p999;
  return row;
}

}  // namespace phalanx::bench

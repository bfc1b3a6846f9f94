// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "phalanx/exercise/identification.h"
#include "phalanx/exercise/training.h"

namespace phalanx {
namespace {

/// Confidence of the exact interval that must lie within the margin for "in range".
constexpr double kShownConfidence = 0.5;
/// Slack for shares such as 24 / 30, which is 0.8.
constexpr double kShareSlack = 1e-9;

std::string percent(double share) { return fmt::format("{:.0f}", 100.0 * share); }

}  // namespace

SuccessReport success_report(std::span<const TrainingSession> history, double target_success) {
  SuccessReport report;
  const std::size_t judged = std::min<std::size_t>(history.size(), kJudgedSessions);
  bool all_count = judged == kJudgedSessions;
  for (const TrainingSession& session : history.last(judged)) {
    const bool counts = session.counted > 0 && session.successes >= 0 && session.successes <= session.counted;
    all_count = all_count && counts;
    if (!counts) continue;
    report.successes += session.successes;
    report.counted += session.counted;
  }
  if (report.counted > 0) {
    const Proportion share = exact_proportion(report.successes, report.counted);
    report.share = share.value;
    report.low = share.low;
    report.high = share.high;
  }
  const double least = target_success - kSuccessMargin;
  const double most = target_success + kSuccessMargin;
  const std::string range = fmt::format("{} to {} %", percent(least), percent(most));
  const std::string seen = fmt::format(
      "{} of {} trials ({} %, 95 % interval {} to {} %) in the last {} sessions", report.successes,
      report.counted, percent(report.share), percent(report.low), percent(report.high), judged);
  if (history.size() < kSessionsToJudge) {
    report.text = fmt::format("not judged: {} of {} sessions were done", history.size(), kSessionsToJudge);
    return report;
  }
  if (!all_count) {
    report.text = fmt::format("not judged: one of the last {} sessions has no valid trial", kJudgedSessions);
    return report;
  }
  if (report.share < least - kShareSlack || report.share > most + kShareSlack) {
    report.verdict = SuccessVerdict::kOutOfRange;
    const bool proven = report.high < least || report.low > most;
    report.text = fmt::format("out of range after {} sessions: success in {}, {} {}; {}", history.size(),
                              seen, report.share < least ? "below" : "above", range,
                              proven ? "chance does not explain it" : "it may be chance");
    return report;
  }
  const Proportion middle = exact_proportion(report.successes, report.counted, kShownConfidence);
  if (middle.low < least || middle.high > most) {
    report.verdict = SuccessVerdict::kNotShown;
    report.text =
        fmt::format("not shown after {} sessions: success in {}, too near the end of {} to exclude a miss",
                    history.size(), seen, range);
    return report;
  }
  report.verdict = SuccessVerdict::kInRange;
  report.text = fmt::format("in range: success in {}, within {}", seen, range);
  return report;
}

}  // namespace phalanx

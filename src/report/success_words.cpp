// SPDX-License-Identifier: Apache-2.0
// The judgement of a training's success in the languages of a report.
#include <fmt/format.h>

#include "phalanx/exercise/training.h"
#include "report/report_sections.h"

namespace phalanx::report {
namespace {

std::string whole_percent(double share) { return fmt::format("{:.0f}", 100.0 * share); }

/// Says in German what SuccessReport::text says in English.
std::string german_success(const ReportedExercise& exercise, const SuccessReport& success) {
  if (success.verdict == SuccessVerdict::kTooFewSessions) {
    if (exercise.sessions < kSessionsToJudge)
      return fmt::format("nicht beurteilt: {} von {} Sitzungen sind getan", exercise.sessions,
                         kSessionsToJudge);
    return fmt::format("nicht beurteilt: Eine der letzten {} Sitzungen hat keinen g\u00FCltigen Versuch",
                       kJudgedSessions);
  }
  const double least = exercise.target_success - kSuccessMargin;
  const double most = exercise.target_success + kSuccessMargin;
  const std::string range = fmt::format("{} bis {} %", whole_percent(least), whole_percent(most));
  const std::string seen = fmt::format(
      "Erfolg in {} von {} Versuchen ({} %, 95-%-Bereich {} bis {} %) in den letzten {} Sitzungen",
      success.successes, success.counted, whole_percent(success.share), whole_percent(success.low),
      whole_percent(success.high), kJudgedSessions);
  switch (success.verdict) {
    case SuccessVerdict::kInRange:
      return fmt::format("im Bereich: {}, innerhalb {}", seen, range);
    case SuccessVerdict::kNotShown:
      return fmt::format(
          "nicht gezeigt nach {} Sitzungen: {}, zu nahe am Rand von {}, um ein Verfehlen auszuschlie\u00DFen",
          exercise.sessions, seen, range);
    default:
      break;
  }
  const bool proven = success.high < least || success.low > most;
  return fmt::format("au\u00DFerhalb des Bereichs nach {} Sitzungen: {}, {} {}; {}", exercise.sessions, seen,
                     success.share < least ? "unter" : "\u00FCber", range,
                     proven ? "Zufall erkl\u00E4rt es nicht" : "es kann Zufall sein");
}

}  // namespace

std::string success_words(const ReportedExercise& exercise, ReportLanguage language) {
  if (!exercise.success) return {};
  return language == ReportLanguage::kGerman ? german_success(exercise, *exercise.success)
                                             : exercise.success->text;
}

}  // namespace phalanx::report

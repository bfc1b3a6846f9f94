// SPDX-License-Identifier: Apache-2.0
#include "study_progress.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <ctime>
#include <string>

#include "terminal/error_line.h"
#include "terminal/progress.h"

namespace phalanx {
namespace {

/// The local time in so many seconds: "14:32", with its date if that is another day.
std::string time_in(double seconds) {
  const std::time_t now = std::time(nullptr);
  const std::time_t then = now + static_cast<std::time_t>(seconds);
  const std::tm today = fmt::localtime(now);
  const std::tm day = fmt::localtime(then);
  const bool same = today.tm_yday == day.tm_yday && today.tm_year == day.tm_year;
  return same ? fmt::format("{:%H:%M}", day) : fmt::format("{:%Y-%m-%d %H:%M}", day);
}

}  // namespace

std::string study_progress_text(const StudyProgress& progress) {
  std::string text = fmt::format("{}/{} points ({}%)", progress.done, progress.total,
                                 100LL * progress.done / progress.total);
  if (progress.resumed > 0) text += fmt::format(", {} of them from earlier runs", progress.resumed);
  if (progress.quarantined > 0) text += fmt::format(", {} quarantined", progress.quarantined);
  if (std::isfinite(progress.points_per_s)) text += fmt::format(", {:.3g} points/s", progress.points_per_s);
  if (progress.in_queue)
    text += progress.workers == 0
                ? ", no worker"
                : fmt::format(", {} worker{}", progress.workers, progress.workers == 1 ? "" : "s");
  text += fmt::format(", {} gone", duration_text(progress.elapsed_s));
  if (std::isfinite(progress.remaining_s) && progress.done < progress.total) {
    text += fmt::format(", about {} left", duration_text(progress.remaining_s));
    if (progress.in_queue) text += fmt::format(" (until {})", time_in(progress.remaining_s));
  }
  return text;
}

StudyProgressLine::StudyProgressLine(bool wanted)
    : wanted_(wanted), terminal_(::isatty(STDERR_FILENO) == 1) {}

StudyProgressLine::~StudyProgressLine() {
  if (wanted_ && terminal_) print_aside("\r\033[K");
}

void StudyProgressLine::show(const StudyProgress& progress) {
  if (!wanted_ || progress.total == 0) return;
  if (terminal_) {
    print_aside(fmt::format("\r\033[Kstudy {}", study_progress_text(progress)));
    return;
  }
  const int tenths = static_cast<int>(10LL * progress.done / progress.total);
  if (tenths == tenths_shown_) return;
  tenths_shown_ = tenths;
  print_aside(fmt::format("study {}\n", study_progress_text(progress)));
}

}  // namespace phalanx

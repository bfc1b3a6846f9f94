// SPDX-License-Identifier: Apache-2.0
#include "study_progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <string>

#include "terminal/error_line.h"
#include "terminal/progress.h"

namespace phalanx {
namespace {

std::string text(const StudyProgress& progress) {
  std::string text = fmt::format("study {}/{} points ({}%)", progress.done, progress.total,
                                 100LL * progress.done / progress.total);
  if (progress.resumed > 0) text += fmt::format(", {} of them from earlier runs", progress.resumed);
  text += fmt::format(", {} gone", duration_text(progress.elapsed_s));
  if (std::isfinite(progress.remaining_s) && progress.done < progress.total)
    text += fmt::format(", about {} left", duration_text(progress.remaining_s));
  return text;
}

}  // namespace

StudyProgressLine::StudyProgressLine(bool wanted)
    : wanted_(wanted), terminal_(::isatty(STDERR_FILENO) == 1) {}

StudyProgressLine::~StudyProgressLine() {
  if (wanted_ && terminal_) print_aside("\r\033[K");
}

void StudyProgressLine::show(const StudyProgress& progress) {
  if (!wanted_ || progress.total == 0) return;
  if (terminal_) {
    print_aside(fmt::format("\r\033[K{}", text(progress)));
    return;
  }
  const int tenths = static_cast<int>(10LL * progress.done / progress.total);
  if (tenths == tenths_shown_) return;
  tenths_shown_ = tenths;
  print_aside(fmt::format("{}\n", text(progress)));
}

}  // namespace phalanx

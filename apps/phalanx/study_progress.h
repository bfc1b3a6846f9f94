// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "phalanx/study/laboratory/run_study.h"

namespace phalanx {

/// Formats progress: "12/40 points (30%), 3.1 points/s, 4 workers, 3 min 20 s gone, about 8 min left (until
/// 14:32)". Pace, workers and end are of a study in a queue.
[[nodiscard]] std::string study_progress_text(const StudyProgress& progress);

/// Progress on standard error: "study 12/40 (30%), 3 min 20 s gone, about 8 min left". A terminal shows it in
/// place. Otherwise each tenth of the points has a line, so that a log stays short.
class StudyProgressLine {
 public:
  explicit StudyProgressLine(bool wanted);
  ~StudyProgressLine();
  StudyProgressLine(const StudyProgressLine&) = delete;
  StudyProgressLine& operator=(const StudyProgressLine&) = delete;

  void show(const StudyProgress& progress);

 private:
  bool wanted_;
  bool terminal_;
  int tenths_shown_ = -1;
};

}  // namespace phalanx

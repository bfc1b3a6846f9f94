// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "phalanx/study/laboratory/run_study.h"

namespace phalanx {

/// "study 12/40 (30%), 3 min 20 s gone, about 8 min left" on standard error: on a terminal in place, else a
/// line each tenth of the points, so that a log stays short.
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

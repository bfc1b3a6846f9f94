// SPDX-License-Identifier: Apache-2.0
// Whatever bytes a study file or the journal of a study holds, reading it ends in a study (a journal: also in
// results that can be reported), or in an error with a message. The first byte chooses (j: journal, else:
// study file).
#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <stdexcept>
#include <string>

#include "phalanx/scene/scene.h"
#include "phalanx/study/laboratory/outputs.h"
#include "phalanx/study/laboratory/report.h"
#include "phalanx/study/laboratory/study_file.h"
#include "scene/toml/toml_reader.h"
#include "study/laboratory/journal.h"
#include "study/laboratory/study_json.h"

namespace {

using namespace phalanx;

constexpr int kMostPoints = 50;  // that are looked at, of a study that has more

void require(bool ok) {
  if (!ok) std::abort();
}

/// What a point changes reads back as TOML, or `--set` would refuse what the study file has let through.
void read_point(const Study& study, int index) {
  const StudyPoint point = study_point(study, index);
  require(point.variant >= 0 && point.variant < static_cast<int>(study.variants.size()));
  require(!point_text(study, point).empty());
  for (const auto& [key, value] : point_overrides(study, point))
    require(parse_toml("v = " + value, "override").contains("v"));
}

void read_study(const std::string& text) {
  const Study study = parse_study(text, "fuzz.toml", "/");
  const int count = point_count(study);
  require(count >= 1 && study.seeds >= 1);
  if (study.stiffness) require(study.stiffness->size() >= 1 && study.stiffness->at(0) > 0.0);
  for (int index = 0; index < std::min(count, kMostPoints); ++index) read_point(study, index);
  read_point(study, count - 1);
  // As a journal keeps it; invalid UTF-8 is no TOML, so that nothing is replaced.
  const OrderedJson json = study_to_json(study);
  require(study_to_json(study_from_json(parse_json(json.dump()))) == json);
}

/// A file without a name.
class MemoryFile {
 public:
  explicit MemoryFile(const std::string& text) : descriptor_(::memfd_create("journal", 0)) {
    require(descriptor_ >= 0);
    require(::write(descriptor_, text.data(), text.size()) == static_cast<ssize_t>(text.size()));
  }
  ~MemoryFile() { ::close(descriptor_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  [[nodiscard]] std::string path() const { return fmt::format("/proc/self/fd/{}", descriptor_); }

 private:
  int descriptor_;
};

void read_journal_text(const std::string& text) {
  const MemoryFile file(text);
  JournalContent content = read_journal(file.path());
  const Study& study = content.header.study;
  require(difference(content.header, content.header).empty());
  const MemoryFile again(journal_text(content));
  require(journal_text(read_journal(again.path())) == journal_text(content));
  std::sort(content.points.begin(), content.points.end(),
            [](const PointResult& a, const PointResult& b) { return a.index < b.index; });
  require(!study_csv(study, content.points).empty());
  if (point_count(study) > kMostPoints) return;
  require(!study_summary_json(study, content.points, Made{}).empty());
  require(!study_report_html(study, content.points, Made{}).empty());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string text(data + 1, data + size);
  try {
    if (data[0] == 'j') {
      read_journal_text(text);
    } else {
      read_study(text);
    }
  } catch (const std::invalid_argument& error) {
    require(error.what()[0] != '\0');
  }
  return 0;
}

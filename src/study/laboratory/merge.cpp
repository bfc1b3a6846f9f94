// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <stdexcept>

#include "phalanx/record/output_file.h"
#include "phalanx/study/laboratory/outputs.h"
#include "study/laboratory/journal.h"

namespace phalanx {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> journals_in(const fs::path& folder) {
  std::vector<fs::path> files;
  if (!fs::is_directory(folder)) return files;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with("points.") && name.ends_with(".jsonl")) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

std::vector<fs::path> journals_of(const std::vector<fs::path>& folders, const fs::path& out) {
  std::vector<fs::path> files = journals_in(out);
  for (const fs::path& folder : folders) {
    const auto found = journals_in(folder);
    if (found.empty())
      throw std::invalid_argument(
          fmt::format("{}: holds no points*.jsonl; name the --out folder of a study", folder.string()));
    files.insert(files.end(), found.begin(), found.end());
  }
  return files;
}

/// Writes numbers as ranges: "3, 7-9, 12". After 20 ranges it states how many numbers are left.
std::string ranges(const std::vector<int>& numbers) {
  constexpr int kMost = 20;
  std::string text;
  int written = 0;
  for (std::size_t i = 0; i < numbers.size(); ++written) {
    if (written == kMost) return fmt::format("{} and {} more", text, numbers.size() - i);
    std::size_t last = i;
    while (last + 1 < numbers.size() && numbers[last + 1] == numbers[last] + 1) ++last;
    text += fmt::format("{}{}", text.empty() ? "" : ", ", numbers[i]);
    if (last > i) text += fmt::format("-{}", numbers[last]);
    i = last + 1;
  }
  return text;
}

/// All points of several journals.
class Union {
 public:
  void add(const fs::path& file) {
    JournalContent content = read_journal(file);
    if (content.points.empty()) content.header.libm.clear();
    if (!header_) {
      header_ = content.header;
      first_ = file;
    } else if (const std::string problem = difference(content.header, *header_); !problem.empty()) {
      throw std::invalid_argument(fmt::format("{} does not fit {}: {}; merge only parts of one study",
                                              file.string(), first_.string(), problem));
    }
    if (header_->libm.empty() && !content.header.libm.empty()) {
      header_->libm = content.header.libm;
      first_ = file;
    }
    for (const PointResult& result : content.points) add(result, file);
  }

  void refuse_missing() const {
    std::vector<int> missing;
    const int count = point_count(header_->study);
    for (int index = 0; index < count; ++index) {
      if (!points_.contains(index)) missing.push_back(index);
    }
    if (missing.empty()) return;
    throw std::invalid_argument(
        fmt::format("{} of {} points are missing: {}; run the shards that they belong to (point p "
                    "is of shard p % n + 1 of n) and merge again",
                    missing.size(), count, ranges(missing)));
  }

  [[nodiscard]] JournalContent content() const {
    JournalContent content{.header = *header_, .points = {}};
    for (const auto& [index, point] : points_) content.points.push_back(point.result);
    return content;
  }

 private:
  struct Point {
    PointResult result;
    fs::path file;
  };

  void add(const PointResult& result, const fs::path& file) {
    const auto [known, is_new] = points_.emplace(result.index, Point{result, file});
    if (is_new || result_line(known->second.result) == result_line(result)) return;
    throw std::invalid_argument(
        fmt::format("point {} has different results in {} and {}; measure the study again", result.index,
                    known->second.file.string(), file.string()));
  }

  std::optional<JournalHeader> header_;
  fs::path first_;
  std::map<int, Point> points_;
};

}  // namespace

MergedStudy merge_studies(const std::vector<fs::path>& folders, const fs::path& out) {
  Union all;
  for (const fs::path& file : journals_of(folders, out)) all.add(file);
  all.refuse_missing();
  const JournalContent content = all.content();
  prepare_output_folder(out);
  const fs::path file = out / journal_name(1, 1);
  const Journal held(file, content.header, false);  // no other process may write the file that
                                                    // is replaced here
  replace_journal(file, content);
  return {.study = content.header.study, .results = content.points};
}

}  // namespace phalanx

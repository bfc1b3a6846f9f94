// SPDX-License-Identifier: Apache-2.0
#include "phalanx/record/retention.h"

#include <algorithm>
#include <iterator>
#include <string>
#include <system_error>

namespace phalanx {
namespace {

namespace fs = std::filesystem;

constexpr double kDay = 24.0 * 3600.0;  // [s]

fs::path folder_of(const fs::path& file) {
  return file.parent_path().empty() ? fs::path(".") : file.parent_path();
}

bool may_be_deleted(const RecordingSummary& recording) {
  if (recording.written || !recording.has_end) return false;
  return recording.no_key || (recording.trouble.empty() && !recording.version.empty());
}

}  // namespace

std::vector<RecordingSummary> expired_recordings(const std::vector<RecordingSummary>& all,
                                                 const RetentionRule& rule, double now) {
  std::vector<RecordingSummary> whole;
  std::copy_if(all.begin(), all.end(), std::back_inserter(whole), may_be_deleted);
  if (whole.empty()) return {};
  std::uint64_t bytes = 0;
  for (const RecordingSummary& recording : whole) bytes += recording.bytes;
  std::vector<RecordingSummary> expired;
  for (std::size_t i = 0; i + 1 < whole.size(); ++i) {
    // The clock may have been wrong while it was recorded.
    const double age = now - std::max(whole[i].begin, whole[i].changed);
    const bool old = rule.days && age > kDay * *rule.days;
    const bool too_many = rule.bytes && bytes > *rule.bytes;
    if (!old && !too_many) continue;
    bytes -= whole[i].bytes;
    expired.push_back(whole[i]);
  }
  return expired;
}

std::vector<fs::path> delete_recording(const fs::path& file) {
  std::vector<fs::path> all{file};
  const fs::path page = beside_recording(file, ".html");
  std::error_code ignored;
  if (fs::exists(page, ignored)) all.push_back(page);
  const std::string torn = file.filename().string() + ".torn";
  for (const fs::directory_entry& entry : fs::directory_iterator(folder_of(file), ignored))
    if (entry.path().filename().string().starts_with(torn)) all.push_back(entry.path());
  for (const fs::path& each : all) fs::remove(each);
  return all;
}

std::uint64_t recorded_bytes(const fs::path& folder) {
  std::uint64_t bytes = 0;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    if (entry.path().filename().string().find(".mcap") == std::string::npos) continue;
    const std::uintmax_t size = entry.is_regular_file(error) ? entry.file_size(error) : 0;
    if (!error) bytes += size;
  }
  return bytes;
}

}  // namespace phalanx

// SPDX-License-Identifier: Apache-2.0
#include "serve/audit_log.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <cmath>
#include <ctime>
#include <nlohmann/json.hpp>
#include <string>

#include "serve/plain_text.h"

namespace phalanx {
namespace {

/// "2026-05-04T09:30:00.123Z"
std::string utc(double unix_time) {
  const double whole = std::floor(unix_time);
  return fmt::format("{:%Y-%m-%dT%H:%M:%S}.{:03d}Z", fmt::gmtime(static_cast<std::time_t>(whole)),
                     static_cast<int>((unix_time - whole) * 1e3));
}

std::string line_of(const wire::Notice& notice) {
  const nlohmann::ordered_json line = {{"time", utc(notice.unix_time())},
                                       {"level", wire::Notice::Level_Name(notice.level())},
                                       {"who", notice.who()},
                                       {"code", notice.code()},
                                       {"text", notice.text()}};
  return line.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

std::string gap_line(const LogGap& gap) {
  wire::Notice notice;
  notice.set_level(wire::Notice::WARNING);
  notice.set_unix_time(gap.until);
  notice.set_code("log_gap");
  notice.set_text(fmt::format("lines missing here, from {} on, because the disk did not take them: {}",
                              utc(gap.since), gap.lines));
  return line_of(notice);
}

}  // namespace

AuditLog::AuditLog(const std::filesystem::path& file, std::uintmax_t file_length) {
  if (!file.empty()) file_.emplace(file, file_length, gap_line);
}

void AuditLog::add(const wire::Notice& notice) {
  newest_.push_back(notice);
  newest_.back().set_text(shortened(notice.text(), kTextLength));
  if (newest_.size() > kRemembered) newest_.pop_front();
  if (file_) file_->add(notice.unix_time(), line_of(notice));
}

}  // namespace phalanx

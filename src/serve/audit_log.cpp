// SPDX-License-Identifier: Apache-2.0
#include "serve/audit_log.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <cerrno>
#include <cmath>
#include <ctime>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "serve/plain_text.h"

namespace phalanx {
namespace {

/// "2026-05-04T09:30:00.123Z"
std::string utc(double unix_time) {
  const double whole = std::floor(unix_time);
  return fmt::format("{:%Y-%m-%dT%H:%M:%S}.{:03d}Z", fmt::gmtime(static_cast<std::time_t>(whole)),
                     static_cast<int>((unix_time - whole) * 1e3));
}

}  // namespace

AuditLog::AuditLog(std::filesystem::path file, std::uintmax_t file_length)
    : path_(std::move(file)), file_length_(file_length) {
  if (path_.empty()) return;
  std::error_code error;
  if (path_.has_parent_path()) std::filesystem::create_directories(path_.parent_path(), error);
  open();
  if (!file_)
    throw std::runtime_error(
        fmt::format("{}: the log of changes cannot be written ({}); name another with --audit",
                    path_.string(), std::generic_category().message(errno)));
}

void AuditLog::open() {
  file_.reset(std::fopen(path_.c_str(), "ae"));
  if (!file_) return;
  std::error_code none;
  const std::uintmax_t bytes = std::filesystem::file_size(path_, none);
  written_ = none ? 0 : bytes;  // a device has no length
}

bool AuditLog::begin_anew() {
  file_.reset();
  std::filesystem::path old = path_;
  old += ".1";
  std::error_code error;
  std::filesystem::rename(path_, old, error);
  if (!error) open();
  return file_ != nullptr;
}

void AuditLog::write(const std::string& line) {
  if (written_ > 0 && written_ + line.size() > file_length_ && !begin_anew()) {
    broken_ = true;
    return;
  }
  written_ += line.size();
  broken_ = std::fputs(line.c_str(), file_.get()) < 0 || std::fflush(file_.get()) != 0;
}

void AuditLog::add(const wire::Notice& notice) {
  newest_.push_back(notice);
  newest_.back().set_text(shortened(notice.text(), kTextLength));
  if (newest_.size() > kRemembered) newest_.pop_front();
  if (!file_ || broken_) return;
  const nlohmann::ordered_json line = {{"time", utc(notice.unix_time())},
                                       {"level", wire::Notice::Level_Name(notice.level())},
                                       {"who", notice.who()},
                                       {"code", notice.code()},
                                       {"text", notice.text()}};
  write(line.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
}

}  // namespace phalanx

// SPDX-License-Identifier: Apache-2.0
#include "serve/audit_log.h"

#include <fcntl.h>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cmath>
#include <ctime>
#include <exception>
#include <mutex>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <utility>

#include "phalanx/core/nice_thread.h"
#include "record/plain_text.h"

namespace phalanx {

// ---- LogFile ----

namespace {

/// Adds a later gap.
void join(LogGap& gap, const LogGap& later) {
  if (later.lines == 0) return;
  if (gap.lines == 0) gap.since = later.since;
  gap.until = later.until;
  gap.lines += later.lines;
}

/// File that is appended to and renamed when it is full. After a failure it is opened again.
class AppendedFile {
 public:
  AppendedFile(std::filesystem::path path, std::uintmax_t most) : path_(std::move(path)), most_(most) {}
  AppendedFile(const AppendedFile&) = delete;
  AppendedFile& operator=(const AppendedFile&) = delete;
  ~AppendedFile() { close(); }

  [[nodiscard]] bool open() {
    file_ = ::open(path_.c_str(), O_WRONLY | O_APPEND | O_CREAT | O_CLOEXEC, 0666);
    struct stat status{};
    regular_ = file_ >= 0 && ::fstat(file_, &status) == 0 && S_ISREG(status.st_mode);
    length_ = regular_ ? static_cast<std::uintmax_t>(status.st_size) : 0;  // a device has no length
    return file_ >= 0;
  }

  /// @returns true if all of the text is in the file
  [[nodiscard]] bool append(std::string_view text) {
    if (file_ < 0 && !open()) return false;
    if (length_ > 0 && length_ + text.size() > most_ && !rotate()) return false;
    if ((!torn_ || put("\n")) && put(text)) return true;
    close();
    return false;
  }

 private:
  [[nodiscard]] bool put(std::string_view text) {
    while (!text.empty()) {
      const ssize_t done = ::write(file_, text.data(), text.size());
      if (done < 0 && errno == EINTR) continue;
      if (done <= 0) return false;
      const auto bytes = static_cast<std::size_t>(done);
      text.remove_prefix(bytes);
      torn_ = !text.empty();
      if (regular_) length_ += bytes;
    }
    return true;
  }

  [[nodiscard]] bool rotate() {
    close();
    std::filesystem::path old = path_;
    old += ".1";
    std::error_code error;
    std::filesystem::rename(path_, old, error);
    torn_ = torn_ && error;
    return !error && open();
  }

  void close() noexcept {
    if (file_ >= 0) ::close(std::exchange(file_, -1));
  }

  std::filesystem::path path_;
  std::uintmax_t most_;
  std::uintmax_t length_ = 0;  ///< [bytes]
  int file_ = -1;
  bool regular_ = false;
  bool torn_ = false;  ///< the file ends in the middle of a line: the next text begins a new one
};

}  // namespace

/// State that both threads use.
struct LogFile::Shared : ThreadEnd {
  struct Line {
    LogGap before;
    double time = 0.0;
    std::string text;
  };

  Shared(std::filesystem::path path, std::uintmax_t file_length,
         std::function<std::string(const LogGap&)> line)
      : file(std::move(path), file_length), gap_line(std::move(line)) {}

  std::deque<Line> waiting;
  std::size_t waiting_bytes = 0;
  LogGap missing;  ///< after the lines that wait
  std::atomic<bool> broken{false};

  // ---- of the writing thread once it has begun
  AppendedFile file;
  const std::function<std::string(const LogGap&)> gap_line;
};

LogFile::LogFile(std::filesystem::path file, std::uintmax_t file_length,
                 std::function<std::string(const LogGap&)> gap_line)
    : shared_(std::make_shared<Shared>(file, file_length, std::move(gap_line))) {
  std::error_code error;
  if (file.has_parent_path()) std::filesystem::create_directories(file.parent_path(), error);
  if (!shared_->file.open())
    throw std::runtime_error(
        fmt::format("{}: the log of changes cannot be written ({}); name another with --audit", file.string(),
                    std::generic_category().message(errno)));
  thread_ = start_nice_thread("phalanx-log", [shared = shared_] { write_all(*shared); });
}

LogFile::~LogFile() { end_or_leave(*shared_, thread_, kCloseTimeout); }

void LogFile::add(double time, std::string line) {
  const std::lock_guard lock(shared_->mutex);
  const bool full =
      shared_->waiting.size() >= kWaiting || shared_->waiting_bytes + line.size() > kWaitingBytes;
  if (full && !shared_->waiting.empty()) {
    join(shared_->missing, {.lines = 1, .since = time, .until = time});
    shared_->broken = true;
    return;
  }
  shared_->waiting_bytes += line.size();
  shared_->waiting.push_back(
      {.before = std::exchange(shared_->missing, {}), .time = time, .text = std::move(line)});
  shared_->changed.notify_all();
}

bool LogFile::broken() const noexcept { return shared_->broken; }

void LogFile::write_all(Shared& shared) {
  LogGap gap;  // not named in the file yet
  const auto put = [&](const std::string& line) noexcept {
    try {
      if (!shared.file.append(gap.lines > 0 ? shared.gap_line(gap) + line : line)) return false;
    } catch (const std::exception&) {  // no memory
      return false;
    }
    gap = {};
    return true;
  };
  std::unique_lock lock(shared.mutex);
  for (;;) {
    shared.changed.wait(lock, [&] { return shared.ending || !shared.waiting.empty(); });
    if (shared.waiting.empty()) break;
    const Shared::Line line = std::move(shared.waiting.front());
    shared.waiting.pop_front();
    shared.waiting_bytes -= line.text.size();
    lock.unlock();
    join(gap, line.before);
    const bool written = put(line.text);
    if (!written) join(gap, {.lines = 1, .since = line.time, .until = line.time});
    shared.broken = !written;
    lock.lock();
  }
  join(gap, shared.missing);
  lock.unlock();
  if (gap.lines > 0) put("");
  lock.lock();
  shared.ended = true;
  shared.changed.notify_all();
}

// ---- AuditLog ----

namespace {

/// @returns "2026-05-04T09:30:00.123Z"
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

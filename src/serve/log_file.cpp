// SPDX-License-Identifier: Apache-2.0
#include "serve/log_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <utility>

#include "phalanx/core/nice_thread.h"

namespace phalanx {
namespace {

void join(LogGap& gap, const LogGap& later) {
  if (later.lines == 0) return;
  if (gap.lines == 0) gap.since = later.since;
  gap.until = later.until;
  gap.lines += later.lines;
}

/// Appends, and puts itself aside when it is full. After a failure it is opened anew.
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
    length_ = regular_ ? static_cast<std::uintmax_t>(status.st_size) : 0;  // a device has none
    return file_ >= 0;
  }

  /// @returns whether all of it is in the file
  [[nodiscard]] bool append(std::string_view text) {
    if (file_ < 0 && !open()) return false;
    if (length_ > 0 && length_ + text.size() > most_ && !begin_anew()) return false;
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
      torn_ = !text.empty();  // what comes next begins a line of its own
      if (regular_) length_ += bytes;
    }
    return true;
  }

  [[nodiscard]] bool begin_anew() {
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
  std::uintmax_t length_ = 0;  ///< what it holds [bytes]
  int file_ = -1;
  bool regular_ = false;
  bool torn_ = false;  ///< ends in the middle of a line
};

}  // namespace

/// What both threads hold.
struct LogFile::Desk {
  struct Line {
    LogGap before;
    double time = 0.0;
    std::string text;
  };

  Desk(std::filesystem::path path, std::uintmax_t file_length,
       std::function<std::string(const LogGap&)> words)
      : file(std::move(path), file_length), gap_line(std::move(words)) {}

  std::mutex mutex;
  std::condition_variable changed;
  std::deque<Line> waiting;
  std::size_t waiting_bytes = 0;
  LogGap missing;  ///< behind what waits
  bool ending = false;
  bool ended = false;
  std::atomic<bool> broken{false};

  // The writing thread's, once it has begun.
  AppendedFile file;
  const std::function<std::string(const LogGap&)> gap_line;
};

LogFile::LogFile(std::filesystem::path file, std::uintmax_t file_length,
                 std::function<std::string(const LogGap&)> gap_line)
    : desk_(std::make_shared<Desk>(file, file_length, std::move(gap_line))) {
  std::error_code error;
  if (file.has_parent_path()) std::filesystem::create_directories(file.parent_path(), error);
  if (!desk_->file.open())
    throw std::runtime_error(
        fmt::format("{}: the log of changes cannot be written ({}); name another with --audit", file.string(),
                    std::generic_category().message(errno)));
  thread_ = start_nice_thread("phalanx-log", [desk = desk_] { write_all(*desk); });
}

LogFile::~LogFile() {
  bool ended = false;
  {
    std::unique_lock lock(desk_->mutex);
    desk_->ending = true;
    desk_->changed.notify_all();
    ended = desk_->changed.wait_for(lock, std::chrono::duration<double>(kGoodbye),
                                    [this] { return desk_->ended; });
  }
  if (ended) {
    thread_.join();
  } else {
    thread_.detach();
  }
}

void LogFile::add(double time, std::string line) {
  const std::lock_guard lock(desk_->mutex);
  const bool full = desk_->waiting.size() >= kWaiting || desk_->waiting_bytes + line.size() > kWaitingBytes;
  if (full && !desk_->waiting.empty()) {
    join(desk_->missing, {.lines = 1, .since = time, .until = time});
    desk_->broken = true;
    return;
  }
  desk_->waiting_bytes += line.size();
  desk_->waiting.push_back(
      {.before = std::exchange(desk_->missing, {}), .time = time, .text = std::move(line)});
  desk_->changed.notify_all();
}

bool LogFile::broken() const noexcept { return desk_->broken; }

void LogFile::write_all(Desk& desk) {
  LogGap gap;  // that the file does not name yet
  const auto put = [&](const std::string& line) noexcept {
    try {
      if (!desk.file.append(gap.lines > 0 ? desk.gap_line(gap) + line : line)) return false;
    } catch (const std::exception&) {  // no memory
      return false;
    }
    gap = {};
    return true;
  };
  std::unique_lock lock(desk.mutex);
  for (;;) {
    desk.changed.wait(lock, [&] { return desk.ending || !desk.waiting.empty(); });
    if (desk.waiting.empty()) break;
    const Desk::Line line = std::move(desk.waiting.front());
    desk.waiting.pop_front();
    desk.waiting_bytes -= line.text.size();
    lock.unlock();
    join(gap, line.before);
    const bool written = put(line.text);
    if (!written) join(gap, {.lines = 1, .since = line.time, .until = line.time});
    desk.broken = !written;
    lock.lock();
  }
  join(gap, desk.missing);
  lock.unlock();
  if (gap.lines > 0) put("");
  lock.lock();
  desk.ended = true;
  desk.changed.notify_all();
}

}  // namespace phalanx

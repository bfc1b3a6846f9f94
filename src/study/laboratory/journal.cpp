// SPDX-License-Identifier: Apache-2.0
#include "study/laboratory/journal.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <utility>

#include "phalanx/record/output_file.h"
#include "record/partial_file.h"

namespace phalanx {
namespace {

/// Writes a new file's name to the disk, too. If a folder cannot be synchronised, this is ignored.
void synchronise_folder_of(const std::filesystem::path& file) {
  const auto folder = file.has_parent_path() ? file.parent_path() : std::filesystem::path(".");
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  static_cast<void>(::fsync(descriptor));
  ::close(descriptor);
}

}  // namespace

void replace_journal(const std::filesystem::path& file, const JournalContent& content) {
  OutputFile out(file);
  out.text(journal_text(content));
  out.synchronise();
  out.commit();
  synchronise_folder_of(file);
}

Journal::Journal(std::filesystem::path file)
    : file_(std::move(file)),
      descriptor_(::open(file_.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0644)) {
  if (descriptor_ < 0) fail("opened");
  try {
    refuse_other_than_a_file();
    lock();
  } catch (...) {
    ::close(descriptor_);
    throw;
  }
}

Journal::Journal(std::filesystem::path file, const JournalHeader& header, bool restart)
    : Journal(std::move(file)) {
  begin(header, restart);
}

void Journal::begin(const JournalHeader& header, bool restart) {
  if (restart && ::ftruncate(descriptor_, 0) != 0) fail("emptied");
  take_up(header);
}

Journal::~Journal() { ::close(descriptor_); }

void Journal::fail(const char* what) const {
  throw std::runtime_error(fmt::format("{}: cannot be {}: {}", file_.string(), what, std::strerror(errno)));
}

void Journal::refuse_other_than_a_file() const {
  struct stat status{};
  if (::fstat(descriptor_, &status) != 0) fail("examined");
  if (S_ISREG(status.st_mode)) return;
  throw std::invalid_argument(
      fmt::format("{}: is no ordinary file; name another --out folder", file_.string()));
}

void Journal::lock() {
  const FileLock taken = lock_file(descriptor_, file_);
  if (taken == FileLock::kTaken) return;
  if (taken == FileLock::kNotPossible)
    throw std::runtime_error(fmt::format(
        "{}: this file system has no locks that keep two processes from writing it; use another --out folder",
        file_.string()));
  throw std::invalid_argument(
      fmt::format("{}: another process is writing it; wait until that has ended, or use another --out folder",
                  file_.string()));
}

/// Reads through the open descriptor: a journal that cannot be opened again must not look empty.
std::string Journal::content() const {
  std::string text;
  std::array<char, 65536> block;
  for (;;) {
    const ssize_t count = ::pread(descriptor_, block.data(), block.size(), static_cast<off_t>(text.size()));
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) fail("read");
    if (count == 0) return text;
    text.append(block.data(), static_cast<std::size_t>(count));
  }
}

void Journal::take_up(const JournalHeader& header) {
  const std::string header_text = journal_text({.header = header, .points = {}});
  std::string text = content();
  const std::size_t size = text.size();
  const std::size_t complete = text.rfind('\n') + 1;  // 0 if there is no complete line
  if (complete == 0 && header_text.starts_with(text)) {
    if (::ftruncate(descriptor_, 0) != 0) fail("emptied");
    write_line(header_text);
    synchronise_folder_of(file_);
    return;
  }
  JournalContent there = parse_journal(std::move(text), file_);
  if (there.points.empty()) there.header.libm.clear();  // nothing was measured
  if (const std::string problem = difference(there.header, header); !problem.empty()) {
    throw std::invalid_argument(
        fmt::format("{}: {}; use another --out folder, or --restart to throw its {} finished points away",
                    file_.string(), problem, there.points.size()));
  }
  if (there.points.empty()) {  // begins with this machine's libm
    if (::ftruncate(descriptor_, 0) != 0) fail("emptied");
    write_line(header_text);
    return;
  }
  if (complete < size && ::ftruncate(descriptor_, static_cast<off_t>(complete)) != 0) fail("shortened");
  finished_ = std::move(there.points);
  libm_ = std::move(there.header.libm);
}

void Journal::append(const PointResult& result) {
  const std::string text = result_line(result);
  const std::lock_guard<std::mutex> guard(mutex_);
  write_line(text);
}

void Journal::write_line(const std::string& line) {
  struct stat before{};
  if (::fstat(descriptor_, &before) != 0) fail("written");
  ssize_t written = -1;
  do {
    written = ::write(descriptor_, line.data(), line.size());
  } while (written < 0 && errno == EINTR);
  if (written == static_cast<ssize_t>(line.size())) {
    if (::fsync(descriptor_) != 0) fail("written to the disk");
    return;
  }
  const int reason = written < 0 ? errno : ENOSPC;  // written in part: the disk is full
  if (written > 0) static_cast<void>(::ftruncate(descriptor_, before.st_size) == 0);
  errno = reason;
  fail("written");
}

}  // namespace phalanx

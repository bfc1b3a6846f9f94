// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <thread>

namespace phalanx {

/// Lines that never got into a file.
struct LogGap {
  std::size_t lines = 0;
  double since = 0.0;  ///< when the first of them was added [s], since 1970
  double until = 0.0;  ///< the last of them
};

/// A file that is only ever appended to, by a thread of its own that gives way to others: whoever adds a line
/// never waits for the disk. What the disk does not take (it is full, gone, or so slow that kWaiting lines
/// wait already) is counted, and a line that names the gap stands in its place as soon as the file can be
/// written again, which each further line tries. Not real-time: allocates and locks.
class LogFile {
 public:
  static constexpr std::size_t kWaiting = 1000;            ///< lines
  static constexpr std::size_t kWaitingBytes = 8'000'000;  ///< of them; one alone may be longer
  static constexpr double kGoodbye = 2.0;                  ///< how long the end waits for the disk [s]

  /// @param file         is made, with its folder
  /// @param file_length  what would make it longer begins it anew; what it held is then in the file with ".1"
  ///                     behind its name, instead of what was there [bytes]
  /// @param gap_line     the line that names a gap, '\n' included; called on the writing thread
  /// @throws std::runtime_error if it cannot be written
  LogFile(std::filesystem::path file, std::uintmax_t file_length,
          std::function<std::string(const LogGap&)> gap_line);
  LogFile(const LogFile&) = delete;
  LogFile& operator=(const LogFile&) = delete;
  /// Writes what waits. A disk that is stuck for longer than kGoodbye is left alone with it.
  ~LogFile();

  /// @param time  now [s], since 1970
  /// @param line  '\n' included
  void add(double time, std::string line);
  /// The newest line that the disk was to take was not taken. Any thread.
  [[nodiscard]] bool broken() const noexcept;

 private:
  struct Desk;
  static void write_all(Desk& desk);

  std::shared_ptr<Desk> desk_;  ///< the thread's, too: it may be there longer
  std::thread thread_;
};

}  // namespace phalanx

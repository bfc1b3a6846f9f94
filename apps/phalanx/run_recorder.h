// SPDX-License-Identifier: Apache-2.0
// What `phalanx run` writes while it runs: its log, and the reports of its faults.
#pragma once

#include <atomic>
#include <deque>
#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "phalanx/record/output_file.h"
#include "phalanx/station/station_host.h"

namespace phalanx {

/// Fetches the station's steps and writes them on a thread of its own, which alone waits for the disk. What
/// was fetched is handed to the system at once: it is there however the process ends. A log that cannot be
/// written is given up, with what is in it; the station goes on.
class RunRecorder {
 public:
  /// What became of something, for people.
  struct Note {
    std::string complaint;    ///< empty: a fault's report was written
    std::string report;       ///< its folder
    double fault_time = 0.0;  ///< FaultEvent::time of it [s]
  };

  /// @param log      empty: none. @param reports  folder
  /// @throws as OutputFile
  RunRecorder(const std::string& log, std::filesystem::path reports);
  RunRecorder(const RunRecorder&) = delete;
  RunRecorder& operator=(const RunRecorder&) = delete;
  ~RunRecorder();  ///< finish(false)

  /// OutputFile::finished_earlier()
  [[nodiscard]] std::filesystem::path finished_earlier() const;
  /// @param host  outlives it. @throws std::system_error: no thread
  void begin(StationHost& host);
  void write_report(FaultReport report);
  [[nodiscard]] std::optional<Note> next_note();
  /// Writes what the station has left, and ends. Call it after StationHost::shut_down().
  /// @param in_good_order  false: the log does not get its name, and so takes that of no finished one
  void finish(bool in_good_order) noexcept;
  /// Whether there is a log that is not whole.
  [[nodiscard]] bool lost() const noexcept { return lost_; }

 private:
  void work() noexcept;
  void write_steps() noexcept;
  void write_reports() noexcept;
  void commit() noexcept;
  void give_up_log(const std::exception& error) noexcept;
  // Where there is no memory for a note, there is none. @param text, make  called for it
  template <class Text>
  void complain(Text text) noexcept;
  template <class Make>
  void note(Make make) noexcept;

  const std::filesystem::path reports_;
  StationHost* host_ = nullptr;
  std::optional<OutputFile> log_;  ///< the thread's while there is one
  std::atomic<bool> lost_{false};
  std::atomic<bool> ending_{false};

  std::mutex mutex_;
  std::deque<FaultReport> faults_;
  std::deque<Note> notes_;
  std::thread thread_;
};

}  // namespace phalanx

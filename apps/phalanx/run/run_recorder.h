// SPDX-License-Identifier: Apache-2.0
// The files that `phalanx run` writes while it runs: its recording, its log, and the reports of its faults.
#pragma once

#include <atomic>
#include <deque>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "phalanx/record/output_file.h"
#include "phalanx/record/session_recorder.h"
#include "phalanx/station/session.h"

namespace phalanx {

/// Recorder that fetches the station's steps and writes them on a thread of its own; only this thread waits
/// for the disk. Fetched steps are handed to the operating system at once, so that they remain if the process
/// is killed. If the log cannot be written, it is closed with the steps that it holds, and
/// the station continues.
class RunRecorder {
 public:
  static constexpr int kPatience = 10;  ///< for a disk that refuses the end of a recording [s]

  /// A message for the user about a log or report.
  struct Note {
    std::string complaint;    ///< empty: a fault's report was written
    std::string report;       ///< folder of the report
    double fault_time = 0.0;  ///< FaultEvent::time of the fault [s]
  };

  /// What is called on the recorder's thread, beside what is written. Exceptions become notes.
  struct Watch {
    std::function<void(const StepRecord&)> on_step;  ///< after the step was handed to the recording
    std::function<void()> on_last;                   ///< after the last step, before the recording ends
  };

  /// Opens the log.
  /// @param log      empty: none
  /// @param reports  folder of fault reports
  /// @throws as OutputFile
  RunRecorder(const std::string& log, std::filesystem::path reports);
  RunRecorder(const RunRecorder&) = delete;
  RunRecorder& operator=(const RunRecorder&) = delete;
  ~RunRecorder();  ///< finish(false)

  /// @returns OutputFile::finished_earlier() of the log.
  [[nodiscard]] std::filesystem::path finished_earlier() const;
  /// Begins the recording, and starts the thread.
  /// @param session   outlives the recorder, as does `clock`
  /// @param settings  none: nothing is recorded
  /// @param watch     may be empty
  /// @throws std::system_error if no thread can be made; as SessionRecorder
  void begin(Session& session, const Clock& clock, std::optional<RecorderSettings> settings,
             Watch watch = {});
  /// Adds something that happened to the recording, if there is one. Any thread.
  void event(const std::string& code, const std::string& who, const std::string& text);
  /// @returns the state of the recording; empty: nothing is recorded. Any thread.
  [[nodiscard]] std::optional<RecordingStatus> recording() const;
  void write_report(FaultReport report);
  [[nodiscard]] std::optional<Note> next_note();
  /// Writes the steps that the station still holds, and ends the thread. Call
  /// it after Session::shut_down().
  /// @param in_good_order  false: the log keeps the name FILE.partial, so that it does not replace
  /// a finished log
  /// @param on_refused  called once if the disk does not take the end of the recording; it is then tried for kPatience.
  /// Empty: it is not
  void finish(bool in_good_order,
              const std::function<void(const RecordingStatus&)>& on_refused = {}) noexcept;
  /// @returns true if a log or the recording could not be written to its end
  [[nodiscard]] bool lost() const noexcept { return lost_; }

 private:
  void work() noexcept;
  void write_steps() noexcept;
  void record_step(const StepRecord& record) noexcept;
  void log_step(const StepRecord& record) noexcept;
  void watch_step(const StepRecord& record) noexcept;
  void watch_last() noexcept;
  void write_reports() noexcept;
  void commit() noexcept;
  void finish_recording(const std::function<void(const RecordingStatus&)>& on_refused) noexcept;
  bool ended_recording(const std::function<void(const RecordingStatus&)>& on_refused);
  void give_up_log(const std::exception& error) noexcept;
  // Both leave the note out if there is no memory for it. `text` returns the text, and `make` the note.
  template <class Text>
  void complain(Text text) noexcept;
  template <class Make>
  void note(Make make) noexcept;

  const std::filesystem::path reports_;
  Session* session_ = nullptr;
  Watch watch_;
  std::unique_ptr<SessionRecorder> recording_;  ///< null: nothing is recorded
  std::optional<OutputFile> log_;               ///< the thread uses it while there is one
  std::vector<DeviceSample> samples_;           ///< of the step being written
  std::atomic<bool> lost_{false};
  std::atomic<bool> ending_{false};

  std::mutex mutex_;
  std::deque<FaultReport> faults_;
  std::deque<Note> notes_;
  std::thread thread_;
};

}  // namespace phalanx

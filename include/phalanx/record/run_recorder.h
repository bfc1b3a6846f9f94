// SPDX-License-Identifier: Apache-2.0
// The files that a program with a station writes while it runs: its recordings, its log, and the reports of its faults.
#pragma once

#include <atomic>
#include <deque>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include "phalanx/record/change_reader.h"
#include "phalanx/record/output_file.h"
#include "phalanx/record/session_recorder.h"
#include "phalanx/station/session.h"

namespace phalanx {

/// Functions that a RunRecorder calls on its thread, beside what it writes. Exceptions become notes.
struct RecordingWatch {
  std::function<void(const StepRecord&)> on_step = {};  ///< after the step was handed to the recording
  std::function<void()> on_last = {};                   ///< after the last step, before the recording ends
  /// After the recording, when its file is closed: with its end, or without one if the disk refused that for
  /// RunRecorder::kPatience. Once, and not if there was no recording. `file` is empty if there was no memory for it.
  std::function<void(const std::filesystem::path& file, bool whole)> on_ended = {};
};

/// Order for RunRecorder::next_recording(). Its functions are called on the recorder's thread, and must return soon: the
/// steps wait meanwhile.
struct NextRecording {
  RecorderSettings settings;
  /// Makes the watch of the recording, before its first step. It may be empty. @param file  RecordingStatus::file
  std::function<RecordingWatch(const std::filesystem::path& file)> watch = {};
  /// The file is open: now it is time for Session::replace(). @param file  RecordingStatus::file
  std::function<void(const std::filesystem::path& file)> on_ready = {};
  /// The recording cannot begin, in words. The steps go on into the recording before it. At most once, and not after
  /// cancel_recording(). If `watch` has thrown, the recording has begun, without a watch.
  std::function<void(const std::string& why)> on_refused = {};
};

/// Recorder that fetches the station's steps and writes them on a thread of its own; only this thread waits
/// for the disk. Fetched steps are handed to the operating system at once, so that they remain if the process
/// is killed. If the log cannot be written, it is closed with the steps that it holds, and
/// the station continues.
///
/// Several recordings of one session follow each other without a gap: each step is in one of them. A recording ends before
/// the first step of a station that was ordered with StationOrder::recording, and the next one begins with this step.
class RunRecorder {
 public:
  static constexpr int kPatience = 10;  ///< for a disk that refuses the end of a recording [s]

  /// A message for the user about a log or report.
  struct Note {
    std::string complaint;    ///< empty: a fault's report was written
    std::string report;       ///< folder of the report
    double fault_time = 0.0;  ///< FaultEvent::time of the fault [s]
  };

  using Watch = RecordingWatch;

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
  /// Opens the next recording soon, and begins it with the first step of the station for which Session::replace() gets
  /// the returned number as StationOrder::recording. The recording before it is ended at this point. Any thread, after
  /// begin(). The session keeps its changes (SessionSettings::keep_changes).
  ///
  /// Only one recording waits: a second call cancels the first. If its station ends before its first step was fetched, the
  /// recording is refused.
  /// @returns its number, from 1
  /// @throws std::invalid_argument if the session does not keep its changes
  std::uint64_t next_recording(NextRecording next);
  /// Removes the file of a recording that waits, after a refused Session::replace() for example.
  /// @returns false, with no effect, if it has begun, was refused, or is another's number. Any thread.
  bool cancel_recording(std::uint64_t number);
  /// Ends the recording of this moment soon, after the steps that the station still holds. Nothing is recorded until the
  /// next one begins. For a session that has no station, so that no other recording can follow. Any thread.
  void end_recording() noexcept { end_asked_ = true; }
  /// Adds something that happened to the recording of this moment, if there is one. Any thread.
  void event(const std::string& code, const std::string& who, const std::string& text);
  /// @returns the state of the recording of this moment; empty: nothing is recorded. Any thread.
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
  /// The recording that waits for its station.
  struct Prepared {
    std::uint64_t number = 0;
    NextRecording order = {};
    std::shared_ptr<SessionRecorder> file = {};
  };
  /// A recording that has all its steps, and whose end the disk has not taken.
  struct Ending {
    std::shared_ptr<SessionRecorder> file = {};
    RecordingWatch watch = {};
    double next_try = 0.0;  ///< [s]
    double give_up = 0.0;   ///< [s]
  };

  void work() noexcept;
  void write_steps() noexcept;
  void record_step(const StepRecord& record) noexcept;
  void log_step(const StepRecord& record) noexcept;
  void watch_step(const StepRecord& record) noexcept;
  void watch_last() noexcept;
  void watch_ended(const RecordingWatch& watch, const std::filesystem::path& file, bool whole) noexcept;
  void write_reports() noexcept;
  void commit() noexcept;

  void begin_station(std::uint64_t station) noexcept;
  void take_order() noexcept;
  void begin_prepared(std::uint64_t station) noexcept;
  void exchange_recording(std::shared_ptr<SessionRecorder> next) noexcept;
  void refuse_prepared(std::string_view why) noexcept;  // needs no memory: a recording is ended without any
  void refuse_orders(std::string_view why) noexcept;
  void drop_prepared() noexcept;
  [[nodiscard]] bool still_wanted(std::uint64_t number) noexcept;
  void end_earlier(bool last) noexcept;

  void finish_recording(const std::function<void(const RecordingStatus&)>& on_refused) noexcept;
  bool ended_recording(const std::function<void(const RecordingStatus&)>& on_refused);
  void complain_of_end(const SessionRecorder& file) noexcept;
  void give_up_log(const std::exception& error) noexcept;
  // Both leave the note out if there is no memory for it. `text` returns the text, and `make` the note.
  template <class Text>
  void complain(Text text) noexcept;
  template <class Make>
  void note(Make make) noexcept;

  const std::filesystem::path reports_;
  Session* session_ = nullptr;
  const Clock* clock_ = nullptr;
  std::atomic<bool> lost_{false};
  std::atomic<bool> ending_{false};
  std::atomic<bool> end_asked_{false};  ///< the present recording is to end, without a next one

  // ---- the thread's, while there is one
  RecordingWatch watch_;
  std::shared_ptr<ChangeReader> changes_;
  std::uint64_t station_ = 0;          ///< of the newest step
  std::optional<Prepared> prepared_;   ///< its file is open
  std::vector<Ending> earlier_;        ///< recordings whose end is tried again
  std::optional<OutputFile> log_;      ///< the thread uses it while there is one
  std::vector<DeviceSample> samples_;  ///< of the step being written

  mutable std::mutex recording_mutex_;
  std::shared_ptr<SessionRecorder>
      recording_;  ///< null: nothing is recorded. The thread exchanges it under the lock

  std::optional<RecordingStatus> ended_;  ///< of the last recording, after finish()

  std::mutex mutex_;               ///< of the members below
  std::optional<Prepared> asked_;  ///< its file is not open yet
  std::uint64_t numbers_ = 0;      ///< of the newest order
  std::uint64_t wanted_ = 0;       ///< number of the recording that waits; 0: none
  std::deque<FaultReport> faults_;
  std::deque<Note> notes_;
  std::thread thread_;
};

template <class Text>
void RunRecorder::complain(Text text) noexcept {
  note([&] { return Note{.complaint = text(), .report = {}, .fault_time = 0.0}; });
}

template <class Make>
void RunRecorder::note(Make make) noexcept {
  try {
    Note made = make();
    const std::lock_guard lock(mutex_);
    notes_.push_back(std::move(made));
  } catch (const std::exception&) {  // no memory for it
  }
}

}  // namespace phalanx

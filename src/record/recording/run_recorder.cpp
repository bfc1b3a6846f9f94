// SPDX-License-Identifier: Apache-2.0
#include "phalanx/record/run_recorder.h"

#include <fmt/format.h>

#include <chrono>
#include <exception>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "phalanx/core/nice_thread.h"
#include "phalanx/core/reason.h"
#include "phalanx/record/station_csv.h"

namespace phalanx {
namespace {

/// Interval of fetching steps, and of recording the hand. The station holds 4 s of unfetched steps at 2 kHz.
constexpr std::chrono::microseconds kBetweenFetches{16'667};

constexpr int kTries = 3;  ///< to end a recording at once

}  // namespace

RunRecorder::RunRecorder(const std::string& log, std::filesystem::path reports)
    : reports_(std::move(reports)) {
  if (log.empty()) return;
  log_.emplace(log, Unfinished::kLeft);
  write_step_header(*log_);
}

RunRecorder::~RunRecorder() { finish(false); }

std::filesystem::path RunRecorder::finished_earlier() const {
  return log_ ? log_->finished_earlier() : std::filesystem::path();
}

void RunRecorder::begin(Session& session, const Clock& clock, std::optional<RecorderSettings> settings,
                        Watch watch) {
  session_ = &session;
  clock_ = &clock;
  watch_ = std::move(watch);
  changes_ = std::make_shared<ChangeReader>(session);
  if (settings)
    recording_ = std::make_shared<SessionRecorder>(*std::move(settings), session, clock, changes_);
  thread_ = start_nice_thread("phalanx-record", [this] { work(); });
}

void RunRecorder::event(const std::string& code, const std::string& who, const std::string& text) {
  // Under the lock: the thread cannot end the recording meanwhile.
  const std::lock_guard lock(recording_mutex_);
  if (recording_) recording_->event(code, who, text);
}

std::optional<RecordingStatus> RunRecorder::recording() const {
  const std::lock_guard lock(recording_mutex_);
  if (!recording_) return ended_;
  return recording_->status();
}

void RunRecorder::write_report(FaultReport report) {
  const std::lock_guard lock(mutex_);
  faults_.push_back(std::move(report));
}

std::optional<RunRecorder::Note> RunRecorder::next_note() {
  const std::lock_guard lock(mutex_);
  if (notes_.empty()) return std::nullopt;
  Note next = std::move(notes_.front());
  notes_.pop_front();
  return next;
}

void RunRecorder::finish(bool in_good_order,
                         const std::function<void(const RecordingStatus&)>& on_refused) noexcept {
  if (!thread_.joinable()) return;
  ending_ = true;
  thread_.join();
  refuse_orders("the station has ended");
  watch_last();
  if (in_good_order) commit();
  log_.reset();
  end_earlier(true);
  if (recording_) finish_recording(on_refused);
}

/// @returns false if the disk does not take the end of the recording
bool RunRecorder::ended_recording(const std::function<void(const RecordingStatus&)>& on_refused) {
  for (int tries = 0; tries < kTries; ++tries)
    if (recording_->finish()) return true;
  if (!on_refused) return false;
  on_refused(recording_->status());
  for (int tries = 0; tries < 2 * kPatience; ++tries) {
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
    if (recording_->finish()) return true;
  }
  return false;
}

void RunRecorder::finish_recording(const std::function<void(const RecordingStatus&)>& on_refused) noexcept {
  bool whole = false;
  try {
    whole = ended_recording(on_refused);
  } catch (const std::exception&) {  // no memory to tell it
  }
  if (!whole) complain_of_end(*recording_);
  std::filesystem::path file;
  try {
    const std::lock_guard lock(recording_mutex_);
    ended_ = recording_->status();
    file = ended_->file;
    recording_.reset();              // closes the file
  } catch (const std::exception&) {  // no memory: it is closed with this recorder
  }
  watch_ended(watch_, file, whole);
}

void RunRecorder::complain_of_end(const SessionRecorder& file) noexcept {
  lost_ = true;
  complain([&] {
    const RecordingStatus status = file.status();
    return fmt::format(
        "the recording has no end, and its last {:.1f} s are lost: {}; what {} holds is kept, and "
        "`phalanx session repair` ends it",
        status.unsaved, status.trouble, status.file.string());
  });
}

void RunRecorder::work() noexcept {
  while (!ending_) {
    write_steps();
    write_reports();
    std::this_thread::sleep_for(kBetweenFetches);
  }
  write_steps();
  write_reports();
}

/// Fetches and writes all steps. Without a log, too: the station must not keep a fetched record.
void RunRecorder::write_steps() noexcept {
  take_order();
  try {
    StepRecord record;
    while (session_->next_record(record, samples_)) {
      if (record.station != station_) begin_station(record.station);
      record_step(record);
      log_step(record);
      watch_step(record);
    }
    if (end_asked_.exchange(false) && recording_) {
      watch_last();
      exchange_recording(nullptr);
    }
    if (!recording_) {  // the changes of the steps so far are of no use
      changes_->fetch();
      changes_->drop_through(station_);
    }
  } catch (const std::exception&) {  // no memory: the steps wait in the station
  }
  try {
    if (recording_) recording_->update();
  } catch (const std::exception& error) {
    complain([&] { return "the recording lacks something of the hand or an event: " + reason(error); });
  }
  end_earlier(false);
  try {
    if (log_) log_->write_through();
  } catch (const std::exception& error) {
    give_up_log(error);
  }
}

/// Without memory for it, the step is missing, and the recording names it with the next one.
void RunRecorder::record_step(const StepRecord& record) noexcept {
  try {
    if (recording_) recording_->add(record, samples_);
  } catch (const std::exception& error) {
    complain([&] { return "a step could not be recorded: " + reason(error); });
  }
}

void RunRecorder::log_step(const StepRecord& record) noexcept {
  try {
    if (log_) write_step(*log_, record);
  } catch (const std::exception& error) {
    give_up_log(error);
  }
}

void RunRecorder::watch_step(const StepRecord& record) noexcept {
  try {
    if (watch_.on_step) watch_.on_step(record);
  } catch (const std::exception& error) {
    complain([&] { return "a step could not be evaluated: " + reason(error); });
  }
}

void RunRecorder::watch_last() noexcept {
  try {
    if (watch_.on_last) watch_.on_last();
  } catch (const std::exception& error) {
    complain([&] { return "the end could not be evaluated: " + reason(error); });
  }
}

void RunRecorder::write_reports() noexcept {
  for (;;) {
    std::unique_lock lock(mutex_);
    if (faults_.empty()) return;
    const FaultReport report = std::move(faults_.front());
    faults_.pop_front();
    lock.unlock();
    try {
      const std::string folder = write_fault_report(reports_, report).string();
      note([&] { return Note{.complaint = {}, .report = folder, .fault_time = report.event.time}; });
    } catch (const std::exception& error) {
      complain([&] { return "the fault's report could not be written: " + reason(error); });
    }
  }
}

void RunRecorder::commit() noexcept {
  try {
    if (log_) log_->commit();
  } catch (const std::exception& error) {
    give_up_log(error);
  }
}

void RunRecorder::give_up_log(const std::exception& error) noexcept {
  lost_ = true;
  complain([&] {
    const std::filesystem::path partial = log_->partial();
    log_.reset();  // first: its memory may be needed for the text; an empty file is removed
    std::error_code ignored;
    return fmt::format("the log ends here: {}; {}", reason(error),
                       std::filesystem::exists(partial, ignored)
                           ? "what was written is in " + partial.string()
                           : "nothing was written");
  });
  log_.reset();
}

}  // namespace phalanx

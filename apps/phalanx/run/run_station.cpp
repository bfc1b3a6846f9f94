// SPDX-License-Identifier: Apache-2.0
#include "run/run_station.h"

#include <fmt/format.h>

#include <cstdint>
#include <ctime>
#include <exception>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "commands.h"
#include "phalanx/record/retention.h"
#include "phalanx/record/run_recorder.h"
#include "phalanx/record/station_csv.h"
#include "phalanx/station/session.h"
#include "retention_options.h"
#include "run/disk_messages.h"
#include "run/marker_port.h"
#include "run/run_console.h"
#include "run/run_page.h"
#include "run/run_registry.h"
#include "run/status_line.h"
#include "run/terminate.h"
#include "run/told_openings.h"
#include "run/typed_commands.h"
#include "terminal/end_signals.h"
#include "terminal/error_line.h"
#include "terminal/typed_lines.h"
#include "usage.h"

namespace phalanx {
namespace {

/// One run of the station, with its terminal. This thread waits for neither the terminal nor the disk.
class Run {
 public:
  /// @param registry  patients of the page; null: none
  Run(const RunOptions& options, const Clock& clock, std::shared_ptr<Registry> registry)
      : options_(options),
        clock_(clock),
        registry_(std::move(registry)),
        recorder_(options.log, options.faults) {}

  /// Runs the station. In every case the station first ends at zero torque, and the files are then written.
  int go() {
    if (const auto earlier = recorder_.finished_earlier(); !earlier.empty())
      console_.say(
          fmt::format("the log of a run that did not end in good order is now {}", earlier.string()));
    const SessionSettings settings = session_settings(options_);
    if (const auto recording = recorder_settings(options_)) {
      delete_expired(*recording);
      check_recordings_folder(*recording);
    }
    if (const std::string warning = replaced_copies(settings); !warning.empty())
      console_.complain(warning, Emphasis::kWarning);
    session_ = std::make_unique<Session>(settings, clock_);
    std::exception_ptr failure;
    {
      const LetsGoAtTerminate lets_go(*session_, clock_);
      try {
        serve();
      } catch (...) {
        failure = std::current_exception();
      }
      session_->shut_down();
    }
    const bool saved = save(failure == nullptr);
    if (failure) std::rethrow_exception(failure);
    return say_end() && saved ? kDone : kFailed;
  }

 private:
  void serve() {
    typed_.emplace(*session_);
    recorder_.begin(*session_, clock_, recorder_settings(options_));
    openings_.emplace(*session_, clock_, console_);
    commands_.emplace(TypedCommands::Parts{
        .session = *session_,
        .exercises = exercises_,
        .console = console_,
        .openings = *openings_,
        .quiet = options_.quiet,
        .tell = [this](const std::string& code, const std::string& text) { tell_typed(code, text); }});
    if (options_.marker_port)
      markers_ = std::make_unique<MarkerPort>(options_.marker_address,
                                              static_cast<std::uint16_t>(*options_.marker_port),
                                              [this](const std::string& from, const std::string& text) {
                                                recorder_.event("marker", from, text);
                                              });
    exercises_ = exercises_of_run(options_, *session_, recorder_, registry_,
                                  [this](const std::string& text, bool warning) {
                                    warning ? console_.say(text, Emphasis::kWarning) : console_.say(text);
                                    tell_notice("exercise", text);
                                  });
    introduce();
    if (!options_.headless)
      page_ = std::make_unique<RunPage>(options_, *session_, recorder_, console_,
                                        PagePatients{.registry = registry_, .exercises = exercises_});
    watch();
  }

  /// Deletes the recordings that the rule on them no longer keeps, and says which.
  void delete_expired(const RecorderSettings& recording) {
    const RetentionRule rule = retention_rule(options_.record_keep_days, options_.record_keep_gb);
    if (!rule.deletes()) return;
    const auto now = static_cast<double>(std::time(nullptr));
    for (const RecordingSummary& old : expired_recordings(list_recordings(recording.folder), rule, now)) {
      try {
        delete_recording(old.file);
        console_.say(fmt::format("deleted {}, by the rule of --record-keep-days and --record-keep-gb",
                                 old.file.string()));
      } catch (const std::filesystem::filesystem_error& error) {
        console_.complain(fmt::format("{} is older than is to be kept, and cannot be deleted ({})",
                                      old.file.string(), error.code().message()),
                          Emphasis::kWarning);
      }
    }
  }

  void introduce() {
    const auto info = session_->info();
    console_.say(
        fmt::format("scene {} at {} Hz, device {} (serial {}), at most {} N a digit{}", info->scene,
                    info->geometry->rate_hz, info->device.name, info->device.serial, info->fingertip_force,
                    options_.clinician.empty() ? "" : fmt::format(" (set by {})", options_.clinician)));
    if (const auto recording = recorder_.recording())
      console_.say(fmt::format("recording: {} ({:.1f} GB of room)", recording->file.string(),
                               1e-9 * static_cast<double>(recording->free_bytes)));
    if (info->source == HandSource::kDevice && options_.calibration.empty())
      console_.complain(
          "no --calibration: using the device's own numbers; see `phalanx device calibrate --help`",
          Emphasis::kWarning);
    if (info->source == HandSource::kDevice && info->range.empty())
      console_.say(
          "no --range: the limits of the hand or the profile alone bound the torque at the ends of the "
          "motion");
    if (holds_without_host(info->device)) console_.complain(kHoldsWithoutHost, Emphasis::kWarning);
    console_.say(
        "Not a medical device. Ctrl-C ramps to zero and ends; type stop, resume, reset, open DIGIT, set "
        "KEY=VALUE or quit.");
  }

  void watch() {
    const double begin = clock_.now();
    double next_line = begin + 1.0;
    while (asked_to_end == 0 && !commands_->quits()) {
      clock_.sleep_until(clock_.now() + (exercises_ ? exercises_->between_ticks() : 0.02));
      const double seconds = clock_.now() - begin;
      seconds_ = seconds;
      if (options_.seconds && seconds >= *options_.seconds) break;
      session_->poll();
      drain();
      commands_->handle(*typed_);
      if (exercises_) exercises_->tick();
      if (clock_.now() < next_line) continue;
      next_line += 1.0;
      if (options_.quiet) continue;
      const SeenAtTerminal seen = commands_->look();
      if (console_.status(status_line(session_->view(), session_->deadlines(), seconds, console_.width())))
        commands_->saw(seen);
    }
  }

  /// Reports what the loop and the recorder have stored.
  void drain() {
    say_grant();
    if (auto report = session_->take_fault_report()) tell_fault(std::move(*report));
    while (const auto note = recorder_.next_note()) tell(*note);
    const bool oscillates = session_->view().oscillates;
    if (oscillates && !oscillates_) {
      const std::string what = "the force oscillates: it fades, and returns by itself once it is quiet";
      console_.say(what, Emphasis::kWarning);
      tell_notice("oscillation", what, true);
    }
    oscillates_ = oscillates;
    say_recording();
    if (openings_) openings_->say();  // it may have ended before it had begun
    const std::uint64_t refused = session_->view().resets_refused;
    if (std::exchange(resets_refused_, refused) < refused) {
      const std::string why =
          "reset refused: the cause is still there, no sample comes, or the torque is not at rest yet";
      console_.say(why, Emphasis::kError);
      tell_notice("reset_refused", why);
    }
  }

  void say_recording() {
    const auto recording = recorder_.recording();
    if (!recording) return;
    for (const std::string& text : disk_messages_.next(*recording, clock_.now())) {
      console_.say(text, Emphasis::kWarning);
      tell_notice("recording", text);
    }
  }

  /// Reports a notice of the station to the pages with their log, and so to the recording; without pages to the recording
  /// alone.
  void tell_notice(const std::string& code, const std::string& text, bool fault = false) {
    if (page_)
      page_->tell(code, text, fault);
    else
      recorder_.event(code, "", text);
  }

  void tell_fault(FaultReport report) {
    const FaultEvent& event = report.event;
    const std::string text =
        fmt::format("{}: {} {}", fault_name(event.fault), fault_words(event), fault_remedy(event.fault));
    if (commands_) commands_->saw_fault(event.time);
    console_.say("FAULT " + text, Emphasis::kError);
    tell_notice("fault", text, true);
    // A report has the steps before the fault in plain text; those of a patient stay in the encrypted recording.
    if (!exercises_ || !exercises_->keeps_private()) recorder_.write_report(std::move(report));
  }

  void tell(const RunRecorder::Note& note) {
    if (!note.complaint.empty()) return console_.complain(note.complaint);
    console_.say("report: " + note.report);
    if (page_) page_->fault_reported(note.report, note.fault_time);
  }

  void say_grant() {
    if (granted_) return;
    granted_ = session_->grant();
    if (!granted_) return;
    console_.say("real time: " + describe(*granted_));
    for (const std::string& missing : granted_->missing) console_.complain(missing, Emphasis::kWarning);
    if (page_) page_->say_addresses(console_);  // again at the end, where users look for them
  }

  /// Reports a typed command to the pages and the log of changes, as a page's change, and to the recording.
  void tell_typed(const std::string& code, const std::string& text) {
    if (!page_) recorder_.event(code, "the terminal", text);
    if (page_) page_->typed(code, text);
  }

  /// Writes log, summary and reports; the torque is zero. @returns false if log or summary is not complete
  [[nodiscard]] bool save(bool in_good_order) {
    while (auto report = session_->take_fault_report()) tell_fault(std::move(*report));
    markers_.reset();
    recorder_.event("ended", "",
                    in_good_order ? "the station has ended" : "the station has ended with an error");
    recorder_.finish(in_good_order, [this](const RecordingStatus& recording) {
      console_.complain(fmt::format(
          "the recording cannot be ended: the disk refuses the data ({}); {:.1f} s are not saved. Make "
          "room now: it is tried again for {} s",
          recording.trouble, recording.unsaved, RunRecorder::kPatience));
    });
    if (exercises_) exercises_->end();
    const bool summarised = in_good_order && write_summary();
    drain();
    page_.reset();
    return summarised && !recorder_.lost();
  }

  /// Reports the end. @returns false if it was a fault
  [[nodiscard]] bool say_end() {
    if (!options_.quiet) say_statistics();
    const StationView last = session_->view();
    const bool faulty = last.state == SafetyState::kFault;
    console_.say(faulty ? fmt::format("ended at zero torque, in fault {}", fault_name(last.fault.fault))
                        : "ended at zero torque",
                 faulty ? Emphasis::kError : Emphasis::kStrong);
    return !faulty;
  }

  [[nodiscard]] bool write_summary() {
    if (options_.summary.empty()) return true;
    try {
      write_text_file(options_.summary,
                      station_summary_json(session_->statistics(), session_->view(),
                                           granted_ ? describe(*granted_) : "not asked for", seconds_));
      return true;
    } catch (const std::exception& error) {
      console_.complain(fmt::format("there is no summary: {}", reason(error)));
      return false;
    }
  }

  void say_statistics() {
    const SessionStatistics sums = session_->statistics();
    const DeadlineStatistics& deadlines = sums.deadlines;
    console_.say(histogram_text(deadlines.lateness, "woken late"));
    console_.say(histogram_text(deadlines.step, "step"));
    console_.say(
        fmt::format("{} steps, {} overruns (at most {} in a row), {} deadlines left out; {} samples, {} "
                    "lost, {} corrupt",
                    deadlines.steps, deadlines.overruns, deadlines.longest_run, deadlines.skipped,
                    sums.link.received, sums.link.lost, sums.link.corrupt));
  }

  const RunOptions& options_;
  const Clock& clock_;
  const std::shared_ptr<Registry> registry_;
  RunConsole console_;
  std::unique_ptr<Session> session_;
  RunRecorder recorder_;
  std::unique_ptr<MarkerPort> markers_;
  std::shared_ptr<StationExercises> exercises_;  ///< null: no patients, or no recordings
  std::unique_ptr<RunPage> page_;
  std::optional<TypedLines> typed_;
  std::optional<RealtimeGrant> granted_;
  std::uint64_t resets_refused_ = 0;
  bool oscillates_ = false;
  DiskMessages disk_messages_;
  std::optional<ToldOpenings> openings_;
  std::optional<TypedCommands> commands_;
  double seconds_ = 0.0;
};

}  // namespace

int run_station(const RunOptions& options, const Clock& clock, std::shared_ptr<Registry> registry) {
  return Run(options, clock, std::move(registry)).go();
}

}  // namespace phalanx

// SPDX-License-Identifier: Apache-2.0
// phalanx run [SCENE]: runs the station.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <ctime>
#include <exception>
#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include "commands.h"
#include "patient/registry_options.h"
#include "phalanx/mesh/isolation/isolation_helper.h"
#include "phalanx/record/retention.h"
#include "phalanx/record/run_recorder.h"
#include "phalanx/record/station_csv.h"
#include "phalanx/scene/scene.h"
#include "phalanx/station/session.h"
#include "retention_options.h"
#include "run/disk_messages.h"
#include "run/marker_port.h"
#include "run/run_console.h"
#include "run/run_options.h"
#include "run/run_page.h"
#include "run/run_registry.h"
#include "run/status_line.h"
#include "run/terminate.h"
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
    seen_ = look();
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
    while (asked_to_end == 0 && !quit_) {
      clock_.sleep_until(clock_.now() + (exercises_ ? exercises_->between_ticks() : 0.02));
      const double seconds = clock_.now() - begin;
      seconds_ = seconds;
      if (options_.seconds && seconds >= *options_.seconds) break;
      session_->poll();
      drain();
      handle_typed();
      if (exercises_) exercises_->tick();
      if (clock_.now() < next_line) continue;
      next_line += 1.0;
      if (options_.quiet) continue;
      const Seen seen = look();
      if (console_.status(status_line(session_->view(), session_->deadlines(), seconds, console_.width())))
        seen_ = seen;
    }
  }

  /// State of which the user at the terminal is informed. Lines may be read late: a line typed before another
  /// stop or fault does not refer to that one.
  struct Seen {
    std::uint64_t stops = 0;
    double fault = 0.0;  ///< FaultEvent::time; 0: none [s]
  };
  [[nodiscard]] Seen look() const {
    const std::uint64_t stops = session_->stops();
    const FaultEvent fault = session_->view().fault;
    return {.stops = stops, .fault = fault.fault == Fault::kNone ? 0.0 : fault.time};
  }

  /// Updates `seen_` after a command. After a refusal, only the next status line counts as seen: a second
  /// `resume` typed with the first must not end a stop that was not shown. Without status lines, the
  /// refusal itself counts.
  void look_after(bool granted) {
    if (granted || options_.quiet) seen_ = look();
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
    say_openings();
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

  static constexpr double kReadWithin = 1.0;  ///< a line that is younger has not been read [s]

  /// A digit's way out as the user at the terminal was told of it.
  struct ToldOpening {
    OpeningPhase phase = OpeningPhase::kNone;
    double way = 0.0;           ///< [m]
    std::uint64_t running = 0;  ///< StationView::running
    double time = 0.0;          ///< of the line [s]
  };

  /// Reports digits that started inside the object, and what came of their opening. What waits for a confirmation is
  /// reported again whenever forces have been off.
  void say_openings() {
    const StationView now = session_->view();
    if (now.state != SafetyState::kRunning) return;
    for (int digit = 0; digit < kDigits; ++digit) {
      const auto d = static_cast<std::size_t>(digit);
      const DigitOpening& opening = now.snapshot.opening[d];
      ToldOpening& told = openings_[d];
      const bool waits =
          opening.phase == OpeningPhase::kUnconfirmed || opening.phase == OpeningPhase::kNotFollowed;
      if (opening.phase == told.phase && (!waits || now.running == told.running)) continue;
      const bool was_inside = told.phase != OpeningPhase::kNone;
      told = {.phase = opening.phase, .way = opening.way, .running = now.running, .time = clock_.now()};
      const std::string_view name = digit_name(digit);
      if (waits && !session_->info()->device.renders_torque) {
        console_.say(fmt::format("{} started inside the object and has no force until it has left it", name),
                     Emphasis::kWarning);
      } else if (waits) {
        console_.say(
            fmt::format(
                "{} {}; to where it is shown it is {:.0f} mm. Open the hand or, to push the digit there "
                "with at most 1 N, type: open {}",
                name,
                opening.phase == OpeningPhase::kNotFollowed
                    ? "did not follow for 3 s and has no force"
                    : "started inside the object and has no force until it has left it",
                1e3 * opening.way, name),
            Emphasis::kWarning);
      } else if (opening.phase == OpeningPhase::kNone && was_inside) {
        console_.say(fmt::format("{} has left the object", name));
      }
    }
  }

  /// Asks to open a digit by the way that was told last.
  void open_typed(const std::string& name) {
    int digit = 0;
    while (digit < kDigits && digit_name(digit) != name) ++digit;
    if (digit == kDigits)
      throw std::invalid_argument(
          fmt::format("'{}' is no digit; type open thumb, index, middle, ring or little", name));
    ToldOpening& told = openings_[static_cast<std::size_t>(digit)];
    const double way = session_->view().snapshot.opening[static_cast<std::size_t>(digit)].way;
    if (told.phase != OpeningPhase::kNone) {
      // A line may have been typed before the way was told, or be the second of two.
      if (clock_.now() - told.time < kReadWithin)
        throw std::invalid_argument(
            fmt::format("the way of {} has just been told; read it, then type open {} again", name, name));
      if (std::abs(way - told.way) > OpeningState::kSameWay) {
        const double before = told.way;
        told = {};  // it is told again
        throw std::invalid_argument(fmt::format(
            "the way of {} was {:.0f} mm and is {:.0f} mm now; wait for its line, then type open {} again",
            name, 1e3 * before, 1e3 * way, name));
      }
    }
    session_->open_digit(digit, told.way, told.running);
    tell_typed("opened", fmt::format("asked to open the digit {}, {:.0f} mm", name, 1e3 * told.way));
  }

  void tell_fault(FaultReport report) {
    const FaultEvent& event = report.event;
    const std::string text = fmt::format("{}: {} {}", fault_name(event.fault), fault_meaning(event.fault),
                                         fault_remedy(event.fault));
    seen_.fault = event.time;
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

  void handle_typed() {
    while (asked_to_end == 0 && !quit_) {
      const auto line = typed_->next();
      if (!line) break;
      handle(*line);
    }
    if (const std::size_t left_out = typed_->take_left_out(); left_out > 0)
      console_.complain(
          fmt::format("{} lines were left out: they came faster than they are handled", left_out),
          Emphasis::kWarning);
  }

  void handle(const TypedLines::Line& typed) {
    const std::string& line = typed.text;
    try {
      if (line == "stop") {  // TypedLines has stopped already
        seen_ = look();
        seen_.stops = typed.stops;
        tell_typed("stopped", "stopped");
      } else if (line == "resume" && carries_out_exercise()) {
        resume_exercise();
        tell_typed("resumed", "resumed the exercise");
      } else if (line == "resume") {
        const bool resumed = session_->resume(seen_.stops);
        look_after(resumed);
        if (!resumed)
          throw std::invalid_argument("another stop or fault has come since; look, then resume again");
        tell_typed("resumed", "resumed");
      } else if (line == "reset") {
        const bool reset = session_->reset(seen_.fault);
        look_after(reset);
        if (!reset) throw std::invalid_argument("another fault has come since; look, then reset again");
        tell_typed("reset", "asked for a reset");
      } else if (line.starts_with("open ")) {
        open_typed(line.substr(5));
      } else if (line == "quit") {
        quit_ = true;
        tell_typed("quit", "ends the station");
      } else if (line.starts_with("set ")) {
        refuse_during_exercise();
        const std::string change = line.substr(4);
        session_->set({parse_override(change)}, [this, change](const ChangeOutcome& outcome) {
          say_typed("set", change, change, outcome);
        });
      } else if (line.starts_with("scene ")) {
        refuse_during_exercise();
        session_->load_scene(line.substr(6), [this, line](const ChangeOutcome& outcome) {
          say_typed("scene", line.substr(6), line, outcome);
        });
      } else if (!line.empty()) {
        throw std::invalid_argument(fmt::format(
            "'{}' is not understood; type stop, resume, reset, open DIGIT, set KEY=VALUE, scene NAME or quit",
            line));
      }
    } catch (const std::exception& error) {  // a refusal ends nothing
      console_.complain(reason(error));
    }
  }

  /// Resumes the exercise. It ends no stop that the user at the terminal has not seen.
  void resume_exercise() {
    try {
      exercises_->input({.kind = ExerciseInput::Kind::kResume},
                        {.stops = seen_.stops, .account = "the terminal"});
    } catch (const std::exception&) {
      look_after(false);
      throw;
    }
  }

  [[nodiscard]] bool carries_out_exercise() const { return exercises_ && exercises_->busy(); }

  void refuse_during_exercise() const {
    if (carries_out_exercise()) throw std::invalid_argument("an exercise runs; end it first, on its page");
  }

  void say_typed(const std::string& code, const std::string& text, const std::string& line,
                 const ChangeOutcome& outcome) {
    if (!outcome.refused.empty()) return console_.say("refused: " + outcome.refused, Emphasis::kError);
    if (outcome.overtaken) return console_.say("overtaken by a newer value: " + line);
    console_.say("changed: " + line);
    tell_typed(code, text);
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
  bool quit_ = false;
  std::uint64_t resets_refused_ = 0;
  bool oscillates_ = false;
  DiskMessages disk_messages_;
  std::array<ToldOpening, kDigits> openings_{};
  Seen seen_;
  double seconds_ = 0.0;
};

}  // namespace

void add_run_command(CLI::App& app, Job& job) {
  auto options = std::make_shared<RunOptions>();
  CLI::App* run = app.add_subcommand(
      "run",
      "The station: device, hand and scene in real time, with the simulated device if there is no other");
  run->add_option("scene", options->scene,
                  fmt::format("a scene's name or file [{}; {} with a device]", RunOptions::kDemonstration,
                              RunOptions::kGrasp));
  run->add_option("--device", options->device,
                  "simulated, sliders, udp:HOST:PORT, serial:PORT[:BAUD] or opengloves:PORT[:BAUD]")
      ->capture_default_str();
  run->add_option("--calibration", options->calibration,
                  "the device's calibration file (phalanx device calibrate)");
  run->add_option("--range", options->range,
                  "the patient's own range of motion (phalanx device range); no torque pushes beyond it");
  run->add_option("--seconds", options->seconds, "end after so long; else with Ctrl-C")->check(positive());
  run->add_option("--rate-hz", options->rate_hz, "the loop's rate, 200 .. 2000 Hz; else the scene's");
  run->add_option("--profile", options->profile, "the patient's hand: a profile's name or file");
  run->add_option("--object", options->object,
                  "a mesh in place of the scene's objects: .obj .3ds .stl .ply .glb");
  run->add_option("--object-size-mm", options->object_size_mm,
                  "its largest extent; without it the file's numbers are metres")
      ->check(CLI::Range(0.0, 2000.0));
  run->add_option("--set", options->set, "a scene's key: KEY=VALUE; may be repeated")
      ->allow_extra_args(false);
  run->add_option("--clinician", options->clinician,
                  "who answers for a fingertip force above 5 N (up to 10 N)");
  CLI::Option* watchdog = run->add_option(
      "--watchdog-ms", options->watchdog_ms,
      "a glove's firmware lets go by itself so long after this program's last message [1 .. 1000]");
  run->add_flag("--no-force-feedback", options->no_force_feedback,
                "the glove only senses: it is never told to hold a finger")
      ->excludes(watchdog);
  run->add_option("--record", options->recordings,
                  "folder of the recordings, a file each run (docs/recording.md); off: none")
      ->capture_default_str();
  run->add_flag("--no-foxglove", options->no_foxglove,
                "recordings without the 3D scene for tools that read Foxglove's schemas");
  run->add_option("--record-quota-gb", options->record_quota_gb,
                  "room for all recordings of the folder: above it, no run begins [none]")
      ->check(number_up_to(1e6));
  add_retention(*run, options->record_keep_days, options->record_keep_gb, "--record-keep-");
  CLI::Option* markers =
      run->add_option("--marker-port", options->marker_port,
                      "UDP port for markers of other programs: each datagram is a text in the recording")
          ->check(CLI::Range(1, 65535));
  run->add_option("--marker-listen", options->marker_address,
                  "address of the marker port; any but 127.0.0.1 lets other computers reach it")
      ->needs(markers)
      ->capture_default_str();
  run->add_option("--log", options->log, "write every step to this CSV file");
  run->add_option("--summary", options->summary, "write percentiles and counts to this JSON file at the end");
  run->add_option("--fault-reports", options->faults, "folder of the fault reports")->capture_default_str();
  run->add_option("--priority", options->priority, "of SCHED_FIFO")
      ->check(CLI::Range(1, 99))
      ->capture_default_str();
  run->add_option("--cpu", options->cpu, "keep the loop on this CPU")->check(CLI::NonNegativeNumber);
  run->add_option("--slow-motion", options->slow_motion,
                  "run everything so many times slower, time limits included")
      ->check(CLI::Range(1.0, 1000.0));
  run->add_flag("--no-realtime", options->no_realtime, "do not ask for SCHED_FIFO and locked memory");
  run->add_flag("--headless", options->headless, "no page");
  run->add_option("--listen", options->listen, "address of the page; any but this machine's own needs TLS")
      ->capture_default_str();
  CLI::Option* port =
      run->add_option("--port", options->port, "of the page; 0: any; else the next free one from 8480")
          ->check(CLI::Range(0, 65535));
  run->add_option("--tls-cert", options->certificate,
                  "the page's certificate (PEM); else one of its own is made");
  run->add_option("--tls-key", options->key, "its key (PEM)");
  run->add_option("--data", options->data,
                  "data folder of the patients: the page people.html shows them (docs/patients.md) [none]")
      ->type_name("DIR");
  run->add_option("--keys", options->keys,
                  "file with the patients' keys, with --data [$PHALANX_KEYS, else ~/.config/phalanx/keys]")
      ->type_name("FILE");
  run->add_option("--stable-n-per-mm", options->stable_n_per_mm,
                  "largest stiffness at which this device is stable with an exercise's scene, as measured "
                  "(docs/stability.md); feel_and_find needs it")
      ->check(positive())
      ->type_name("K");
  run->add_option("--audit", options->audit, "every change made in the page, a JSON line each")
      ->capture_default_str();
  run->add_option("--uploads", options->uploads, "folder of the meshes that pages send")
      ->capture_default_str();
  run->add_option("--calibrations", options->calibrations, "folder of what the page's calibration writes")
      ->capture_default_str();
  run->add_option("--ranges", options->ranges, "folder of the ranges of motion that the page measures")
      ->capture_default_str();
  run->add_flag("--quiet", options->quiet, "no status line");
  run->callback([options, run, port, &job] {
    refuse_empty_values(*run);
    options->port_stated = port->count() > 0;
    check_page_options(*options);
    job = [options] {
      end_on_signal();
      const mesh::IsolationHelper helper;  // before there are threads, while memory is small
      std::shared_ptr<Registry> registry;
      with_registry_errors([&] { return registry = open_run_registry(*options), 0; });
      const Clock clock(options->slow_motion);
      return Run(*options, clock, std::move(registry)).go();
    };
  });
}

}  // namespace phalanx

// SPDX-License-Identifier: Apache-2.0
// phalanx run [SCENE]: the station.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "commands.h"
#include "phalanx/record/station_csv.h"
#include "phalanx/scene/scene.h"
#include "phalanx/station/assemble.h"
#include "phalanx/station/station.h"
#include "run_console.h"
#include "run_device.h"
#include "run_options.h"
#include "usage.h"

namespace phalanx {
namespace {

volatile std::sig_atomic_t asked_to_end = 0;

void end_on_signal() {
  struct sigaction action = {};
  action.sa_handler = [](int) { asked_to_end = 1; };
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  sigaction(SIGHUP, &action, nullptr);
  // A reader that has gone, or a terminal that belongs to another job, must not end or stop a loop that holds
  // a hand.
  action.sa_handler = SIG_IGN;
  sigaction(SIGPIPE, &action, nullptr);
  sigaction(SIGTTIN, &action, nullptr);
}

Overrides overrides_of(const RunOptions& o) {
  Overrides overrides;
  for (const std::string& text : o.set) overrides.push_back(parse_override(text));
  if (!o.profile.empty()) overrides.emplace_back("hand.profile", fmt::format("\"{}\"", o.profile));
  if (o.rate_hz) overrides.emplace_back("rate_hz", fmt::format("{:.17g}", *o.rate_hz));
  return overrides;
}

void say(const std::string& line) {
  fmt::print("{}\n", line);
  std::fflush(stdout);
}

/// One run of the station, from the terminal's side.
class Run {
 public:
  Run(const RunOptions& options, const Clock& clock)
      : options_(options), clock_(clock), overrides_(overrides_of(options)) {}

  int go() {
    const SceneDescription scene = load_scene(options_.scene, overrides_);
    StationModel made = make_station_model(scene, options_.clinician);
    OpenDevice opened = open_station_device(options_, scene, made, clock_);
    device_ = std::move(opened.device);
    StationOptions station_options;
    station_options.realtime = {.priority = options_.priority, .cpu = options_.cpu, .lock_memory = true};
    station_options.ask_for_realtime = !options_.no_realtime;
    station_options.safety = made.safety;
    station_options.witnesses = make_witnesses(scene, opened.channels, made.safety);
    ChannelMap map = make_channel_map(scene, opened.channels, made.model->hand.parameters());
    introduce(scene);
    if (!options_.log.empty()) {
      log_ = std::make_unique<OutputFile>(options_.log);
      write_step_header(*log_);
    }
    station_ =
        std::make_unique<Station>(std::move(made.model), *device_, std::move(map), station_options, clock_);
    station_->start();
    watch();
    station_->shut_down();
    return finish();
  }

 private:
  void introduce(const SceneDescription& scene) {
    const DeviceInfo& info = device_->info();
    say(fmt::format("scene {} at {} Hz, device {} (serial {}), at most {} N a digit{}", options_.scene,
                    scene.rate_hz, info.name, info.serial, scene.limits.fingertip_force,
                    options_.clinician.empty() ? "" : fmt::format(" (set by {})", options_.clinician)));
    say("Not a medical device. Ctrl-C ramps to zero and ends; type stop, resume, reset, set KEY=VALUE or "
        "quit.");
  }

  void watch() {
    const double begin = clock_.now();
    double next_line = begin + 1.0;
    while (asked_to_end == 0 && !quit_) {
      clock_.sleep_until(clock_.now() + 0.02);
      const double seconds = clock_.now() - begin;
      if (options_.seconds && seconds >= *options_.seconds) break;
      drain();
      std::string line;
      while (typed_.next(line)) obey(line);
      if (clock_.now() < next_line) continue;
      next_line += 1.0;
      if (!options_.quiet) say(status_line(station_->view(), station_->deadlines(), seconds));
    }
    seconds_ = clock_.now() - begin;
  }

  /// Fetches what the loop has put aside.
  void drain() {
    say_grant();
    StepRecord record;
    while (station_->next_record(record))
      if (log_) write_step(*log_, record);
    if (const auto report = station_->take_fault_report()) {
      fault_seen_ = true;
      const auto folder = write_fault_report(options_.faults, *report);
      say(fmt::format("FAULT {}: {} {} Report: {}", fault_name(report->event.fault),
                      fault_meaning(report->event.fault), fault_remedy(report->event.fault),
                      folder.string()));
    }
  }

  void say_grant() {
    if (granted_) return;
    granted_ = station_->grant();
    if (!granted_) return;
    say("real time: " + describe(*granted_));
    for (const std::string& missing : granted_->missing) fmt::print(stderr, "phalanx run: {}\n", missing);
  }

  void obey(const std::string& line) {
    try {
      if (line == "stop") {
        station_->stop_torque();
      } else if (line == "resume") {
        station_->resume_torque();
      } else if (line == "reset") {
        station_->reset();
      } else if (line == "quit") {
        quit_ = true;
      } else if (line.starts_with("set ")) {
        change(line.substr(4));
      } else if (line.starts_with("slow ")) {
        station_->lengthen_steps(std::clamp(1e-3 * std::stod(line.substr(5)), 0.0, 1.0));
      } else if (!line.empty()) {
        fmt::print(
            stderr,
            "phalanx run: '{}' is not understood; type stop, resume, reset, set KEY=VALUE, slow MS or quit\n",
            line);
      }
    } catch (const std::exception& error) {  // a change that is refused ends nothing
      fmt::print(stderr, "phalanx run: {}\n", error.what());
    }
  }

  void change(const std::string& text) {
    const auto override_ = parse_override(text);
    const ChangeKind kind = change_kind(override_.first);
    if (kind == ChangeKind::kNewStation)
      throw std::invalid_argument(fmt::format(
          "{}: this cannot change while the station runs; end it and start it with --set {}", text, text));
    Overrides overrides = overrides_;
    overrides.push_back(override_);
    const SceneDescription scene = load_scene(options_.scene, overrides);
    StationModel made = make_station_model(scene, options_.clinician);
    if (kind == ChangeKind::kInContact) {
      station_->blend_to(blended_of(*made.model));
    } else {
      station_->replace(
          std::make_unique<Replacement>(Replacement{LiveModel(std::move(made.model)), made.safety}));
    }
    overrides_ = std::move(overrides);
    say(fmt::format("changed: {}", text));
  }

  int finish() {
    drain();
    const StationView last = station_->view();
    const DeadlineStatistics deadlines = station_->deadlines();
    if (log_) log_->commit();
    const std::string granted = granted_ ? describe(*granted_) : "not asked for";
    if (!options_.summary.empty())
      write_text_file(options_.summary, station_summary_json(deadlines, last, granted, seconds_));
    if (!options_.quiet) {
      say(histogram_text(deadlines.lateness, "woken late"));
      say(histogram_text(deadlines.step, "step"));
      say(
          fmt::format("{} steps, {} overruns (at most {} in a row), {} deadlines left out; {} samples, {} "
                      "lost, {} corrupt",
                      deadlines.steps, deadlines.overruns, deadlines.longest_run, deadlines.skipped,
                      last.link.received, last.link.lost, last.link.corrupt));
    }
    const bool faulty = last.state == SafetyState::kFault;
    say(faulty ? fmt::format("ended at zero torque, in fault {}", fault_name(last.fault.fault))
               : "ended at zero torque");
    return faulty ? kFailed : kDone;
  }

  const RunOptions& options_;
  const Clock& clock_;
  Overrides overrides_;
  std::unique_ptr<Device> device_;
  std::unique_ptr<OutputFile> log_;
  std::unique_ptr<Station> station_;
  std::optional<RealtimeGrant> granted_;
  TypedLines typed_;
  bool quit_ = false;
  bool fault_seen_ = false;
  double seconds_ = 0.0;
};

}  // namespace

void add_run_command(CLI::App& app, Job& job) {
  auto options = std::make_shared<RunOptions>();
  CLI::App* run = app.add_subcommand("run", "the station: a device, a hand and a scene, in real time");
  run->add_option("scene", options->scene, "a scene's name or file")->capture_default_str();
  run->add_option("--device", options->device,
                  "simulated, udp:HOST:PORT, serial:PORT[:BAUD] or opengloves:PORT[:BAUD]")
      ->capture_default_str();
  run->add_option("--calibration", options->calibration,
                  "the device's calibration file (phalanx device calibrate)");
  run->add_option("--seconds", options->seconds, "end after so long; else with Ctrl-C")
      ->check(CLI::PositiveNumber);
  run->add_option("--rate-hz", options->rate_hz, "the loop's rate, 200 .. 2000 Hz; else the scene's");
  run->add_option("--profile", options->profile, "the patient's hand: a profile's name or file");
  run->add_option("--set", options->set, "a scene's key: KEY=VALUE; may be repeated")
      ->allow_extra_args(false);
  run->add_option("--clinician", options->clinician,
                  "who answers for a fingertip force above 5 N (up to 10 N)");
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
  run->add_flag("--headless", options->headless, "open no page");
  run->add_flag("--quiet", options->quiet, "no line a second");
  run->callback([options, run, &job] {
    refuse_empty_values(*run);
    job = [options] {
      end_on_signal();
      const Clock clock(options->slow_motion);
      return Run(*options, clock).go();
    };
  });
}

}  // namespace phalanx

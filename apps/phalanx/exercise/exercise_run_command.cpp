// SPDX-License-Identifier: Apache-2.0
#include "exercise/exercise_run_command.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <ctime>
#include <exception>
#include <memory>
#include <stdexcept>
#include <utility>

#include "exercise/exercise_station.h"
#include "phalanx/clinic/exercise_patient.h"
#include "phalanx/clinic/exercise_plan.h"
#include "phalanx/clinic/exercise_results.h"
#include "phalanx/mesh/isolation/isolation_helper.h"
#include "phalanx/record/recorded_exercise.h"
#include "terminal/end_signals.h"
#include "terminal/error_line.h"
#include "usage.h"

namespace phalanx {
namespace {

namespace fs = std::filesystem;

/// The patient of the exercise, with the registry that knows it.
struct OpenedPatient {
  OpenedRegistry opened;
  KnownPatient known;

  [[nodiscard]] const Patient& patient() const noexcept { return known.patient; }
  [[nodiscard]] ActingRegistry acting() noexcept {
    return {.registry = opened.registry, .actor = opened.actor};
  }
};

/// Reads one line without reading ahead: the station reads the lines that follow. @returns false if there is none
bool read_typed_line(std::string& line) {
  line.clear();
  char c = '\0';
  while (::read(STDIN_FILENO, &c, 1) == 1) {
    if (c == '\n') return true;
    if (line.size() < 100) line.push_back(c);
  }
  return !line.empty();
}

/// Shows code, side and symbol, and has the code typed, before there can be a force: the wrong hand must not
/// get the limits of another person.
void confirm_patient(const Patient& patient, const std::string& option) {
  print_aside(fmt::format("patient {}, {} hand, symbol: {}\n", patient.code, side_name(patient.side),
                          patient.symbol));
  for (const std::string& warning : patient.warnings) print_aside(fmt::format("  warning: {}\n", warning));
  std::string typed = option;
  if (typed.empty()) {
    if (::isatty(STDIN_FILENO) != 1)
      throw std::invalid_argument(fmt::format(
          "--patient {}: the code must be confirmed before there is a force; type it at the terminal, or add "
          "--confirm CODE",
          patient.code));
    print_aside("type the code to confirm that this person's hand is in the device: ");
    if (!read_typed_line(typed)) throw std::invalid_argument("nothing was typed; no exercise begins");
    std::transform(typed.begin(), typed.end(), typed.begin(),
                   [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  }
  refuse_other_code(patient, typed);
}

OpenedPatient opened_patient(const ExerciseOptions& o) {
  OpenedRegistry opened = open_registry(o.registry);
  Patient patient = opened.registry.patient(opened.actor, o.patient);
  std::vector<ResultRow> results = opened.registry.results(opened.actor, patient.record);
  return {.opened = std::move(opened),
          .known = {.patient = std::move(patient),
                    .results = std::move(results),
                    .today = utc_date(static_cast<double>(std::time(nullptr)))}};
}

/// Refuses files that the command line states beside a patient: they may be of another person.
void refuse_other_files(const ExerciseOptions& o) {
  const auto refuse = [&o](const char* option, const std::string& file, const char* more) {
    if (!file.empty())
      throw std::invalid_argument(
          fmt::format("{} {}: with --patient the patient's own files hold; bind it with `phalanx patient "
                      "edit {} {} {}{}`, and leave it out here",
                      option, file, o.patient, option, file, more));
  };
  refuse("--calibration", o.run.calibration, " --expires DATE");
  refuse("--range", o.run.range, "");
  refuse("--profile", o.run.profile, "");
}

ExerciseStationPlan station_plan(const ExerciseOptions& o, const OpenedPatient* known) {
  RunOptions run = o.run;
  if (!o.demo.empty()) run.device = "sliders";
  ExerciseStationPlan plan;
  plan.session = session_settings(run);
  PlannedStation station;
  station.device = run.device;
  station.sliders = run.device == "sliders";
  station.overrides = std::move(plan.session.overrides);
  station.clinician = run.clinician;
  if (o.stable_n_per_mm) station.stable_stiffness = 1e3 * *o.stable_n_per_mm;
  plan.exercise = plan_exercise({.exercise = o.exercise, .demo = o.demo, .seed = o.seed}, station,
                                known != nullptr ? &known->known : nullptr);
  plan.session.scene = plan.exercise.start.exercise.scene;
  plan.session.overrides = plan.exercise.overrides;
  if (known != nullptr) {
    plan.session.calibration = plan.exercise.calibration;
    plan.session.range = plan.exercise.range;
  }
  const auto recording = recorder_settings(run);
  if (!recording)
    throw std::invalid_argument(
        "--record off: the result of an exercise is made from its recording; name a folder");
  plan.recording = *recording;
  plan.seconds = run.seconds;
  return plan;
}

/// Adds the dose of an exercise whose recording gives no result.
void keep_dose_of(OpenedPatient& known, const LiveExercise* live, double began, const fs::path& file,
                  RunConsole& console) {
  if (live == nullptr) return;
  const UnscoredExercise done = {.start = live->start(), .result = live->result(), .began = began};
  try {
    if (keep_dose(known.acting(), known.patient().record, done, file,
                  [&console](const std::string& text) { console.complain(text); }))
      console.say("the registry has the dose of this exercise, without scores");
  } catch (const RegistryError& busy) {
    console.complain(fmt::format("the dose of this exercise is not in the registry: {}", busy.what()));
  }
}

/// Makes the result from the recording, shows it and keeps it.
/// @param live   exercise as the station carried it out; null: it did not begin
/// @param began  UTC of the station's begin [s]
/// @returns false if something of it is missing or differs
bool make_result(const fs::path& file, const FindRecordingKey& keys, OpenedPatient* known,
                 const LiveExercise* live, double began, RunConsole& console) {
  try {
    const std::vector<RecordedExercise> exercises = recorded_exercises(file, keys);
    if (exercises.empty()) {
      if (known != nullptr) keep_dose_of(*known, live, began, file, console);
      console.say("the exercise has not begun; it has no result");
      return true;
    }
    if (known != nullptr)
      keep_results(known->acting(), known->patient().record, exercises, file,
                   [&console](const std::string& text) { console.complain(text); });
    for (const RecordedExercise& exercise : exercises) {
      std::string report = exercise_report(exercise, false);
      if (!report.empty() && report.back() == '\n') report.pop_back();
      console.say(report);
    }
    if (known != nullptr) console.say(fmt::format("kept in the registry for {}", known->patient().code));
    return std::all_of(exercises.begin(), exercises.end(),
                       [](const RecordedExercise& exercise) { return exercise.difference.empty(); });
  } catch (const std::exception& error) {
    const auto* refused = dynamic_cast<const RegistryError*>(&error);
    const bool busy = refused != nullptr && refused->fault() == RegistryFault::kBusy;
    // After a busy registry the scores can still be made: a dose would hide them from the next exercise.
    if (known != nullptr && !busy) keep_dose_of(*known, live, began, file, console);
    console.complain(fmt::format("{}. The recording {} is kept; {}", reason(error), file.string(),
                                 known != nullptr ? "`phalanx patient rebuild` makes the result again"
                                                  : "`phalanx exercise results` makes the result again"));
    return false;
  }
}

}  // namespace

int run_exercise(const ExerciseOptions& o) {
  if (o.patient.empty() && !o.confirm.empty())
    throw std::invalid_argument("--confirm: it confirms the code of --patient; name that, too");
  if (!o.patient.empty()) refuse_other_files(o);
  const mesh::IsolationHelper helper;  // before there are keys and threads, while memory is small
  std::optional<OpenedPatient> known;
  if (!o.patient.empty()) known.emplace(opened_patient(o));
  if (known && o.run.recordings != "off")
    take_up_left_recordings(known->acting(), known->known, o.run.recordings,
                            [](const std::string& text) { print_aside(text + '\n'); });
  ExerciseStationPlan plan = station_plan(o, known ? &*known : nullptr);
  FindRecordingKey keys;
  std::shared_ptr<const KeyUse> use;  // until the result is kept, no program deletes the patient
  if (known) {
    Registry& registry = known->opened.registry;
    confirm_patient(known->patient(), o.confirm);
    use = registry.use_key(known->opened.actor, known->patient().record);
    if (!o.record_plain) {
      plan.recording.encryption = registry.recording_key(known->opened.actor, known->patient().record);
      keys = [key = *plan.recording.encryption](const std::string& id) -> std::optional<RecordingKey> {
        return id == key.id ? std::optional(key.key) : std::nullopt;
      };
    }
    plan.on_open = [&known, exercise = plan.exercise](const SessionInfo& info) {
      refuse_on_station(known->known, exercise, info);
    };
    plan.on_recording = [&known](const fs::path& file) {
      known->opened.registry.add_recording(known->opened.actor, known->patient().record,
                                           file.filename().string());
    };
  }
  end_on_signal();
  const Clock clock(o.run.slow_motion);
  RunConsole console("phalanx exercise run");
  if (!o.seed) console.say(fmt::format("seed {}", plan.exercise.start.seed));
  ExerciseStation station(std::move(plan), clock, console);
  const auto began = static_cast<double>(std::time(nullptr));
  const bool saved = station.go();
  if (station.recording().empty()) return kFailed;
  const bool made =
      make_result(station.recording(), keys, known ? &*known : nullptr, station.live(), began, console);
  return made && saved ? kDone : kFailed;
}

void add_exercise_run(CLI::App& exercise, Job& job) {
  auto options = std::make_shared<ExerciseOptions>();
  CLI::App* run = exercise.add_subcommand(
      "run", "Carry out an exercise on the station, record it, and make its result from the recording");
  run->add_option("EXERCISE", options->exercise, "an exercise's name or file")->required();
  run->add_option(
         "--patient", options->patient,
         "code of a patient of the registry: their limits, prescription and dose hold, the recording is "
         "encrypted with their key, and the result is kept")
      ->type_name("CODE");
  run->add_option("--confirm", options->confirm, "the code again instead of typing it, for scripts")
      ->type_name("CODE");
  CLI::Option* demo = run->add_option(
      "--demo", options->demo,
      "a simulated participant moves the hand: a number from 0 (severe) to 1 (healthy), or healthy, mild, "
      "moderate, severe, tremor or weak. Its results join those of patients whose code begins with SIM "
      "only");
  demo->type_name("SKILL");
  run->add_option("--seed", options->seed,
                  "of the order of stimuli, and of the simulated participant [drawn]")
      ->type_name("N");
  RunOptions& station = options->run;
  run->add_option("--device", station.device,
                  "simulated, sliders, udp:HOST:PORT, serial:PORT[:BAUD] or opengloves:PORT[:BAUD]")
      ->capture_default_str()
      ->excludes(demo);
  run->add_option("--calibration", station.calibration,
                  "the device's calibration file; with --patient that of the patient")
      ->type_name("FILE");
  run->add_option("--range", station.range, "the own range of motion; with --patient that of the patient")
      ->type_name("FILE");
  run->add_option("--profile", station.profile,
                  "the hand: a profile's name or file; with --patient that of the patient");
  run->add_option("--stable-n-per-mm", options->stable_n_per_mm,
                  "largest stiffness at which this device is stable with the exercise's scene, as measured "
                  "(docs/stability.md); feel_and_find needs it")
      ->check(positive())
      ->type_name("K");
  run->add_option("--clinician", station.clinician,
                  "who answers for a fingertip force above 5 N (up to 10 N)");
  run->add_option("--rate-hz", station.rate_hz, "the loop's rate, 200 .. 2000 Hz; else the scene's");
  run->add_option("--seconds", station.seconds, "end after so long; else with the exercise")
      ->check(positive());
  run->add_option("--record", station.recordings, "folder of the recordings")
      ->capture_default_str()
      ->type_name("DIR");
  run->add_flag("--record-plain", options->record_plain,
                "do not encrypt the recording of a patient: for laboratories");
  run->add_flag("--no-foxglove", station.no_foxglove,
                "recordings without the 3D scene for tools that read Foxglove's schemas");
  run->add_flag("--no-realtime", station.no_realtime, "do not ask for SCHED_FIFO and locked memory");
  add_registry_options(*run, options->registry);
  run->callback([options, run, &job] {
    refuse_empty_values(*run);
    job = [options] { return with_registry_errors([&options] { return run_exercise(*options); }); };
  });
}

}  // namespace phalanx

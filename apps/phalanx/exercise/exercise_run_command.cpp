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
#include <random>
#include <stdexcept>
#include <utility>

#include "exercise/exercise_patient.h"
#include "exercise/exercise_station.h"
#include "exercise/exercise_text.h"
#include "phalanx/mesh/isolation/isolation_helper.h"
#include "phalanx/record/recorded_exercise.h"
#include "phalanx/record/recordings.h"
#include "phalanx/scene/exercise_file.h"
#include "phalanx/station/safety_settings.h"
#include "terminal/end_signals.h"
#include "terminal/error_line.h"
#include "usage.h"

namespace phalanx {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kLargestSeed = 1'000'000'000;  // a seed that a person can type again

/// The patient of the exercise, with the registry that knows it.
struct KnownPatient {
  OpenedRegistry opened;
  Patient patient;
  std::vector<ResultRow> results;
  std::string today;
};

/// @returns true if the device is a simulated one of this program
bool is_own_simulation(const RunOptions& run) { return run.device == "simulated" || run.device == "sliders"; }

std::uint64_t drawn_seed() {
  std::random_device source;
  return source() % kLargestSeed;
}

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
  if (typed != patient.code)
    throw std::invalid_argument(
        fmt::format("'{}' is not the code of patient {}; no exercise begins", typed, patient.code));
}

KnownPatient known_patient(const ExerciseOptions& o) {
  OpenedRegistry opened = open_registry(o.registry);
  Patient patient = opened.registry.patient(opened.actor, o.patient);
  std::vector<ResultRow> results = opened.registry.results(opened.actor, patient.record);
  return {.opened = std::move(opened),
          .patient = std::move(patient),
          .results = std::move(results),
          .today = utc_date(static_cast<double>(std::time(nullptr)))};
}

/// Adds the results of recordings that a killed program has left without one, so that their dose counts, and
/// takes over what they have measured. A recording without an end is repaired first; the original stays beside
/// it. What cannot be read is named, and prevents nothing.
void take_up_left_recordings(KnownPatient& known, const fs::path& folder) {
  Registry& registry = known.opened.registry;
  const Actor& actor = known.opened.actor;
  FindRecordingKey keys;
  bool added = false;
  for (const std::string& name : registry.recordings_without_result(actor, known.patient.record)) {
    const fs::path file = folder / name;
    std::error_code ignored;
    if (!fs::exists(file, ignored)) continue;
    if (!keys) keys = registry.recording_keys(actor);
    try {
      const RecordingSummary summary = summarise_recording(file, keys);
      if (summary.written) continue;  // by a program that lives
      if (!summary.has_end) {
        print_aside(fmt::format(
            "{} has no end: its program was killed. It is repaired and read for the dose\n", file.string()));
        static_cast<void>(repair_recording(file, keys));
      }
      for (const RecordedExercise& exercise : recorded_exercises(file, keys)) {
        if (exercise.start.record != known.patient.record) continue;
        const ResultRow row = result_row(exercise, name);
        registry.add_result(actor, known.patient.record, row);
        if (takes_late(known.patient, exercise, name, known.results))
          update_patient(registry, actor, known.patient.record,
                         [&exercise](Patient& patient) { return take_measured(patient, exercise); });
        print_aside(fmt::format("{}: {} trials of {} are added to the dose\n", file.string(), row.repetitions,
                                row.exercise));
        added = true;
      }
    } catch (const std::exception& error) {
      print_aside(fmt::format("  warning: the dose of {} is not known: {}\n", file.string(), reason(error)));
    }
  }
  if (!added) return;
  known.results = registry.results(actor, known.patient.record);
  known.patient = registry.patient(actor, known.patient.record);
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

/// Takes the device settings from the patient.
void take_settings(const Patient& patient, RunOptions& run) {
  run.profile = patient.profile;
  if (run.profile.empty()) run.set.push_back(fmt::format("hand.side={}", side_name(patient.side)));
  if (is_own_simulation(run)) return;
  run.calibration = patient.calibration;
  if (!run.calibration.empty()) run.range = patient.range;
}

ExercisePlan exercise_plan(const ExerciseOptions& o, KnownPatient* known) {
  ExercisePlan plan;
  plan.start.exercise = load_exercise(o.exercise);
  plan.start.seed = o.seed ? *o.seed : drawn_seed();
  plan.start.simulated = !o.demo.empty() || is_own_simulation(o.run);
  RunOptions run = o.run;
  run.scene = plan.start.exercise.scene;
  if (!o.demo.empty()) {
    plan.skill = demo_skill(o.demo);
    plan.assume_person = known == nullptr;
    run.device = "sliders";
  }
  if (known != nullptr) {
    const Patient& patient = known->patient;
    // A device on a wire states only later whether it is simulated.
    const bool simulated = plan.start.simulated || (!is_own_simulation(run) && is_simulated(patient));
    refuse_patient(patient, plan.start.exercise, simulated, known->today);
    plan.start.exercise = exercise_of(patient, std::move(plan.start.exercise));
    plan.start.person = person_of(patient, plan.start.exercise, known->results, known->today);
    plan.start.record = patient.record;
    take_settings(patient, run);
  }
  if (!o.run.clinician.empty())
    plan.start.person.force_cap = std::min(
        kForceWithClinician,
        known != nullptr ? known->patient.force_limit_n.value_or(kForceWithClinician) : kForceWithClinician);
  plan.session = session_settings(run);
  plan.start.person.stable_stiffness = stable_stiffness(o, load_scene(run.scene, plan.session.overrides));
  const Overrides lowered =
      lowered_limits(run.scene, plan.session.overrides, plan.start.exercise, plan.start.person);
  plan.session.overrides.insert(plan.session.overrides.end(), lowered.begin(), lowered.end());
  plan.start.person =
      within_scene(plan.start.person, load_scene(run.scene, plan.session.overrides), plan.start.exercise);
  if (!plan.assume_person) check_person(plan.start.exercise, plan.start.person);
  const auto recording = recorder_settings(run);
  if (!recording)
    throw std::invalid_argument(
        "--record off: the result of an exercise is made from its recording; name a folder");
  plan.recording = *recording;
  plan.seconds = run.seconds;
  return plan;
}

/// Adds the results of a recording to the registry, and takes over what was measured.
void keep_results(KnownPatient& known, const std::vector<RecordedExercise>& exercises, const fs::path& file,
                  RunConsole& console) {
  Registry& registry = known.opened.registry;
  for (const RecordedExercise& exercise : exercises) {
    // Before the row: with it, `patient rebuild` takes nothing over again. The patient may have changed while
    // the exercise ran, and may change now.
    try {
      update_patient(registry, known.opened.actor, known.patient.record,
                     [&exercise](Patient& patient) { return take_measured(patient, exercise); });
    } catch (const RegistryError& error) {
      if (error.fault() != RegistryFault::kConflict) throw;
      console.complain(fmt::format("what {} has measured is not taken over: {}; its scores are kept",
                                   exercise.start.exercise.name, error.what()));
    }
    registry.add_result(known.opened.actor, known.patient.record,
                        result_row(exercise, file.filename().string()));
  }
}

/// Adds the dose of an exercise whose recording gives no result. `patient rebuild` replaces it if the recording is mended.
void keep_dose(KnownPatient& known, const LiveExercise* live, double began, const fs::path& file,
               RunConsole& console) {
  if (live == nullptr || live->result().repetitions == 0) return;
  try {
    known.opened.registry.add_result(known.opened.actor, known.patient.record,
                                     dose_row(live->start(), live->result(), file.filename().string(), began,
                                              "not scored: no result could be made from the recording"));
    console.say("the registry has the dose of this exercise, without scores");
  } catch (const std::exception& error) {
    console.complain(fmt::format("the dose of this exercise is not in the registry: {}", reason(error)));
  }
}

/// Makes the result from the recording, shows it and keeps it.
/// @param live   exercise as the station carried it out; null: it did not begin
/// @param began  UTC of the station's begin [s]
/// @returns false if something of it is missing or differs
bool make_result(const fs::path& file, const FindRecordingKey& keys, KnownPatient* known,
                 const LiveExercise* live, double began, RunConsole& console) {
  try {
    const std::vector<RecordedExercise> exercises = recorded_exercises(file, keys);
    if (exercises.empty()) {
      if (known != nullptr) keep_dose(*known, live, began, file, console);
      console.say("the exercise has not begun; it has no result");
      return true;
    }
    if (known != nullptr) keep_results(*known, exercises, file, console);
    for (const RecordedExercise& exercise : exercises) {
      std::string report = exercise_report(exercise, false);
      if (!report.empty() && report.back() == '\n') report.pop_back();
      console.say(report);
    }
    if (known != nullptr) console.say(fmt::format("kept in the registry for {}", known->patient.code));
    return std::all_of(exercises.begin(), exercises.end(),
                       [](const RecordedExercise& exercise) { return exercise.difference.empty(); });
  } catch (const std::exception& error) {
    if (known != nullptr) keep_dose(*known, live, began, file, console);
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
  std::optional<KnownPatient> known;
  if (!o.patient.empty()) known.emplace(known_patient(o));
  if (known && o.run.recordings != "off") take_up_left_recordings(*known, o.run.recordings);
  ExercisePlan plan = exercise_plan(o, known ? &*known : nullptr);
  FindRecordingKey keys;
  if (known) {
    Registry& registry = known->opened.registry;
    confirm_patient(known->patient, o.confirm);
    if (!o.record_plain) {
      plan.recording.encryption = registry.recording_key(known->opened.actor, known->patient.record);
      keys = [key = *plan.recording.encryption](const std::string& id) -> std::optional<RecordingKey> {
        return id == key.id ? std::optional(key.key) : std::nullopt;
      };
    }
    plan.on_open = [&known, exercise = plan.start.exercise,
                    demo = plan.start.simulated](const SessionInfo& info) {
      refuse_patient(known->patient, exercise, demo || info.device.simulated, known->today);
      refuse_other_hand(known->patient, info.geometry->handedness);
    };
    plan.on_recording = [&known](const fs::path& file) {
      known->opened.registry.add_recording(known->opened.actor, known->patient.record,
                                           file.filename().string());
    };
  }
  end_on_signal();
  const Clock clock(o.run.slow_motion);
  RunConsole console("phalanx exercise run");
  if (!o.seed) console.say(fmt::format("seed {}", plan.start.seed));
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

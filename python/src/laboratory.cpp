// SPDX-License-Identifier: Apache-2.0
// Closed-loop trials, and studies of many of them.
#include <dlfcn.h>
#include <fmt/format.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>
#include <tbb/parallel_for.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "arrays.h"
#include "columns.h"
#include "phalanx/force/parameter_ranges.h"
#include "phalanx/record/made.h"
#include "phalanx/scene/resolved_scene.h"
#include "phalanx/scene/scene_trial.h"
#include "phalanx/simulation/closed_loop/trial.h"
#include "phalanx/study/laboratory/run_study.h"
#include "phalanx/study/laboratory/scene_inputs.h"
#include "phalanx/study/laboratory/study_file.h"
#include "phalanx/study/trial_function.h"
#include "scene.h"
#include "study/laboratory/fingerprint.h"

namespace phalanx::python {
namespace {

namespace fs = std::filesystem;

/// Result of a trial, with its motion if it was recorded.
struct Trial {
  std::uint64_t seed = 0;
  TrialResult result;
  std::shared_ptr<Run> run;
};

/// What every trial of a call has in common.
struct TrialArguments {
  double stiffness = 0.0;
  double press = 0.0;
  bool records = false;
  std::vector<const Column*> columns;
};

TrialArguments read_arguments(const py::object& stiffness, const py::object& press, const py::object& names) {
  const bool none = py::isinstance<py::bool_>(names) && !names.cast<bool>();
  return {.stiffness = read_number(stiffness, "stiffness_n_per_m", above(0.0, 1e5)),
          .press = read_number(press, "press_n", between(0.0, 1000.0)),
          .records = !none,
          .columns = none ? std::vector<const Column*>() : chosen_columns(names)};
}

/// Call it without the GIL.
Trial run_one(const TrialSetup& setup, std::uint64_t seed, const TrialArguments& arguments) {
  Trial trial{.seed = seed, .result = {}, .run = nullptr};
  TickObserver observer;
  if (arguments.records) {
    const double steps = setup.schedule.end * setup.parameters.rate_hz;
    trial.run = std::make_shared<Run>(arguments.columns, static_cast<std::size_t>(steps) + 2);
    observer = [&](double, const Snapshot& snapshot, const SimulatedExoskeleton&) {
      trial.run->add(snapshot);
    };
  }
  trial.result = run_trial(setup, arguments.stiffness, arguments.press, seed, observer);
  return trial;
}

using Setup = std::shared_ptr<const TrialSetup>;

/// Device, patient and hand of a scene in a closed loop. Constant.
class ClosedLoop {
 public:
  explicit ClosedLoop(Setup setup) : setup_(std::move(setup)) {}

  [[nodiscard]] Trial run(std::uint64_t seed, const py::object& stiffness, const py::object& press,
                          const py::object& names) const {
    const TrialArguments arguments = read_arguments(stiffness, press, names);
    const py::gil_scoped_release release;
    return run_one(*setup_, seed, arguments);
  }
  [[nodiscard]] std::vector<Trial> run_seeds(const std::vector<std::uint64_t>& seeds,
                                             const py::object& stiffness, const py::object& press,
                                             const py::object& names) const {
    const TrialArguments arguments = read_arguments(stiffness, press, names);
    std::vector<Trial> trials(seeds.size());
    const py::gil_scoped_release release;
    tbb::parallel_for(std::size_t{0}, seeds.size(),
                      [&](std::size_t i) { trials[i] = run_one(*setup_, seeds[i], arguments); });
    return trials;
  }
  [[nodiscard]] const TrialSetup& setup() const noexcept { return *setup_; }

 private:
  Setup setup_;
};

/// A folder that is removed with its content.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (fs::temp_directory_path() / "phalanx-study-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr)
      throw std::system_error(errno, std::generic_category(), name + ": no folder for the study");
    path_ = name;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  [[nodiscard]] const fs::path& path() const noexcept { return path_; }

 private:
  fs::path path_;
};

/// @returns the value for StudyOptions::commit, as program_version(), for this module's file.
std::string module_version() {
  const std::string commit = built_from_commit();
  if (!commit.ends_with("-dirty") && commit != "unknown") return commit;
  Dl_info info{};
  if (::dladdr(reinterpret_cast<const void*>(&module_version), &info) == 0 || info.dli_fname == nullptr)
    throw std::runtime_error("the file of phalanx._core is not known; install the module again");
  return fmt::format("{} {}", commit, fingerprint_of_files({info.dli_fname}));
}

/// One number of each point.
struct StudyColumn {
  const char* name;
  double (*value)(const PointResult& point);
};
constexpr StudyColumn kStudyColumns[] = {
    {"k_lim_n_per_m", [](const PointResult& p) { return p.k_lim; }},
    {"measured_at_n_per_m", [](const PointResult& p) { return p.measured_at; }},
    {"k_eff_n_per_m", [](const PointResult& p) { return p.k_eff; }},
    {"peak_depth_m", [](const PointResult& p) { return p.peak_depth; }},
    {"force_swing_n", [](const PointResult& p) { return p.force_swing; }},
    {"position_swing_m", [](const PointResult& p) { return p.position_swing; }},
    {"ghost_mean_s", [](const PointResult& p) { return p.ghost_s.mean; }},
    {"ghost_largest_s", [](const PointResult& p) { return p.ghost_s.largest; }},
    {"ghost_energy_mean_j", [](const PointResult& p) { return p.ghost_energy.mean; }},
    {"ghost_energy_largest_j", [](const PointResult& p) { return p.ghost_energy.largest; }},
    {"trials", [](const PointResult& p) { return static_cast<double>(p.trials); }},
    {"invalid_trials", [](const PointResult& p) { return static_cast<double>(p.invalid_trials); }},
};
struct StudyFlag {
  const char* name;
  bool (*value)(const PointResult& point);
};
constexpr StudyFlag kStudyFlags[] = {
    {"stable", [](const PointResult& p) { return p.stable; }},
    {"at_least", [](const PointResult& p) { return p.at_least; }},
    {"non_monotone", [](const PointResult& p) { return p.non_monotone; }},
    {"ends_in_invalid", [](const PointResult& p) { return p.ends_in_invalid; }},
};

py::object values_of_axis(const Study& study, const std::vector<PointResult>& results, std::size_t axis) {
  py::list values;
  for (const PointResult& result : results) {
    const int index = study_point(study, result.index).value[axis];
    const StudyValue& value = study.axes[axis].values[static_cast<std::size_t>(index)];
    values.append(study.axes[axis].numeric() ? py::object(py::float_(value.number))
                                             : py::object(py::str(value.shown)));
  }
  return py::module_::import("numpy").attr("array")(values);
}

py::dict study_table(const Study& study, const std::vector<PointResult>& results) {
  const py::module_ numpy = py::module_::import("numpy");
  const auto rows = static_cast<py::ssize_t>(results.size());
  py::dict table;
  py::list points, variants, reasons;
  for (const PointResult& result : results) {
    points.append(result.index);
    variants.append(study.variants[static_cast<std::size_t>(study_point(study, result.index).variant)].name);
    reasons.append(result.why_invalid);
  }
  table["point"] = numpy.attr("array")(points, "int64");
  if (study.has_variants()) table["variant"] = numpy.attr("array")(variants);
  for (std::size_t axis = 0; axis < study.axes.size(); ++axis)
    table[py::str(study.axes[axis].key)] = values_of_axis(study, results, axis);
  for (const StudyColumn& column : kStudyColumns) {
    std::vector<double> values;
    for (const PointResult& result : results) values.push_back(column.value(result));
    table[column.name] = take_doubles(std::move(values), {rows});
  }
  for (const StudyFlag& flag : kStudyFlags) {
    py::list values;
    for (const PointResult& result : results) values.append(flag.value(result));
    table[flag.name] = numpy.attr("array")(values, "bool");
  }
  table["why_invalid"] = numpy.attr("array")(reasons);
  return table;
}

py::dict run_whole_study(const Study& study, const py::object& out, int jobs, bool restart,
                         const py::object& progress) {
  check_function(progress, "progress");
  if (jobs < 0 || jobs > 4096)
    throw std::invalid_argument(fmt::format("jobs = {}: must be >= 0, <= 4096", jobs));
  const fs::path folder = out.is_none() ? fs::path() : read_path(out);
  std::vector<PointResult> results;
  {
    const py::gil_scoped_release release;
    std::unique_ptr<TemporaryFolder> temporary;
    if (out.is_none()) temporary = std::make_unique<TemporaryFolder>();
    const StudyOptions options{
        .jobs = jobs,
        .shard = {},
        .restart = restart,
        .commit = module_version(),
        .progress = [&](const StudyProgress& now) { call_python(progress, now.done, now.total); }};
    results = run_study(study, scene_check(study), make_trial_function(scene_of(study)),
                        temporary ? temporary->path() : folder, options);
  }
  return study_table(study, results);
}

template <class Member>
void number(py::class_<Trial>& trial, const char* name, Member TrialResult::* member, const char* meaning) {
  trial.def_property_readonly(name, [member](const Trial& self) { return self.result.*member; }, meaning);
}

void bind_trial(py::module_& module) {
  py::class_<Trial> trial(module, "Trial", "Result of one seed in the closed loop; docs/stability.md.");
  close_class(trial);
  trial.def_readonly("seed", &Trial::seed, "Seed of all random numbers.");
  number(trial, "valid", &TrialResult::valid, "True if the trial proves something.");
  number(trial, "why_invalid", &TrialResult::why_invalid, "A few words; empty if valid.");
  number(trial, "stable", &TrialResult::stable, "No contact swings by more than the criterion allows.");
  number(trial, "force_swing_n", &TrialResult::force_swing, "Largest swing of a force, peak to peak [N].");
  number(trial, "position_swing_m", &TrialResult::position_swing,
         "Largest swing of a measured contact along its normal, peak to peak [m].");
  number(trial, "peak_depth_m", &TrialResult::peak_depth, "Deepest penetration of the whole trial [m].");
  number(trial, "mean_force_n", &TrialResult::mean_force, "Mean force in the window [N].");
  number(trial, "mean_depth_m", &TrialResult::mean_depth, "Mean depth in the window [m].");
  number(trial, "ghost_s", &TrialResult::ghost_s, "Time with a force after the finger has left [s].");
  number(trial, "ghost_energy_j", &TrialResult::ghost_energy, "Work of this force on the finger [J].");
  trial.def_property_readonly(
      "run", [](const Trial& self) { return self.run; }, "The host's steps as a Run; None: not recorded.");
  trial.def("__repr__", [](const Trial& self) {
    return fmt::format("<Trial of seed {}: {}>", self.seed,
                       !self.result.valid   ? "invalid, " + self.result.why_invalid
                       : self.result.stable ? "stable"
                                            : "not stable");
  });
}

}  // namespace

void bind_laboratory(py::module_& module) {
  bind_trial(module);
  py::class_<ClosedLoop> loop(module, "ClosedLoop",
                              R"(The step of a scene with its simulated device and patient.

The patient presses, is bumped, holds and releases; docs/stability.md. The object is constant: trials do not
depend on each other.)");
  close_class(loop);
  loop.def(py::init([](const Scene& scene) {
             const Scene copy = scene;
             const py::gil_scoped_release release;
             return std::make_unique<ClosedLoop>(
                 make_trial_setup(copy.resolve({.device = true, .motion = true})));
           }),
           py::arg("scene"))
      .def("run", &ClosedLoop::run, py::arg("seed") = 1, py::arg("stiffness_n_per_m") = py::none(),
           py::arg("press_n") = py::none(), py::arg("columns") = py::none(),
           R"(Runs one trial. Other Python threads run meanwhile.

seed: of all random numbers.
stiffness_n_per_m: of the wall [N/m]; None: the scene's.
press_n: intended force of each digit [N]; None: the patient's.
columns: names of the columns to record; None: those of docs/python.md; False: no run is recorded.)")
      .def("run_seeds", &ClosedLoop::run_seeds, py::arg("seeds"), py::arg("stiffness_n_per_m") = py::none(),
           py::arg("press_n") = py::none(), py::arg("columns") = false,
           "Runs a trial for each seed on all cores, and returns them in this order. Arguments as run().")
      .def_property_readonly(
          "window_s",
          [](const ClosedLoop& self) {
            return py::make_tuple(self.setup().schedule.window_begin, self.setup().schedule.window_end);
          },
          "Begin and end of the time in which stability is judged [s].")
      .def_property_readonly(
          "bump_s",
          [](const ClosedLoop& self) {
            const PatientParameters& patient = self.setup().patient;
            return py::make_tuple(patient.bump_start, patient.bump_start + patient.bump_duration);
          },
          "Begin and end of the bump on the finger [s].")
      .def_property_readonly(
          "duration_s", [](const ClosedLoop& self) { return self.setup().schedule.end; }, "[s]")
      .def_property_readonly(
          "stiffness_n_per_m", [](const ClosedLoop& self) { return self.setup().parameters.force.stiffness; },
          "Stiffness of the scene's wall [N/m].");

  py::class_<Study> study(module, "Study",
                          R"(A sweep over keys of a scene in the closed loop, as docs/cli.md describes it.

file: path of a study file (.toml).)");
  close_class(study);
  study.def(py::init([](const fs::path& file) { return load_study(file); }), py::arg("file"))
      .def_static(
          "from_text",
          [](const std::string& text, const fs::path& folder) { return parse_study(text, "text", folder); },
          py::arg("text"), py::arg("folder") = ".",
          "Reads a study from TOML text. Relative paths in it are relative to `folder`.")
      .def_readonly("name", &Study::name, "Name of the file, without its ending.")
      .def_readonly("title", &Study::title, "Its description, one line.")
      .def_readonly("scene", &Study::scene, "The scene, as the file states it.")
      .def_property_readonly(
          "axes",
          [](const Study& self) {
            std::vector<std::string> keys;
            for (const StudyAxis& axis : self.axes) keys.push_back(axis.key);
            return keys;
          },
          "Keys of the axes.")
      .def("__len__", &point_count)
      .def(
          "check",
          [](const Study& self) {
            const Study copy = self;
            const py::gil_scoped_release release;
            static_cast<void>(check_study(copy, scene_check(copy)));
          },
          "Loads the scene, the device and the patient of every point; raises SceneError for the first "
          "problem.")
      .def(
          "run",
          [](const Study& self, const py::object& out, int jobs, bool restart, const py::object& progress) {
            return run_whole_study(Study(self), out, jobs, restart, progress);
          },
          py::arg("out") = py::none(), py::arg("jobs") = 0, py::arg("restart") = false,
          py::arg("progress") = py::none(),
          R"(Measures all points on all cores, and returns columns by name: a row for each point.

Other Python threads run meanwhile.

out: folder of the journal; the same call continues where it was ended. None: nothing is kept.
jobs: number of threads; 0: as many as there are cores.
restart: discards what the journal holds.
progress: called as progress(done, total) after each point; what it raises ends the run.

Columns: point, variant, each axis by its key, k_lim_n_per_m (largest stable stiffness), measured_at_n_per_m,
k_eff_n_per_m, peak_depth_m, force_swing_n, position_swing_m, ghost_mean_s, ghost_largest_s,
ghost_energy_mean_j, ghost_energy_largest_j, trials, invalid_trials, stable, at_least, non_monotone,
ends_in_invalid, why_invalid. NaN: there is no value.)")
      .def("__repr__", [](const Study& self) {
        return fmt::format("<Study {} of {} points>", self.name, point_count(self));
      });
}

}  // namespace phalanx::python

// SPDX-License-Identifier: Apache-2.0
// The step, one at a time and for a whole motion.
#include <fmt/format.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "arrays.h"
#include "columns.h"
#include "phalanx/scene/build_model.h"
#include "phalanx/simulation/simulate.h"
#include "phalanx/step/haptic_step.h"
#include "scene.h"
#include "step/check_parameters.h"

namespace phalanx::python {
namespace {

constexpr NumberRange kTime = between(-1e9, 1e9);  // [s]
constexpr double kNextTime = std::numeric_limits<double>::quiet_NaN();

/// Copies the rows of an array of angles, so that no thread can change them during a call.
std::vector<JointArray> rows_of(const Doubles& angle) {
  std::vector<JointArray> rows(static_cast<std::size_t>(angle.shape(0)));
  for (std::size_t i = 0; i < rows.size(); ++i)
    std::copy_n(angle.data() + i * kJoints, kJoints, rows[i].begin());
  return rows;
}

/// Model, parameters and state of one hand. Its functions may be called from several threads: a call during
/// another one is refused, since the order of steps would be a matter of chance.
class Stepper {
 public:
  /// Call it without the GIL.
  explicit Stepper(const Scene& scene) : Stepper(scene.resolve({})) {}

  Snapshot step(const JointArray& angle, double time_s) {
    const std::lock_guard lock(lock_now(), std::adopt_lock);
    advance(angle, time_s);
    return state_.snapshot();
  }

  /// Steps through rows of angles. Call it without the GIL.
  /// @param time_s  of each row; empty: one period after the other
  void steps(const std::vector<JointArray>& angle, const std::vector<double>& time_s, Run& run) {
    const std::lock_guard lock(lock_now(), std::adopt_lock);
    for (std::size_t i = 0; i < angle.size(); ++i) {
      advance(angle[i], time_s.empty() ? kNextTime : time_s[i]);
      run.add(state_.snapshot());
    }
  }

  void reset() {
    const std::lock_guard lock(lock_now(), std::adopt_lock);
    state_ = HapticState(*model_, parameters_);
    begin_s_ = 0.0;
    steps_ = 0;
  }
  void set_parameters(const HapticParameters& parameters) {
    const std::lock_guard lock(lock_now(), std::adopt_lock);
    check_parameters(parameters);
    if (parameters.rate_hz != parameters_.rate_hz)
      throw std::invalid_argument(
          fmt::format("rate_hz = {}: the rate of a stepper is {} Hz; make another one", parameters.rate_hz,
                      parameters_.rate_hz));
    parameters_ = parameters;
  }
  bool confirm_opening(int digit) {
    const std::lock_guard lock(lock_now(), std::adopt_lock);
    if (digit < 0 || digit >= kDigits)
      throw std::invalid_argument(fmt::format("digit = {}: must be >= 0, <= {}", digit, kDigits - 1));
    return state_.confirm_opening(digit);
  }
  Snapshot snapshot() {
    const std::lock_guard lock(lock_now(), std::adopt_lock);
    return state_.snapshot();
  }

  [[nodiscard]] const HapticModel& model() const noexcept { return *model_; }
  [[nodiscard]] std::shared_ptr<const HapticModel> shared_model() const noexcept { return model_; }
  [[nodiscard]] const HandParameters& hand() const noexcept { return model_->hand.parameters(); }
  [[nodiscard]] double rate_hz() const noexcept { return parameters_.rate_hz; }

 private:
  explicit Stepper(ResolvedScene scene)
      : parameters_(scene.description.parameters),
        model_(std::make_shared<const HapticModel>(build_model(std::move(scene)))),
        state_(*model_, parameters_) {}

  std::mutex& lock_now() {
    if (!mutex_.try_lock()) throw std::runtime_error("this stepper is in use by another thread");
    return mutex_;
  }
  void advance(const JointArray& angle, double time_s) noexcept {
    if (!std::isnan(time_s)) {
      begin_s_ = time_s;
      steps_ = 0;
    }
    // As simulate() counts, so that both give the same bits.
    const double now = begin_s_ + static_cast<double>(steps_++) / parameters_.rate_hz;
    phalanx::step(*model_, parameters_, {.time_s = now, .angle = angle}, state_);
  }

  std::mutex mutex_;
  HapticParameters parameters_;
  std::shared_ptr<const HapticModel> model_;
  HapticState state_;
  double begin_s_ = 0.0;     ///< the last time that was given
  std::uint64_t steps_ = 0;  ///< since then
};

py::array joints_of(const Stepper& stepper, const JointArray& values) {
  return view_of('d', {kJoints}, {sizeof(double)}, values.data(),
                 shared_owner<HapticModel>(stepper.shared_model()));
}

int checked_segment(int segment) {
  if (segment >= 0 && segment < kSegments) return segment;
  throw std::invalid_argument(fmt::format("segment = {}: must be >= 0, <= {}", segment, kSegments - 1));
}

/// Positions and rotations of all segments at some angles.
py::tuple poses_at(const Stepper& stepper, const py::object& angle) {
  const JointArray joints = read_joints(angle, "angle_rad");
  HandPoses poses;
  stepper.model().hand.poses(joints, poses);
  std::vector<double> positions, rotations;
  for (int s = 0; s < kSegments; ++s) {
    const int digit = digit_of_segment(s);
    const Pose& X = digit < 0 ? stepper.model().hand.palm_pose()
                              : poses.digit[static_cast<std::size_t>(digit)]
                                    .segment[static_cast<std::size_t>(s % kSegmentsPerDigit)];
    for (int i = 0; i < 3; ++i) {
      positions.push_back(X.p[i]);
      for (int k = 0; k < 3; ++k) rotations.push_back(X.R(i, k));
    }
  }
  return py::make_tuple(take_doubles(std::move(positions), {kSegments, 3}),
                        take_doubles(std::move(rotations), {kSegments, 3, 3}));
}

py::array segment_shapes(const Stepper& stepper) {
  std::vector<double> values;
  for (const SegmentShape& shape : stepper.hand().segments)
    values.insert(values.end(), {shape.length, shape.radius_base, shape.radius_tip});
  return take_doubles(std::move(values), {kSegments - 1, 3});
}

std::shared_ptr<Run> steps_of(Stepper& stepper, const py::object& angle, const py::object& time,
                              const py::object& names) {
  const std::vector<JointArray> rows = rows_of(read_doubles(angle, "angle_rad", {-1, kJoints}));
  std::vector<double> times;
  if (!time.is_none()) {
    const Doubles given = read_doubles(time, "time_s", {static_cast<py::ssize_t>(rows.size())});
    times.assign(given.data(), given.data() + given.size());
  }
  const auto run = std::make_shared<Run>(chosen_columns(names), rows.size());
  const py::gil_scoped_release release;
  stepper.steps(rows, times, *run);
  return run;
}

/// Joint angles over time, as Python holds them.
std::shared_ptr<Motion> make_python_motion(const py::object& time, const py::object& angle) {
  const Doubles times = read_doubles(time, "time_s", {-1});
  const Doubles angles = read_doubles(angle, "angle_rad", {times.shape(0), kJoints});
  auto motion = std::make_shared<Motion>();
  motion->time_s.assign(times.data(), times.data() + times.size());
  motion->angle = rows_of(angles);
  check_motion(*motion);
  motion->angle_origin.fill(AngleOrigin::kScripted);
  return motion;
}

std::shared_ptr<Run> run_simulation(const Scene& scene, const std::shared_ptr<const Motion>& given,
                                    const py::object& seconds, const py::object& names,
                                    const py::object& progress) {
  check_function(progress, "progress");
  const double length = read_number(seconds, "seconds", between(0.0, 86400.0));
  const std::vector<const Column*> chosen = chosen_columns(names);
  const Scene copy = scene;
  const py::gil_scoped_release release;
  ResolvedScene resolved = copy.resolve({.motion = given == nullptr});
  const Motion motion = given ? *given : *resolved.motion;
  const SceneDescription description = resolved.description;
  const HapticModel model = build_model(std::move(resolved));
  const std::uint64_t ticks = tick_count(
      std::isnan(length) ? simulation_seconds(description, motion) : length, description.parameters.rate_hz);
  const auto run = std::make_shared<Run>(chosen, ticks);
  static_cast<void>(simulate(
      model, description.parameters, motion, ticks,
      {.tick = [&](const Snapshot& snapshot) { run->add(snapshot); },
       .progress = [&](std::uint64_t done, std::uint64_t total) { call_python(progress, done, total); }}));
  return run;
}

void bind_snapshot(py::module_& module) {
  py::class_<Snapshot, std::shared_ptr<Snapshot>> snapshot(module, "Snapshot", R"(Result of one step.

Its arrays are read-only views of its memory; a later step does not change them. "Measured" is the hand at the
device's angles (HCP), "shown" the hand that does not penetrate (GDP).)");
  close_class(snapshot);
  for (const Column& column : columns())
    snapshot.def_property_readonly(
        column.name.c_str(),
        [&column](const py::object& self) { return column.of(self.cast<Snapshot&>(), self); },
        column.meaning.c_str());
  snapshot.def("__repr__", [](const Snapshot& s) {
    return fmt::format("<Snapshot of step {} at {} s>", s.tick, s.time_s);
  });
}

void bind_motion(py::module_& module) {
  py::class_<Motion, std::shared_ptr<Motion>> bound(module, "Motion",
                                                    R"(Joint angles over time, linear between the rows.

time_s: (n,) increasing times [s].
angle_rad: (n, 20) angles in the order of JOINTS [rad].)");
  close_class(bound);
  bound.def(py::init(&make_python_motion), py::arg("time_s"), py::arg("angle_rad"))
      .def_property_readonly(
          "time_s",
          [](const py::object& self) {
            const auto& motion = self.cast<const Motion&>();
            return view_of('d', {static_cast<py::ssize_t>(motion.time_s.size())}, {sizeof(double)},
                           motion.time_s.data(), self);
          },
          "Times of the rows [s], (n,).")
      .def_property_readonly(
          "angle_rad",
          [](const py::object& self) {
            const auto& motion = self.cast<const Motion&>();
            return view_of('d', {static_cast<py::ssize_t>(motion.angle.size()), kJoints},
                           {sizeof(JointArray), sizeof(double)}, motion.angle.data(), self);
          },
          "Angles of the rows [rad], (n, 20).")
      .def_property_readonly("duration_s", &Motion::duration, "Time from the first to the last row [s].")
      .def(
          "at",
          [](const Motion& motion, const py::object& time) {
            const JointArray angle = motion.at(read_number(time, "time_s", kTime));
            return take_doubles({angle.begin(), angle.end()}, {kJoints});
          },
          py::arg("time_s"), "Returns the angles `time_s` after the first row [rad], (20,).")
      .def("__len__", [](const Motion& motion) { return motion.time_s.size(); })
      .def("__repr__", [](const Motion& motion) {
        return fmt::format("<Motion of {} rows, {} s>", motion.time_s.size(), motion.duration());
      });
  module.def(
      "motion_of",
      [](const Scene& scene) {
        const Scene copy = scene;
        const py::gil_scoped_release release;
        return std::make_shared<Motion>(*copy.resolve({.motion = true}).motion);
      },
      py::arg("scene"), "Returns the motion that a scene states.");
}

}  // namespace

void bind_stepper(py::module_& module) {
  bind_snapshot(module);
  bind_motion(module);
  py::class_<Stepper> bound(module, "Stepper",
                            R"(The hand of a scene, its objects, and the state between steps.

It begins at the open hand at time 0. A call while another thread is in one raises Error.)");
  close_class(bound);
  bound
      .def(py::init([](const Scene& scene) {
             const Scene copy = scene;
             const py::gil_scoped_release release;
             return std::make_unique<Stepper>(copy);
           }),
           py::arg("scene"))
      .def(
          "step",
          [](Stepper& stepper, const py::object& angle, const py::object& time, bool allow_nonfinite) {
            const Finite finite = allow_nonfinite ? Finite::kAny : Finite::kYes;
            return std::make_shared<Snapshot>(
                stepper.step(read_joints(angle, "angle_rad", finite), read_number(time, "time_s", kTime)));
          },
          py::arg("angle_rad"), py::arg("time_s") = py::none(), py::arg("allow_nonfinite") = false,
          R"(Makes one step and returns its Snapshot.

angle_rad: (20,) measured angles in the order of JOINTS [rad].
time_s: time of the sample [s]; None: one period after the last.
allow_nonfinite: passes NaN and infinity on to the sample guard, as from a broken sensor; else they raise.)")
      .def("steps", &steps_of, py::arg("angle_rad"), py::arg("time_s") = py::none(),
           py::arg("columns") = py::none(),
           R"(Makes a step for each row of angles and returns their Run. Other Python threads run meanwhile.

angle_rad: (n, 20) [rad].
time_s: (n,) times of the samples [s]; None: one period after the other.
columns: names of the columns to record; None: those of docs/python.md.)")
      .def("reset", &Stepper::reset, "Returns to the open hand at time 0.")
      .def(
          "use_parameters_of",
          [](Stepper& stepper, const Scene& scene) {
            stepper.set_parameters(scene.description().parameters);
          },
          py::arg("scene"),
          "Takes forces, stabiliser, contact and limits of a scene for the next steps; hand and objects "
          "stay.")
      .def("confirm_opening", &Stepper::confirm_opening, py::arg("digit"),
           R"(Lets the next steps open a digit that started inside an object.

digit: 0 thumb to 4 little finger. Returns False unless the digit has no force for this reason.)")
      .def(
          "snapshot", [](Stepper& stepper) { return std::make_shared<Snapshot>(stepper.snapshot()); },
          "Returns the result of the last step.")
      .def("poses", &poses_at, py::arg("angle_rad"),
           R"(Returns where the segments are at some angles, without a step.

angle_rad: (20,) [rad]. Result: origins (16, 3) in the world frame [m], rotation matrices (16, 3, 3).)")
      .def(
          "segment_mesh",
          [](const Stepper& stepper, int segment) {
            return mesh_views(stepper.model().hand.mesh(checked_segment(segment)),
                              shared_owner<HapticModel>(stepper.shared_model()));
          },
          py::arg("segment"),
          "Returns a segment's mesh in its own frame: vertices (n, 3) [m], triangles (m, 3). No copies.")
      .def(
          "object_mesh",
          [](const Stepper& stepper) {
            return mesh_views(stepper.model().object.mesh(),
                              shared_owner<HapticModel>(stepper.shared_model()));
          },
          "Returns the objects' mesh in the world frame: vertices (n, 3) [m], triangles (m, 3). No copies.")
      .def_property_readonly("segment_shapes_m", &segment_shapes,
                             "Length, radius at the joint and radius at the far end of each segment but the "
                             "palm [m], (15, 3).")
      .def_property_readonly("rate_hz", &Stepper::rate_hz, "Nominal steps a second [Hz].")
      .def_property_readonly(
          "open_angle_rad", [](const Stepper& s) { return joints_of(s, s.hand().open_angle); },
          "Angles of the open hand [rad], (20,).")
      .def_property_readonly(
          "min_angle_rad", [](const Stepper& s) { return joints_of(s, s.hand().min_angle); },
          "Least angles of the range of motion [rad], (20,).")
      .def_property_readonly(
          "max_angle_rad", [](const Stepper& s) { return joints_of(s, s.hand().max_angle); },
          "Largest angles of the range of motion [rad], (20,).")
      .def("__repr__", [](const Stepper& s) { return fmt::format("<Stepper at {} Hz>", s.rate_hz()); });
  module.def("simulate", &run_simulation, py::arg("scene"), py::arg("motion") = py::none(),
             py::arg("seconds") = py::none(), py::arg("columns") = py::none(),
             py::arg("progress") = py::none(),
             R"(Plays a motion through the step and returns its Run.

Other Python threads run meanwhile. Each column is computed into memory that its array then shares.

motion: Motion; None: the scene's.
seconds: length [s]; None: the scene's, or the motion's.
columns: names of the columns to record; None: those of docs/python.md.
progress: called as progress(done, total) about 100 times a run; what it raises ends the run.)");
}

}  // namespace phalanx::python

// SPDX-License-Identifier: Apache-2.0
#include "papers/loop_run.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "papers/swing_watch.h"
#include "phalanx/scene/scene_file.h"
#include "phalanx/scene/scene_trial.h"
#include "phalanx/simulation/closed_loop/trial.h"
#include "phalanx/simulation/simulated_exoskeleton.h"

namespace phalanx {
namespace {

class CurveRecorder {
 public:
  explicit CurveRecorder(LoopCurves& curves) : curves_(curves) {}

  void add(double t, const Snapshot& snapshot) {
    curves_.time_s.push_back(t);
    for (std::size_t s = 0; s < kSegments; ++s) {
      const SegmentSnapshot& segment = snapshot.segment[s];
      if (segment.contact && !seen_[s]) {
        seen_[s] = true;
        point_[s] = snapshot.gdp_pose[s].inverse() * segment.point;
        normal_[s] = segment.normal;
        origin_[s] = segment.point;
      }
      curves_.force[s].push_back(segment.force);
      curves_.position[s].push_back(seen_[s] ? -normal_[s].dot(snapshot.hcp_pose[s] * point_[s] - origin_[s])
                                             : std::numeric_limits<double>::quiet_NaN());
    }
  }
  void finish() {
    for (std::size_t s = 0; s < kSegments; ++s) {
      if (std::any_of(curves_.force[s].begin(), curves_.force[s].end(), [](double f) { return f > 0.0; }))
        curves_.touching.push_back(static_cast<int>(s));
    }
  }

 private:
  LoopCurves& curves_;
  std::array<bool, kSegments> seen_{};
  std::array<Vec3, kSegments> point_{}, normal_{}, origin_{};
};

}  // namespace

int LoopRun::stable() const {
  return static_cast<int>(
      std::count_if(trials.begin(), trials.end(), [](const TrialResult& t) { return t.stable && t.valid; }));
}

int LoopRun::unstable() const {
  return static_cast<int>(
      std::count_if(trials.begin(), trials.end(), [](const TrialResult& t) { return !t.stable; }));
}

double LoopRun::largest_force_swing() const {
  double largest = 0.0;
  for (const TrialResult& trial : trials) largest = std::max(largest, trial.force_swing);
  return largest;
}

double LoopRun::largest_position_swing() const {
  double largest = 0.0;
  for (const TrialResult& trial : trials) largest = std::max(largest, trial.position_swing);
  return largest;
}

LoopRun run_loop(const std::string& name, const std::string& scene, const Overrides& overrides, int seeds) {
  const auto setup = make_trial_setup(SceneFile(scene).scene(overrides));
  LoopRun run;
  run.name = name;
  run.stiffness = setup->parameters.force.stiffness;
  run.trials.resize(static_cast<std::size_t>(seeds));
  run.detections.resize(static_cast<std::size_t>(seeds));
  constexpr double kAsItIs = std::numeric_limits<double>::quiet_NaN();
  tbb::parallel_for(0, seeds, [&](int i) {
    const auto at = static_cast<std::size_t>(i);
    Detection& detection = run.detections[at];
    std::array<SwingWatch, kSegments> watch;
    CurveRecorder recorder(run.curves);
    run.trials[at] = run_trial(
        *setup, kAsItIs, kAsItIs, static_cast<std::uint64_t>(i) + 1,
        [&](double t, const Snapshot& snapshot, const SimulatedExoskeleton& device) {
          if (t < setup->schedule.release) {
            for (std::size_t s = 0; s < kSegments; ++s) {
              const double since = watch[s].add(t, snapshot.segment[s].force);
              if (std::isnan(detection.swung_s)) detection.swung_s = since;
            }
            if (has(snapshot.status, Status::kOscillating) && std::isnan(detection.fired_s))
              detection.fired_s = t;
          }
          if (i > 0) return;
          recorder.add(t, snapshot);
          for (std::size_t j = 0; j < kJoints; ++j)
            run.unrendered[j] = std::max(run.unrendered[j], std::abs(device.rendered().unrendered[j]));
        });
    if (i == 0) recorder.finish();
  });
  return run;
}

}  // namespace phalanx

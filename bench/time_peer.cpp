// SPDX-License-Identifier: Apache-2.0
#include "time_peer.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "peer_brute.h"
#include "peer_fcl.h"
#include "phalanx/force/force_stage.h"
#include "replay.h"
#include "stopwatch.h"

namespace phalanx::bench {
namespace {

std::unique_ptr<DistanceEngine> engine_of(PeerKind kind, const HapticModel& model) {
  if (kind == PeerKind::kBrute) return std::make_unique<BruteEngine>(model.hand, model.object.mesh());
  return std::make_unique<FclEngine>(model.hand, model.object.mesh());
}

/// A peer's whole step and what it keeps between ticks.
class PeerStep {
 public:
  PeerStep(const HapticModel& model, const HapticParameters& parameters, PeerKind kind)
      : model_(model),
        parameters_(parameters),
        engine_(engine_of(kind, model)),
        gdp_(model, parameters.contact, *engine_,
             kind == PeerKind::kFclNaive ? Pruning::kNone : Pruning::kLikeOurs),
        state_(contact_model(model, parameters)) {}

  /// Begins a motion with the open hand.
  void begin() {
    gdp_.forget();
    force_ = ForceState{};
    model_.hand.poses(model_.hand.parameters().open_angle, force_.hcp_before);
  }

  PeerTick run(std::size_t tick, const GdpValues& start, const JointArray& hcp_angle) {
    set_values(start, state_);
    const long before = gdp_.questions();
    const Stopwatch watch;
    model_.hand.poses(hcp_angle, hcp_);
    static_cast<void>(gdp_.advance(hcp_angle, hcp_, kMeasured, state_));
    static_cast<void>(compute_command(parameters_, state_, hcp_, false, force_));
    return {tick, watch.us(), gdp_.questions() - before};
  }

  [[nodiscard]] const PeerGdp& gdp() const { return gdp_; }
  [[nodiscard]] GdpValues result() const { return values_of(state_); }

 private:
  const HapticModel& model_;
  const HapticParameters& parameters_;
  std::unique_ptr<DistanceEngine> engine_;
  PeerGdp gdp_;
  GdpState state_;
  ForceState force_;
  HandPoses hcp_;
};

bool makes_contact(const GdpValues& before, const GdpValues& after) {
  for (std::size_t s = 0; s < kSegments; ++s) {
    if (after.record[s].active && !before.record[s].active) return true;
  }
  return false;
}

/// One motion's part of PeerTimes: `first` is the motion's first tick among all motions' ticks.
class MotionRun {
 public:
  MotionRun(const HapticModel& model, const HapticParameters& parameters, const BenchMotion& motion,
            std::size_t first, DistanceEngine& judge, PeerTimes& out)
      : model_(model),
        parameters_(parameters),
        motion_(motion),
        first_(first),
        judge_(judge),
        out_(out),
        begin_(out.ticks.size()),
        states_(replay(model, parameters, motion.angle)) {}

  /// All ticks that are timed, and in the first repeat those that are compared.
  void play(PeerStep& peer, int repeat) {
    peer.begin();
    std::size_t entry = begin_;
    for (std::size_t tick = 0; tick < motion_.angle.size(); ++tick) {
      const bool timed = (first_ + tick) % static_cast<std::size_t>(out_.plan.every) == 0;
      const bool compared = repeat == 0 && (timed || makes_contact(states_[tick], states_[tick + 1]));
      if (!timed && !compared) continue;
      const PeerTick run = peer.run(first_ + tick, states_[tick], motion_.angle[tick]);
      if (compared) hold_against_ours(peer, tick);
      if (timed) note(run, repeat, entry++);
    }
  }

 private:
  void hold_against_ours(const PeerStep& peer, std::size_t tick) {
    compare(model_, parameters_, states_[tick], states_[tick + 1], peer.result(), peer.gdp(), judge_,
            fmt::format("{}, {} tick {}", out_.plan.name, motion_.name, tick), out_.agreement);
  }
  void note(const PeerTick& run, int repeat, std::size_t entry) {
    if (repeat == 0) {
      out_.ticks.push_back(run);
    } else {
      out_.ticks[entry].us = std::min(out_.ticks[entry].us, run.us);
    }
  }

  const HapticModel& model_;
  const HapticParameters& parameters_;
  const BenchMotion& motion_;
  std::size_t first_;
  DistanceEngine& judge_;
  PeerTimes& out_;
  std::size_t begin_;
  std::vector<GdpValues> states_;
};

}  // namespace

PeerTimes time_peer(const HapticModel& model, const HapticParameters& parameters,
                    const std::vector<BenchMotion>& motions, const PeerPlan& plan) {
  PeerStep peer(model, parameters, plan.kind);
  FclEngine judge(model.hand, model.object.mesh());
  PeerTimes out{.plan = plan, .ticks = {}, .agreement = {}};
  std::size_t first = 0;
  for (const BenchMotion& motion : motions) {
    MotionRun run(model, parameters, motion, first, judge, out);
    for (int repeat = 0; repeat < plan.repeats; ++repeat) run.play(peer, repeat);
    first += motion.angle.size();
  }
  return out;
}

}  // namespace phalanx::bench

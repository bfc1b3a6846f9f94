// SPDX-License-Identifier: Apache-2.0
// What a run of the benchmark found, as numbers, and as the text, Markdown and JSON that show it.
#pragma once

#include <array>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "compare.h"
#include "object_cost.h"
#include "phalanx/record/made.h"
#include "phalanx/simulation/step_times.h"
#include "phases.h"
#include "time_ours.h"
#include "time_peer.h"

namespace phalanx::bench {

/// Times of some ticks of our step.
struct TimesRow {
  std::string phase;
  std::size_t ticks = 0;
  StepTimes us;        ///< of the ticks' least times
  double raw_max = 0;  ///< greatest single time [us]; cold: the same as max
};

/// One peer beside ours, at the same ticks, both the least of as many repeats [us].
struct PeerRow {
  PeerPlan plan;
  std::size_t ticks = 0;              ///< run
  std::size_t with_queries = 0;       ///< of them, those in which pruned FCL had to ask for a distance
  double p50 = 0.0, our_p50 = 0.0;    ///< of the ticks with queries
  double p999 = 0.0, our_p999 = 0.0;  ///< of all ticks that were run
  double idle_p50 = 0.0, our_idle_p50 = 0.0;  ///< of the ticks without queries
  Agreement agreement;
};

enum class HashCheck { kMatches, kNotOnRecord, kRecorded };

struct SceneReport {
  std::string scene;
  int object_triangles = 0;
  int hand_triangles = 0;
  std::size_t motions = 0;
  std::size_t ticks = 0;
  std::uint64_t hash = 0;
  HashCheck hash_check = HashCheck::kMatches;
  std::vector<TimesRow> warm;  ///< by phase, all, and all with other instruction sets
  std::vector<TimesRow> cold;
  std::vector<PeerRow> peers;
  ObjectCost cost;
};

/// A digit's torque before stabiliser and limits jumps if it changes by this much more than what explains it: kappa
/// times the way of measured and shown angles, where kappa is the ratio of torque to their difference, and kJumpShare
/// of the greatest torque of the last 30 ticks [Nm].
inline constexpr double kJump = 0.02;
inline constexpr double kJumpShare = 0.05;
/// Residual of a contact problem that is not solved [m].
inline constexpr double kUnsolved = 10e-9;

/// One recording of human motion before one object.
struct RecordingReport {
  std::string recording;  ///< the file's name
  std::string object;     ///< the mesh file's name
  double size_mm = 0.0;   ///< its largest extent
  int triangles = 0;
  double lowered_mm = 0.0;  ///< so far below the scene's place that the open hand is clear of it
  bool sliding = false;     ///< contacts slide; otherwise they are fixed points
  double friction = 0.0;    ///< coefficient of contacts that slide [-]
  double seconds = 0.0;     ///< length of the motion that was run [s]
  double in_contact = 0.0;  ///< share of the ticks with a contact [-]
  double slid = 0.0;        ///< share of the ticks in which a contact has slid [-]
  double exhausted = 0.0;   ///< share of the ticks in which the search ran out of iterations [-]
  double offset_mm = 0.0;  ///< median over the ticks with contact of the greatest offset_along() of a segment
  double farthest_mm = 0.0;  ///< the greatest of them
  double jumps = 0.0;        ///< share of a digit's ticks with contact in which its torque jumps: kJump
  double slow_jumps = 0.0;   ///< those of them in which no point of the shown digit moves by more than 0.5 mm
  double unsolved = 0.0;     ///< the same for a contact problem whose residual is above kUnsolved
  std::uint64_t hash = 0;    ///< of the forces
  TimesRow times;            ///< warm, all ticks
};

struct Report {
  Made made;
  std::string instructions;  ///< the set that the contact search used
  std::vector<SceneReport> scenes;
  ObjectCost million;  ///< 0 triangles if it was not measured
  std::vector<RecordingReport> recordings;
};

/// One row a phase that occurs, and one for all ticks.
[[nodiscard]] std::vector<TimesRow> warm_rows(const std::vector<Phase>& phases, const OurTimes& times);
[[nodiscard]] std::vector<TimesRow> cold_rows(const std::vector<Phase>& phases,
                                              const std::vector<ColdTime>& times);

/// @param pruned  the ticks of pruned FCL, in order, one for every tick: which ticks have queries
[[nodiscard]] PeerRow peer_row(const PeerTimes& peer, const OurTimes& ours,
                               const std::vector<PeerTick>& pruned);

[[nodiscard]] std::string recordings_heading(bool sliding);
[[nodiscard]] std::string recording_text(const RecordingReport& recording);
[[nodiscard]] std::string scene_text(const SceneReport& scene);
[[nodiscard]] std::string cost_text(const ObjectCost& cost);
[[nodiscard]] std::string markdown(const Report& report);
[[nodiscard]] nlohmann::json json(const Report& report);

}  // namespace phalanx::bench

// SPDX-License-Identifier: Apache-2.0
// phalanx_bench: the whole step in microseconds, beside what it would take with FCL.
#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "expected_hashes.h"
#include "options.h"
#include "phalanx/contact/instruction_set.h"
#include "phalanx/mesh/objects.h"
#include "phalanx/scene/build_model.h"
#include "recordings.h"
#include "report.h"

namespace phalanx::bench {
namespace {

constexpr std::uint64_t kSqueezeSeed = 1001;
constexpr std::uint64_t kSlides = 3;  ///< motions of each kind, of contacts that slide
constexpr int kBruteMost = 2000;      ///< object triangles up to which brute force is run

std::vector<BenchMotion> make_motions(const HapticModel& model, const HapticParameters& parameters,
                                      int grasps) {
  std::vector<BenchMotion> motions;
  for (int i = 1; i <= grasps; ++i)
    motions.push_back(make_grasp(model, parameters, static_cast<std::uint64_t>(i)));
  motions.push_back(make_squeeze(model, parameters, kSqueezeSeed));
  if (parameters.contact.mode == ContactMode::kStatic) return motions;
  for (std::uint64_t seed = 1; seed <= kSlides; ++seed) {
    motions.push_back(make_slide(model, parameters, seed, static_cast<int>(Digit::kIndex)));
    motions.push_back(make_slide(model, parameters, seed, kAllDigits));
  }
  return motions;
}

/// Of all motions' ticks; also makes sure that the replays are what step() does.
std::vector<Phase> all_phases(const HapticModel& model, const HapticParameters& parameters,
                              const std::vector<BenchMotion>& motions) {
  std::vector<Phase> phases;
  for (const BenchMotion& motion : motions) {
    const std::vector<GdpValues> states = replay(model, parameters, motion.angle);
    check_replay(model, parameters, motion.angle, states);
    const std::vector<Phase> of_motion = phases_of(model, states, parameters.contact.mode);
    phases.insert(phases.end(), of_motion.begin(), of_motion.end());
  }
  return phases;
}

/// @throws std::runtime_error if the forces are not what they should be: then no time means anything.
HashCheck check_hash(const std::string& scene, const OurTimes& times, const Options& options,
                     ExpectedHashes& expected) {
  if (!times.same_hash) {
    throw std::runtime_error(fmt::format(
        "{}: two runs of the same motions gave different forces; the step is not deterministic", scene));
  }
  if (options.record) {
    expected.set(scene, options.grasps, times.hash);
    return HashCheck::kRecorded;
  }
  const std::optional<std::uint64_t> wanted = expected.find(scene, options.grasps);
  if (!wanted) return HashCheck::kNotOnRecord;
  if (*wanted == times.hash) return HashCheck::kMatches;
  throw std::runtime_error(
      fmt::format("{}: the forces' hash is {:016x}, {:016x} was expected: forces have changed. If they were "
                  "meant to, run with --record and say so in the changelog",
                  scene, times.hash, *wanted));
}

/// What the peers are compared on beside the grasps and the squeeze, and a row of its own.
std::vector<BenchMotion> make_restless_motions(const HapticModel& model, const HapticParameters& parameters,
                                               int grasps) {
  std::vector<BenchMotion> motions;
  for (int i = 1; i <= grasps; ++i)
    motions.push_back(make_restless(model, parameters, static_cast<std::uint64_t>(i)));
  return motions;
}

std::vector<PeerRow> run_peers(const HapticModel& model, const HapticParameters& parameters,
                               const std::vector<BenchMotion>& motions, const OurTimes& ours,
                               const Options& options) {
  const std::vector<BenchMotion> restless = make_restless_motions(model, parameters, options.grasps);
  std::vector<PeerTick> pruned;
  std::vector<PeerRow> rows;
  const auto run = [&](const PeerPlan& plan, int restless_every) {
    const PeerTimes times = time_peer(model, parameters, motions, plan);
    if (plan.kind == PeerKind::kFclPruned) pruned = times.ticks;
    rows.push_back(peer_row(times, ours, pruned));
    const PeerPlan untimed{plan.kind, plan.name, 1, restless_every};
    rows.back().agreement.add(time_peer(model, parameters, restless, untimed).agreement);
  };
  run({PeerKind::kFclPruned, "FCL pruned", kRepeats, 1}, 1);
  run({PeerKind::kFclNaive, "FCL naive", 2, options.naive_every}, 50 * options.naive_every);
  if (model.object.triangle_count() <= kBruteMost) run({PeerKind::kBrute, "brute force", 2, 1}, 5);
  return rows;
}

/// All ticks of these motions.
TimesRow row_of(const std::string& name, const HapticModel& model, const HapticParameters& parameters,
                const std::vector<BenchMotion>& motions) {
  const OurTimes times = time_ours(model, parameters, motions);
  if (!times.same_hash)
    throw std::runtime_error(fmt::format("{}: two runs of the same motions gave different forces", name));
  const std::vector<Phase> any(times.repeat_us.front().size(), Phase::kNear);
  TimesRow row = warm_rows(any, times).back();
  row.phase = name;
  return row;
}

/// Hands that close far, however deep the object is then in them: contacts far from where the fingers are measured.
std::vector<BenchMotion> make_wraps(const HapticModel& model) {
  std::vector<BenchMotion> motions;
  for (std::uint64_t seed = 1; seed <= kSlides; ++seed) motions.push_back(make_wrap(model, seed));
  return motions;
}

/// Of all ticks, in those instruction sets that this processor has beside its best one: the same forces, to
/// the last bit, or no time is reported.
std::vector<TimesRow> other_instruction_sets(const std::string& scene, const HapticModel& model,
                                             const HapticParameters& parameters,
                                             const std::vector<BenchMotion>& motions,
                                             const std::vector<Phase>& phases, std::uint64_t hash) {
  const InstructionSet best = instruction_set();
  std::vector<TimesRow> rows;
  for (const InstructionSet set : {InstructionSet::kAvx2, InstructionSet::kPortable}) {
    if (set == best || !has_instruction_set(set)) continue;
    use_instruction_set(set);
    const OurTimes times = time_ours(model, parameters, motions);
    use_instruction_set(best);
    if (!times.same_hash || times.hash != hash) {
      throw std::runtime_error(
          fmt::format("{}: {} instructions give other forces than {}; they must give the same bits", scene,
                      instruction_set_name(set), instruction_set_name(best)));
    }
    rows.push_back(warm_rows(phases, times).back());
    rows.back().phase = instruction_set_name(set);
  }
  return rows;
}

SceneReport run_scene(const std::string& name, const Options& options, ExpectedHashes& expected) {
  Overrides overrides;
  if (options.sliding)
    overrides = {{"contact.mode", "\"sliding\""}, {"contact.friction", fmt::format("{}", options.friction)}};
  const std::string scene =
      options.sliding ? fmt::format("{}, contacts slide, friction {}", name, options.friction) : name;
  const SceneDescription description = load_scene(name, overrides);
  const HapticModel model = build_model(description);
  const HapticParameters& parameters = description.parameters;
  const std::vector<BenchMotion> motions = make_motions(model, parameters, options.grasps);
  const std::vector<Phase> phases = all_phases(model, parameters, motions);
  const OurTimes times = time_ours(model, parameters, motions);
  SceneReport report{.scene = scene,
                     .object_triangles = model.object.triangle_count(),
                     .hand_triangles = model.hand.triangle_count(),
                     .motions = motions.size(),
                     .ticks = phases.size(),
                     .hash = times.hash,
                     .hash_check = check_hash(scene, times, options, expected),
                     .warm = warm_rows(phases, times),
                     .cold = {},
                     .peers = {},
                     .cost = object_cost(model.object.mesh())};
  // Fingers that slip off and catch up with the HCP, which takes the longest search.
  report.warm.push_back(
      row_of("restless", model, parameters, make_restless_motions(model, parameters, options.grasps)));
  if (options.sliding) report.warm.push_back(row_of("wrap", model, parameters, make_wraps(model)));
  for (const TimesRow& row : other_instruction_sets(scene, model, parameters, motions, phases, times.hash))
    report.warm.push_back(row);
  if (options.cold)
    report.cold = cold_rows(phases, time_cold(model, parameters, motions, options.cold_every));
  if (options.peers && !options.sliding) report.peers = run_peers(model, parameters, motions, times, options);
  return report;
}

void write(const std::string& file, const std::string& text) {
  if (file.empty()) return;
  std::ofstream out(file);
  out << text;
  if (!out.flush()) throw std::runtime_error(fmt::format("{}: cannot be written", file));
}

bool all_agree(const Report& report) {
  for (const SceneReport& scene : report.scenes) {
    for (const PeerRow& peer : scene.peers) {
      if (!peer.agreement.different.empty()) return false;
    }
  }
  return true;
}

int run(const Options& options) {
  Report report{.made = made_here(),
                .instructions = std::string(instruction_set_name(instruction_set())),
                .scenes = {},
                .million = {},
                .recordings = {}};
  fmt::print("phalanx_bench {} on {} ({}), {}, {}, {}\n", report.made.commit, report.made.cpu,
             report.instructions, report.made.compiler, report.made.build_type, report.made.date);
  if (!options.recordings.empty()) {
    fmt::print("{}", recordings_heading(options.sliding));
    run_recordings(options, [&](const RecordingReport& recording) {
      report.recordings.push_back(recording);
      fmt::print("{}", recording_text(recording));
      std::fflush(stdout);
    });
    write(options.json, json(report).dump(2) + "\n");
    write(options.markdown, markdown(report));
    return 0;
  }
  ExpectedHashes expected(PHALANX_BENCH_FOLDER "/expected_hashes.txt");
  for (const std::string& scene : options.scenes) {
    report.scenes.push_back(run_scene(scene, options, expected));
    fmt::print("{}", scene_text(report.scenes.back()));
    std::fflush(stdout);
  }
  if (options.large) {
    report.million = object_cost(make_therapy_ball(0.085, 0.004, 1'000'000));
    fmt::print("\n{}", cost_text(report.million));
  }
  if (options.record) expected.save();
  write(options.json, json(report).dump(2) + "\n");
  write(options.markdown, markdown(report));
  if (all_agree(report)) return 0;
  fmt::print(stderr,
             "phalanx_bench: a peer's answers differ from ours beyond grazing; see DIFFERENT above\n");
  return 1;
}

}  // namespace
}  // namespace phalanx::bench

int main(int argc, char** argv) {
  phalanx::bench::Options options;
  int exit_code = 0;
  if (!phalanx::bench::parse_options(argc, argv, options, exit_code)) return exit_code;
  try {
    return phalanx::bench::run(options);
  } catch (const std::exception& error) {
    fmt::print(stderr, "phalanx_bench: {}\n", error.what());
    return 1;
  }
}

// SPDX-License-Identifier: Apache-2.0
#include "recordings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <stdexcept>
#include <utility>

#include "peer_fcl.h"
#include "phalanx/contact/gdp.h"
#include "phalanx/contact/proximity.h"
#include "phalanx/contact/segment_motion.h"
#include "phalanx/core/constants.h"
#include "phalanx/core/index.h"
#include "phalanx/scene/build_model.h"
#include "phalanx/scene/resolved_scene.h"
#include "phalanx/scene/scene.h"
#include "phalanx/scene/scene_file.h"

namespace phalanx::bench {
namespace {

namespace fs = std::filesystem;

// The hand above the object; `place` puts a mesh in the object's place.
constexpr const char* kScene = R"(
[hand]
position_mm = [14, -114, 98]
rotation_deg = [75, 0, 0]
[[objects]]
kind = "sphere"
rotation_deg = [0, 0, -42]
)";

SceneDescription recordings_scene(const Overrides& overrides) {
  return SceneFile(kScene, "bench/recordings.cpp", fs::current_path()).scene(overrides);
}

constexpr double kSizesMm[] = {70.0, 110.0};
constexpr double kFineSizeMm = 70.0;
constexpr std::size_t kFineTriangles = 1'000'000;
constexpr double kClear = 1e-3;   // least distance of the open hand from the object [m]
constexpr double kLower = 1e-3;   // step in which the object is lowered [m]
constexpr double kLowest = 0.3;   // [m]
constexpr double kLeadInS = 0.5;  // from the open hand to the recording's first sample

/// @param extensions  in lower case
std::vector<fs::path> files(const std::string& folder, const std::vector<std::string>& extensions) {
  std::vector<fs::path> found;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    std::string extension = entry.path().extension().string();
    for (char& c : extension) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    if (std::ranges::find(extensions, extension) != extensions.end()) found.push_back(entry.path());
  }
  if (found.empty())
    throw std::runtime_error(fmt::format("{}: no file of this folder ends in {}; name a folder that has one",
                                         folder, fmt::join(extensions, " or ")));
  std::ranges::sort(found);
  return found;
}

/// The absolute path as a TOML string.
std::string quoted(const fs::path& file) {
  std::string text = "\"";
  for (const char c : fs::absolute(file).string()) {
    if (c == '"' || c == '\\') text += '\\';
    text += c;
  }
  return text + '"';
}

/// Divides every triangle into four, by the middles of its edges.
TriangleMesh divided(const TriangleMesh& mesh) {
  TriangleMesh fine{.vertices = mesh.vertices, .triangles = {}};
  std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> middles;
  const auto middle = [&](std::int32_t a, std::int32_t b) {
    const auto [place, is_new] =
        middles.try_emplace(std::minmax(a, b), static_cast<std::int32_t>(fine.vertices.size()));
    if (is_new) fine.vertices.push_back(0.5 * (mesh.vertices[idx(a)] + mesh.vertices[idx(b)]));
    return place->second;
  };
  for (const Triangle& t : mesh.triangles) {
    const std::int32_t ab = middle(t[0], t[1]);
    const std::int32_t bc = middle(t[1], t[2]);
    const std::int32_t ca = middle(t[2], t[0]);
    for (const Triangle& part : {Triangle{t[0], ab, ca}, {t[1], bc, ab}, {t[2], ca, bc}, {ab, bc, ca}})
      fine.triangles.push_back(part);
  }
  return fine;
}

/// How far the object must be lowered, in whole steps, so that the open hand is clear of it [m]. Negative: it
/// is not even at kLowest.
double way_down(const HapticModel& model) {
  HandPoses poses;
  model.hand.poses(model.hand.parameters().open_angle, poses);
  SearchScratch scratch(model.trees());
  const auto is_clear = [&](double lower) {
    for (int s = 0; s < kSegments; ++s) {
      Pose X = s == kPalm ? model.hand.palm_pose()
                          : poses.digit[idx(digit_of_segment(s))].segment[idx(s % kSegmentsPerDigit)];
      X.p.z() += lower;  // the hand goes up instead
      if (distance({model.trees()[idx(s)], X, scratch}, model.object.tree(), kClear) < kClear) return false;
    }
    return true;
  };
  for (double lower = 0.0; lower <= kLowest; lower += kLower)
    if (is_clear(lower)) return lower;
  return -1.0;
}

/// An object below the scene's hand.
struct Placed {
  SceneDescription scene;
  std::unique_ptr<HapticModel> model;
  double lowered = 0.0;  ///< [m]
};

Placed place(const fs::path& object, double size_mm, bool fine, const Options& options) {
  const Pose pose = recordings_scene({}).objects.front().pose;
  SceneDescription scene = recordings_scene({{"objects", "[{ kind = \"file\", size_mm = 0 }]"},
                                             {"objects.0.file", quoted(object)},
                                             {"objects.0.size_mm", fmt::format("{:.1f}", size_mm)},
                                             {"contact.mode", options.sliding ? "\"sliding\"" : "\"static\""},
                                             {"contact.friction", fmt::format("{}", options.friction)},
                                             {"rate_hz", "1000.0"}});
  scene.objects.front().pose = pose;
  ResolvedScene resolved = resolve(scene, {});
  Placed placed{.scene = scene, .model = nullptr, .lowered = 0.0};
  placed.lowered = way_down(build_model(resolved));
  if (placed.lowered < 0.0)
    throw std::runtime_error(
        fmt::format("{}: {:.0f} mm wide and {:.0f} mm below its place it still touches the open hand; take "
                    "this mesh out of the folder",
                    object.string(), size_mm, 1e3 * kLowest));
  for (Vec3& x : resolved.world.vertices) x.z() -= placed.lowered;
  while (fine && resolved.world.triangles.size() < kFineTriangles) resolved.world = divided(resolved.world);
  placed.model = std::make_unique<HapticModel>(build_model(std::move(resolved)));
  return placed;
}

BenchMotion recorded(const SceneDescription& of_scene, const fs::path& file, const Options& options) {
  SceneDescription scene = recordings_scene({{"motion.file", quoted(file)},
                                             {"motion.mapping", fmt::format("\"{}\"", options.mapping)},
                                             {"motion.trial", "1"},
                                             {"motion.lead_in_s", fmt::format("{:.1f}", kLeadInS)}});
  const Motion motion = build_motion(scene);
  const double rate = of_scene.parameters.rate_hz;
  const double length = simulation_seconds(scene, motion);
  const auto ticks =
      static_cast<std::size_t>((options.seconds > 0.0 ? std::min(options.seconds, length) : length) * rate);
  BenchMotion out{.name = file.filename().string(), .angle = {}};
  for (std::size_t t = 0; t < ticks; ++t) out.angle.push_back(motion.at(static_cast<double>(t) / rate));
  return out;
}

/// Returns the normal of the surface that a segment touches: of its contact points, or of its static contact.
Vec3 surface_normal(const Snapshot& snapshot, int segment) {
  Vec3 sum = Vec3::Zero();
  for (const ContactPoint& at : snapshot.contact_points)
    if (at.segment == segment) sum += at.force * at.normal;
  return sum.norm() > 0.0 ? sum.normalized() : snapshot.segment[idx(segment)].normal;
}

/// Returns how far the contact's material point is on the measured segment from where it is on the shown one, along
/// the surface [mm].
double offset_along(const Snapshot& snapshot, int segment) {
  const Vec3& point = snapshot.segment[idx(segment)].point;
  const Pose& shown = snapshot.gdp_pose[idx(segment)];
  const Vec3 offset = snapshot.hcp_pose[idx(segment)] * (shown.inverse() * point) - point;
  const Vec3 normal = surface_normal(snapshot, segment);
  return 1e3 * (offset - offset.dot(normal) * normal).norm();
}

/// Torques of a digit before stabiliser and limits, and the hands that they belong to.
struct DigitState {
  Eigen::Vector4d measured, shown, torque;
  bool touches = false;

  DigitState(const Snapshot& snapshot, int digit) {
    for (int i = 0; i < kJointsPerDigit; ++i) {
      const std::size_t joint = idx(joint_index(digit, i));
      measured[i] = snapshot.hcp_angle[joint];
      shown[i] = snapshot.gdp_angle[joint];
      torque[i] = snapshot.torque[joint];
    }
    for (int k = 0; k < kSegmentsPerDigit; ++k)
      touches = touches || snapshot.segment[idx(segment_index(digit, k))].contact;
  }
  /// Returns the ratio of the torque to the difference of the hands [Nm/rad].
  [[nodiscard]] double kappa() const {
    const double apart = (measured - shown).norm();
    return apart > 0.0 ? torque.norm() / apart : 0.0;
  }
};

/// Finds jumps of a digit's torque from tick to tick: kJump.
class JumpFinder {
 public:
  explicit JumpFinder(const DigitState& first) : last_(first) { recent_.fill(first.torque.norm()); }
  /// @returns true if the torque has jumped since the last tick
  bool see(const DigitState& now) {
    recent_[next_] = now.torque.norm();
    next_ = (next_ + 1) % recent_.size();
    const double way = (now.measured - last_.measured).norm() + (now.shown - last_.shown).norm();
    const double explained =
        std::max(now.kappa(), last_.kappa()) * way + kJumpShare * *std::ranges::max_element(recent_);
    const bool jumps = (now.torque - last_.torque).norm() > explained + kJump;
    last_ = now;
    return jumps;
  }
  [[nodiscard]] const DigitState& last() const { return last_; }

 private:
  DigitState last_;
  std::array<double, 30> recent_{};  ///< sizes of the torque at the last ticks [Nm]
  std::size_t next_ = 0;
};

constexpr double kSlowly = 0.5e-3;  // way of a shown finger in a tick [m]

/// Returns how far the points of a shown digit have moved at most [m].
double way_of(const HandModel& hand, int digit, const DigitState& from, const DigitState& to) {
  DigitAngles change{};
  for (int i = 0; i < kJointsPerDigit; ++i) change[idx(i)] = to.shown[i] - from.shown[i];
  return segment_speed(hand, digit, change, kSegmentsPerDigit - 1);
}

constexpr double kTolerance = 10e-9;  // of the margin [m]

/// @throws std::runtime_error if FCL finds a shown segment nearer to the object than the margin
void expect_clear(FclEngine& fcl, const Placed& placed, const Snapshot& snapshot, const std::string& motion) {
  const double margin = placed.scene.parameters.contact.margin;
  for (int s = 0; s < kPalm; ++s) {
    const double distance = fcl.nearest(s, snapshot.gdp_pose[idx(s)], margin).distance;
    if (!(distance >= margin - kTolerance))
      throw std::runtime_error(fmt::format("{}: tick {}: {} is {} mm from the object; the margin is {} mm",
                                           motion, snapshot.tick, segment_name(s), 1e3 * distance,
                                           1e3 * margin));
  }
}

/// What the torques do over the motion, before stabiliser and limits, and the contact problems of sliding mode.
void describe_forces(const Placed& placed, const BenchMotion& motion, RecordingReport& report) {
  HapticParameters parameters = placed.scene.parameters;
  parameters.stabiliser.method = Stabiliser::kNone;
  parameters.limits.fingertip_force_enabled = false;
  parameters.limits.joint_torque_enabled = false;
  parameters.limits.torque_rate_enabled = false;
  HapticState state(*placed.model, parameters);
  const ContactModel contact{placed.model->hand, placed.model->trees(), placed.model->object,
                             parameters.contact, parameters.period()};
  GdpState gdp(contact);  // of the same steps, to be looked into
  HandPoses hcp;
  std::array<bool, kDigits> all_measured{};
  all_measured.fill(true);
  FclEngine fcl(placed.model->hand, placed.model->object.mesh());
  std::size_t touching = 0;
  std::size_t jumps = 0;
  std::size_t slow_jumps = 0;
  std::size_t unsolved = 0;
  std::vector<JumpFinder> finder;
  for (int d = 0; d < kDigits; ++d) finder.emplace_back(DigitState(state.snapshot(), d));
  for (std::size_t t = 0; t < motion.angle.size(); ++t) {
    (void)step(*placed.model, parameters, {static_cast<double>(t) / parameters.rate_hz, motion.angle[t]},
               state);
    const Snapshot& snapshot = state.snapshot();
    placed.model->hand.poses(snapshot.hcp_angle, hcp);
    (void)advance_gdp(contact, snapshot.hcp_angle, hcp, all_measured, gdp);
    if (gdp.angle != snapshot.gdp_angle)
      throw std::runtime_error(
          fmt::format("{}: tick {}: two runs of the same motion show different hands", motion.name, t));
    expect_clear(fcl, placed, snapshot, motion.name);
    for (int d = 0; d < kDigits; ++d) {
      const DigitState now(snapshot, d);
      const DigitState before = finder[idx(d)].last();
      touching += now.touches || before.touches ? 1U : 0U;
      unsolved += gdp.sliding[idx(d)].residual > kUnsolved ? 1U : 0U;
      if (!finder[idx(d)].see(now)) continue;
      ++jumps;
      slow_jumps += way_of(placed.model->hand, d, before, now) <= kSlowly ? 1U : 0U;
    }
  }
  if (touching == 0) return;
  report.jumps = static_cast<double>(jumps) / static_cast<double>(touching);
  report.slow_jumps = static_cast<double>(slow_jumps) / static_cast<double>(touching);
  report.unsolved = static_cast<double>(unsolved) / static_cast<double>(touching);
}

/// What the hand does over the motion.
void describe(const Placed& placed, const BenchMotion& motion, RecordingReport& report) {
  HapticState state(*placed.model, placed.scene.parameters);
  std::size_t contacts = 0;
  std::size_t slid = 0;
  std::size_t exhausted = 0;
  std::vector<double> offsets;
  for (std::size_t t = 0; t < motion.angle.size(); ++t) {
    const Sample sample{static_cast<double>(t) / placed.scene.parameters.rate_hz, motion.angle[t]};
    const Status status = step(*placed.model, placed.scene.parameters, sample, state);
    slid += has(status, Status::kSlid) ? 1U : 0U;
    exhausted += has(status, Status::kSearchExhausted) ? 1U : 0U;
    bool any = false;
    double greatest = 0.0;
    for (int s = 0; s < kPalm; ++s) {
      const SegmentSnapshot& segment = state.snapshot().segment[idx(s)];
      if (!segment.contact || !(segment.force > 0.0)) continue;
      any = true;
      greatest = std::max(greatest, offset_along(state.snapshot(), s));
    }
    contacts += any ? 1U : 0U;
    if (any) offsets.push_back(greatest);
  }
  if (!offsets.empty()) {
    std::ranges::sort(offsets);
    report.offset_mm = offsets[offsets.size() / 2];
    report.farthest_mm = offsets.back();
  }
  const auto ticks = static_cast<double>(motion.angle.size());
  report.in_contact = static_cast<double>(contacts) / ticks;
  report.slid = static_cast<double>(slid) / ticks;
  report.exhausted = static_cast<double>(exhausted) / ticks;
}

RecordingReport measure(const Placed& placed, const BenchMotion& motion) {
  RecordingReport report;
  report.recording = motion.name;
  report.sliding = placed.scene.parameters.contact.mode == ContactMode::kSliding;
  report.friction = report.sliding ? placed.scene.parameters.contact.friction : 0.0;
  report.seconds = static_cast<double>(motion.angle.size()) / placed.scene.parameters.rate_hz;
  report.triangles = placed.model->object.triangle_count();
  report.lowered_mm = 1e3 * placed.lowered;
  describe(placed, motion, report);
  describe_forces(placed, motion, report);
  const OurTimes times = time_ours(*placed.model, placed.scene.parameters, {motion});
  if (!times.same_hash)
    throw std::runtime_error(fmt::format(
        "{}: two runs of the same motion gave different forces; the step is not deterministic", motion.name));
  report.hash = times.hash;
  report.times = warm_rows(std::vector<Phase>(motion.angle.size(), Phase::kNear), times).back();
  return report;
}

}  // namespace

void run_recordings(const Options& options, const std::function<void(const RecordingReport&)>& done) {
  const std::vector<fs::path> recordings = files(options.recordings, {".csv"});
  bool touched = false;
  for (const fs::path& object : files(options.meshes, {".obj", ".stl", ".ply", ".3ds", ".glb"})) {
    const auto run = [&](double size_mm, bool fine) {
      const Placed placed = place(object, size_mm, fine, options);
      for (const fs::path& recording : recordings) {
        RecordingReport report = measure(placed, recorded(placed.scene, recording, options));
        report.object = object.filename().string();
        report.size_mm = size_mm;
        touched = touched || report.in_contact > 0.0;
        done(report);
      }
    };
    for (const double size_mm : kSizesMm) run(size_mm, false);
    if (options.large) run(kFineSizeMm, true);
  }
  if (!touched)
    throw std::runtime_error(fmt::format(
        "{} before {}: the hand touches nothing in any recording; take other meshes, or longer recordings",
        options.recordings, options.meshes));
}

}  // namespace phalanx::bench

// SPDX-License-Identifier: Apache-2.0
#include "recordings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <memory>
#include <stdexcept>
#include <utility>

#include "phalanx/contact/proximity.h"
#include "phalanx/core/constants.h"
#include "phalanx/core/index.h"
#include "phalanx/scene/build_model.h"
#include "phalanx/scene/resolved_scene.h"
#include "phalanx/scene/scene.h"

namespace phalanx::bench {
namespace {

namespace fs = std::filesystem;

constexpr const char* kScene = "grasp_teapot";  // its hand, and the place of its object
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
  const Pose pose = load_scene(kScene).objects.front().pose;
  SceneDescription scene =
      load_scene(kScene, {{"objects", "[{ kind = \"file\", size_mm = 0 }]"},
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
  SceneDescription scene = load_scene(kScene, {{"motion.file", quoted(file)},
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

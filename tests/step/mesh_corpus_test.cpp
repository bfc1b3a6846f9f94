// SPDX-License-Identifier: Apache-2.0
// Debian's assimp-testmodels: every file ends in a sane step or in a refusal that says what to do. The table
// in docs/meshes.md is this test's; PHALANX_WRITE_CORPUS_TABLE=FILE writes it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "phalanx/contact/triangle_distance.h"
#include "phalanx/mesh/import.h"
#include "phalanx/scene/build_model.h"
#include "phalanx/scene/scene.h"
#include "phalanx/step/haptic_step.h"
#include "support/reference/raw_triangles.h"
#include "support/sanitized.h"

namespace phalanx {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

const fs::path kCorpus = "/usr/share/assimp/models";
constexpr double kSize = 0.09;
/// How far below the margin a stopped segment may be [m].
constexpr double kTolerance = 10e-9;
/// How far an import may move a point: 1 um and 1e-5 of the largest extent [m].
constexpr double kMoved = 1e-6 + 1e-5 * kSize;
/// Files that end in a step and that the second reader reads.
constexpr int kHeldFiles = 29;
const std::string kBegin = "<!-- corpus table -->\n";
const std::string kEnd = "<!-- end of corpus table -->\n";

std::string extension_of(const fs::path& file) {
  std::string text = file.extension().string();
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

bool is_known(const std::string& extension) {
  for (const char* known : {".obj", ".3ds", ".stl", ".ply", ".glb"})
    if (extension == known) return true;
  return false;
}

std::vector<fs::path> corpus() {
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(kCorpus))
    if (entry.is_regular_file()) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

/// The index finger presses from above.
SceneDescription pressing_hand() {
  SceneDescription scene = load_scene("index_ball");
  scene.objects.clear();
  scene.motion.script.start_s = 0.05;
  scene.motion.script.close_s = 0.6;
  scene.motion.script.hold_s = 0.1;
  scene.motion.script.open_s = 0.3;
  scene.motion.script.closure = 0.6;
  return scene;
}

std::vector<Vec3> placed(const TriangleMesh& mesh, const Pose& X) {
  std::vector<Vec3> points;
  for (const Vec3& v : mesh.vertices) points.push_back(X * v);
  return points;
}

Vec3 lowest(const std::vector<Vec3>& points) {
  return *std::min_element(points.begin(), points.end(),
                           [](const Vec3& a, const Vec3& b) { return a.z() < b.z(); });
}

const Pose& pose_of(const HandPoses& poses, int segment) {
  return poses.digit[static_cast<std::size_t>(segment / kSegmentsPerDigit)]
      .segment[static_cast<std::size_t>(segment % kSegmentsPerDigit)];
}

/// Where the fingertip's lowest point is when it has come below all the rest of the open hand.
Vec3 meeting_point(const HandModel& hand, const Motion& motion) {
  HandPoses poses;
  hand.poses(motion.at(0.0), poses);
  double floor = lowest(placed(hand.mesh(kPalm), hand.palm_pose())).z();
  for (int s = 0; s < kPalm; ++s)
    floor = std::min(floor, lowest(placed(hand.mesh(s), pose_of(poses, s))).z());
  constexpr int kIndexTip = segment_index(static_cast<int>(Digit::kIndex), 2);
  for (double t = 0.0; t < motion.duration(); t += 0.01) {
    hand.poses(motion.at(t), poses);
    const Vec3 tip = lowest(placed(hand.mesh(kIndexTip), pose_of(poses, kIndexTip)));
    if (tip.z() < floor - 1e-3) return tip;
  }
  throw std::logic_error("the finger never comes below the hand");
}

/// What brings the mesh's highest vertex there, all the rest of it below [m].
Vec3 way_under(const TriangleMesh& mesh, const Vec3& meeting) {
  return meeting - *std::max_element(mesh.vertices.begin(), mesh.vertices.end(),
                                     [](const Vec3& a, const Vec3& b) { return a.z() < b.z(); });
}

/// The file's own triangles as a second reader has them, scaled and moved as the import is; empty where that
/// reader does not know how.
std::vector<test::RawTriangle> own_triangles(const fs::path& file, const Vec3& way) {
  std::vector<test::RawTriangle> raw;
  try {
    raw = test::read_raw(file);
  } catch (const std::exception&) {
    return {};
  }
  test::scale_raw(raw, kSize);
  for (test::RawTriangle& t : raw)
    for (Vec3& v : t) v += way;
  return raw;
}

double squared_distance(const Bounds& a, const Bounds& b) {
  return (a.min - b.max).cwiseMax(b.min - a.max).cwiseMax(0.0).squaredNorm();
}

/// Least distance of the segment from the object over all pairs of triangles [m]; `cap` if it is not below.
double clearance(const TriangleMesh& segment, const Pose& X, const TriangleMesh& object, double cap) {
  const std::vector<Vec3> points = placed(segment, X);
  const auto corners = [](const std::vector<Vec3>& p, const Triangle& t) {
    return Corners{p[static_cast<std::size_t>(t[0])], p[static_cast<std::size_t>(t[1])],
                   p[static_cast<std::size_t>(t[2])]};
  };
  const auto box_of = [](const Corners& c) {
    return Bounds{c[0].cwiseMin(c[1]).cwiseMin(c[2]), c[0].cwiseMax(c[1]).cwiseMax(c[2])};
  };
  Bounds whole{points.front(), points.front()};
  for (const Vec3& p : points) whole = {whole.min.cwiseMin(p), whole.max.cwiseMax(p)};
  double least = cap * cap;
  for (const Triangle& t : object.triangles) {
    const Corners c = corners(object.vertices, t);
    const Bounds box = box_of(c);
    if (squared_distance(box, whole) >= least) continue;
    for (const Triangle& s : segment.triangles) {
      const Corners d = corners(points, s);
      if (squared_distance(box, box_of(d)) < least) least = std::min(least, triangle_distance(d, c).squared);
    }
  }
  return std::sqrt(least);
}

bool is_finite(const Snapshot& s) {
  bool finite = std::all_of(s.torque.begin(), s.torque.end(), [](double t) { return std::isfinite(t); });
  for (const SegmentSnapshot& segment : s.segment)
    finite = finite && std::isfinite(segment.force) && std::isfinite(segment.force_raw) &&
             std::isfinite(segment.depth) && segment.point.allFinite() && segment.normal.allFinite();
  return finite;
}

/// What the file's own triangles were held against.
struct Held {
  int files = 0;
  int segments = 0;      ///< segments at checked ticks
  int stopped = 0;       ///< of these, in contact
  double worst = 0.0;    ///< | clearance - margin | of a stopped one [m]
  double nearest = 1.0;  ///< of those not stopped [m]
};

/// Of the shown segment from the file's own triangles, all pairs, by a second distance.
void hold_against(const std::vector<test::RawTriangle>& raw, const HapticModel& model, double margin,
                  const Snapshot& now, int s, Held& held) {
  const auto i = static_cast<std::size_t>(s);
  const double gap =
      test::brute_force_gap(test::raw_of(model.hand.mesh(s), now.gdp_pose[i]), raw, 3.0 * margin);
  ++held.segments;
  if (now.segment[i].contact) {
    ++held.stopped;
    held.worst = std::max(held.worst, std::abs(gap - margin));
    EXPECT_LE(std::abs(gap - margin), margin) << segment_name(s) << ", from the file's own triangles";
    EXPECT_GT(gap, 0.0) << segment_name(s) << " goes through the file's own triangles";
  } else {
    held.nearest = std::min(held.nearest, gap);
    EXPECT_GE(gap, margin - kMoved) << segment_name(s) << ", from the file's own triangles";
  }
}

/// Presses the finger on the file's mesh and opens it again.
void expect_sane_steps(const fs::path& file, TriangleMesh mesh, Held& held) {
  const SceneDescription scene = pressing_hand();
  const Motion motion = build_motion(scene);
  HapticModel model = build_model(scene);
  const Vec3 meeting = meeting_point(model.hand, motion);
  const Vec3 way = way_under(mesh, meeting);
  for (Vec3& v : mesh.vertices) v += way;
  model.object = ObjectModel(std::move(mesh));
  const std::vector<test::RawTriangle> raw = own_triangles(file, way);
  const double margin = scene.parameters.contact.margin;
  const int stopped_before = held.stopped;
  const auto state = std::make_unique<HapticState>(model, scene.parameters);
  double largest_force = 0.0;
  int tick = 0;
  for (double t = 0.0; t < motion.duration(); t += scene.parameters.period(), ++tick) {
    (void)step(model, scene.parameters, Sample{t, motion.at(t)}, *state);
    const Snapshot& now = state->snapshot();
    ASSERT_TRUE(is_finite(now)) << "tick " << tick;
    for (const SegmentSnapshot& s : now.segment) largest_force = std::max(largest_force, s.force);
    if (tick % (test::kSlowBuild ? 100 : 20) != 0) continue;
    for (int k = 0; k < kSegmentsPerDigit; ++k) {
      const int s = segment_index(static_cast<int>(Digit::kIndex), k);
      ASSERT_GE(clearance(model.hand.mesh(s), now.gdp_pose[static_cast<std::size_t>(s)], model.object.mesh(),
                          2.0 * margin),
                margin - kTolerance)
          << segment_name(s) << " at tick " << tick;
      SCOPED_TRACE(tick);
      if (!raw.empty()) hold_against(raw, model, margin, now, s, held);
    }
  }
  EXPECT_GT(largest_force, 0.05) << "the finger is there to press";
  if (raw.empty()) return;
  EXPECT_GT(held.stopped, stopped_before) << "stopped by the file's own triangles";
  ++held.files;
}

/// Findings that say something about the file, with their counts.
std::string findings(const MeshReport& report) {
  std::string text;
  for (const MeshFinding& f : report.findings) {
    if (f.kind == FindingKind::kDuplicateVertices) continue;
    text += (text.empty() ? "" : ", ") + std::string(finding_name(f.kind)) + " " + std::to_string(f.found);
    if (f.repaired == f.found) text += " (repaired)";
  }
  return text;
}

std::string kind(const MeshReport& r) {
  std::string text;
  const auto add = [&](std::size_t count, const char* name) {
    if (count > 0) text += (text.empty() ? "" : ", ") + std::to_string(count) + " " + name;
  };
  add(r.solids, "solid");
  add(r.cavities, "hollow");
  add(r.sheets, "sheet");
  return text;
}

/// A refusal's words without the path in front, fit for a table.
std::string reason(const std::string& message, const fs::path& file) {
  std::string text = message.substr(std::min(message.size(), file.string().size() + 2));
  text = text.substr(0, text.find(';'));
  for (char& c : text)
    if (c == '|') c = '/';
  return text;
}

void expect_clear_refusal(const std::string& message, const fs::path& file) {
  EXPECT_THAT(message, AllOf(HasSubstr(file.filename().string()), Not(HasSubstr("\n")), HasSubstr("; ")));
}

/// One row, and what leads to it.
std::string row_of(const fs::path& file, Held& held) {
  SCOPED_TRACE(file.string());
  const std::string name = fs::relative(file, kCorpus).string();
  ImportedMesh imported;
  try {
    imported = import_and_check(file, {.size = kSize});
  } catch (const std::invalid_argument& e) {
    expect_clear_refusal(e.what(), file);
    return "| " + name + " | | | " + reason(e.what(), file) + " | refused |\n";
  }
  const MeshReport& r = imported.report;
  const std::string row =
      "| " + name + " | " + std::to_string(r.triangles_in_file) + " | " + kind(r) + " | " + findings(r);
  try {
    expect_sane_steps(file, std::move(imported.mesh), held);
  } catch (const std::exception& e) {
    ADD_FAILURE() << e.what();
  }
  return row + " | step |\n";
}

/// The table's lines.
std::vector<std::string> rows(const std::string& table) {
  std::vector<std::string> all;
  std::istringstream lines(table);
  for (std::string line; std::getline(lines, line);)
    if (line.starts_with("|")) all.push_back(line);
  return all;
}

TEST(MeshCorpus, EveryFileEndsInASaneStepOrAClearRefusalAsTheDocsSay) {
  if (!fs::is_directory(kCorpus)) GTEST_SKIP() << kCorpus << " is not there; install assimp-testmodels";
  std::string table =
      "| file | triangles in the file | shells | findings, or why | outcome |\n| --- | --- | --- | --- | --- "
      "|\n";
  std::map<std::string, std::size_t> others;
  Held held;
  for (const fs::path& file : corpus()) {
    const std::string extension = extension_of(file);
    if (is_known(extension)) {
      table += row_of(file, held);
      continue;
    }
    ++others[extension];
    try {
      (void)import_and_check(file);
      ADD_FAILURE() << file << " was read";
    } catch (const std::invalid_argument& e) {
      EXPECT_THAT(e.what(), HasSubstr("unknown mesh format"));
      EXPECT_THAT(e.what(), AllOf(HasSubstr(file.filename().string()), Not(HasSubstr("\n"))));
    }
  }
  for (const auto& [extension, count] : others)
    table += "| " + std::to_string(count) + " files " +
             (extension.empty() ? "without extension" : extension) +
             " | | | unknown mesh format | refused |\n";
  std::printf(
      "%d files held against their own triangles: %d segments, %d stopped, | clearance - margin | at most "
      "%.3f um, others at least %.3f um away\n",
      held.files, held.segments, held.stopped, held.worst * 1e6, held.nearest * 1e6);
  EXPECT_GE(held.files, kHeldFiles);
  if (const char* path = std::getenv("PHALANX_WRITE_CORPUS_TABLE")) std::ofstream(path) << table;

  std::ifstream in(fs::path(PHALANX_SOURCE_DIR) / "docs" / "meshes.md");
  const std::string docs((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  const std::size_t begin = docs.find(kBegin);
  const std::size_t end = docs.find(kEnd);
  ASSERT_TRUE(begin < end && end != std::string::npos) << "docs/meshes.md has no corpus table";
  EXPECT_EQ(rows(docs.substr(begin, end - begin)), rows(table))
      << "docs/meshes.md differs; write it anew with scripts/update_mesh_table.sh";
}

}  // namespace
}  // namespace phalanx

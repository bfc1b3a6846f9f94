// SPDX-License-Identifier: Apache-2.0
#include "mesh/repair.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "mesh/box_tree.h"
#include "mesh/edge_table.h"
#include "mesh/flat_faces.h"
#include "mesh/near_vertices.h"
#include "mesh/open_edges.h"
#include "mesh/patches.h"
#include "mesh/self_intersection.h"
#include "mesh/shells.h"
#include "mesh/t_junctions.h"
#include "mesh/weld.h"

namespace phalanx::mesh {
namespace {

class Repair {
 public:
  Repair(const RepairOptions& options, const std::string& origin, MeshReport& report)
      : options_(options), origin_(origin), report_(report) {}

  TriangleMesh run(TriangleMesh soup) {
    report_ = {};
    report_.vertices_in_file = soup.vertices.size();
    report_.triangles_in_file = soup.triangles.size();
    WeldCounts welded;
    mesh_ = weld(soup, &welded);
    soup = {};
    if (options_.positions > 0) {
      // Apart by the reader's doing: what counts is what the file has.
      report_.vertices_in_file = options_.positions;
      const std::size_t left = welded.unreferenced + mesh_.vertices.size();
      welded.duplicates = options_.positions > left ? options_.positions - left : 0;
    }
    add(FindingKind::kUnreferencedVertices, welded.unreferenced, welded.unreferenced);
    add(FindingKind::kDuplicateVertices, welded.duplicates, welded.duplicates);
    check_mesh(mesh_, origin_.c_str());
    scale();
    close_cracks(welded.degenerate);
    orient();
    finish();
    return std::move(mesh_);
  }

 private:
  template <typename... Parts>
  [[noreturn]] void refuse(const Parts&... parts) const {
    std::ostringstream message;
    message.precision(4);
    message << origin_ << ": ";
    (message << ... << parts);
    throw std::invalid_argument(message.str());
  }

  void add(FindingKind kind, std::size_t found, std::size_t repaired, double size = 0.0, double width = 0.0) {
    if (found > 0) report_.findings.push_back({kind, found, repaired, size, width});
  }

  /// To metres and the size wanted, if the numbers allow it.
  void scale() {
    const Bounds box = bounds(mesh_);
    const double largest = (box.max - box.min).maxCoeff();  // > 0: a triangle has corners at different places
    const double farthest = std::max(box.min.cwiseAbs().maxCoeff(), box.max.cwiseAbs().maxCoeff());
    report_.scale = options_.size > 0.0 ? options_.size / largest : options_.unit;
    if (!std::isfinite(report_.scale) || report_.scale <= 0.0)
      refuse("its largest extent is ", largest, " units, which cannot be scaled; export it again");
    // A float has 24 bits.
    const double step = farthest * 0x1p-23 * report_.scale;
    if (options_.size == 0.0 && !(farthest * report_.scale < kFarthest)) {
      const std::string advice = unit_advice(largest * report_.scale, report_.scale);
      refuse("it reaches ", farthest * report_.scale, " m far, more than 10 km; ",
             advice.empty() ? "move it to the origin" : advice);
    }
    if (step > kCoarsest)
      refuse("its numbers are up to ", farthest, " for an object ", largest,
             " wide; in single precision that is a step of ", step * 1e3,
             " mm, coarser than the contact margin of ", kCoarsest * 1e3,
             " mm; move it to the origin and export it again");
    if (options_.size > 0.0) {
      const Vec3 centre = 0.5 * (box.min + box.max);
      for (Vec3& v : mesh_.vertices) v = (v - centre) * report_.scale;
    } else if (options_.unit != 1.0) {
      for (Vec3& v : mesh_.vertices) v *= options_.unit;
    }
    check_mesh(mesh_, origin_.c_str());
    const Vec3 extent = bounds(mesh_).max - bounds(mesh_).min;
    report_.tolerance = std::min(kMostMoved, 1e-5 * extent.maxCoeff());
    if (!(report_.tolerance > 0.0)) refuse("its largest extent is 0; export it again");
    if (!unit_advice(extent.maxCoeff(), report_.scale).empty())
      add(FindingKind::kUnits, 1, 0, extent.maxCoeff());
    if (step > report_.tolerance) add(FindingKind::kCoarseNumbers, 1, 0, step);
  }

  void note(const Mended& mended) {
    report_.moved = std::max(report_.moved, mended.moved);
    report_.complete = report_.complete && mended.complete;
  }

  /// Degenerate and duplicate triangles go, cracks are closed, until nothing is left to do. A later step may
  /// bring what an earlier one looks for: two sides of a crack become one edge.
  void close_cracks(std::size_t degenerate) {
    const double tolerance = report_.tolerance;
    const double flat = 0.01 * tolerance;
    std::size_t duplicates = 0;
    Mended near;
    Mended junctions;
    Mended flats;
    constexpr int kRounds = 8;
    for (int round = 0; round < kRounds; ++round) {
      const std::size_t dropped = drop_duplicate_faces(mesh_);
      const Mended n = merge_near_vertices(mesh_, tolerance);
      const Mended t = split_t_junctions(mesh_, tolerance);
      const Mended f = remove_flat_faces(mesh_, flat, tolerance);
      duplicates += dropped;
      near.count += n.count;
      near.moved = std::max(near.moved, n.moved);
      junctions.count += t.count;
      junctions.moved = std::max(junctions.moved, t.moved);
      flats.count += f.count;
      for (const Mended& m : {n, t, f}) note(m);
      if (mesh_.triangles.empty()) refuse("all its triangles are without area; export a surface");
      if (n.count + t.count + f.count == 0) break;
    }
    const std::size_t still_flat = count_flat_faces(mesh_, flat);
    if (still_flat == mesh_.triangles.size())
      refuse("none of its ", still_flat, " triangles has an area; export a surface");
    add(FindingKind::kNearVertices, near.count, near.count, near.moved);
    add(FindingKind::kDegenerateFaces, degenerate + flats.count + still_flat, degenerate + flats.count);
    add(FindingKind::kDuplicateFaces, duplicates, duplicates);
    add(FindingKind::kTJunctions, junctions.count, junctions.count, junctions.moved);
  }

  void orient() {
    std::optional<EdgeTable> edges(mesh_);
    const Patches patches = orient_patches(mesh_, *edges);
    if (patches.turned > 0) edges.emplace(mesh_);  // a turned triangle's edges start from other corners
    Shells shells = find_shells(mesh_, *edges, patches);
    const std::size_t crowded = count_crowded_edges(*edges);
    const std::size_t pinched = count_pinch_vertices(mesh_, *edges);
    const OpenEdges open = find_open_edges(mesh_, *edges);
    edges.reset();
    const BoxTree tree = triangle_boxes(mesh_);
    const SelfIntersections crossing = find_self_intersections(mesh_, shells, tree, report_.tolerance);
    report_.complete = report_.complete && crossing.complete;
    const std::size_t turned = turn_shells_outward(mesh_, shells, tree, crossing.between_shells);
    std::size_t one_sided = 0;
    double widest = 0.0;
    for (const Shell& shell : shells.shell) {
      if (!shell.two_sided) ++one_sided;
      if (shell.closed) {
        report_.volume += shell.volume;
        ++(shell.cavity ? report_.cavities : report_.solids);
      } else {
        ++report_.sheets;
        widest = std::max(widest, (shell.box.max - shell.box.min).maxCoeff());
      }
    }
    add(FindingKind::kInconsistentWinding, patches.turned, patches.turned);
    add(FindingKind::kInsideOut, turned, turned);
    add(FindingKind::kNonManifoldEdges, crowded, 0);
    add(FindingKind::kPinchVertices, pinched, 0);
    add(FindingKind::kHoles, open.lines, 0, open.longest, open.widest);
    add(FindingKind::kSheets, report_.sheets, 0, widest);
    add(FindingKind::kNonOrientable, one_sided, 0);
    add(FindingKind::kSelfIntersections, crossing.pairs, 0);
  }

  void finish() {
    report_.vertices = mesh_.vertices.size();
    report_.triangles = mesh_.triangles.size();
    report_.extent = bounds(mesh_).max - bounds(mesh_).min;
    report_.closed = is_closed(mesh_);
    if (report_.triangles > kManyTriangles) add(FindingKind::kManyTriangles, report_.triangles, 0);
    std::sort(report_.findings.begin(), report_.findings.end(),
              [](const MeshFinding& a, const MeshFinding& b) { return a.kind < b.kind; });
  }

  static constexpr double kFarthest = 1e4;  ///< what contact takes [m]
  const RepairOptions& options_;
  const std::string& origin_;
  MeshReport& report_;
  TriangleMesh mesh_;
};

}  // namespace

TriangleMesh repair(TriangleMesh soup, const RepairOptions& options, const std::string& origin,
                    MeshReport& report) {
  return Repair(options, origin, report).run(std::move(soup));
}

}  // namespace phalanx::mesh

// SPDX-License-Identifier: Apache-2.0
#include "mesh/repair/repair.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <utility>
#include <vector>

#include "mesh/repair/box_tree.h"
#include "mesh/repair/edge_table.h"
#include "mesh/repair/flat_faces.h"
#include "mesh/repair/near_vertices.h"
#include "mesh/repair/open_edges.h"
#include "mesh/repair/patches.h"
#include "mesh/repair/self_intersection.h"
#include "mesh/repair/shells.h"
#include "mesh/repair/t_junctions.h"
#include "mesh/repair/weld.h"

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
      // The reader separated the vertices, so that the file's number counts.
      report_.vertices_in_file = options_.positions;
      const std::size_t left = welded.unreferenced + mesh_.vertices.size();
      welded.duplicates = options_.positions > left ? options_.positions - left : 0;
    }
    add(FindingKind::kUnreferencedVertices, welded.unreferenced, welded.unreferenced);
    add(FindingKind::kDuplicateVertices, welded.duplicates, welded.duplicates);
    check_mesh(mesh_, origin_.c_str());
    scale();
    close_cracks(welded);
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

  struct Measured {
    double size = 0.0;
    double width = 0.0;
    double area = 0.0;
    Spot place = {};  ///< in the mesh's frame; its size is not used
  };
  void add(FindingKind kind, std::size_t found, std::size_t repaired, const Measured& m) {
    if (found == 0) return;
    MeshFinding finding{kind, found, repaired, m.size, m.width, m.area, std::nullopt};
    if (m.place.known()) finding.at = m.place.at / report_.scale + report_.origin;
    report_.findings.push_back(finding);
  }
  void add(FindingKind kind, std::size_t found, std::size_t repaired) {
    add(kind, found, repaired, Measured());
  }
  void add(FindingKind kind, const OpenLines& lines) {
    const double width = kind == FindingKind::kOutlines ? 0.0 : lines.widest.size;
    add(kind, lines.count, 0, {.size = lines.longest, .width = width, .place = lines.widest});
  }

  /// Scales to metres and the wanted size, if the numbers allow it.
  void scale() {
    const Bounds box = bounds(mesh_);
    const double largest = (box.max - box.min).maxCoeff();  // > 0: a triangle has corners at different places
    const double farthest = std::max(box.min.cwiseAbs().maxCoeff(), box.max.cwiseAbs().maxCoeff());
    report_.scale = options_.size > 0.0 ? options_.size / largest : options_.unit;
    if (!std::isfinite(report_.scale) || report_.scale <= 0.0)
      refuse("its largest extent is ", largest, " units, which cannot be scaled; export it again");
    // A float has 24 significant bits.
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
      report_.origin = centre;
    } else if (options_.unit != 1.0) {
      for (Vec3& v : mesh_.vertices) v *= options_.unit;
    }
    check_mesh(mesh_, origin_.c_str());
    const Vec3 extent = bounds(mesh_).max - bounds(mesh_).min;
    report_.tolerance = std::min(kMostMoved, 1e-5 * extent.maxCoeff());
    if (!(report_.tolerance > 0.0)) refuse("its largest extent is 0; export it again");
    if (!unit_advice(extent.maxCoeff(), report_.scale).empty())
      add(FindingKind::kUnits, 1, 0, {.size = extent.maxCoeff()});
    if (step > report_.tolerance) add(FindingKind::kCoarseNumbers, 1, 0, {.size = step});
  }

  /// Drops degenerate and duplicate triangles and closes cracks, until nothing changes. A later step may
  /// create work for an earlier one: two sides of a crack become one edge.
  void close_cracks(const WeldCounts& welded) {
    const double tolerance = report_.tolerance;
    const double flat = 0.01 * tolerance;
    Allowance allowance{tolerance / 6.0, tolerance, std::vector<double>(mesh_.vertices.size(), 0.0)};
    std::size_t duplicates = 0;
    MeasuredFaces dropped_faces;
    Mended near;
    Mended junctions;
    Mended flats;
    constexpr int kRounds = 8;
    for (int round = 0; round < kRounds; ++round) {
      allowance.held_back = false;  // only the last round counts, which finds nothing more
      const std::size_t dropped = drop_duplicate_faces(mesh_, &dropped_faces);
      const Mended n = merge_near_vertices(mesh_, allowance);
      const Mended t = split_t_junctions(mesh_, allowance);
      const Mended f = remove_flat_faces(mesh_, flat, allowance);
      duplicates += dropped;
      near.count += n.count;
      near.worst.take(n.worst);
      junctions.count += t.count;
      junctions.worst.take(t.worst);
      flats.count += f.count;
      flats.worst.take(f.worst);
      for (const Mended& m : {n, t, f}) report_.complete = report_.complete && m.complete;
      for (const double moved : allowance.spent) report_.moved = std::max(report_.moved, moved);
      if (n.count + t.count + f.count == 0) break;
      report_.complete = report_.complete && round + 1 < kRounds;
    }
    report_.held_back = allowance.held_back;
    const std::size_t still_flat = count_flat_faces(mesh_, flat);
    if (still_flat == mesh_.triangles.size())
      refuse("none of its ", still_flat, " triangles has an area; export a surface");
    // The place is that of a remaining flat triangle, or else of the longest removed one.
    Spot flattest = longest_flat_face(mesh_, flat);
    if (!flattest.known()) {
      flattest = flats.worst;
      const Spot& w = welded.longest_degenerate;
      if (w.known()) flattest.take(w.size * report_.scale, (w.at - report_.origin) * report_.scale);
    }
    const std::size_t gone = welded.degenerate + flats.count;
    add(FindingKind::kNearVertices, near.count, near.count, {.size = near.worst.size, .place = near.worst});
    add(FindingKind::kDegenerateFaces, gone + still_flat, gone, {.size = flattest.size, .place = flattest});
    add(FindingKind::kDuplicateFaces, duplicates, duplicates, measured(dropped_faces));
    add(FindingKind::kTJunctions, junctions.count, junctions.count,
        {.size = junctions.worst.size, .place = junctions.worst});
  }

  static Measured measured(const MeasuredFaces& faces) {
    return {.size = faces.longest.size, .area = faces.area, .place = faces.longest};
  }

  /// Returns the largest of the shells for which `is_one` is true.
  template <typename IsOne>
  [[nodiscard]] Measured largest_shell(const Shells& shells, const IsOne& is_one) const {
    Measured m;
    for (const Shell& shell : shells.shell)
      if (is_one(shell))
        m.place.take((shell.box.max - shell.box.min).maxCoeff(),
                     centroid(mesh_, mesh_.triangles[shell.first]));
    for (std::size_t t = 0; t < shells.of.size(); ++t)
      if (is_one(shells.shell[shells.of[t]])) m.area += area_of(mesh_, mesh_.triangles[t]);
    m.size = m.place.size;
    return m;
  }

  void orient() {
    std::optional<EdgeTable> edges(mesh_);
    const Patches patches = orient_patches(mesh_, *edges);
    if (patches.turned > 0) edges.emplace(mesh_);  // a turned triangle's edges start from other corners
    Shells shells = find_shells(mesh_, *edges, patches);
    const CrowdedEdges crowded = find_crowded_edges(mesh_, *edges);
    const PinchVertices pinched = find_pinch_vertices(mesh_, *edges);
    const OpenEdges open = find_open_edges(mesh_, *edges, shells);
    edges.reset();
    const BoxTree tree = triangle_boxes(mesh_);
    const SelfIntersections crossing = find_self_intersections(mesh_, shells, tree, report_.tolerance);
    report_.complete = report_.complete && crossing.complete && open.complete;
    const TurnedShells turned =
        turn_shells_outward(mesh_, shells, tree, crossing.between_shells, report_.tolerance);
    report_.complete = report_.complete && turned.complete;
    std::size_t one_sided = 0;
    for (const Shell& shell : shells.shell) {
      if (!shell.two_sided) ++one_sided;
      if (shell.closed) {
        report_.volume += shell.volume;
        ++(shell.cavity ? report_.cavities : report_.solids);
      } else {
        ++report_.sheets;
      }
    }
    add(FindingKind::kInconsistentWinding, patches.turned, patches.turned, measured(patches.turned_faces));
    add(FindingKind::kInsideOut, turned.count, turned.count,
        {.size = turned.largest.size, .area = turned.area, .place = turned.largest});
    add(FindingKind::kNonManifoldEdges, crowded.count, 0, {.size = crowded.length, .place = crowded.longest});
    add(FindingKind::kPinchVertices, pinched.count, 0,
        {.size = pinched.longest.size, .place = pinched.longest});
    add(FindingKind::kHoles, open.holes);
    add(FindingKind::kSlits, open.slits);
    add(FindingKind::kOutlines, open.outlines);
    add(FindingKind::kSheets, report_.sheets, 0,
        largest_shell(shells, [](const Shell& shell) { return !shell.closed; }));
    add(FindingKind::kNonOrientable, one_sided, 0,
        largest_shell(shells, [](const Shell& shell) { return !shell.two_sided; }));
    add(FindingKind::kSelfIntersections, crossing.pairs, 0,
        {.size = crossing.longest.size, .place = crossing.longest});
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

  static constexpr double kFarthest = 1e4;  ///< limit of the contact search [m]
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

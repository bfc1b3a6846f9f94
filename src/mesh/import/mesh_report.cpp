// SPDX-License-Identifier: Apache-2.0
#include "phalanx/mesh/mesh_report.h"

#include <cstdio>
#include <string_view>

#include "phalanx/mesh/length_units.h"

namespace phalanx {
namespace {

struct Words {
  const char* name;
  const char* repaired;  ///< consequence for the forces if repaired
  const char* remains;   ///< consequence if it remains
};

constexpr std::array<Words, kFindingKinds> kWords = {{
    {"unreferenced_vertices", "none: left out, also for the size", ""},
    {"duplicate_vertices", "none: made one, so that neighbours know each other", ""},
    {"near_vertices", "a crack is closed; nothing can catch in it", ""},
    {"degenerate_faces", "none: a triangle without area has no normal and is covered by its neighbours",
     "met as thin lines; the force's normal there is the neighbours'"},
    {"duplicate_faces", "none: one of them is kept", ""},
    {"t_junctions", "a long edge is split at its neighbours' vertices; the surface stays where it is", ""},
    {"inconsistent_winding", "normals of neighbours agree, so that they can be interpolated", ""},
    {"inside_out", "normals point out of the solid", ""},
    {"non_manifold_edges", "", "met where they are; normals are not interpolated over these edges"},
    {"pinch_vertices", "", "met where they are; normals are not interpolated across"},
    {"holes", "", "not filled: what is narrower goes through; the surface is met from both sides"},
    {"slits", "", "left open: no fingertip goes through, but its edges are met one by one"},
    {"outlines", "", "a sheet ends there: nothing to go through; met as an edge"},
    {"sheets", "",
     "met from both sides; nothing is inside, so that a hand that starts behind it is not noticed"},
    {"non_orientable", "", "left as it is and met from both sides; flat normals where it joins itself"},
    {"self_intersections", "", "whichever surface comes first is met; where two cross is a crease"},
    {"units", "", ""},
    {"coarse_numbers", "", "the surface is right to this step only; move it to the origin before exporting"},
    {"many_triangles", "", "right, but slow and large in memory; consider --decimate"},
}};

const Words& words_of(FindingKind kind) { return kWords[static_cast<std::size_t>(kind)]; }

std::string length_text(double metres) {
  std::array<char, 64> text{};
  const char* form = metres >= 1.0 ? "%.4g m" : metres < 1e-4 ? "%.3g um" : "%.4g mm";
  std::snprintf(text.data(), text.size(), form, metres * (metres >= 1.0 ? 1.0 : metres < 1e-4 ? 1e6 : 1e3));
  return text.data();
}

}  // namespace

MeshFinding MeshReport::finding(FindingKind kind) const {
  for (const MeshFinding& f : findings)
    if (f.kind == kind) return f;
  return {.kind = kind};
}

const char* finding_name(FindingKind kind) noexcept { return words_of(kind).name; }

std::string finding_meaning(const MeshFinding& finding) {
  if (finding.kind == FindingKind::kUnits)
    return "too " + std::string(finding.size < 1.0 ? "small" : "large") +
           " for a hand; give the file's unit (mm, cm, in) or a size";
  const Words& words = words_of(finding.kind);
  if (finding.kind == FindingKind::kHoles)
    return std::string(words.remains) + " (the widest is " + length_text(finding.width) + " across at most)";
  if (finding.kind == FindingKind::kSlits)
    return std::string(words.remains) + " (the widest is " + length_text(finding.width) + ")";
  if (finding.repaired == finding.found) return words.repaired;
  if (finding.repaired == 0) return words.remains;
  return std::string(words.repaired) + "; those that remain: " + words.remains;
}

// Objects for a hand are about 5 to 50 cm wide.
std::string_view probable_unit(double largest, double scale) {
  for (const std::string_view name : {"mm", "cm", "in", "m"}) {
    const double metres = metres_per(name).value();
    const double would_be = largest / scale * metres;
    if (metres != scale && would_be >= 0.02 && would_be <= 1.0) return name;
  }
  return "";
}

std::string unit_advice(double largest, double scale) {
  constexpr double kSmallest = 3e-3;
  constexpr double kLargest = 3.0;
  if (largest >= kSmallest && largest <= kLargest) return "";
  const std::string unit(probable_unit(largest, scale));
  if (unit.empty())
    return "it is " + length_text(largest) + " wide, no object for a hand; give its size in mm";
  return "it is " + length_text(largest) + " wide; probably its numbers are " + unit + " (" +
         length_text(largest / scale * metres_per(unit).value()) + "): give unit \"" + unit +
         "\" with size_mm 0, or the size in mm";
}

}  // namespace phalanx

// SPDX-License-Identifier: Apache-2.0
// phalanx mesh check
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "commands.h"
#include "phalanx/mesh/import.h"
#include "phalanx/mesh/length_units.h"
#include "phalanx/record/mesh_report_json.h"
#include "terminal/emphasis.h"
#include "terminal/error_line.h"
#include "usage.h"

namespace phalanx {
namespace {

struct MeshCheck {
  std::vector<std::string> files;
  double size_mm = 0.0;
  std::string unit = "m";
  int triangles = 0;
  std::string out;
  bool json = false;
};

std::string millimetres(double metres) { return fmt::format("{:.4g} mm", metres * 1e3); }

std::string length(double metres) {
  if (metres == 0.0) return "";
  if (metres < 1e-3) return fmt::format("{:.3g} um", metres * 1e6);
  return metres < 10.0 ? millimetres(metres) : fmt::format("{:.4g} m", metres);
}

/// Formats a size: "200 mm, 25 cm^2".
std::string size_text(const MeshFinding& f) {
  return length(f.size) + (f.area > 0.0 ? fmt::format(", {:.3g} cm^2", f.area * 1e4) : "");
}

std::string place_text(const MeshFinding& f) {
  return f.at ? fmt::format("({:.6g}, {:.6g}, {:.6g})", f.at->x(), f.at->y(), f.at->z()) : "";
}

void print_decimation(const DecimationReport& d) {
  fmt::print(
      "  decimated    {} -> {} triangles ({} asked for); at least {} from the original (measured at {} "
      "points)\n",
      d.before, d.after, d.asked, length(std::max(d.deviation.outward, d.deviation.inward)),
      d.deviation.probes);
}

/// @param sized  --size-mm was typed
/// @returns the option that corrects a size that suits no hand; empty if the size suits one.
std::string size_option(const MeshReport& r, bool sized) {
  const MeshFinding units = r.finding(FindingKind::kUnits);
  if (units.found == 0) return "";
  const std::string_view unit = probable_unit(units.size, r.scale);
  if (unit.empty()) return "; type --size-mm 100";
  return fmt::format("; type --unit {}{}", unit, sized ? " in place of --size-mm" : "");
}

void print_report(const std::string& file, const MeshReport& r, bool sized) {
  fmt::print("{}\n", file);
  if (r.decimation) {
    fmt::print("  triangles    {} in the file, {} after the repair, {} after decimation\n",
               r.triangles_in_file, r.decimation->before, r.triangles);
    fmt::print("  vertices     {} in the file, {} after repair and decimation\n", r.vertices_in_file,
               r.vertices);
  } else {
    fmt::print("  triangles    {} in the file, {} after the repair\n", r.triangles_in_file, r.triangles);
    fmt::print("  vertices     {} in the file, {} after the repair\n", r.vertices_in_file, r.vertices);
  }
  fmt::print("  extent       {} x {} x {}\n", millimetres(r.extent.x()), millimetres(r.extent.y()),
             millimetres(r.extent.z()));
  fmt::print("  closed       {}; shells: {} solid, {} hollow, {} sheet\n", r.closed ? "yes" : "no", r.solids,
             r.cavities, r.sheets);
  if (r.solids > 0) fmt::print("  volume       {:.6g} cm^3\n", r.volume * 1e6);
  fmt::print("  moved        {} at most (tolerance {})\n", r.moved > 0.0 ? length(r.moved) : "0",
             length(r.tolerance));
  if (r.decimation) print_decimation(*r.decimation);
  if (r.held_back)
    fmt::print(
        "  note         some cracks stay open: closing them all would move the surface farther than the "
        "tolerance\n");
  if (!r.complete)
    fmt::print("  note         too many triangles lie over each other: counts are lower bounds\n");
  if (!r.findings.empty())
    fmt::print("  {:<22} {:>8} {:>8} {:>8}  {:<22} {:<30} {}\n", "finding", "found", "repaired", "remains",
               "size", "at, in the file's units", "for the forces");
  for (const MeshFinding& f : r.findings) {
    fmt::print("  {:<22} {:>8} {:>8} {:>8}  {:<22} {:<30} {}\n", finding_name(f.kind), f.found, f.repaired,
               f.found - f.repaired, size_text(f), place_text(f), finding_meaning(f));
  }
  fmt::print("  {}\n", emphasised(Emphasis::kStrong, mesh_verdict(r) + size_option(r, sized),
                                  takes_colour(STDOUT_FILENO)));
}

void check_out(const std::string& out, const std::string& file) {
  const std::filesystem::path path(out);
  std::error_code error;  // a file that does not exist is not equivalent to another
  if (std::filesystem::equivalent(path, file, error))
    throw std::invalid_argument(fmt::format("--out: {} is the file that is read; name another", out));
  if (path.extension() != ".obj")
    throw std::invalid_argument(fmt::format("--out: {} does not end with .obj, the format written", out));
}

int check_meshes(const MeshCheck& check) {
  if (!check.out.empty() && check.files.size() != 1)
    throw std::invalid_argument(
        fmt::format("--out: {} files were named; write one repaired mesh at a time", check.files.size()));
  if (!check.out.empty()) check_out(check.out, check.files.front());
  if (check.size_mm > 0.0 && check.unit != "m")
    throw std::invalid_argument("--unit: --size-mm decides the size by itself; give one of the two");
  const ImportOptions options{
      .size = check.size_mm * 1e-3, .unit = metres_per(check.unit).value(), .triangles = check.triangles};
  auto all = nlohmann::ordered_json::array();
  int code = kDone;
  for (const std::string& file : check.files) {
    try {
      const ImportedMesh imported = import_and_check(file, options);
      if (imported.report.finding(FindingKind::kUnits).found > 0) code = kWrongInput;
      if (check.json) {
        all.push_back(nlohmann::ordered_json::parse(mesh_report_json(file, imported.report)));
      } else {
        print_report(file, imported.report, check.size_mm > 0.0);
      }
      if (!check.out.empty()) write_obj(imported.mesh, check.out, "repaired");
    } catch (const std::invalid_argument& refusal) {
      code = kWrongInput;
      if (check.json) {
        all.push_back({{"file", file}, {"usable", false}, {"verdict", refusal.what()}});
      } else {
        print_error_line(fmt::format("phalanx: {}", refusal.what()));
      }
    }
  }
  if (check.json) fmt::print("{}\n", all.dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
  return code;
}

}  // namespace

void add_mesh_command(CLI::App& app, Job& job) {
  CLI::App* mesh = app.add_subcommand("mesh", "What is wrong with a mesh file and what becomes of it");
  mesh->require_subcommand(1);
  auto what = std::make_shared<MeshCheck>();
  CLI::App* check = mesh->add_subcommand(
      "check", "Import mesh files and report what was found, repaired and left (docs/meshes.md)");
  check->add_option("FILE", what->files, ".obj .3ds .stl .ply .glb")->required();
  check
      ->add_option("--size-mm", what->size_mm,
                   "scale so that the largest extent is this; 0: the file's own size")
      ->check(CLI::Range(0.0, 2000.0));
  check->add_option("--unit", what->unit, "what the file's numbers are: m, mm, cm or in")
      ->check(CLI::IsMember({"m", "mm", "cm", "in"}));
  check->add_option("--decimate", what->triangles, "simplify to about this many triangles; 0: keep all")
      ->check(CLI::Range(0, 10'000'000));
  check->add_option("--out", what->out, "write the repaired mesh as .obj, in metres");
  check->add_flag("--json", what->json, "the reports as one JSON array");
  check->callback([what, check, &job] {
    refuse_empty_values(*check);
    job = [what] { return check_meshes(*what); };
  });
}

}  // namespace phalanx

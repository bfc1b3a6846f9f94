// SPDX-License-Identifier: Apache-2.0
#include "phalanx/record/mesh_report_json.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace phalanx {

std::string mesh_verdict(const MeshReport& report) {
  if (const MeshFinding units = report.finding(FindingKind::kUnits); units.found > 0)
    return "refused in a scene as it stands: " + unit_advice(units.size, report.scale);
  std::string text = report.closed ? "usable: a closed solid"
                     : report.sheets > 0
                         ? "usable: open, so that its sheets are met from both sides"
                         : "usable: closed, though edges are shared by more than two triangles";
  if (report.solids > 1 && report.sheets == 0)
    text += fmt::format(" in {} pieces", report.solids + report.cavities);
  return text;
}

std::string mesh_report_json(const std::string& file, const MeshReport& r) {
  using Json = nlohmann::ordered_json;
  Json j = Json::object();
  j["file"] = file;
  j["usable"] = r.finding(FindingKind::kUnits).found == 0;
  j["verdict"] = mesh_verdict(r);
  j["triangles_in_file"] = r.triangles_in_file;
  j["vertices_in_file"] = r.vertices_in_file;
  j["triangles"] = r.triangles;
  j["vertices"] = r.vertices;
  j["extent_m"] = {r.extent.x(), r.extent.y(), r.extent.z()};
  j["metres_per_unit"] = r.scale;
  j["closed"] = r.closed;
  j["volume_m3"] = r.volume;
  j["solids"] = r.solids;
  j["hollows"] = r.cavities;
  j["sheets"] = r.sheets;
  j["tolerance_m"] = r.tolerance;
  j["moved_m"] = r.moved;
  j["held_back"] = r.held_back;
  j["complete"] = r.complete;
  j["findings"] = Json::array();
  for (const MeshFinding& f : r.findings) {
    j["findings"].push_back({{"kind", finding_name(f.kind)},
                             {"found", f.found},
                             {"repaired", f.repaired},
                             {"remains", f.found - f.repaired},
                             {"size_m", f.size},
                             {"width_m", f.width},
                             {"area_m2", f.area},
                             {"at", f.at ? Json{f.at->x(), f.at->y(), f.at->z()} : Json()},
                             {"meaning", finding_meaning(f)}});
  }
  if (r.decimation) {
    const DecimationReport& d = *r.decimation;
    j["decimation"] = {{"asked", d.asked},
                       {"before", d.before},
                       {"after", d.after},
                       {"was_closed", d.was_closed},
                       {"original_to_decimated_m", d.deviation.outward},
                       {"decimated_to_original_m", d.deviation.inward},
                       {"points", d.deviation.probes}};
  }
  return j.dump(2, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace phalanx

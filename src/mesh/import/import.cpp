// SPDX-License-Identifier: Apache-2.0
#include "phalanx/mesh/import.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <utility>

#include "mesh/import/assimp_reader.h"
#include "mesh/import/decimate.h"
#include "mesh/import/deviation.h"
#include "mesh/import/index_check.h"
#include "mesh/import/obj_reduce.h"
#include "mesh/repair/repair.h"
#include "phalanx/mesh/import_cache.h"
#include "phalanx/mesh/isolation/isolation_helper.h"

namespace phalanx {
namespace {

std::string lower(std::string text) {
  for (char& c : text)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return text;
}

void check_format(const std::string& format, const std::string& origin) {
  constexpr std::array<std::string_view, 5> kKnown = {"obj", "3ds", "stl", "ply", "glb"};
  if (std::find(kKnown.begin(), kKnown.end(), format) != kKnown.end()) return;
  throw std::invalid_argument(origin + ": unknown mesh format '" + format +
                              "'; known are .obj .3ds .stl .ply .glb, so convert the file to one of these");
}

void check_options(const ImportOptions& options, const std::string& origin) {
  std::ostringstream message;
  message << origin << ": ";
  if (!std::isfinite(options.size) || options.size < 0.0) {
    message << "size is " << options.size << " m; give a finite length, or 0 to keep the file's own size";
  } else if (!std::isfinite(options.unit) || options.unit <= 0.0) {
    message << "unit is " << options.unit
            << " m; give the metres that one unit of the file is, such as 0.001";
  } else if (options.triangles < 0) {
    message << options.triangles << " triangles asked for; give a count, or 0 to keep the file's own";
  } else {
    return;
  }
  throw std::invalid_argument(message.str());
}

/// Reader's result for a file.
struct Soup {
  TriangleMesh mesh;
  /// Number of the file's vertices, if the reader gives every corner its own; else 0.
  std::size_t positions = 0;
};

/// Parses a checked file with Assimp. It must run in a process of its own.
TriangleMesh parse_mesh(std::string_view text, const std::string& format, const std::string& origin) {
  if (format == "obj") {
    mesh::ReducedObj reduced = mesh::reduce_obj(text, origin);
    TriangleMesh soup = mesh::read_with_assimp(reduced.text.data(), reduced.text.size(), format, origin);
    // Assimp drops these silently, but the report counts them.
    soup.vertices.resize(soup.vertices.size() + reduced.unreferenced, Vec3::Zero());
    return soup;
  }
  if (format == "3ds") mesh::check_3ds_indices(text, origin);
  if (format == "glb") mesh::check_glb_indices(text, origin);
  return mesh::read_with_assimp(text.data(), text.size(), format, origin);
}

/// Calls parse_mesh() for "format NUL origin NUL text".
TriangleMesh parse_packed(const std::string& packed) {
  const std::size_t format = packed.find('\0');
  const std::size_t origin = packed.find('\0', format + 1);
  return parse_mesh(std::string_view(packed).substr(origin + 1), packed.substr(0, format),
                    packed.substr(format + 1, origin - format - 1));
}

Soup read_soup(const void* data, std::size_t bytes, const std::string& format, const std::string& origin) {
  if (bytes == 0) throw std::invalid_argument(origin + ": the file is empty; export the mesh again");
  if (format == "ply" &&
      std::string_view(static_cast<const char*>(data), bytes).find("end_header") == std::string_view::npos)
    throw std::invalid_argument(
        origin + ": the header has no end_header line; the file is cut off or no .ply, export it again");
  const mesh::IsolationLimits limits = mesh::reading_limits(bytes);
  const std::string_view text(static_cast<const char*>(data), bytes);
  Soup soup;
  soup.mesh = mesh::has_isolation_helper()
                  ? mesh::run_isolated_mesh(parse_packed, format + '\0' + origin + '\0' + std::string(text),
                                            origin, limits)
                  : mesh::run_isolated([&] { return parse_mesh(text, format, origin); }, origin, limits);
  if (format == "obj") soup.positions = mesh::count_obj_positions(text);
  return soup;
}

/// Decimates the mesh, checks the result, and measures its distance from the original.
void decimate_to(const ImportOptions& options, const std::string& origin, ImportedMesh& imported) {
  DecimationReport decimation;
  decimation.asked = options.triangles;
  decimation.before = imported.mesh.triangles.size();
  decimation.was_closed = imported.report.closed;
  MeshReport after;
  TriangleMesh decimated =
      mesh::repair(mesh::decimate(imported.mesh, options.triangles, origin), {}, origin, after);
  if (decimation.was_closed && !after.closed)
    throw std::invalid_argument(
        origin + ": decimated to " + std::to_string(options.triangles) +
        " triangles, the closed solid would open; ask for more, or for 0 to keep them all");
  decimation.after = decimated.triangles.size();
  decimation.deviation = mesh::measure_deviation(imported.mesh, decimated);
  imported.mesh = std::move(decimated);
  MeshReport& report = imported.report;
  report.triangles = after.triangles;
  report.vertices = after.vertices;
  report.extent = after.extent;
  report.closed = after.closed;
  report.volume = after.volume;
  report.solids = after.solids;
  report.cavities = after.cavities;
  report.sheets = after.sheets;
  // Repairs are counted in the file, remaining defects in the decimated mesh.
  for (const FindingKind kind :
       {FindingKind::kNonManifoldEdges, FindingKind::kPinchVertices, FindingKind::kHoles, FindingKind::kSlits,
        FindingKind::kOutlines, FindingKind::kSheets, FindingKind::kNonOrientable,
        FindingKind::kSelfIntersections, FindingKind::kManyTriangles}) {
    std::erase_if(report.findings, [&](const MeshFinding& f) { return f.kind == kind; });
    MeshFinding now = after.finding(kind);
    if (now.at) now.at = Vec3(*now.at / report.scale + report.origin);  // back to the file's frame
    if (now.found > 0) report.findings.push_back(now);
  }
  std::sort(report.findings.begin(), report.findings.end(),
            [](const MeshFinding& a, const MeshFinding& b) { return a.kind < b.kind; });
  report.decimation = decimation;
}

void refuse_too_many(std::size_t triangles, const ImportOptions& options, const std::string& origin) {
  if (options.most_triangles == 0 || triangles <= options.most_triangles) return;
  throw std::invalid_argument(origin + ": " + std::to_string(triangles) +
                              " triangles; decimate the mesh before sending it, the limit is " +
                              std::to_string(options.most_triangles));
}

ImportedMesh check_soup(Soup soup, const ImportOptions& options, const std::string& origin) {
  refuse_too_many(soup.mesh.triangles.size(), options, origin);
  check_mesh(soup.mesh, origin.c_str());
  ImportedMesh imported;
  imported.mesh = mesh::repair(std::move(soup.mesh),
                               {.size = options.size, .unit = options.unit, .positions = soup.positions},
                               origin, imported.report);
  check_mesh(imported.mesh, origin.c_str());
  const auto wanted = static_cast<std::size_t>(options.triangles);
  if (options.triangles > 0 && wanted < imported.mesh.triangles.size())
    decimate_to(options, origin, imported);
  return imported;
}

std::string read_file(const std::filesystem::path& file, const std::string& origin) {
  std::error_code error;
  if (!std::filesystem::exists(file, error))
    throw std::invalid_argument(origin + ": there is no such file; check the path");
  if (!std::filesystem::is_regular_file(file, error))
    throw std::invalid_argument(origin + ": this is not a regular file; give the path of a mesh file");
  const std::uintmax_t bytes = std::filesystem::file_size(file, error);
  constexpr std::uintmax_t kMostBytes = std::uintmax_t{2} << 30;
  if (error || bytes > kMostBytes)
    throw std::invalid_argument(origin + ": " + std::to_string(bytes) + " bytes are more than the " +
                                std::to_string(kMostBytes) + " that are read; decimate the mesh");
  std::string data(static_cast<std::size_t>(bytes), '\0');
  std::ifstream in(file, std::ios::binary);
  if (!in)
    throw std::invalid_argument(origin + ": the file cannot be opened (" + std::strerror(errno) +
                                "); check its permissions");
  if (!in.read(data.data(), static_cast<std::streamsize>(data.size())))
    throw std::invalid_argument(origin + ": the file cannot be read to its end; check the disk");
  return data;
}

}  // namespace

ImportedMesh import_and_check(const std::filesystem::path& file, const ImportOptions& options) {
  return import_and_check(file, options, nullptr);
}

ImportedMesh import_and_check(const std::filesystem::path& file, const ImportOptions& options,
                              ImportCache* cache) {
  const std::string origin = file.string();
  std::string format = lower(file.extension().string());
  if (!format.empty()) format.erase(0, 1);
  check_format(format, origin);
  check_options(options, origin);
  std::string content = read_file(file, origin);
  if (cache != nullptr) {
    if (const auto known = cache->find(content, format, options)) return *known;
  }
  Soup soup = read_soup(content.data(), content.size(), format, origin);
  if (cache == nullptr) std::string().swap(content);  // frees the memory, which the repair may need
  ImportedMesh imported = check_soup(std::move(soup), options, origin);
  if (cache != nullptr) cache->keep(std::move(content), std::move(format), options, imported);
  return imported;
}

ImportedMesh import_and_check_from_memory(const void* data, std::size_t bytes, const std::string& format,
                                          const ImportOptions& options) {
  const std::string origin = "mesh in memory";
  check_format(lower(format), origin);
  check_options(options, origin);
  return check_soup(read_soup(data, bytes, lower(format), origin), options, origin);
}

}  // namespace phalanx

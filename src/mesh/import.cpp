// SPDX-License-Identifier: Apache-2.0
#include "phalanx/mesh/import.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <vector>

#include "mesh/assimp_reader.h"
#include "mesh/index_check.h"
#include "mesh/isolated.h"
#include "mesh/obj_reduce.h"
#include "mesh/weld.h"

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

void check_size(double size, const std::string& origin) {
  if (std::isfinite(size) && size >= 0.0) return;
  std::ostringstream message;
  message << origin << ": size is " << size << " m; give a finite length, or 0 to keep the file's own size";
  throw std::invalid_argument(message.str());
}

/// Scales about the box's centre so that the largest extent is `size`, and moves the centre to the origin.
void resize(TriangleMesh& mesh, double size) {
  const Bounds box = bounds(mesh);
  const double largest =
      (box.max - box.min).maxCoeff();  // > 0: some triangle has corners at different places
  const Vec3 centre = 0.5 * (box.min + box.max);
  for (Vec3& v : mesh.vertices) v = (v - centre) * (size / largest);
}

TriangleMesh import_bytes(const void* data, std::size_t bytes, const std::string& format, double size,
                          const std::string& origin) {
  check_format(format, origin);
  check_size(size, origin);
  if (bytes == 0) throw std::invalid_argument(origin + ": the file is empty; export the mesh again");
  if (format == "ply" &&
      std::string_view(static_cast<const char*>(data), bytes).find("end_header") == std::string_view::npos)
    throw std::invalid_argument(
        origin + ": the header has no end_header line; the file is cut off or no .ply, export it again");
  // Generous for honest files (Assimp reads some 10 MB/s and takes some 20 times a file's size), soon over
  // for a loop.
  const mesh::IsolationLimits limits{.cpu_seconds = 2 + bytes / 1'000'000,
                                     .memory_bytes = (std::uint64_t{1} << 30) + 100 * std::uint64_t{bytes}};
  const std::string_view text(static_cast<const char*>(data), bytes);
  const auto read = [&] {
    if (format == "obj") {
      const std::string reduced = mesh::reduce_obj(text, origin);
      return mesh::read_with_assimp(reduced.data(), reduced.size(), format, origin);
    }
    if (format == "3ds") mesh::check_3ds_indices(text, origin);
    if (format == "glb") mesh::check_glb_indices(text, origin);
    return mesh::read_with_assimp(data, bytes, format, origin);
  };
  const TriangleMesh soup = mesh::run_isolated(read, origin, limits);
  check_mesh(soup, origin.c_str());
  TriangleMesh mesh = mesh::weld(soup);
  check_mesh(mesh, origin.c_str());
  if (size > 0.0) {
    resize(mesh, size);
    check_mesh(mesh, origin.c_str());
  }
  return mesh;
}

}  // namespace

TriangleMesh import_mesh(const std::filesystem::path& file, double size) {
  const std::string origin = file.string();
  std::string format = lower(file.extension().string());
  if (!format.empty()) format.erase(0, 1);
  check_format(format, origin);
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
  std::vector<char> data(static_cast<std::size_t>(bytes));
  std::ifstream in(file, std::ios::binary);
  if (!in || !in.read(data.data(), static_cast<std::streamsize>(data.size())))
    throw std::invalid_argument(origin + ": the file cannot be read; check its permissions");
  return import_bytes(data.data(), data.size(), format, size, origin);
}

TriangleMesh import_mesh_from_memory(const void* data, std::size_t bytes, const std::string& format,
                                     double size) {
  return import_bytes(data, bytes, lower(format), size, "mesh in memory");
}

}  // namespace phalanx

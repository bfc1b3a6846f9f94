// SPDX-License-Identifier: Apache-2.0
#include "serve/uploads.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <thread>
#include <vector>

#include "phalanx/core/constants.h"
#include "phalanx/mesh/isolated_import.h"
#include "phalanx/mesh/length_units.h"
#include "phalanx/record/mesh_report_json.h"
#include "phalanx/record/output_file.h"
#include "record/plain_text.h"

namespace phalanx {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::size_t kKept = 50;
/// Limits of the import in a process of its own. A faulty mesh can harm that process only. A mesh that
/// passes there also passes if the station imports it with another size.
constexpr mesh::IsolationLimits kImportLimits{
    .cpu_seconds = 60, .memory_bytes = std::uint64_t{4} << 30, .wall_seconds = 180.0};
constexpr std::size_t kPreviewTriangles = 20'000;
constexpr double kPreviewUnit = 1e-6;  // [m], of a preview's coordinates
constexpr mesh::IsolationLimits kPreviewLimits{
    .cpu_seconds = 5, .memory_bytes = std::uint64_t{4} << 30, .wall_seconds = 20.0};
constexpr std::array<const char*, 5> kFormats = {".obj", ".3ds", ".stl", ".ply", ".glb"};

int hex(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  return c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
}

std::string percent_decoded(std::string_view text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '%' && i + 2 < text.size() && hex(text[i + 1]) >= 0 && hex(text[i + 2]) >= 0) {
      out.push_back(static_cast<char>(hex(text[i + 1]) * 16 + hex(text[i + 2])));
      i += 2;
    } else {
      out.push_back(text[i] == '+' ? ' ' : text[i]);
    }
  }
  return out;
}

double number(const std::string& text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !(value >= 0.0 && value <= 2000.0))
    throw std::invalid_argument(fmt::format("size_mm = {}: must be a number from 0 to 2000", text));
  return value;
}

double metres_per_unit_of(const UploadedMesh& mesh) {
  if (const std::optional<double> metres = metres_per(mesh.unit)) return *metres;
  throw std::invalid_argument(fmt::format("unit = {}: must be m, mm, cm or in", mesh.unit));
}

/// @returns the FNV-1a hash, with which different files of one name get different names
std::uint64_t hash_of(const std::string& bytes) {
  std::uint64_t hash = 14695981039346656037U;
  for (const char c : bytes) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211U;
  return hash;
}

std::string file_name(const UploadedMesh& mesh, const std::string& extension) {
  std::string stem = fs::path(mesh.name).stem().string();
  std::erase_if(stem, [](char c) { return !is_plain(c); });
  if (stem.empty()) stem = "mesh";
  return fmt::format("{}-{:016x}{}", stem.substr(0, 40), hash_of(mesh.bytes), extension);
}

/// @returns true if file_name() could have made the name: "mug-0123456789abcdef.stl"
bool is_upload_name(const std::string& name) {
  constexpr std::size_t kDigits = 16;
  const std::size_t dot = name.rfind('.');
  if (dot == std::string::npos || dot < kDigits + 2 || name[dot - kDigits - 1] != '-') return false;
  const auto digits = name.begin() + static_cast<std::ptrdiff_t>(dot - kDigits);
  const bool hashed = std::all_of(digits, digits + kDigits,
                                  [](char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f'); });
  return hashed && std::all_of(name.begin(), digits, is_plain) &&
         std::find(kFormats.begin(), kFormats.end(), name.substr(dot)) != kFormats.end();
}

/// @returns true if a value names the file. The names of uploads need no escapes in TOML, so that a plain
/// search finds them.
bool is_named(const std::string& name, const Overrides& values) {
  return std::any_of(values.begin(), values.end(),
                     [&](const auto& entry) { return entry.second.find(name) != std::string::npos; });
}

void keep_newest(const fs::path& folder, const Overrides& in_force) {
  std::vector<fs::directory_entry> files;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored))
    if (!entry.is_symlink(ignored) && entry.is_regular_file(ignored) &&
        is_upload_name(entry.path().filename().string()))
      files.push_back(entry);
  std::sort(files.begin(), files.end(), [&](const auto& a, const auto& b) {
    return a.last_write_time(ignored) > b.last_write_time(ignored);
  });
  for (std::size_t i = kKept; i < files.size(); ++i) {
    const fs::path& file = files[i].path();
    if (!is_named(file.filename().string(), in_force)) fs::remove(file, ignored);
  }
}

std::string extension_of(const std::string& name) {
  std::string extension = fs::path(name).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  if (std::find(kFormats.begin(), kFormats.end(), extension) == kFormats.end())
    throw std::invalid_argument(
        fmt::format("{}: this is not a mesh that can be read; send an .obj, .3ds, .stl, .ply or .glb",
                    name.empty() ? "a file without a name" : name));
  return extension;
}

/// @returns the import's message with the file's name in place of "mesh in memory"
std::string with_file_name(std::string refusal, const std::string& name) {
  constexpr std::string_view kInMemory = "mesh in memory";
  if (refusal.starts_with(kInMemory)) refusal.replace(0, kInMemory.size(), name);
  return refusal;
}

/// @throws std::runtime_error  the station has ended
Overrides values_now(const ValuesInForce& in_force) {
  std::optional<Overrides> values = in_force();
  if (!values) throw std::runtime_error("the station has ended");
  return std::move(*values);
}

/// @throws std::runtime_error  the station has ended
void require_station(const ValuesInForce& in_force) { static_cast<void>(values_now(in_force)); }

/// @returns the JSON text; replaces invalid UTF-8, which a file's name may hold
std::string as_text(const Json& answer) {
  return answer.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

/// @returns the answer about an imported mesh for the page, without the file
Json answer_about(const std::string& name, const MeshReport& report) {
  Json answer = {{"ok", report.finding(FindingKind::kUnits).found == 0}};
  answer["report"] = Json::parse(mesh_report_json(name, report));
  if (!answer["ok"].get<bool>()) answer["error"] = mesh_verdict(report);
  return answer;
}

/// @returns the imported mesh for the page's picture, see docs/meshes.md; null if it has too many triangles
/// and was not simplified within the limits
Json preview_of(const TriangleMesh& mesh, const std::string& name) {
  TriangleMesh drawn;
  try {
    drawn = mesh::picture_isolated(mesh, kPreviewTriangles, name, kPreviewLimits);
  } catch (const std::exception&) {
    return nullptr;  // the mesh can be used without a picture
  }
  if (drawn.triangles.empty()) return nullptr;
  Json position = Json::array();
  for (const Vec3& v : drawn.vertices)
    for (int k = 0; k < 3; ++k) position.push_back(std::llround(v[k] / kPreviewUnit));
  Json triangle = Json::array();
  for (const Triangle& t : drawn.triangles)
    for (const std::int32_t vertex : t) triangle.push_back(vertex);
  return {{"position_um", std::move(position)}, {"triangle", std::move(triangle)}};
}

Json accepted(const UploadedMesh& mesh, const fs::path& folder, const ValuesInForce& in_force,
              ImportCache& imports) {
  const std::string extension = extension_of(mesh.name);
  const std::string format = extension.substr(1);
  const ImportOptions options{.size = mesh.size_mm * kMm,
                              .unit = metres_per_unit_of(mesh),
                              .triangles = 0,
                              .most_triangles = kMostUploadedTriangles};
  require_station(in_force);
  ImportedMesh imported = mesh::import_isolated(mesh.bytes, format, options, mesh.name, kImportLimits);
  Json answer = answer_about(mesh.name, imported.report);
  if (!answer["ok"].get<bool>()) return answer;
  answer["preview"] = preview_of(imported.mesh, mesh.name);
  require_station(in_force);
  fs::create_directories(folder);
  const fs::path file = fs::absolute(folder) / file_name(mesh, extension);
  write_text_file(file, mesh.bytes);
  imports.keep(mesh.bytes, format, options, std::move(imported));
  keep_newest(folder, values_now(in_force));
  answer["file"] = file.lexically_normal().string();
  return answer;
}

}  // namespace

UploadedMesh upload_of(const std::string& query, std::string bytes) {
  UploadedMesh mesh;
  mesh.bytes = std::move(bytes);
  for (std::size_t begin = 0; begin < query.size();) {
    const std::size_t end = std::min(query.find('&', begin), query.size());
    const std::string_view pair = std::string_view(query).substr(begin, end - begin);
    const std::size_t equals = pair.find('=');
    if (equals != std::string_view::npos) {
      const std::string_view key = pair.substr(0, equals);
      const std::string value = percent_decoded(pair.substr(equals + 1));
      if (key == "name") mesh.name = value;
      if (key == "size_mm") mesh.size_mm = number(value);
      if (key == "unit") mesh.unit = value;
    }
    begin = end + 1;
  }
  static_cast<void>(metres_per_unit_of(mesh));
  if (mesh.bytes.empty())
    throw std::invalid_argument(
        fmt::format("{}: the file is empty; send another", mesh.name.empty() ? "the mesh" : mesh.name));
  return mesh;
}

std::string take_upload(const UploadedMesh& mesh, const fs::path& folder, const ValuesInForce& in_force,
                        ImportCache& imports) {
  Json answer;
  try {
    answer = accepted(mesh, folder, in_force, imports);
  } catch (const std::exception& refused) {
    answer = {{"ok", false}, {"error", with_file_name(refused.what(), mesh.name)}};
  }
  return as_text(answer);
}

// ---- UploadJob ----

std::optional<Overrides> UploadJob::values() const {
  const std::lock_guard lock(mutex_);
  if (session_ == nullptr) return std::nullopt;
  return session_->info()->values;
}

bool UploadJob::done() const {
  const std::lock_guard lock(mutex_);
  return done_;
}

void UploadJob::finish() {
  const std::lock_guard lock(mutex_);
  done_ = true;
  done_changed_.notify_all();
}

void UploadJob::abandon(std::chrono::milliseconds wait) {
  std::unique_lock lock(mutex_);
  session_ = nullptr;
  done_changed_.wait_for(lock, wait, [this] { return done_; });
}

void start_upload(const std::shared_ptr<UploadJob>& job,
                  std::function<WebResponse(const ValuesInForce&)> work,
                  std::function<void(WebResponse)> respond) {
  std::thread([job, work = std::move(work), respond = std::move(respond)]() mutable {
    WebResponse response = work([job] { return job->values(); });
    work = nullptr;  // frees what the work holds before the response is sent
    job->finish();
    respond(std::move(response));
  }).detach();
}

}  // namespace phalanx

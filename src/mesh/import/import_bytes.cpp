// SPDX-License-Identifier: Apache-2.0
#include "mesh/import/import_bytes.h"

#include <cstdint>
#include <cstring>
#include <optional>
#include <stdexcept>
#include <type_traits>
#include <utility>

namespace phalanx::mesh {
namespace {

/// Archive that appends to a text.
class BytesOut {
 public:
  static constexpr bool kReads = false;
  void raw(const void* data, std::size_t count) { out_.append(static_cast<const char*>(data), count); }
  [[noreturn]] static void refuse() { throw std::logic_error("a mesh with values out of range"); }
  [[nodiscard]] std::string take() { return std::move(out_); }

 private:
  std::string out_;
};

/// Archive that takes from a text.
class BytesIn {
 public:
  static constexpr bool kReads = true;
  BytesIn(std::string_view bytes, const std::string& origin) : left_(bytes), origin_(origin) {}
  void raw(void* data, std::size_t count) {
    if (count > left_.size()) refuse();
    if (count > 0) std::memcpy(data, left_.data(), count);
    left_.remove_prefix(count);
  }
  [[noreturn]] void refuse() const {
    throw std::invalid_argument(origin_ + ": the process that read it sent no valid mesh; send it again");
  }
  [[nodiscard]] std::size_t left() const { return left_.size(); }

 private:
  std::string_view left_;
  const std::string& origin_;
};

// Each function below writes or reads, depending on the archive, so that both have the same order.

template <typename Archive, typename Value>
void pass(Archive& archive, Value& value) {
  using Plain = std::remove_const_t<Value>;
  if constexpr (std::is_same_v<Plain, Vec3>) {
    archive.raw(value.data(), 3 * sizeof(double));
  } else if constexpr (std::is_same_v<Plain, bool> || std::is_same_v<Plain, FindingKind>) {
    constexpr std::size_t kValues = std::is_same_v<Plain, bool> ? 2 : kFindingKinds;
    auto byte = static_cast<std::uint8_t>(value);
    archive.raw(&byte, 1);
    if (byte >= kValues) archive.refuse();
    if constexpr (Archive::kReads) value = static_cast<Plain>(byte);
  } else {
    static_assert(std::is_arithmetic_v<Plain>);
    archive.raw(&value, sizeof value);
  }
}

template <typename Archive, typename... Values>
void pass_all(Archive& archive, Values&... values) {
  (pass(archive, values), ...);
}

/// @param most  largest count that is accepted
template <typename Archive, typename Vector>
void pass_size(Archive& archive, Vector& values, std::size_t most) {
  std::size_t count = values.size();
  pass(archive, count);
  if (count > most) archive.refuse();
  if constexpr (Archive::kReads) values.resize(count);
}

/// Passes the values of a mesh, which are plain numbers without gaps.
template <typename Archive, typename Vector>
void pass_numbers(Archive& archive, Vector& values) {
  constexpr std::size_t kEach = sizeof(typename Vector::value_type);
  std::size_t most = values.size();
  if constexpr (Archive::kReads) most = archive.left() / kEach;
  pass_size(archive, values, most);
  archive.raw(values.data(), values.size() * kEach);
}

/// @returns true if the value exists, so that its content follows
template <typename Archive, typename Optional>
bool pass_presence(Archive& archive, Optional& value) {
  bool there = value.has_value();
  pass(archive, there);
  if constexpr (Archive::kReads) {
    if (there) value.emplace();
  }
  return there;
}

template <typename Archive, typename Finding>
void pass_finding(Archive& archive, Finding& f) {
  pass_all(archive, f.kind, f.found, f.repaired, f.size, f.width, f.area);
  if (pass_presence(archive, f.at)) pass(archive, *f.at);
}

template <typename Archive, typename Imported>
void pass_import(Archive& archive, Imported& imported) {
  pass_numbers(archive, imported.mesh.vertices);
  pass_numbers(archive, imported.mesh.triangles);
  auto& r = imported.report;
  pass_all(archive, r.vertices_in_file, r.triangles_in_file, r.vertices, r.triangles, r.extent, r.scale,
           r.origin, r.tolerance, r.moved, r.closed, r.volume, r.solids, r.cavities, r.sheets, r.held_back,
           r.complete);
  pass_size(archive, r.findings, kFindingKinds);
  for (auto& finding : r.findings) pass_finding(archive, finding);
  if (pass_presence(archive, r.decimation)) {
    auto& d = *r.decimation;
    pass_all(archive, d.asked, d.before, d.after, d.was_closed, d.deviation.outward, d.deviation.inward,
             d.deviation.probes);
  }
}

}  // namespace

std::string to_bytes(const ImportedMesh& imported) {
  BytesOut out;
  pass_import(out, imported);
  return out.take();
}

ImportedMesh from_bytes(std::string_view bytes, const std::string& origin) {
  static_assert(sizeof(Vec3) == 3 * sizeof(double) && sizeof(Triangle) == 3 * sizeof(std::int32_t));
  BytesIn in(bytes, origin);
  ImportedMesh imported;
  pass_import(in, imported);
  if (in.left() > 0) in.refuse();
  check_mesh(imported.mesh, origin.c_str());
  return imported;
}

}  // namespace phalanx::mesh

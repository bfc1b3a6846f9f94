// SPDX-License-Identifier: Apache-2.0
#include "mesh/import/index_check.h"

#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>

namespace phalanx::mesh {
namespace {

/// Returns the little-endian value at `at`, if the bytes suffice.
template <typename T>
std::optional<T> value_at(std::string_view bytes, std::size_t at) {
  T value{};
  if (at > bytes.size() || bytes.size() - at < sizeof(T)) return std::nullopt;
  std::memcpy(&value, bytes.data() + at, sizeof(T));
  return value;
}

[[noreturn]] void refuse_index(const std::string& origin, std::size_t face, std::uint64_t index,
                               std::uint64_t count) {
  throw std::invalid_argument(origin + ": face " + std::to_string(face) + " names vertex " +
                              std::to_string(index) + ", but its mesh has " + std::to_string(count) +
                              " (counted from 0); repair the mesh or export it again");
}

/// Calls visit(id, content) for each chunk: 2 bytes of name, 4 bytes of length including these 6.
template <typename Visit>
void for_each_chunk(std::string_view bytes, const Visit& visit) {
  while (bytes.size() >= 6) {
    const std::size_t length = *value_at<std::uint32_t>(bytes, 2);
    if (length < 6 || length > bytes.size()) return;
    visit(*value_at<std::uint16_t>(bytes, 0), bytes.substr(6, length - 6));
    bytes.remove_prefix(length);
  }
}

void check_3ds_mesh(std::string_view mesh, const std::string& origin) {
  std::uint16_t vertices = 0;
  std::string_view faces;
  for_each_chunk(mesh, [&](std::uint16_t id, std::string_view content) {
    if (id == 0x4110) vertices = value_at<std::uint16_t>(content, 0).value_or(0);
    if (id == 0x4120) faces = content;
  });
  const std::size_t count = value_at<std::uint16_t>(faces, 0).value_or(0);
  for (std::size_t face = 0; face < count; ++face) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto index = value_at<std::uint16_t>(faces, 2 + 8 * face + 2 * k);  // 3 corners and a flag
      if (index && *index >= vertices) refuse_index(origin, face, *index, vertices);
    }
  }
}

/// Refuses extensions that a reader must know for the correct surface. Extensions that affect only the
/// appearance are accepted.
void check_extensions(const nlohmann::json& root, const std::string& origin) {
  for (const nlohmann::json& entry : root.value("extensionsRequired", nlohmann::json::array())) {
    const auto name = entry.get<std::string>();
    if (name == "KHR_draco_mesh_compression") continue;
    if (name.starts_with("KHR_materials_") || name.starts_with("KHR_texture_") ||
        name.starts_with("EXT_texture_") || name.starts_with("KHR_lights_"))
      continue;
    throw std::invalid_argument(origin + ": the file requires the glTF extension '" + name.substr(0, 60) +
                                "', which is not read; export it without quantisation or compression");
  }
}

/// Checks that positions are floats and that corners come in threes, each three a triangle.
void check_primitive(const nlohmann::json& root, const nlohmann::json& primitive, const std::string& origin) {
  const auto accessor = [&](const nlohmann::json& index) -> const nlohmann::json& {
    return root.at("accessors").at(index.get<std::size_t>());
  };
  const nlohmann::json& positions = accessor(primitive.at("attributes").at("POSITION"));
  constexpr int kFloat = 5126;
  const int type = positions.at("componentType").get<int>();
  if (type != kFloat)
    throw std::invalid_argument(origin + ": the positions have component type " + std::to_string(type) +
                                ", not 5126 (float); export the mesh without quantisation");
  constexpr int kTriangles = 4;
  if (primitive.value("mode", kTriangles) != kTriangles) return;
  const auto corners = (primitive.contains("indices") ? accessor(primitive.at("indices")) : positions)
                           .at("count")
                           .get<std::uint64_t>();
  if (corners % 3 != 0)
    throw std::invalid_argument(origin + ": a mesh of triangles has " + std::to_string(corners) +
                                " corners, which 3 does not divide; export it again");
}

}  // namespace

void check_3ds_indices(std::string_view bytes, const std::string& origin) {
  constexpr std::uint16_t kMain = 0x4D4D;
  constexpr std::uint16_t kEditor = 0x3D3D;
  constexpr std::uint16_t kObject = 0x4000;
  constexpr std::uint16_t kMesh = 0x4100;
  for_each_chunk(bytes, [&](std::uint16_t main, std::string_view in_main) {
    if (main != kMain) return;
    for_each_chunk(in_main, [&](std::uint16_t editor, std::string_view in_editor) {
      if (editor != kEditor) return;
      for_each_chunk(in_editor, [&](std::uint16_t object, std::string_view in_object) {
        const std::size_t name = in_object.find('\0');
        if (object != kObject || name == std::string_view::npos) return;
        for_each_chunk(in_object.substr(name + 1), [&](std::uint16_t id, std::string_view content) {
          if (id == kMesh) check_3ds_mesh(content, origin);
        });
      });
    });
  });
}

void check_glb_indices(std::string_view bytes, const std::string& origin) {
  using Json = nlohmann::json;
  if (value_at<std::uint32_t>(bytes, 4) == 1U)
    throw std::invalid_argument(origin + ": this is glTF 1.0; export it as glTF 2.0 (.glb)");
  const auto json_length = value_at<std::uint32_t>(bytes, 12);
  if (!json_length || bytes.size() < 20 || *json_length > bytes.size() - 20) return;
  const Json root = Json::parse(bytes.substr(20, *json_length), nullptr, false);
  if (!root.is_object()) return;
  check_extensions(root, origin);
  // The BIN chunk follows the JSON chunk; 8 bytes of length and type precede each.
  const std::size_t bin = 20 + std::size_t{*json_length} + 8;
  const std::string_view buffer = bin < bytes.size() ? bytes.substr(bin) : std::string_view();
  const auto element = [&](const char* list, const Json& index) -> const Json& {
    return root.at(list).at(index.get<std::size_t>());
  };
  for (const Json& mesh : root.value("meshes", Json::array())) {
    for (const Json& primitive : mesh.value("primitives", Json::array())) {
      if (!primitive.at("attributes").contains("POSITION")) continue;
      check_primitive(root, primitive, origin);
      if (!primitive.contains("indices")) continue;
      const auto vertices =
          element("accessors", primitive.at("attributes").at("POSITION")).at("count").get<std::uint64_t>();
      const Json& accessor = element("accessors", primitive.at("indices"));
      if (!accessor.contains("bufferView")) continue;  // all zeros
      const Json& view = element("bufferViews", accessor.at("bufferView"));
      const std::size_t start =
          view.value("byteOffset", std::size_t{0}) + accessor.value("byteOffset", std::size_t{0});
      const int type = accessor.at("componentType").get<int>();
      const std::size_t width = type == 5121 ? 1 : type == 5123 ? 2 : 4;
      const std::size_t count = std::min(accessor.at("count").get<std::size_t>(), buffer.size() / width);
      for (std::size_t i = 0; i < count; ++i) {
        const std::size_t at = start + i * width;
        const auto index = width == 1   ? std::optional<std::uint32_t>(value_at<std::uint8_t>(buffer, at))
                           : width == 2 ? std::optional<std::uint32_t>(value_at<std::uint16_t>(buffer, at))
                                        : value_at<std::uint32_t>(buffer, at);
        if (index && *index >= vertices) refuse_index(origin, i / 3, *index, vertices);
      }
    }
  }
}

}  // namespace phalanx::mesh

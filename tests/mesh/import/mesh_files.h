// SPDX-License-Identifier: Apache-2.0
// Small writers of the formats that are imported, by the formats' descriptions, for the tests only.
// Little-endian hosts.
#pragma once

#include <array>
#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

#include "phalanx/mesh/triangle_mesh.h"

namespace phalanx::test {

template <typename T>
void put(std::string& out, T value) {
  const auto* bytes = reinterpret_cast<const char*>(&value);
  out.append(bytes, sizeof value);
}

inline void put(std::string& out, const Vec3& v) {
  for (const double x : v) put(out, static_cast<float>(x));
}

inline std::string line(const char* format, double x, double y, double z) {
  std::array<char, 128> text{};
  std::snprintf(text.data(), text.size(), format, x, y, z);
  return text.data();
}

inline const Vec3& corner(const TriangleMesh& mesh, std::int32_t i) {
  return mesh.vertices[static_cast<std::size_t>(i)];
}

inline std::string to_obj(const TriangleMesh& mesh) {
  std::string out;
  for (const Vec3& v : mesh.vertices) out += line("v %.9g %.9g %.9g\n", v.x(), v.y(), v.z());
  for (const Triangle& t : mesh.triangles) {
    out += "f";
    for (const std::int32_t i : t) out.append(" ").append(std::to_string(i + 1));
    out += "\n";
  }
  return out;
}

inline std::string to_stl_text(const TriangleMesh& mesh) {
  std::string out = "solid test\n";
  for (const Triangle& t : mesh.triangles) {
    out += "facet normal 0 0 0\nouter loop\n";
    for (const std::int32_t i : t)
      out += line("vertex %.9g %.9g %.9g\n", corner(mesh, i).x(), corner(mesh, i).y(), corner(mesh, i).z());
    out += "endloop\nendfacet\n";
  }
  return out + "endsolid test\n";
}

inline std::string to_stl_binary(const TriangleMesh& mesh) {
  std::string out(80, ' ');
  put(out, static_cast<std::uint32_t>(mesh.triangles.size()));
  for (const Triangle& t : mesh.triangles) {
    put(out, Vec3(Vec3::Zero()));
    for (const std::int32_t i : t) put(out, corner(mesh, i));
    put(out, std::uint16_t{0});
  }
  return out;
}

inline std::string ply_header(const char* format, std::size_t vertices, std::size_t faces) {
  return std::string("ply\nformat ") + format + " 1.0\nelement vertex " + std::to_string(vertices) +
         "\nproperty float x\nproperty float y\nproperty float z\nelement face " + std::to_string(faces) +
         "\nproperty list uchar int vertex_indices\nend_header\n";
}

inline std::string to_ply_text(const TriangleMesh& mesh) {
  std::string out = ply_header("ascii", mesh.vertices.size(), mesh.triangles.size());
  for (const Vec3& v : mesh.vertices) out += line("%.9g %.9g %.9g\n", v.x(), v.y(), v.z());
  for (const Triangle& t : mesh.triangles)
    out.append("3 ")
        .append(std::to_string(t[0]))
        .append(" ")
        .append(std::to_string(t[1]))
        .append(" ")
        .append(std::to_string(t[2]))
        .append("\n");
  return out;
}

inline std::string to_ply_binary(const TriangleMesh& mesh) {
  std::string out = ply_header("binary_little_endian", mesh.vertices.size(), mesh.triangles.size());
  for (const Vec3& v : mesh.vertices) put(out, v);
  for (const Triangle& t : mesh.triangles) {
    put(out, std::uint8_t{3});
    for (const std::int32_t i : t) put(out, i);
  }
  return out;
}

inline std::string chunk_3ds(std::uint16_t id, const std::string& content) {
  std::string out;
  put(out, id);
  put(out, static_cast<std::uint32_t>(content.size() + 6));
  return out + content;
}

/// Main chunk 4D4D, editor 3D3D, object 4000, triangle mesh 4100 with vertices 4110 and faces 4120.
inline std::string to_3ds(const TriangleMesh& mesh) {
  std::string vertices;
  put(vertices, static_cast<std::uint16_t>(mesh.vertices.size()));
  for (const Vec3& v : mesh.vertices) put(vertices, v);
  std::string faces;
  put(faces, static_cast<std::uint16_t>(mesh.triangles.size()));
  for (const Triangle& t : mesh.triangles) {
    for (const std::int32_t i : t) put(faces, static_cast<std::uint16_t>(i));
    put(faces, std::uint16_t{7});
  }
  const std::string object =
      std::string("test") + '\0' + chunk_3ds(0x4100, chunk_3ds(0x4110, vertices) + chunk_3ds(0x4120, faces));
  return chunk_3ds(0x4D4D, chunk_3ds(0x3D3D, chunk_3ds(0x4000, object)));
}

/// glTF 2.0 binary container: positions and indices in one buffer; `nodes` is the JSON of the scene's nodes,
/// 0 being the root.
inline std::string to_glb(const TriangleMesh& mesh, const std::string& nodes = R"({"mesh":0})") {
  std::string buffer;
  for (const Vec3& v : mesh.vertices) put(buffer, v);
  const std::size_t positions = buffer.size();
  for (const Triangle& t : mesh.triangles)
    for (const std::int32_t i : t) put(buffer, static_cast<std::uint32_t>(i));
  const Bounds b = bounds(mesh);
  const auto number = [](std::size_t n) { return std::to_string(n); };
  std::string json =
      R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[)" + nodes +
      R"(],"meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],"buffers":[{"byteLength":)" +
      number(buffer.size()) + R"(}],"bufferViews":[{"buffer":0,"byteLength":)" + number(positions) +
      R"(},{"buffer":0,"byteOffset":)" + number(positions) + R"(,"byteLength":)" +
      number(buffer.size() - positions) +
      R"(}],"accessors":[{"bufferView":0,"componentType":5126,"type":"VEC3","count":)" +
      number(mesh.vertices.size()) + line(R"(,"min":[%g,%g,%g])", b.min.x(), b.min.y(), b.min.z()) +
      line(R"(,"max":[%g,%g,%g]})", b.max.x(), b.max.y(), b.max.z()) +
      R"(,{"bufferView":1,"componentType":5125,"type":"SCALAR","count":)" +
      number(3 * mesh.triangles.size()) + "}]}";
  while (json.size() % 4 != 0) json += ' ';
  std::string out = "glTF";
  put(out, std::uint32_t{2});
  put(out, static_cast<std::uint32_t>(12 + 8 + json.size() + 8 + buffer.size()));
  put(out, static_cast<std::uint32_t>(json.size()));
  out += "JSON" + json;
  put(out, static_cast<std::uint32_t>(buffer.size()));
  return out + std::string("BIN\0", 4) + buffer;
}

}  // namespace phalanx::test

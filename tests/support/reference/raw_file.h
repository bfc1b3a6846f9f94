// SPDX-License-Identifier: Apache-2.0
// A second, plain reader of OBJ, STL and PLY files: the triangles as the file has them, polygons cut into
// fans. Nothing is welded, dropped or turned.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "phalanx/core/math.h"

namespace phalanx::test {

using RawTriangle = std::array<Vec3, 3>;

namespace raw {

/// Adds polygons of `points` to `out`.
struct Fan {
  std::vector<Vec3> points;
  std::vector<RawTriangle> out;

  /// @throws std::runtime_error for a hollow polygon, which its fan does not cover
  void add(const std::vector<long>& index) {
    Vec3 area = Vec3::Zero();
    std::vector<RawTriangle> pieces;
    for (std::size_t k = 2; k < index.size(); ++k) {
      pieces.push_back({points.at(static_cast<std::size_t>(index[0])),
                        points.at(static_cast<std::size_t>(index[k - 1])),
                        points.at(static_cast<std::size_t>(index[k]))});
      area += cross(pieces.back());
    }
    for (const RawTriangle& t : pieces) {
      if (cross(t).dot(area) < -1e-6 * area.squaredNorm()) throw std::runtime_error("a hollow polygon");
      out.push_back(t);
    }
  }
  static Vec3 cross(const RawTriangle& t) { return (t[1] - t[0]).cross(t[2] - t[0]); }
};

/// Takes numbers off the front of a binary file.
struct Bytes {
  const std::string& text;
  std::size_t at;
  template <class T>
  T take() {
    T value;
    if (at + sizeof value > text.size()) throw std::runtime_error("the file ends early");
    std::memcpy(&value, text.data() + at, sizeof value);
    at += sizeof value;
    return value;
  }
  double take(const std::string& type) {
    if (type == "float" || type == "float32") return static_cast<double>(take<float>());
    if (type == "double" || type == "float64") return take<double>();
    if (type == "uchar" || type == "uint8") return take<std::uint8_t>();
    if (type == "char" || type == "int8") return take<std::int8_t>();
    if (type == "ushort" || type == "uint16") return take<std::uint16_t>();
    if (type == "short" || type == "int16") return take<std::int16_t>();
    if (type == "uint" || type == "uint32") return take<std::uint32_t>();
    if (type == "int" || type == "int32") return take<std::int32_t>();
    throw std::runtime_error("unknown type " + type);
  }
};

inline std::vector<RawTriangle> ply(const std::string& text) {
  struct Property {
    std::string count;  // its type; empty if the property is no list
    std::string type;
    std::string name;
  };
  struct Element {
    std::string name;
    std::size_t count;
    std::vector<Property> properties;
  };
  std::vector<Element> elements;
  std::istringstream in(text);
  std::string format;
  std::string line;
  while (std::getline(in, line) && line.rfind("end_header", 0) != 0) {
    std::istringstream words(line);
    std::string word;
    words >> word;
    if (word == "format") words >> format;
    if (word == "element") {
      Element element;
      words >> element.name >> element.count;
      elements.push_back(element);
    }
    if (word != "property") continue;
    Property property;
    words >> property.type;
    if (property.type == "list") words >> property.count >> property.type;
    words >> property.name;
    elements.at(elements.size() - 1).properties.push_back(property);
  }
  if (format != "ascii" && format != "binary_little_endian") throw std::runtime_error("a PLY " + format);
  Bytes bytes{text, static_cast<std::size_t>(in.tellg())};
  const auto number = [&](const std::string& type) {
    double value = 0.0;
    if (format == "ascii") {
      in >> value;
    } else {
      value = bytes.take(type);
    }
    return value;
  };
  Fan fan;
  for (const Element& element : elements) {
    for (std::size_t i = 0; i < element.count; ++i) {
      Vec3 point = Vec3::Zero();
      for (const Property& p : element.properties) {
        if (p.count.empty()) {
          const double value = number(p.type);
          if (p.name == "x") point.x() = value;
          if (p.name == "y") point.y() = value;
          if (p.name == "z") point.z() = value;
          continue;
        }
        std::vector<long> index(static_cast<std::size_t>(number(p.count)));
        for (long& v : index) v = static_cast<long>(number(p.type));
        if (element.name == "face") fan.add(index);
      }
      if (element.name == "vertex") fan.points.push_back(point);
    }
  }
  if (!in) throw std::runtime_error("the file ends early");
  return fan.out;
}

inline std::vector<RawTriangle> stl(const std::string& text) {
  std::vector<RawTriangle> out;
  constexpr std::size_t kHead = 80;
  if (text.size() >= kHead + 4) {
    Bytes bytes{text, kHead};
    const std::size_t count = bytes.take<std::uint32_t>();
    if (text.size() == kHead + 4 + 50 * count) {
      for (std::size_t i = 0; i < count; ++i) {
        bytes.at = kHead + 4 + 50 * i + 12;  // behind the facet's normal
        RawTriangle t;
        for (Vec3& v : t)
          for (int k = 0; k < 3; ++k) v[k] = static_cast<double>(bytes.take<float>());
        out.push_back(t);
      }
      return out;
    }
  }
  std::istringstream in(text);
  std::size_t corner = 0;
  RawTriangle t;
  for (std::string word; in >> word;) {
    if (word != "vertex") continue;
    in >> t[corner].x() >> t[corner].y() >> t[corner].z();
    corner = (corner + 1) % 3;
    if (corner == 0) out.push_back(t);
  }
  return out;
}

inline std::vector<RawTriangle> obj(const std::string& text) {
  Fan fan;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) {
    while (!line.empty() && (line.back() == '\\' || line.ends_with("\\\r"))) {
      line.resize(line.rfind('\\'));
      std::string next;
      if (!std::getline(in, next)) break;
      line += " " + next;
    }
    std::istringstream words(line);
    std::string word;
    words >> word;
    if (word == "v") {
      Vec3 v;
      words >> v.x() >> v.y() >> v.z();
      fan.points.push_back(v);
    } else if (word == "f") {
      std::vector<long> index;
      while (words >> word) {
        const long i = std::stol(word);  // up to the first slash
        index.push_back(i > 0 ? i - 1 : static_cast<long>(fan.points.size()) + i);
      }
      fan.add(index);
    }
  }
  return fan.out;
}

}  // namespace raw

/// The faces of an OBJ, STL or PLY file.
/// @throws std::runtime_error where this reader does not know how
inline std::vector<RawTriangle> read_raw(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw std::runtime_error("cannot read " + file.string());
  const std::string text((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  std::string kind = file.extension().string();
  for (char& c : kind) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  if (kind == ".ply") return raw::ply(text);
  if (kind == ".stl") return raw::stl(text);
  if (kind == ".obj") return raw::obj(text);
  throw std::runtime_error("no second reader for " + kind);
}

}  // namespace phalanx::test

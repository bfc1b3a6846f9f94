// SPDX-License-Identifier: Apache-2.0
// Where the hand's segment meshes were cut apart, and how far the cuts open.
//
// The gap criterion. Two neighbours were cut apart along a rim; the file of the one farther from the palm
// names its edges ("# rim 3/17 4/18, ...": vertices of its own mesh / of its neighbour's). At a pose the gap
// at a point of the rim (the ends and the middles of its edges) is the distance of that point of the one
// segment from the other segment's solid, or the other way round, whichever is less; 0 inside. So no crack
// opens: all along the cut the skin of the one ends in or at the other.
#pragma once

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "phalanx/hand/hand_model.h"

namespace phalanx::test {

inline constexpr double kFar = std::numeric_limits<double>::infinity();

inline int neighbour_of(int segment) { return segment % kSegmentsPerDigit == 0 ? kPalm : segment - 1; }

inline std::string generic_mesh_file(int segment) {
  return PHALANX_SOURCE_DIR "/assets/hands/generic/" + std::string(segment_name(segment)) + ".obj";
}

/// The file's mesh [m], its vertices as the file numbers them.
inline TriangleMesh read_generic_mesh(int segment) {
  TriangleMesh mesh;
  std::ifstream in(generic_mesh_file(segment));
  for (std::string line; std::getline(in, line);) {
    std::istringstream words(line);
    std::string word;
    words >> word;
    if (word == "v") {
      Vec3 v;
      words >> v.x() >> v.y() >> v.z();
      mesh.vertices.push_back(1e-3 * v);
    } else if (word == "f") {
      Triangle t{};
      for (auto& corner : t) {
        words >> corner;
        --corner;
      }
      mesh.triangles.push_back(t);
    }
  }
  return mesh;
}

/// Points of a rim, in the frames of the segment itself and of its neighbour [m], in the same order.
struct Rim {
  std::vector<Vec3> own;
  std::vector<Vec3> neighbours;
};

/// @param own, neighbours  vertices of the two meshes, numbered as the files do
inline Rim read_rim(int segment, const std::vector<Vec3>& own, const std::vector<Vec3>& neighbours) {
  Rim rim;
  std::ifstream in(generic_mesh_file(segment));
  for (std::string line; std::getline(in, line);) {
    if (!line.starts_with("# rim ")) continue;
    std::istringstream numbers(line.substr(6));
    std::size_t a = 0, a_there = 0, b = 0, b_there = 0;
    char slash = 0;
    while (numbers >> a >> slash >> a_there >> b >> slash >> b_there) {
      const auto add = [](std::vector<Vec3>& points, const Vec3& p, const Vec3& q) {
        points.insert(points.end(), {p, q, 0.5 * (p + q)});
      };
      add(rim.own, own.at(a - 1), own.at(b - 1));
      add(rim.neighbours, neighbours.at(a_there - 1), neighbours.at(b_there - 1));
      numbers.ignore(1);  // the comma
    }
  }
  return rim;
}

inline double distance_to_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 n = (b - a).cross(c - a);
  const auto left = [&](const Vec3& u, const Vec3& v) { return (v - u).cross(p - u).dot(n) >= 0.0; };
  if (n.squaredNorm() > 0.0 && left(a, b) && left(b, c) && left(c, a))
    return std::abs((p - a).dot(n)) / n.norm();
  const auto to_edge = [&](const Vec3& u, const Vec3& v) {
    const Vec3 e = v - u;
    const double t = e.squaredNorm() > 0.0 ? std::clamp((p - u).dot(e) / e.squaredNorm(), 0.0, 1.0) : 0.0;
    return (p - u - t * e).norm();
  };
  return std::min({to_edge(a, b), to_edge(b, c), to_edge(c, a)});
}

/// 0 inside the closed mesh (winding number by solid angles, van Oosterom and Strackee 1983), else the
/// distance from its surface.
inline double distance_to_solid(const Vec3& p, const TriangleMesh& mesh) {
  double angle = 0.0;
  double nearest = kFar;
  for (const Triangle& t : mesh.triangles) {
    const auto corner = [&](std::size_t k) -> const Vec3& {
      return mesh.vertices[static_cast<std::size_t>(t[k])];
    };
    nearest = std::min(nearest, distance_to_triangle(p, corner(0), corner(1), corner(2)));
    const Vec3 x = corner(0) - p;
    const Vec3 y = corner(1) - p;
    const Vec3 z = corner(2) - p;
    const double lx = x.norm();
    const double ly = y.norm();
    const double lz = z.norm();
    angle +=
        2.0 * std::atan2(x.dot(y.cross(z)), lx * ly * lz + x.dot(y) * lz + y.dot(z) * lx + z.dot(x) * ly);
  }
  return std::abs(angle) > 2.0 * std::numbers::pi ? 0.0 : nearest;
}

struct Gap {
  double width = 0.0;      ///< [m]
  Vec3 at = Vec3::Zero();  ///< the rim's point, in the segment's frame [m]
};

/// The widest gap along a rim.
/// @param X_NS   pose of the segment in its neighbour's frame
/// @param reach  only points nearer than this to the segment's joint count [m]
inline Gap widest_gap(const Rim& rim, const TriangleMesh& segment, const TriangleMesh& neighbour,
                      const Pose& X_NS, double reach = kFar) {
  Gap widest;
  const Pose X_SN = X_NS.inverse();
  for (std::size_t i = 0; i < rim.own.size(); ++i) {
    if (!(rim.own[i].norm() < reach)) continue;
    double width = distance_to_solid(X_SN * rim.neighbours[i], segment);
    if (width > widest.width) width = std::min(width, distance_to_solid(X_NS * rim.own[i], neighbour));
    if (width > widest.width) widest = {width, rim.own[i]};
  }
  return widest;
}

}  // namespace phalanx::test

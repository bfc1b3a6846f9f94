// SPDX-License-Identifier: Apache-2.0
#include "contact/normal_fan.h"

#include <algorithm>

#include "contact/feature_pairs.h"
#include "phalanx/contact/object_tree.h"
#include "phalanx/contact/triangle_distance.h"
#include "phalanx/core/constants.h"

namespace phalanx {
namespace {

Vec3 unit_or(const Vec3& v, const Vec3& fallback) noexcept {
  const double length = v.norm();
  return length > 1e-9 ? Vec3(v / length) : fallback;
}

}  // namespace

void TiedTriangles::add(int position) noexcept {
  if (count_ == kMost || std::find(begin(), end(), position) != end()) return;
  position_[count_++] = position;
}

void MeanDirection::add(const TriangleDistance& closest, const Vec3& direction, double weight) noexcept {
  for (std::size_t i = 0; i < count_; ++i) {
    Place& place = place_[i];
    if ((place.nearest.on_a - closest.on_a).squaredNorm() > radius_squared_ ||
        (place.nearest.on_b - closest.on_b).squaredNorm() > radius_squared_)
      continue;
    place.weight += weight;
    if (closest.squared < place.nearest.squared) {
      place.nearest = closest;
      place.direction = direction;
    }
    return;
  }
  if (count_ < kMost) {
    place_[count_++] = {closest, direction, weight};
  } else {
    others_ += weight * direction;
    others_weight_ += weight;
  }
}

Vec3 MeanDirection::unit() const noexcept {
  Vec3 sum = others_;
  double weight = others_weight_;
  std::size_t nearest = 0;
  for (std::size_t i = 0; i < count_; ++i) {
    sum += place_[i].weight * place_[i].direction;
    weight += place_[i].weight;
    if (place_[i].nearest.squared < place_[nearest].nearest.squared) nearest = i;
  }
  const double length = sum.norm();
  return length > 0.1 * weight ? Vec3(sum / length) : place_[nearest].direction;
}

void NormalFan::add(const Vec3& unit) noexcept {
  for (std::size_t i = 0; i < count_; ++i) {
    if ((unit_[i] - unit).squaredNorm() < 1e-12) return;
  }
  if (count_ < kMost) unit_[count_++] = unit;
}

bool NormalFan::is_nearest_vector(std::size_t i, const Vec3& n) const noexcept {
  const double along = unit_[i].dot(n);
  if (!(along > 0.0)) return false;
  const Vec3 across = n - along * unit_[i];
  const double size = across.norm();
  if (!(size > 1e-9)) return false;  // n may lie in the cone
  for (std::size_t j = 0; j < count_; ++j)
    if (j != i && !(across.dot(unit_[j]) < -1e-15 * size)) return false;
  return true;
}

Vec3 NormalFan::nearest(const Vec3& n) const noexcept {
  if (count_ == 0) return n;
  std::size_t nearest = 0;
  for (std::size_t i = 1; i < count_; ++i)
    if (unit_[i].dot(n) > unit_[nearest].dot(n)) nearest = i;
  Vec3 best = unit_[nearest];
  if (is_nearest_vector(nearest, n)) return best;
  const auto offer = [&](const Vec3& v) {
    if (v.dot(n) > best.dot(n)) best = v;
  };
  for (std::size_t i = 0; i < count_; ++i) {
    for (std::size_t j = i + 1; j < count_; ++j) {
      // n's projection a u + b v on the plane of two of them, if it lies between them
      const Vec3& u = unit_[i];
      const Vec3& v = unit_[j];
      const double uv = u.dot(v);
      const double sine_squared = 1.0 - uv * uv;
      if (!(sine_squared > 1e-12)) continue;
      const double a = (n.dot(u) - uv * n.dot(v)) / sine_squared;
      const double b = (n.dot(v) - uv * n.dot(u)) / sine_squared;
      if (a >= 0.0 && b >= 0.0) offer(unit_or(a * u + b * v, best));
      const Vec3 across = u.cross(v);
      for (std::size_t k = j + 1; k < count_; ++k) {
        const Vec3& w = unit_[k];
        const double volume = across.dot(w);
        if (!(volume * volume > 1e-18)) continue;
        const bool inside = across.dot(n) / volume >= 0.0 && v.cross(w).dot(n) / volume >= 0.0 &&
                            w.cross(u).dot(n) / volume >= 0.0;
        if (inside) return n;
      }
    }
  }
  return best;
}

Vec3 normal_at_contact(const ObjectModel& object, const TiedTriangles& tied, const Vec3& contact,
                       const Vec3& n_c) noexcept {
  struct Place {
    Vec3 weight;
    Vec3 foot;
    double apart;  // distance of the foot from the contact [m]
  };
  const ObjectTree& tree = object.tree();
  const auto place_on = [&](int position) {
    const Corners& t = tree.corners(position);
    const Vec3 w = barycentric(t, contact);
    const Vec3 foot = w[0] * t[0] + w[1] * t[1] + w[2] * t[2];
    return Place{w, foot, (foot - contact).norm()};
  };
  const auto normal_on = [&](int position, const Place& place) {
    const Vec3 normal = object.normal_at(tree.source(position), place.weight);
    return normal.dot(n_c) < 0.0 ? Vec3(-normal) : normal;  // a sheet is met from both sides
  };
  if (tied.begin() == tied.end()) return n_c;
  int nearest = *tied.begin();
  Place main_place = place_on(nearest);
  for (const int position : tied) {
    const Place place = place_on(position);
    if (place.apart >= main_place.apart) continue;
    nearest = position;
    main_place = place;
  }
  Vec3 main = normal_on(nearest, main_place);
  if (n_c.isZero(0.0)) return main;  // they touch: no direction separates them

  NormalFan fan;
  fan.add(main);
  const auto add = [&](const Vec3& v, double share) {
    if (share > 0.0) fan.add(unit_or(main + share * (v - main), main));
  };
  for (const int position : tied) {
    // The mean of distant places may lie between them. Then all of them are about equally near.
    const Place place = place_on(position);
    const double share = clamp01(1.0 - (place.apart - main_place.apart) / (kEdgeBand + main_place.apart));
    add(normal_on(position, place), share);

    const int open = object.open_edges(tree.source(position));
    const Corners& corners = tree.corners(position);
    for (std::size_t k = 0; k < 3; ++k) {
      if ((open >> k & 1) == 0) continue;
      const Vec3 edge = corners[(k + 1) % 3] - corners[k];
      const Vec3 to_opposite = corners[(k + 2) % 3] - corners[k];
      const double squared = edge.squaredNorm();
      if (!(squared > 0.0)) continue;
      const Vec3 inward = to_opposite - edge * (to_opposite.dot(edge) / squared);
      const double height = inward.norm();
      if (!(height * height > 1e-12 * squared)) continue;  // a sliver: its neighbours suffice
      const double depth = inward.dot(place.foot - corners[k]) / height;
      add(-inward / height, share * clamp01(1.0 - depth / kEdgeBand));
    }
  }
  return fan.nearest(n_c);
}

Vec3 within_cone(const Vec3& n, const Vec3& n_c) noexcept {
  constexpr double kSin30Deg = 0.5;
  const double along = n.dot(n_c);
  if (along >= kCos30Deg) return n;
  const Vec3 across = n - along * n_c;
  const double length = across.norm();
  if (!(length > 1e-12)) return n_c;
  return kCos30Deg * n_c + (kSin30Deg / length) * across;
}

}  // namespace phalanx

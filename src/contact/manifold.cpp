// SPDX-License-Identifier: Apache-2.0
#include "contact/manifold.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "contact/feature_pairs.h"
#include "contact/normal_fan.h"
#include "phalanx/core/index.h"

namespace phalanx {
namespace {

constexpr double kMerge = 1e-3;    // points nearer than this on the segment belong to one place [m]
constexpr double kTie = 1e-6;      // a point on a face is this near to it [m]
constexpr double kSame = 10e-6;    // points nearer than this are one [m]
constexpr double kEqual = 0.1e-6;  // places whose distances differ by less are equally near [m]
constexpr double kTier = 5e-6;     // places whose distances differ by less are about as near [m]
constexpr int kMostCandidates = 32;
constexpr int kMostTests = 64;                       // of pairs against their neighbours
constexpr double kCosInside = 1.0 - 5e-10;           // 0.002 degrees, of a direction beside its fan
constexpr double kCosBetween = 0.99619469809174555;  // 5 degrees, between directions of one place

/// Adds the face normal of a triangle, on the side of `direction`. A sliver's normal is rounding noise; its
/// neighbours' suffice.
void add_face(const Corners& t, const Vec3& direction, NormalFan& fan) noexcept {
  const Vec3 u = t[1] - t[0];
  const Vec3 v = t[2] - t[0];
  const Vec3 normal = u.cross(v);
  const double size = normal.norm();
  if (!(size > 1e-9 * (u.squaredNorm() + v.squaredNorm()))) return;
  fan.add((normal.dot(direction) < 0.0 ? -1.0 / size : 1.0 / size) * normal);
}

/// Returns the point of the triangle that is nearest to a point.
Vec3 closest_in(const Corners& t, const Vec3& point) noexcept {
  const Vec3 w = barycentric(t, point);
  return w[0] * t[0] + w[1] * t[1] + w[2] * t[2];
}

/// @returns true if the point is outside the triangle's box by more than `tolerance` [m]
bool is_outside_box(const Corners& t, const Vec3& point, double tolerance) noexcept {
  const Vec3 lowest = t[0].cwiseMin(t[1]).cwiseMin(t[2]);
  const Vec3 highest = t[0].cwiseMax(t[1]).cwiseMax(t[2]);
  return ((lowest - point).array() > tolerance).any() || ((point - highest).array() > tolerance).any();
}

/// @returns true if the triangle contains the point, to `tolerance` [m]
bool contains(const Corners& t, const Vec3& point, double tolerance = kTie) noexcept {
  if (is_outside_box(t, point, tolerance)) return false;
  return (closest_in(t, point) - point).squaredNorm() <= tolerance * tolerance;
}

/// Returns the place of a pair at two of its points.
ContactPlace place_of(const NearPairs::Pair& pair, const Vec3& on_segment, const Vec3& on_object) noexcept {
  const Vec3 apart = on_segment - on_object;
  const double gap = apart.norm();
  return {.triangle = pair.triangle,
          .slot = pair.slot,
          .gap = gap,
          .on_segment = on_segment,
          .on_object = on_object,
          .direction = gap > 0.0 ? Vec3(apart / gap) : Vec3(Vec3::Zero())};
}

/// @returns true if the place is nearer than its neighbours on both meshes: its direction lies between the normals
/// of the faces that meet at its point, on the object and on the segment. The faces that meet at a point are as
/// near to the other triangle as the place, and so are among the near pairs.
bool is_nearest(const PlacedSegment& segment, const ObjectTree& object, const NearPairs& near,
                const ContactPlace& place) noexcept {
  const double reach = place.gap + kTie;
  const double limit = reach * reach;
  const auto holds = [](const NormalFan& fan, const Vec3& n) { return fan.nearest(n).dot(n) >= kCosInside; };
  NormalFan on_object;
  for (std::size_t i = 0; i < near.count(); ++i) {
    const NearPairs::Pair& other = near[i];
    if (other.triangle != place.triangle || other.closest.squared > limit) continue;
    const Corners t = object.corners(other.slot);
    if (contains(t, place.on_object)) add_face(t, place.direction, on_object);
  }
  if (!holds(on_object, place.direction)) return false;
  NormalFan on_segment;
  const Vec3 in_segment = segment.X_WS.R.transpose() * (place.on_segment - segment.X_WS.p);
  for (std::size_t i = 0; i < near.count(); ++i) {
    const NearPairs::Pair& other = near[i];
    if (other.slot != place.slot || other.closest.squared > limit) continue;
    Corners t = segment.tree.corners(other.triangle);
    if (is_outside_box(t, in_segment, 2.0 * kTie)) continue;  // twice, for the rounding of the frame's change
    for (Vec3& x : t) x = segment.X_WS * x;
    if (contains(t, place.on_segment)) add_face(t, -place.direction, on_segment);
  }
  return holds(on_segment, -place.direction);
}

bool belongs_to(const ContactPlace& chosen, const ContactPlace& place) noexcept {
  return place.direction.dot(chosen.direction) >= kCosBetween &&
         (place.on_segment - chosen.on_segment).squaredNorm() <= kMerge * kMerge;
}

/// Places that a manifold is chosen from. The first is the nearest.
struct Candidates {
  int count = 0;
  std::array<ContactPlace, kMostCandidates> place;

  /// @returns true if the place is one of them, seen by another pair
  [[nodiscard]] bool has(const ContactPlace& other) const noexcept {
    return std::any_of(place.begin(), place.begin() + count, [&](const ContactPlace& at) {
      return other.direction.dot(at.direction) >= kCosBetween &&
             (other.on_segment - at.on_segment).squaredNorm() <= kSame * kSame;
    });
  }
  /// Adds a place, unless there are too many.
  void add(const ContactPlace& other) noexcept {
    if (count < kMostCandidates) place[idx(count++)] = other;
  }
};

/// @returns true if the place is as near as the nearest one and faces the same way
bool is_tied(const ContactPlace& nearest, const ContactPlace& place) noexcept {
  return place.gap - nearest.gap <= kTier && place.direction.dot(nearest.direction) >= kCosBetween;
}

/// Adds a place unless it belongs to one that is chosen.
void choose(const ContactPlace& place, int most, Manifold& out) noexcept {
  const auto end = out.place.begin() + out.count;
  const bool belongs = std::any_of(out.place.begin(), end,
                                   [&](const ContactPlace& chosen) { return belongs_to(chosen, place); });
  if (!belongs && out.count < most) out.place[idx(out.count++)] = place;
}

/// Points farthest along four directions.
class Ends {
 public:
  explicit Ends(const ContactPlace& nearest) noexcept {
    // Not along the axes: there two corners of a box are equally far.
    constexpr double kCos = 0.82533561490967833;  // of 0.6 rad
    constexpr double kSin = 0.56464247339503537;
    const Vec3 u = nearest.direction.unitOrthogonal();
    const Vec3 v = nearest.direction.cross(u);
    const Vec3 a = kCos * u + kSin * v;
    const Vec3 b = kCos * v - kSin * u;
    along_ = {a, Vec3(-a), b, Vec3(-b)};
    farthest_.fill(nearest);
    for (std::size_t e = 0; e < along_.size(); ++e) value_[e] = along_[e].dot(nearest.on_segment);
  }
  /// @returns true if the place is farther along one of the directions
  [[nodiscard]] bool is_farther(const ContactPlace& place) const noexcept {
    for (std::size_t e = 0; e < along_.size(); ++e)
      if (along_[e].dot(place.on_segment) > value_[e]) return true;
    return false;
  }
  void add(const ContactPlace& place) noexcept {
    for (std::size_t e = 0; e < along_.size(); ++e) {
      const double value = along_[e].dot(place.on_segment);
      if (value <= value_[e]) continue;
      value_[e] = value;
      farthest_[e] = place;
    }
  }
  /// @returns true if a point in both triangles may be farther
  [[nodiscard]] bool may_be_farther(const Corners& t, const Corners& other) const noexcept {
    for (std::size_t e = 0; e < along_.size(); ++e) {
      const auto farthest = [&](const Corners& c) {
        return std::max({along_[e].dot(c[0]), along_[e].dot(c[1]), along_[e].dot(c[2])});
      };
      if (std::min(farthest(t), farthest(other)) > value_[e]) return true;
    }
    return false;
  }
  [[nodiscard]] const std::array<ContactPlace, 4>& places() const noexcept { return farthest_; }
  /// Returns the greatest distance between opposite ends [m].
  [[nodiscard]] double extent() const noexcept {
    return std::max((farthest_[0].on_segment - farthest_[1].on_segment).norm(),
                    (farthest_[2].on_segment - farthest_[3].on_segment).norm());
  }

 private:
  std::array<Vec3, 4> along_;
  std::array<double, 4> value_{};
  std::array<ContactPlace, 4> farthest_;
};

/// Ends of a line or face that lies flat: of the places equally near, and of those about as near as the nearest.
/// Without ties all are the nearest place.
class FlatContact {
 public:
  /// @param tests  number of places that were tested by is_nearest()
  FlatContact(const ContactPlace& nearest, const PlacedSegment& segment, const ObjectTree& object,
              const NearPairs& near, int& tests) noexcept
      : equal(nearest),
        tied(nearest),
        nearest_(nearest),
        segment_(segment),
        object_(object),
        near_(near),
        tests_(tests) {}

  /// Adds all points of a tied pair that are about as near. Points of parallel edges and faces are.
  void add(const NearPairs::Pair& pair) noexcept {
    Corners corners = segment_.tree.corners(pair.triangle);
    for (Vec3& x : corners) x = segment_.X_WS * x;
    const Corners object = object_.corners(pair.slot);
    if (!equal.may_be_farther(corners, object) && !tied.may_be_farther(corners, object)) return;
    for_each_feature_pair(corners, object, [&](const Vec3& on_a, const Vec3& on_b) {
      const double limit = nearest_.gap + kTier;
      if ((on_a - on_b).squaredNorm() > limit * limit) return;
      const ContactPlace place = place_of(pair, on_a, on_b);
      if (!is_tied(nearest_, place)) return;
      const bool equally = place.gap <= nearest_.gap + kEqual;
      if (!tied.is_farther(place) && !(equally && equal.is_farther(place))) return;
      // On a finely cut face a point of the segment is about as near to an edge beside it: that is no place.
      const bool parallel = place.direction.dot(nearest_.direction) >= kCosInside;
      if (!parallel && !is_place(place, corners, object)) return;
      tied.add(place);
      if (equally) equal.add(place);
    });
  }

  Ends equal;
  Ends tied;

 private:
  /// Asks is_nearest(), unless the two triangles alone, or an earlier answer, say no.
  bool is_place(const ContactPlace& place, const Corners& corners, const Corners& object) noexcept {
    const double nearer = (place.gap - kNoise) * (place.gap - kNoise);
    if ((closest_in(object, place.on_segment) - place.on_segment).squaredNorm() < nearer ||
        (closest_in(corners, place.on_object) - place.on_object).squaredNorm() < nearer ||
        rejected_.has(place))
      return false;
    if (++tests_ > kMostTests) return false;
    if (is_nearest(segment_, object_, near_, place)) return true;
    rejected_.add(place);
    return false;
  }

  static constexpr double kNoise = 1e-9;  // [m]
  ContactPlace nearest_;
  Candidates rejected_;
  const PlacedSegment& segment_;
  const ObjectTree& object_;
  const NearPairs& near_;
  int& tests_;
};

/// Chooses places: the ends of what is nearest; then, of those about as near as the nearest one left, the farthest
/// from all that are chosen.
void choose(const FlatContact& flat, const Candidates& from, int most, Manifold& out) noexcept {
  // The ends of what is long come first; on a curved surface these are all near the nearest place.
  const bool is_long = flat.tied.extent() >= kMerge;
  for (const Ends* ends : {is_long ? &flat.tied : &flat.equal, is_long ? &flat.equal : &flat.tied}) {
    for (const ContactPlace& end : ends->places()) choose(end, most, out);
  }
  while (out.count < most) {
    int best = -1;
    double least_tier = 0.0;
    double farthest = 0.0;
    for (int i = 1; i < from.count; ++i) {
      const ContactPlace& place = from.place[idx(i)];
      double apart = 1e300;
      bool belongs = is_tied(from.place[0], place);
      for (int j = 0; j < out.count && !belongs; ++j) {
        belongs = belongs_to(out.place[idx(j)], place);
        apart = std::min(apart, (place.on_segment - out.place[idx(j)].on_segment).squaredNorm());
      }
      if (belongs) continue;
      const double tier = std::floor((place.gap - from.place[0].gap) / kTier);
      if (best >= 0 && (tier > least_tier || (tier == least_tier && apart <= farthest))) continue;
      best = i;
      least_tier = tier;
      farthest = apart;
    }
    if (best < 0) return;
    out.place[idx(out.count++)] = from.place[idx(best)];
  }
}

}  // namespace

void find_manifold(const PlacedSegment& segment, const ObjectTree& object, double reach, double least,
                   int most, NearPairs& near, Manifold& out) noexcept {
  out.count = 0;
  near.find(segment, object, reach);
  while (near.overflows() && reach > least) {
    reach = std::max(least, 0.5 * reach);
    near.find(segment, object, reach);
  }
  if (near.overflows() || near.count() == 0) return;

  const double limit = reach * reach;
  std::array<std::uint16_t, NearPairs::kMost> order;
  std::size_t count = 0;
  for (std::size_t i = 0; i < near.count(); ++i)
    if (near[i].closest.squared <= limit) order[count++] = static_cast<std::uint16_t>(i);
  std::sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(count),
            [&](std::uint16_t a, std::uint16_t b) {
              const double da = near[a].closest.squared;
              const double db = near[b].closest.squared;
              return da != db ? da < db : a < b;
            });
  if (count == 0 || !(near[order[0]].closest.squared > 0.0)) return;
  Candidates candidates;
  const NearPairs::Pair& first = near[order[0]];
  const ContactPlace nearest = place_of(first, first.closest.on_a, first.closest.on_b);
  candidates.add(nearest);
  int tests = 0;
  FlatContact flat(nearest, segment, object, near, tests);
  for (std::size_t n = 0; n < count; ++n) {
    const NearPairs::Pair& pair = near[order[n]];
    const ContactPlace place = place_of(pair, pair.closest.on_a, pair.closest.on_b);
    if (is_tied(nearest, place)) {
      flat.add(pair);
      continue;
    }
    if (candidates.has(place) || ++tests > kMostTests) continue;
    if (is_nearest(segment, object, near, place)) candidates.add(place);
  }
  choose(flat, candidates, std::min(most, Manifold::kMost), out);
  // The nearest first. Places that are equally near keep their order, so that rounding does not decide.
  for (int n = 1; n < out.count; ++n) {
    for (int i = n; i > 0 && out.place[idx(i)].gap < out.place[idx(i - 1)].gap - kEqual; --i)
      std::swap(out.place[idx(i)], out.place[idx(i - 1)]);
  }
}

Vec3 normal_at_place(const ObjectModel& object, const NearPairs& near, const ContactPlace& place) noexcept {
  TiedTriangles meet;
  meet.add(place.slot);
  const double limit = (place.gap + kEdgeBand) * (place.gap + kEdgeBand);
  for (std::size_t i = 0; !near.overflows() && i < near.count(); ++i) {
    const NearPairs::Pair& pair = near[i];
    if (place.triangle >= 0 && pair.triangle != place.triangle) continue;
    if (pair.closest.squared > limit) continue;
    if (contains(object.tree().corners(pair.slot), place.on_object, kEdgeBand)) meet.add(pair.slot);
  }
  return within_cone(normal_at_contact(object, meet, place.on_object, place.direction), place.direction);
}

}  // namespace phalanx

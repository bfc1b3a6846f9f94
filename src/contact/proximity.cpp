// SPDX-License-Identifier: Apache-2.0
#include "phalanx/contact/proximity.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "contact/normal_fan.h"
#include "phalanx/contact/triangle_distance.h"

namespace phalanx {
namespace {

enum class Order {
  kFixed,    ///< left before right: the same order whatever is pruned
  kNearest,  ///< the nearer child first: what shrinks the bound is found early
};

/// Depth-first walk over pairs of nodes; of two boxes the larger is opened. `wanted(squared box distance)`
/// prunes, `leaf(i, j)` gets pairs of triangles.
template <Order order, class Wanted, class Leaf>
void for_each_pair(const TriangleTree& a, const TriangleTree& b, Wanted&& wanted, Leaf&& leaf) noexcept {
  if (a.empty() || b.empty()) return;
  struct Pair {
    std::int32_t a, b;
    double squared;
  };
  const auto node = [](const TriangleTree& tree, std::int32_t i) -> const TriangleTree::Node& {
    return tree.nodes()[static_cast<std::size_t>(i)];
  };
  const auto pair_of = [&](std::int32_t i, std::int32_t j) {
    return Pair{i, j, squared_distance(node(a, i).box, node(b, j).box)};
  };
  // Both trees are balanced (median splits), so that their depths add up to less than 64 below 2^31 triangles
  // each.
  std::array<Pair, 128> stack;
  std::size_t top = 0;
  stack[top++] = pair_of(0, 0);
  while (top > 0) {
    const Pair pair = stack[--top];
    const TriangleTree::Node& na = node(a, pair.a);
    const TriangleTree::Node& nb = node(b, pair.b);
    if (!wanted(na.box, nb.box, pair.squared)) continue;
    if (na.count > 0 && nb.count > 0) {
      for (std::int32_t i = na.first; i < na.first + na.count; ++i) {
        for (std::int32_t j = nb.first; j < nb.first + nb.count; ++j) leaf(i, j);
      }
      continue;
    }
    const bool open_a = nb.count > 0 || (na.count == 0 && (na.box.max - na.box.min).squaredNorm() >
                                                              (nb.box.max - nb.box.min).squaredNorm());
    Pair first = open_a ? pair_of(pair.a + 1, pair.b) : pair_of(pair.a, pair.b + 1);
    Pair second = open_a ? pair_of(na.right, pair.b) : pair_of(pair.a, nb.right);
    if (order == Order::kNearest && second.squared < first.squared) std::swap(first, second);
    stack[top++] = second;
    stack[top++] = first;
  }
}

/// The largest h >= 0 with  height - v h - A h^2 / 2 >= floor  up to h, for height >= floor.
double safe_step(double height, double v, double A, double floor) noexcept {
  const double gap = std::max(0.0, height - floor);
  const double root = std::sqrt(v * v + 2.0 * A * gap);
  if (v > 0.0) return 2.0 * gap / (v + root);
  if (A > 0.0) return (root - v) / A;
  return std::numeric_limits<double>::infinity();
}

/// Whether no point of box `a`, part of a segment in this motion, gets nearer than `clearance` to box `b`
/// within a step of h. The boxes' gap is a direction that separates them, so that only the speed along it
/// counts.
bool stays_clear(const Aabb& a, const Aabb& b, double squared, const SegmentMotion& motion, double h,
                 double clearance) noexcept {
  if (!(squared > clearance * clearance)) return false;
  const double gap = std::sqrt(squared);
  const Vec3 n = ((a.min - b.max).cwiseMax(0.0) - (b.min - a.max).cwiseMax(0.0)) / gap;
  const Vec3 turn =
      n.cross(motion.angular);  // -n . (w x r) = (n x w) . (-r): the box's half extents bound it
  const double closing = -n.dot(motion.angular.cross(0.5 * (a.min + a.max)) + motion.linear) +
                         0.5 * turn.cwiseAbs().dot(a.max - a.min);
  return gap - h * (closing + 0.5 * motion.acceleration * h) > clearance;
}

}  // namespace

Advance safe_advance(const TriangleTree& segment, const TriangleTree& object, const SegmentMotion& motion,
                     double longest, const StopBand& band) noexcept {
  Advance out{.step = longest, .blocked = false, .near = false};
  const auto reachable = [&] {
    const double d = band.margin + motion.speed * out.step;
    return d * d;
  };
  double reach_squared = reachable();
  for_each_pair<Order::kNearest>(
      segment, object,
      [&](const Aabb& a, const Aabb& b, double box_squared) {
        return !out.blocked && box_squared <= reach_squared &&
               !stays_clear(a, b, box_squared, motion, out.step, band.margin);
      },
      [&](int i, int j) {
        if (out.blocked) return;
        const Corners& corners = segment.corners(i);
        const TriangleDistance closest = triangle_distance(corners, object.corners(j));
        if (closest.squared > reach_squared) return;
        const double distance = std::sqrt(closest.squared);
        if (!(distance > 0.0)) {  // cannot happen from a clear start; stop where we are
          out = {.step = 0.0, .blocked = true, .near = true};
          return;
        }
        const Vec3 n = (closest.on_a - closest.on_b) / distance;
        const auto closing_speed = [&](const Vec3& x) {
          return -n.dot(motion.angular.cross(x) + motion.linear);
        };
        double floor = band.floor;
        if (distance <= band.margin) {
          // Already within the margin: only motion that closes it is stopped. Less than a nanometre a tick is
          // no motion, as long as there is room for it above the floor.
          const double creep = distance > band.floor ? 1e-9 : 0.0;
          if (closing_speed(closest.on_a) > creep) {
            out = {.step = 0.0, .blocked = true, .near = true};
            return;
          }
          floor = std::min(band.floor, distance - 5e-10);
        }
        double step = std::numeric_limits<double>::infinity();
        double clear_step = std::numeric_limits<double>::infinity();
        for (const Vec3& x : corners) {
          const double height = n.dot(x - closest.on_b);
          const double v = closing_speed(x);
          step = std::min(step, safe_step(height, v, motion.acceleration, floor));
          clear_step = std::min(clear_step, safe_step(height, v, motion.acceleration, band.margin));
        }
        if (clear_step <= out.step || distance <= band.margin) out.near = true;
        if (step < out.step) {
          out.step = step;
          reach_squared = reachable();
        }
      });
  return out;
}

double distance(const TriangleTree& segment, const TriangleTree& object, double cap) noexcept {
  double best = cap * cap;
  for_each_pair<Order::kNearest>(
      segment, object, [&](const Aabb&, const Aabb&, double box_squared) { return box_squared < best; },
      [&](int i, int j) {
        best = std::min(best, triangle_distance(segment.corners(i), object.corners(j)).squared);
      });
  return std::sqrt(best);
}

namespace {

/// The pair within the cap that closes fastest, and which others count beside it.
struct Lead {
  const SegmentMotion* motion = nullptr;
  Vec3 direction = Vec3::Zero();
  double speed = 0.0;  ///< 0: nothing closes, every pair counts

  [[nodiscard]] double closing_speed(const Vec3& n, const Vec3& x) const noexcept {
    return -n.dot(motion->angular.cross(x) + motion->linear);
  }
  [[nodiscard]] bool admits(const Vec3& n, const Vec3& on_segment) const noexcept {
    constexpr double kCos = 0.86602540378443865;  // 30 degrees
    return !(speed > 0.0) || n.dot(direction) >= kCos || closing_speed(n, on_segment) >= 0.5 * speed;
  }
};

Vec3 direction_of(const TriangleDistance& closest) noexcept {
  const double d = std::sqrt(closest.squared);
  return d > 0.0 ? Vec3((closest.on_a - closest.on_b) / d) : Vec3(Vec3::Zero());
}

Lead find_lead(const TriangleTree& segment, const TriangleTree& object, double cap,
               const SegmentMotion& motion) noexcept {
  Lead lead{.motion = &motion};
  const double cap_squared = cap * cap;
  for_each_pair<Order::kFixed>(
      segment, object,
      [&](const Aabb&, const Aabb&, double box_squared) { return box_squared < cap_squared; },
      [&](int i, int j) {
        const TriangleDistance closest = triangle_distance(segment.corners(i), object.corners(j));
        if (closest.squared >= cap_squared) return;
        const Vec3 n = direction_of(closest);
        const double speed = lead.closing_speed(n, closest.on_a);
        if (speed <= lead.speed) return;
        lead.speed = speed;
        lead.direction = n;
      });
  return lead;
}

/// The smallest distance below `cap` of the pairs that count.
double distance_of_admitted(const TriangleTree& segment, const TriangleTree& object, double cap,
                            const Lead& lead) noexcept {
  if (!(lead.speed > 0.0)) return distance(segment, object, cap);
  double best = cap * cap;
  for_each_pair<Order::kNearest>(
      segment, object, [&](const Aabb&, const Aabb&, double box_squared) { return box_squared < best; },
      [&](int i, int j) {
        const TriangleDistance closest = triangle_distance(segment.corners(i), object.corners(j));
        if (closest.squared < best && lead.admits(direction_of(closest), closest.on_a))
          best = closest.squared;
      });
  return std::sqrt(best);
}

}  // namespace

ContactPatch contact_patch(const TriangleTree& segment, const ObjectModel& object, double cap,
                           const SegmentMotion* motion) noexcept {
  ContactPatch patch;
  const Lead lead = motion == nullptr ? Lead{} : find_lead(segment, object.tree(), cap, *motion);
  patch.distance = distance_of_admitted(segment, object.tree(), cap, lead);
  if (!(patch.distance < cap)) return patch;
  const double limit = patch.distance + kPatchBand;
  const double limit_squared = limit * limit;
  MeanDirection direction(std::sqrt(limit_squared - patch.distance * patch.distance));
  TiedTriangles tied;
  double weight = 0.0;
  for_each_pair<Order::kFixed>(
      segment, object.tree(),
      [&](const Aabb&, const Aabb&, double box_squared) { return box_squared <= limit_squared; },
      [&](int i, int j) {
        const Corners& corners = object.tree().corners(j);
        const TriangleDistance closest = triangle_distance(segment.corners(i), corners);
        if (closest.squared > limit_squared) return;
        const Vec3 n = direction_of(closest);
        if (!lead.admits(n, closest.on_a)) return;
        TiedRegion region = tied_region(segment.corners(i), corners, closest, limit, kPatchBand);
        region.weight *= (limit - std::sqrt(closest.squared)) / kPatchBand;
        patch.on_segment += region.weight * region.on_a;
        patch.on_object += region.weight * region.on_b;
        direction.add(closest, n, region.weight);
        weight += region.weight;
        ++patch.pairs;
        tied.add(j);
      });
  patch.on_segment /= weight;
  patch.on_object /= weight;
  patch.direction = direction.unit();
  patch.object_normal = normal_at_contact(object, tied, patch.on_object, patch.direction);
  return patch;
}

}  // namespace phalanx

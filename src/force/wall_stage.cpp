// SPDX-License-Identifier: Apache-2.0
#include "force/wall_stage.h"

#include <algorithm>
#include <cmath>

#include "phalanx/core/index.h"
#include "phalanx/force/force_law.h"

namespace phalanx {
namespace {

using DigitWalls = std::array<LocalWall*, kSegmentsPerDigit>;
using DigitNormals = std::array<Vec3, kSegmentsPerDigit>;

// How long, how far off and how far aside a wall that was left is still sent.
constexpr double kKeptFor = 0.25;        // [s]
constexpr double kHighest = 10e-3;       // [m]
constexpr double kFarthestAside = 3e-3;  // [m]
constexpr double kUncapped = 1e6;        // f_max without a cap: what no device renders [N]
constexpr double kRounding = 1e-12;      // of the square of a force that is as large as the cap

/// Largest s in 0 .. 1 with |a + s b| <= cap, up to rounding; 0 if a itself is longer.
double largest_share(const Vec3& a, const Vec3& b, double cap) noexcept {
  const double most = (1.0 + kRounding) * cap * cap;
  const double room = most - a.squaredNorm();
  if (!(room >= 0.0)) return 0.0;  // also for what is not a number
  if ((a + b).squaredNorm() <= most) return 1.0;
  const double ab = a.dot(b);
  const double bb = b.squaredNorm();
  return std::clamp((std::sqrt(ab * ab + bb * room) - ab) / bb, 0.0, 1.0);
}

/// f_max of each wall: what the host sends, and of the room up to the cap as large a share for all as keeps
/// the vector sum within the cap for any forces 0 .. f_max. That sum is largest where each force is one of
/// its two ends, so seven sums say it.
void share_the_cap(const DigitWalls& wall, const DigitNormals& normal, double cap) noexcept {
  double scale = 1.0;
  double share = 1.0;
  for (unsigned subset = 1; subset < 1U << kSegmentsPerDigit; ++subset) {
    Vec3 held = Vec3::Zero();
    Vec3 room = Vec3::Zero();
    for (std::size_t k = 0; k < wall.size(); ++k) {
      if ((subset >> k & 1U) == 0U || !wall[k]->active) continue;
      const double host = std::min(wall[k]->host_force, cap);
      held += host * normal[k];
      room += (cap - host) * normal[k];
    }
    const double size = held.norm();
    if (size > cap) scale = std::min(scale, cap / size);
    share = std::min(share, largest_share(held, room, cap));
  }
  for (LocalWall* w : wall) {
    const double host = std::min(w->host_force, cap);
    w->force_max = w->active ? scale * (host + share * (cap - host)) : 0.0;
  }
}

/// Makes the f_max so small that the walls together load no joint by more than the limit, whatever they do.
void keep_torque_limit(const DigitWalls& walls, double limit) noexcept {
  double factor = 1.0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(kJointsPerDigit); ++i) {
    double most = 0.0;
    for (const LocalWall* wall : walls) most += std::abs(wall->g[i]) * wall->force_max;
    if (most > limit) factor = std::min(factor, limit / most);
  }
  for (LocalWall* wall : walls) wall->force_max *= factor;
}

/// A wall at this contact, as the host sees it.
LocalWall wall_of(const ForceModel& model, const ContactRecord& record, const SegmentForce& force,
                  const ForceState& state) noexcept {
  LocalWall wall;
  wall.stiffness = state.stiffness_factor.value() * law_slope(model.law, record.depth);
  wall.d_ref = record.depth > 0.0 ? force.raw / wall.stiffness : record.depth;
  wall.host_force = force.sent;
  return wall;
}

/// The wall that the segment has just left, as long as the finger is still near its place.
LocalWall wall_left(const ForceModel& model, const Pose& hcp, RememberedWall& left) noexcept {
  LocalWall wall;
  left.age += model.period;
  const Vec3 apart = hcp * left.p_S - left.p_W;
  const double height = left.normal.dot(apart);
  const double aside = (apart - height * left.normal).norm();
  // Below the plane without a contact: the object is not there any more.
  left.kept = left.age <= kKeptFor && height >= 0.0 && height <= kHighest && aside <= kFarthestAside;
  if (!left.kept) return wall;
  wall.stiffness = left.stiffness;
  wall.d_ref = -height;
  return wall;
}

bool usable(const LocalWall& wall) noexcept {
  return wall.stiffness > 0.0 && std::isfinite(wall.stiffness) && std::isfinite(wall.d_ref) &&
         std::ranges::all_of(wall.g, [](double arm) { return std::isfinite(arm); });
}

}  // namespace

void clear_walls(int digit, ForceState& state) noexcept {
  for (int k = 0; k < kSegmentsPerDigit; ++k) {
    state.wall[idx(segment_index(digit, k))] = {};
    state.remembered[idx(segment_index(digit, k))] = {};
  }
}

void withhold_walls(int digit, ForceState& state) noexcept {
  for (int k = 0; k < kSegmentsPerDigit; ++k) state.wall[idx(segment_index(digit, k))] = {};
}

void make_walls(const ForceModel& model, const GdpState& contacts, const HandPoses& hcp, int digit,
                bool stale, ForceState& state) noexcept {
  const DigitPose& gdp = contacts.poses.digit[idx(digit)];
  DigitWalls walls{};
  DigitNormals normal;
  for (int k = 0; k < kSegmentsPerDigit; ++k) {
    const std::size_t s = idx(segment_index(digit, k));
    const SegmentForce& force = state.segment[s];
    const ContactRecord& record = contacts.record[s];
    LocalWall& wall = state.wall[s];
    RememberedWall& remembered = state.remembered[s];
    walls[idx(k)] = &wall;
    wall = {};
    if (record.silent || stale) remembered.kept = false;
    if (record.active && !record.silent && !stale) {
      wall = wall_of(model, record, force, state);
      remembered = {.kept = true,
                    .age = 0.0,
                    .stiffness = wall.stiffness,
                    .p_S = record.p_S,
                    .normal = force.normal,
                    .p_W = record.p_gdp};
    } else if (remembered.kept && !record.active) {
      wall = wall_left(model, hcp.digit[idx(digit)].segment[idx(k)], remembered);
    }
    JointArray unit_torque{};
    add_torques(gdp, digit, k, gdp.segment[idx(k)] * remembered.p_S, remembered.normal, unit_torque);
    for (int i = 0; i < kJointsPerDigit; ++i) wall.g[idx(i)] = unit_torque[idx(joint_index(digit, i))];
    wall.active = usable(wall);
    if (!wall.active) {
      wall = {};
      remembered.kept = false;
      continue;
    }
    normal[idx(k)] = remembered.normal;
  }
  if (model.limits.fingertip_force_enabled) {
    share_the_cap(walls, normal, model.limits.fingertip_force);
  } else {
    for (LocalWall* wall : walls) wall->force_max = wall->active ? kUncapped : 0.0;
  }
  if (model.limits.joint_torque_enabled) keep_torque_limit(walls, model.limits.joint_torque);
}

bool remembers_walls(int digit, const ForceState& state) noexcept {
  for (int k = 0; k < kSegmentsPerDigit; ++k)
    if (state.remembered[idx(segment_index(digit, k))].kept) return true;
  return false;
}

}  // namespace phalanx

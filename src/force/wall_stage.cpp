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

// Bounds within which the wall of a contact that has let go is still sent: time, height and lateral offset.
constexpr double kKeptFor = 0.25;        // [s]
constexpr double kHighest = 10e-3;       // [m]
constexpr double kFarthestAside = 3e-3;  // [m]
constexpr double kUncapped = 1e6;        // f_max without a cap: beyond any device [N]
constexpr double kRounding = 1e-12;      // relative, of the square of a force as large as the cap

/// Returns the largest s in 0 .. 1 with |a + s b| <= cap, up to rounding; 0 if a alone exceeds the cap.
double largest_share(const Vec3& a, const Vec3& b, double cap) noexcept {
  const double most = (1.0 + kRounding) * cap * cap;
  const double room = most - a.squaredNorm();
  if (!(room >= 0.0)) return 0.0;  // also for NaN
  if ((a + b).squaredNorm() <= most) return 1.0;
  const double ab = a.dot(b);
  const double bb = b.squaredNorm();
  return std::clamp((std::sqrt(ab * ab + bb * room) - ab) / bb, 0.0, 1.0);
}

/// Sets f_max of each wall: the host's force, and a common share of the room up to the cap. The share is the
/// largest that keeps the vector sum within the cap for any forces 0 .. f_max. That sum is largest where each
/// force is 0 or f_max, so that seven sums suffice.
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

/// Reduces the f_max so that the walls together load no joint beyond the limit, whatever their forces.
void keep_torque_limit(const DigitWalls& walls, double limit) noexcept {
  double factor = 1.0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(kJointsPerDigit); ++i) {
    double most = 0.0;
    for (const LocalWall* wall : walls) most += std::abs(wall->g[i]) * wall->force_max;
    if (most > limit) factor = std::min(factor, limit / most);
  }
  for (LocalWall* wall : walls) wall->force_max *= factor;
}

/// Returns the wall at this contact, as the host computes it.
LocalWall wall_of(const HapticParameters& parameters, const ContactRecord& record, const SegmentForce& force,
                  const ForceState& state) noexcept {
  LocalWall wall;
  wall.stiffness = state.stiffness_factor.value() * law_slope(parameters.force, record.depth);
  wall.d_ref = record.depth > 0.0 ? force.raw / wall.stiffness : record.depth;
  wall.host_force = force.sent;
  return wall;
}

/// Returns the wall of a contact that has just let go, while the finger is still near its place.
LocalWall wall_left(const HapticParameters& parameters, const Pose& hcp, RememberedWall& left) noexcept {
  LocalWall wall;
  left.age += parameters.period();
  const Vec3 apart = hcp * left.p_S - left.p_W;
  const double height = left.normal.dot(apart);
  const double aside = (apart - height * left.normal).norm();
  // Below the plane without a contact the object is absent.
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

void make_walls(const HapticParameters& parameters, const GdpState& contacts, const HandPoses& hcp, int digit,
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
      wall = wall_of(parameters, record, force, state);
      remembered = {.kept = true,
                    .age = 0.0,
                    .stiffness = wall.stiffness,
                    .p_S = record.p_S,
                    .normal = force.normal,
                    .p_W = record.p_gdp};
    } else if (parameters.contact.mode == ContactMode::kSliding) {
      remembered.kept = false;  // the wall ends with the contact
    } else if (remembered.kept && !record.active) {
      wall = wall_left(parameters, hcp.digit[idx(digit)].segment[idx(k)], remembered);
    }
    JointArray unit_torque{};
    add_torques(gdp, digit, k, gdp.segment[idx(k)] * remembered.p_S, remembered.normal, unit_torque);
    if (record.active && !record.couple.isZero(0.0)) add_couple(gdp, digit, k, record.couple, unit_torque);
    for (int i = 0; i < kJointsPerDigit; ++i) wall.g[idx(i)] = unit_torque[idx(joint_index(digit, i))];
    wall.active = usable(wall);
    if (!wall.active) {
      wall = {};
      remembered.kept = false;
      continue;
    }
    normal[idx(k)] = remembered.normal;
  }
  if (parameters.limits.fingertip_force_enabled) {
    share_the_cap(walls, normal, parameters.limits.fingertip_force);
  } else {
    for (LocalWall* wall : walls) wall->force_max = wall->active ? kUncapped : 0.0;
  }
  if (parameters.limits.joint_torque_enabled) keep_torque_limit(walls, parameters.limits.joint_torque);
}

bool remembers_walls(int digit, const ForceState& state) noexcept {
  for (int k = 0; k < kSegmentsPerDigit; ++k)
    if (state.remembered[idx(segment_index(digit, k))].kept) return true;
  return false;
}

}  // namespace phalanx

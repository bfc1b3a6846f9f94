// SPDX-License-Identifier: Apache-2.0
#include "step/contact_points.h"

#include <algorithm>

#include "phalanx/core/index.h"

namespace phalanx {
namespace {

static_assert(ContactPoints::kMost == kDigits * DigitContacts::kMost);

constexpr double kLeastResultant = 0.1;   // of the sum of a segment's contact points
constexpr double kLeastSlipSpeed = 1e-4;  // slower is rest [m/s]

/// Returns the speed of a segment's material point along a surface [m/s]; 0 in the tick in which contact begins.
double slip_speed(const LastHand& last, const Snapshot& now, int segment, const Vec3& p_S, const Vec3& normal,
                  double period) noexcept {
  const std::size_t s = idx(segment);
  if (!last.in_contact[s]) return 0.0;
  const Vec3 moved = now.gdp_pose[s] * p_S - last.pose[s] * p_S;
  return (moved - moved.dot(normal) * normal).norm() / period;
}

}  // namespace

void record_contact_points(const HapticParameters& parameters, const GdpState& gdp, const ForceState& force,
                           const LastHand& last, Snapshot& out) noexcept {
  std::array<double, kSegments> size{};  // of the points' depths, added
  std::array<double, kSegments> pressing{};
  std::array<double, kSegments> slipping{};
  const auto for_each_point = [&](auto&& use) {
    for (int d = 0; d < kDigits; ++d) {
      const DigitContacts& contacts = gdp.sliding[idx(d)];
      for (int c = 0; c < contacts.count; ++c) {
        const SlidingContact& contact = contacts.contact[idx(c)];
        if (contact.presses()) use(segment_index(d, contact.k), contact);
      }
    }
  };
  for_each_point([&](int s, const SlidingContact& contact) { size[idx(s)] += contact.resultant().norm(); });
  for_each_point([&](int s, const SlidingContact& contact) {
    const ContactRecord& record = gdp.record[idx(s)];
    const double sent = force.segment[idx(s)].sent;
    const double resultant = std::max(record.depth, kLeastResultant * size[idx(s)]);
    ContactPoint& at = out.contact_points.point[idx(out.contact_points.count++)];
    at.segment = s;
    at.point = out.gdp_pose[idx(s)] * contact.p_S;
    at.normal = contact.force_normal;
    at.force = sent * (contact.depth[0] / resultant);
    at.friction = sent / resultant * contact.friction_depth();
    at.spin = sent * (contact.spin_depth / resultant);
    at.coefficient = contact.friction;
    at.slips = contact.slips &&
               slip_speed(last, out, s, contact.p_S, contact.normal, parameters.period()) > kLeastSlipSpeed;

    SegmentSnapshot& segment = out.segment[idx(s)];
    segment.friction += at.friction;
    segment.spin += at.spin * at.normal.dot(record.n_c);
    pressing[idx(s)] += contact.depth[0];
    if (at.slips) slipping[idx(s)] += contact.depth[0];
  });
  for (int s = 0; s < kPalm; ++s) {
    SegmentSnapshot& segment = out.segment[idx(s)];
    const ContactRecord& record = gdp.record[idx(s)];
    segment.slips = slipping[idx(s)] > 0.5 * pressing[idx(s)];
    if (record.active)
      segment.slip_speed = slip_speed(last, out, s, record.p_S, record.n_c, parameters.period());
  }
}

}  // namespace phalanx

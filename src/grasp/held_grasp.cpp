// SPDX-License-Identifier: Apache-2.0
#include "phalanx/grasp/held_grasp.h"

#include "grasp/object_shape.h"
#include "grasp/placed_hand.h"
#include "grasp/wrench_ball.h"
#include "phalanx/core/index.h"

namespace phalanx {

HeldGrasp held_grasp(const HapticModel& model, const HapticParameters& parameters, const Snapshot& snapshot) {
  HeldGrasp out;
  if (model.object.triangle_count() == 0) return out;
  for (int segment = 0; segment < kPalm; ++segment) {
    const SegmentSnapshot& now = snapshot.segment[idx(segment)];
    if (!now.contact || !(now.depth > 0.0)) continue;
    out.contact.push_back({.segment = segment,
                           .point = now.point,
                           .normal = now.normal,
                           .pad = is_palmar(snapshot.gdp_pose[idx(segment)], now.normal)});
  }
  if (const auto palm = palm_contact(model.hand, model.trees(), model.object, parameters.contact.margin))
    out.contact.push_back(*palm);
  const ObjectShape shape = shape_of(model.object.mesh());
  std::vector<WrenchContact> contacts;
  for (const PlannedContact& contact : out.contact) contacts.push_back({contact.point, -contact.normal});
  const double friction = model.object.friction(0, parameters.contact.friction);
  out.closure_margin = wrench_ball(
      contact_wrenches(contacts, friction, parameters.contact.spin_radius, shape.centre, shape.radius));
  return out;
}

}  // namespace phalanx

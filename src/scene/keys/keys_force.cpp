// SPDX-License-Identifier: Apache-2.0
// Keys of everything between contact and command.
#include "phalanx/force/parameter_ranges.h"
#include "scene/keys/key_rows.h"

namespace phalanx {
namespace {

using T = const KeyTarget&;
using V = const KeyValue&;

void add_contact_and_law(std::vector<SceneKey>& keys) {
  const KeyRows in_contact(keys, ChangeKind::kInContact);
  const KeyRows at_zero_torque(keys, ChangeKind::kAtZeroTorque);
  at_zero_torque.number("contact.margin_mm", "mm", in_unit(ranges::kMargin, kMm), 0.05,
                        "clearance of a stopped segment",
                        [](T t, V v) { t.scene.parameters.contact.margin = v.number * kMm; });
  at_zero_torque.number("contact.slid_mm", "mm", in_unit(ranges::kSlidDistance, kMm), 5,
                        "tangential offset beyond which a contact reports `slid`",
                        [](T t, V v) { t.scene.parameters.contact.slid_distance = v.number * kMm; });
  at_zero_torque.choice("contact.mode", {"static", "sliding"}, "static",
                        "contacts are fixed points, as in the papers, or slide with friction", [](T t, V v) {
                          t.scene.parameters.contact.mode = static_cast<ContactMode>(v.integer);
                        });
  at_zero_torque.number("contact.friction", "", ranges::kFriction, 0.6,
                        "sliding: Coulomb friction coefficient",
                        [](T t, V v) { t.scene.parameters.contact.friction = v.number; });
  at_zero_torque.number("contact.tangential_stiffness_ratio", "", ranges::kTangentialStiffnessRatio, 0.5,
                        "sliding: stiffness along the surface of friction that holds, over that across it",
                        [](T t, V v) { t.scene.parameters.contact.tangential_stiffness_ratio = v.number; });
  at_zero_torque.number("contact.spin_radius_mm", "mm", in_unit(ranges::kSpinRadius, kMm), 4,
                        "sliding: radius of the area whose friction resists rotation about the normal",
                        [](T t, V v) { t.scene.parameters.contact.spin_radius = v.number * kMm; });
  at_zero_torque.integer("contact.max_contacts", ranges::kMaxContacts, 4,
                         "sliding: greatest number of contact points of a segment", [](T t, V v) {
                           t.scene.parameters.contact.max_contacts = static_cast<int>(v.integer);
                         });
  at_zero_torque.choice(
      "gdp.method", {"continuous", "trajectory"}, "continuous",
      "method for the shown hand: first time of contact, or S1 fig. 4 as printed",
      [](T t, V v) { t.scene.parameters.contact.method = static_cast<GdpMethod>(v.integer); });
  at_zero_torque.choice(
      "force.law", {"hooke", "kelvin_voigt", "hunt_crossley", "duffing", "linear_then_cubic"}, "hooke",
      "force over depth", [](T t, V v) { t.scene.parameters.force.law = static_cast<ForceLaw>(v.integer); });
  in_contact.number("force.stiffness_n_per_mm", "N/mm", in_unit(ranges::kStiffness, 1 / kMm), 0.5,
                    "stiffness k; hunt_crossley: F/d at 1 mm",
                    [](T t, V v) { t.scene.parameters.force.stiffness = v.number / kMm; });
  in_contact.number("force.damping_ns_per_m", "N s/m", ranges::kDamping, 2, "kelvin_voigt: damping b",
                    [](T t, V v) { t.scene.parameters.force.damping = v.number; });
  at_zero_torque.number("force.velocity_lowpass_hz", "Hz", ranges::kLowpass, 30,
                        "corner of the low-pass on the closing speed of the damped laws",
                        [](T t, V v) { t.scene.parameters.force.velocity_lowpass_hz = v.number; });
  at_zero_torque.number("force.exponent", "", ranges::kHuntCrossleyExponent, 1.5,
                        "hunt_crossley: exponent n of the depth",
                        [](T t, V v) { t.scene.parameters.force.hunt_crossley_exponent = v.number; });
  at_zero_torque.number("force.hunt_crossley_damping_s_per_m", "s/m", ranges::kHuntCrossleyDamping, 2,
                        "hunt_crossley: damping a",
                        [](T t, V v) { t.scene.parameters.force.hunt_crossley_damping = v.number; });
  at_zero_torque.number("force.cubic_n_per_mm3", "N/mm^3", in_unit(ranges::kCubic, 1 / (kMm * kMm * kMm)),
                        0.05, "duffing, linear_then_cubic: k3",
                        [](T t, V v) { t.scene.parameters.force.cubic = v.number / (kMm * kMm * kMm); });
  at_zero_torque.number("force.linear_depth_mm", "mm", in_unit(ranges::kLinearDepth, kMm), 2,
                        "linear_then_cubic: depth d1 where the cubic piece begins",
                        [](T t, V v) { t.scene.parameters.force.linear_depth = v.number * kMm; });
  at_zero_torque.choice(
      "force.depth", {"continuous", "s1"}, "continuous",
      "a later contact's depth starts from zero, or from the shown hand as S1's formula says",
      [](T t, V v) { t.scene.parameters.contact.depth = static_cast<DepthOrigin>(v.integer); });
  at_zero_torque.choice(
      "force.normal", {"interpolated", "contact"}, "interpolated",
      "direction of the force: the object's interpolated normal, or the direction of closest approach",
      [](T t, V v) { t.scene.parameters.contact.normal = static_cast<ForceNormal>(v.integer); });
}

void add_smoothing_and_limits(std::vector<SceneKey>& keys) {
  const KeyRows in_contact(keys, ChangeKind::kInContact);
  const KeyRows new_station(keys, ChangeKind::kNewStation);
  // A bound per tick is in the range of a bound per second at every rate.
  const NumberRange min_per_tick = in_unit(ranges::kMinRate, ranges::kRate.max);
  const NumberRange max_per_tick = in_unit(ranges::kMaxRate, ranges::kRate.max);
  in_contact.number("smoothing.min_n_per_s", "N/s", ranges::kMinRate, -20,
                    "smoothing: fastest fall of a contact's force; -inf: none",
                    [](T t, V v) { t.scene.parameters.stabiliser.min_rate = v.number; });
  in_contact.number("smoothing.max_n_per_s", "N/s", ranges::kMaxRate, 20, "fastest rise of a contact's force",
                    [](T t, V v) { t.scene.parameters.stabiliser.max_rate = v.number; });
  in_contact.number(
      "smoothing.min_n", "N", min_per_tick, std::nullopt,
      "the papers' form, per tick at rate_hz; not together with the _n_per_s keys",
      [](T t, V v) { t.scene.parameters.stabiliser.min_rate = v.number * t.scene.parameters.rate_hz; });
  in_contact.number(
      "smoothing.max_n", "N", max_per_tick, std::nullopt, "the same for the rise",
      [](T t, V v) { t.scene.parameters.stabiliser.max_rate = v.number * t.scene.parameters.rate_hz; });
  new_station.limit("limits.fingertip_force_n", "N", ranges::kFingertipForce, 5,
                    "largest force of a contact, and of a digit's contacts together", [](T t, V v) {
                      t.scene.parameters.limits.fingertip_force_enabled = !v.off;
                      if (!v.off) t.scene.parameters.limits.fingertip_force = v.number;
                    });
  new_station.limit("limits.joint_torque_nm", "Nm", ranges::kJointTorque, 0.5, "largest torque of a joint",
                    [](T t, V v) {
                      t.scene.parameters.limits.joint_torque_enabled = !v.off;
                      if (!v.off) t.scene.parameters.limits.joint_torque = v.number;
                    });
  new_station.limit("limits.torque_rate_nm_per_s", "Nm/s", ranges::kTorqueRate, 10,
                    "fastest change of a joint's torque", [](T t, V v) {
                      t.scene.parameters.limits.torque_rate_enabled = !v.off;
                      if (!v.off) t.scene.parameters.limits.torque_rate = v.number;
                    });
  new_station.limit("limits.joint_speed_rad_per_s", "rad/s", ranges::kJointSpeed, 40,
                    "largest plausible speed of a joint; faster samples are slewed",
                    [](T t, V v) { t.scene.parameters.limits.joint_speed = v.off ? kInfinity : v.number; });
}

void add_stabiliser(std::vector<SceneKey>& keys) {
  const KeyRows at_zero_torque(keys, ChangeKind::kAtZeroTorque);
  at_zero_torque.choice(
      "stabiliser.method",
      {"none", "smoothing", "rise_only", "direction", "low_pass", "kelvin_voigt", "virtual_coupling",
       "passivity", "energy_bounding", "local_wall"},
      "rise_only", "method that keeps the loop through the device stable; docs/stabilisers.md",
      [](T t, V v) { t.scene.parameters.stabiliser.method = static_cast<Stabiliser>(v.integer); });
  at_zero_torque.number("stabiliser.turn_deg_per_s", "deg/s", in_unit(ranges::kTurnRate, kDeg), 90,
                        "direction: fastest turn of a contact's force",
                        [](T t, V v) { t.scene.parameters.stabiliser.turn_rate = v.number * kDeg; });
  at_zero_torque.number("stabiliser.lowpass_hz", "Hz", ranges::kLowpass, 3,
                        "low_pass: corner of the low-pass on a contact's force",
                        [](T t, V v) { t.scene.parameters.stabiliser.lowpass_hz = v.number; });
  at_zero_torque.number("stabiliser.damping_ns_per_m", "N s/m", ranges::kDamping, 4,
                        "kelvin_voigt: damping b beside the law",
                        [](T t, V v) { t.scene.parameters.stabiliser.damping = v.number; });
  at_zero_torque.number("stabiliser.coupling_stiffness_n_per_mm", "N/mm",
                        in_unit(ranges::kCouplingStiffness, 1 / kMm), 1,
                        "virtual_coupling: stiffness Kc between finger and proxy",
                        [](T t, V v) { t.scene.parameters.stabiliser.coupling_stiffness = v.number / kMm; });
  at_zero_torque.number("stabiliser.coupling_damping_ns_per_m", "N s/m", ranges::kDamping, 4,
                        "virtual_coupling: damping Bc between finger and proxy",
                        [](T t, V v) { t.scene.parameters.stabiliser.coupling_damping = v.number; });
  at_zero_torque.number("stabiliser.passivity_damping_max_ns_per_m", "N s/m", ranges::kDamping, 10,
                        "passivity: largest damping a of the controller",
                        [](T t, V v) { t.scene.parameters.stabiliser.passivity_damping_max = v.number; });
  at_zero_torque.number("stabiliser.device_damping_ns_per_m", "N s/m", ranges::kDamping, 1.6,
                        "energy_bounding: the device's own damping b; no contact is stiffer than 2 b rate_hz",
                        [](T t, V v) { t.scene.parameters.stabiliser.device_damping = v.number; });
  at_zero_torque.number("stabiliser.wall_valid_ms", "ms", in_unit(ranges::kWallValid, kMilli), 14,
                        "local_wall: time for which the controller may use a wall that the host has sent",
                        [](T t, V v) { t.scene.parameters.stabiliser.wall_valid = kMilli * v.number; });
  at_zero_torque.choice(
      "oscillation.reaction", {"report", "halve"}, "report",
      "reaction to a segment's force that oscillates: report it, or also halve the law's force (over 200 ms)",
      [](T t, V v) {
        t.scene.parameters.oscillation.reaction = static_cast<OscillationReaction>(v.integer);
      });
  at_zero_torque.number(
      "oscillation.swing_n", "N", ranges::kSwing, 0.5,
      "swing of a segment's force, from peak to peak, beyond which it counts as an oscillation",
      [](T t, V v) { t.scene.parameters.oscillation.swing = v.number; });
}

}  // namespace

void add_force_keys(std::vector<SceneKey>& keys) {
  add_contact_and_law(keys);
  add_smoothing_and_limits(keys);
  add_stabiliser(keys);
}

}  // namespace phalanx

// SPDX-License-Identifier: Apache-2.0
// Keys of everything between contact and command.
#include "scene/key_builders.h"

namespace phalanx {
namespace {

using T = const KeyTarget&;
using V = const KeyValue&;

void add_contact_and_law(std::vector<KeySpec>& keys) {
  keys.push_back(number("contact.margin_mm", "mm", between(0.001, 1), "0.05",
                        "clearance of a stopped segment",
                        [](T t, V v) { t.scene.contact.margin = v.number * kMm; }));
  keys.push_back(number("contact.slid_mm", "mm", above(0, 100), "5",
                        "tangential offset beyond which a contact reports `slid`",
                        [](T t, V v) { t.scene.contact.slid_distance = v.number * kMm; }));
  keys.push_back(choice("gdp.method", {"continuous", "trajectory"}, "\"continuous\"",
                        "how the shown hand is found: first time of contact, or S1 fig. 4 to the letter",
                        [](T t, V v) { t.scene.contact.method = static_cast<GdpMethod>(v.integer); }));
  keys.push_back(choice(
      "force.law", {"hooke", "kelvin_voigt", "hunt_crossley", "duffing", "linear_then_cubic"}, "\"hooke\"",
      "force over depth", [](T t, V v) { t.scene.force.law = static_cast<ForceLaw>(v.integer); }));
  keys.push_back(number("force.stiffness_n_per_mm", "N/mm", between(0, 100), "0.5",
                        "stiffness k; hunt_crossley: F/d at 1 mm",
                        [](T t, V v) { t.scene.force.stiffness = v.number / kMm; }));
  keys.push_back(number("force.damping_ns_per_m", "N s/m", between(0, 1000), "2", "kelvin_voigt: damping b",
                        [](T t, V v) { t.scene.force.damping = v.number; }));
  keys.push_back(number("force.velocity_lowpass_hz", "Hz", above(0, 2000), "30",
                        "corner of the low-pass on the closing speed of the damped laws",
                        [](T t, V v) { t.scene.force.velocity_lowpass_hz = v.number; }));
  keys.push_back(number("force.exponent", "", between(1, 5), "1.5", "hunt_crossley: exponent n of the depth",
                        [](T t, V v) { t.scene.force.hunt_crossley_exponent = v.number; }));
  keys.push_back(number("force.hunt_crossley_damping_s_per_m", "s/m", between(0, 100), "2",
                        "hunt_crossley: damping a",
                        [](T t, V v) { t.scene.force.hunt_crossley_damping = v.number; }));
  keys.push_back(number("force.cubic_n_per_mm3", "N/mm^3", between(0, 100), "0.05",
                        "duffing, linear_then_cubic: k3",
                        [](T t, V v) { t.scene.force.cubic = v.number / (kMm * kMm * kMm); }));
  keys.push_back(number("force.linear_depth_mm", "mm", between(0, 50), "2",
                        "linear_then_cubic: depth d1 where the cubic piece begins",
                        [](T t, V v) { t.scene.force.linear_depth = v.number * kMm; }));
  keys.push_back(
      choice("force.depth", {"continuous", "s1"}, "\"continuous\"",
             "a later contact's depth starts from zero, or from the shown hand as S1's formula says",
             [](T t, V v) { t.scene.contact.depth = static_cast<DepthOrigin>(v.integer); }));
  keys.push_back(
      choice("force.normal", {"interpolated", "contact"}, "\"interpolated\"",
             "direction of the force: the object's interpolated normal, or the direction of closest approach",
             [](T t, V v) { t.scene.contact.normal = static_cast<ForceNormal>(v.integer); }));
}

void add_smoothing_and_limits(std::vector<KeySpec>& keys) {
  constexpr NumberRange kFall = {.min = -1e6, .max = 0, .max_open = true, .allows_minus_infinity = true};
  keys.push_back(flag("smoothing.enabled", "true", "older form: false is stabiliser.method = \"none\"",
                      [](T t, V v) { t.scene.smoothing.enabled = v.flag; }));
  keys.push_back(number("smoothing.min_n_per_s", "N/s", kFall, "-20",
                        "fastest fall of a contact's force; -inf: rise-only smoothing",
                        [](T t, V v) { t.scene.smoothing.min_rate = v.number; }));
  keys.push_back(number("smoothing.max_n_per_s", "N/s", above(0, 1e6), "20",
                        "fastest rise of a contact's force",
                        [](T t, V v) { t.scene.smoothing.max_rate = v.number; }));
  keys.push_back(number("smoothing.min_n", "N", kFall, "",
                        "the papers' form, per tick at rate_hz; not together with the _n_per_s keys",
                        [](T t, V v) { t.scene.smoothing.min_rate = v.number * t.scene.rate_hz; }));
  keys.push_back(number("smoothing.max_n", "N", above(0, 1e6), "", "the same for the rise",
                        [](T t, V v) { t.scene.smoothing.max_rate = v.number * t.scene.rate_hz; }));
  keys.push_back(limit("limits.fingertip_force_n", "N", above(0, 15), "5",
                       "largest force of a contact, and of a digit's contacts together", [](T t, V v) {
                         t.scene.limits.fingertip_force_enabled = !v.off;
                         if (!v.off) t.scene.limits.fingertip_force = v.number;
                       }));
  keys.push_back(
      limit("limits.joint_torque_nm", "Nm", above(0, 10), "0.5", "largest torque of a joint", [](T t, V v) {
        t.scene.limits.joint_torque_enabled = !v.off;
        if (!v.off) t.scene.limits.joint_torque = v.number;
      }));
  keys.push_back(limit("limits.torque_rate_nm_per_s", "Nm/s", above(0, 10000), "10",
                       "fastest change of a joint's torque", [](T t, V v) {
                         t.scene.limits.torque_rate_enabled = !v.off;
                         if (!v.off) t.scene.limits.torque_rate = v.number;
                       }));
  keys.push_back(limit("limits.joint_speed_rad_per_s", "rad/s", above(0, 1000), "40",
                       "fastest believable joint; faster samples are slewed", [](T t, V v) {
                         t.scene.limits.joint_speed =
                             v.off ? std::numeric_limits<double>::infinity() : v.number;
                       }));
}

void add_stabiliser(std::vector<KeySpec>& keys) {
  keys.push_back(choice("stabiliser.method",
                        {"none", "smoothing", "rise_only", "direction", "low_pass", "kelvin_voigt",
                         "virtual_coupling", "passivity", "energy_bounding", "local_wall"},
                        "\"smoothing\"", "what keeps the loop through the device calm; docs/stabilisers.md",
                        [](T t, V v) { t.scene.stabiliser.method = static_cast<Stabiliser>(v.integer); }));
  keys.push_back(number("stabiliser.turn_deg_per_s", "deg/s", above(0, 1e6), "90",
                        "direction: fastest turn of a contact's force",
                        [](T t, V v) { t.scene.stabiliser.turn_rate = v.number * kDeg; }));
  keys.push_back(number("stabiliser.lowpass_hz", "Hz", between(0.001, 2000), "3",
                        "low_pass: corner of the low-pass on a contact's force",
                        [](T t, V v) { t.scene.stabiliser.lowpass_hz = v.number; }));
  keys.push_back(number("stabiliser.damping_ns_per_m", "N s/m", between(0, 1000), "4",
                        "kelvin_voigt: damping b beside the law",
                        [](T t, V v) { t.scene.stabiliser.damping = v.number; }));
  keys.push_back(number("stabiliser.coupling_stiffness_n_per_mm", "N/mm", between(0.001, 1000), "1",
                        "virtual_coupling: stiffness Kc between finger and proxy",
                        [](T t, V v) { t.scene.stabiliser.coupling_stiffness = v.number / kMm; }));
  keys.push_back(number("stabiliser.coupling_damping_ns_per_m", "N s/m", between(0, 1000), "4",
                        "virtual_coupling: damping Bc between finger and proxy",
                        [](T t, V v) { t.scene.stabiliser.coupling_damping = v.number; }));
  keys.push_back(number("stabiliser.passivity_damping_max_ns_per_m", "N s/m", between(0, 1000), "10",
                        "passivity: largest damping a of the controller",
                        [](T t, V v) { t.scene.stabiliser.passivity_damping_max = v.number; }));
  keys.push_back(number("stabiliser.device_damping_ns_per_m", "N s/m", between(0, 1000), "1.6",
                        "energy_bounding: the device's own damping b; no contact is stiffer than 2 b rate_hz",
                        [](T t, V v) { t.scene.stabiliser.device_damping = v.number; }));
  keys.push_back(number("stabiliser.wall_valid_ms", "ms", between(0.1, 1000), "14",
                        "local_wall: how long the controller may use a wall that the host has sent",
                        [](T t, V v) { t.scene.stabiliser.wall_valid = 1e-3 * v.number; }));
  keys.push_back(
      choice("oscillation.reaction", {"report", "halve"}, "\"report\"",
             "where a segment's force oscillates: say so, or halve the law's force as well (over 200 ms)",
             [](T t, V v) { t.scene.oscillation.reaction = static_cast<OscillationReaction>(v.integer); }));
  keys.push_back(number("oscillation.swing_n", "N", between(0.01, 15), "0.5",
                        "swing of a segment's force, from peak to peak, beyond which it counts",
                        [](T t, V v) { t.scene.oscillation.swing = v.number; }));
}

}  // namespace

void add_force_keys(std::vector<KeySpec>& keys) {
  add_contact_and_law(keys);
  add_smoothing_and_limits(keys);
  add_stabiliser(keys);
}

}  // namespace phalanx

// SPDX-License-Identifier: Apache-2.0
#include "scene/key_table.h"

#include <fmt/format.h>

#include <array>
#include <limits>
#include <numbers>

namespace phalanx {
namespace {

using T = const KeyTarget&;
using V = const KeyValue&;

constexpr double kMm = 1e-3;
constexpr double kDeg = std::numbers::pi / 180.0;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

constexpr NumberRange between(double min, double max) { return {.min = min, .max = max}; }
constexpr NumberRange above(double min, double max) { return {.min = min, .max = max, .min_open = true}; }

KeySpec number(std::string path, std::string unit, NumberRange range, std::string fallback,
               std::string meaning, std::function<void(T, V)> store) {
  return {std::move(path),     KeyType::kNumber,   std::move(unit),  range, {},
          std::move(fallback), std::move(meaning), std::move(store), ""};
}

KeySpec integer(std::string path, NumberRange range, std::string fallback, std::string meaning,
                std::function<void(T, V)> store) {
  return {std::move(path),    KeyType::kInteger, "", range, {}, std::move(fallback),
          std::move(meaning), std::move(store),  ""};
}

KeySpec choice(std::string path, std::vector<std::string> choices, std::string fallback, std::string meaning,
               std::function<void(T, V)> store) {
  return {std::move(path),    KeyType::kChoice, "", {}, std::move(choices), std::move(fallback),
          std::move(meaning), std::move(store), ""};
}

KeySpec vector(std::string path, std::string unit, NumberRange range, std::string fallback,
               std::string meaning, std::function<void(T, V)> store) {
  return {std::move(path),     KeyType::kVector,   std::move(unit),  range, {},
          std::move(fallback), std::move(meaning), std::move(store), ""};
}

KeySpec word(KeyType type, std::string path, std::string fallback, std::string meaning,
             std::function<void(T, V)> store) {
  return {std::move(path), type, "", {}, {}, std::move(fallback), std::move(meaning), std::move(store), ""};
}

KeySpec flag(std::string path, std::string fallback, std::string meaning, std::function<void(T, V)> store) {
  return word(KeyType::kFlag, std::move(path), std::move(fallback), std::move(meaning), std::move(store));
}

KeySpec limit(std::string path, std::string unit, NumberRange range, std::string fallback,
              std::string meaning, std::function<void(T, V)> store) {
  KeySpec spec = number(std::move(path), std::move(unit), range, std::move(fallback), std::move(meaning),
                        std::move(store));
  spec.type = KeyType::kNumberOrOff;
  return spec;
}

KeySpec for_kinds(std::string kinds, KeySpec spec,
                  std::vector<std::pair<std::string, std::string>> kind_defaults = {}) {
  spec.kinds = std::move(kinds);
  spec.kind_defaults = std::move(kind_defaults);
  return spec;
}

/// Roll, pitch, yaw in degrees:  R = Rz(yaw) Ry(pitch) Rx(roll).
Mat3 rotation_of(const Vec3& roll_pitch_yaw_deg) {
  const Vec3 angle = roll_pitch_yaw_deg * kDeg;
  return rotation_about(Vec3::UnitZ(), angle.z()) * rotation_about(Vec3::UnitY(), angle.y()) *
         rotation_about(Vec3::UnitX(), angle.x());
}

void add_general_and_hand(std::vector<KeySpec>& keys) {
  constexpr NumberRange kPlace = between(-10000, 10000);
  constexpr NumberRange kTurn = between(-360, 360);
  keys.push_back(word(KeyType::kText, "description", "\"\"", "one line about the scene",
                      [](T t, V v) { t.scene.description = v.text; }));
  keys.push_back(number("rate_hz", "Hz", between(1, 4000), "200", "ticks per second",
                        [](T t, V v) { t.scene.rate_hz = v.number; }));
  keys.push_back(number("seconds", "s", between(0, 86400), "0", "length of a simulation; 0: the motion's",
                        [](T t, V v) { t.scene.seconds = v.number; }));
  keys.push_back(integer("seed", between(0, 9007199254740992.0), "1",
                         "of everything random in the scene (the tremor)", [](T t, V v) {
                           t.scene.seed = static_cast<std::uint64_t>(v.integer);
                           t.scene.motion.script.seed = t.scene.seed;
                         }));
  keys.push_back(
      flag("mirror", "false",
           "the whole scene mirrored in the plane x = 0: the other hand, its place and every object",
           [](T t, V v) { t.scene.mirror = v.flag; }));
  keys.push_back(word(KeyType::kName, "hand.file", "\"adult\"", "the hand: a name in assets/hands, or a path",
                      [](T t, V v) { t.scene.hand.file = v.text; }));
  keys.push_back(choice(
      "hand.side", {"right", "left"}, "\"right\"", "which hand; a left one is the right one's mirror image",
      [](T t, V v) { t.scene.hand.handedness = v.integer == 0 ? Handedness::kRight : Handedness::kLeft; }));
  keys.push_back(word(KeyType::kName, "hand.profile", "",
                      "a patient's profile: a name in assets/profiles, or a path; it says hand.file and "
                      "hand.side, which may not be given beside it; a left hand's mirrors the scene",
                      [](T t, V v) { t.scene.hand.profile = v.text; }));
  keys.push_back(choice("hand.meshes", {"file", "capsules"}, "\"file\"",
                        "what the hand is made of: the hand file's meshes (capsules if it names none), or "
                        "capsules in any case",
                        [](T t, V v) {
                          t.scene.hand.mesh_source =
                              v.integer == 0 ? HandMeshSource::kFile : HandMeshSource::kCapsules;
                        }));
  keys.push_back(integer("hand.triangles", between(800, 2000000), "2250",
                         "capsules only: about how many triangles the 16 segments have together",
                         [](T t, V v) { t.scene.hand.triangles = static_cast<int>(v.integer); }));
  keys.push_back(vector("hand.position_mm", "mm", kPlace, "[0, 0, 0]", "the wrist's place in the world",
                        [](T t, V v) { t.scene.hand.pose.p = v.vector * kMm; }));
  keys.push_back(vector("hand.rotation_deg", "deg", kTurn, "[0, 0, 0]",
                        "the wrist's roll, pitch, yaw: R = Rz(yaw) Ry(pitch) Rx(roll); at 0 the fingers "
                        "point to -z, their backs to +y",
                        [](T t, V v) { t.scene.hand.pose.R = rotation_of(v.vector); }));
}

void add_objects(std::vector<KeySpec>& keys) {
  constexpr NumberRange kSize = above(0, 2000);
  keys.push_back(choice("objects[].kind",
                        {"teapot", "sphere", "box", "cylinder", "torus", "mug", "bottle", "key", "pen", "cup",
                         "therapy_ball", "putty_bar", "peg", "jar", "tap_handle", "file"},
                        "\"teapot\"", "the shape", [](T t, V v) { t.object.kind = v.text; }));
  keys.push_back(
      for_kinds("file", word(KeyType::kFile, "objects[].file", "", "a mesh file: .obj .3ds .stl .ply .glb",
                             [](T t, V v) { t.object.file = v.text; })));
  keys.push_back(for_kinds(
      "teapot file",
      number("objects[].size_mm", "mm", between(0, 2000), "100",
             "teapot: from handle to spout; file: its largest extent, 0 keeps its numbers as metres",
             [](T t, V v) { t.object.size = v.number * kMm; })));
  keys.push_back(
      for_kinds("file", choice("objects[].unit", {"m", "mm", "cm", "in"}, "\"m\"",
                               "what the file's numbers are; counts with size_mm = 0", [](T t, V v) {
                                 constexpr std::array<double, 4> kMetres = {1.0, 1e-3, 1e-2, 0.0254};
                                 t.object.unit = kMetres[static_cast<std::size_t>(v.integer)];
                               })));
  keys.push_back(
      for_kinds("file", integer("objects[].decimate_to", between(0, 10000000), "0",
                                "simplified to about this many triangles; 0 keeps the file's own",
                                [](T t, V v) { t.object.decimate_to = static_cast<int>(v.integer); })));
  keys.push_back(for_kinds(
      "sphere cylinder mug bottle cup pen therapy_ball peg jar tap_handle",
      number("objects[].diameter_mm", "mm", kSize, "60", "outer diameter",
             [](T t, V v) { t.object.diameter = v.number * kMm; }),
      {{"bottle", "65"}, {"cup", "75"}, {"pen", "10"}, {"therapy_ball", "70"}, {"peg", "9"}, {"jar", "80"}}));
  keys.push_back(
      for_kinds("cylinder mug bottle key cup pen peg jar tap_handle",
                number("objects[].length_mm", "mm", kSize, "100", "along the axis (z); key: along x",
                       [](T t, V v) { t.object.length = v.number * kMm; }),
                {{"bottle", "205"},
                 {"key", "57"},
                 {"cup", "90"},
                 {"pen", "140"},
                 {"peg", "32"},
                 {"jar", "110"},
                 {"tap_handle", "50"}}));
  keys.push_back(for_kinds("key", number("objects[].breadth_mm", "mm", kSize, "25", "of the bow, along y",
                                         [](T t, V v) { t.object.breadth = v.number * kMm; })));
  keys.push_back(for_kinds("key", number("objects[].thickness_mm", "mm", kSize, "2.2", "along z",
                                         [](T t, V v) { t.object.thickness = v.number * kMm; })));
  keys.push_back(
      for_kinds("therapy_ball", number("objects[].bump_mm", "mm", between(0, 300), "4",
                                       "height of the bumps, below the outer diameter; 0: a smooth ball",
                                       [](T t, V v) { t.object.bump = v.number * kMm; })));
  keys.push_back(for_kinds("peg", number("objects[].head_diameter_mm", "mm", between(0, 2000), "0",
                                         "of the grip at its upper end; 0: a plain dowel",
                                         [](T t, V v) { t.object.head_diameter = v.number * kMm; })));
  keys.push_back(for_kinds("jar", number("objects[].lid_diameter_mm", "mm", kSize, "70", "of the lid",
                                         [](T t, V v) { t.object.lid_diameter = v.number * kMm; })));
  keys.push_back(for_kinds(
      "torus", number("objects[].ring_diameter_mm", "mm", kSize, "80", "of the tube's centre line, around z",
                      [](T t, V v) { t.object.ring_diameter = v.number * kMm; })));
  keys.push_back(for_kinds(
      "torus", number("objects[].tube_diameter_mm", "mm", kSize, "20", "of the tube; below the ring's",
                      [](T t, V v) { t.object.tube_diameter = v.number * kMm; })));
  keys.push_back(
      for_kinds("box putty_bar",
                vector("objects[].extent_mm", "mm", kSize, "[50, 50, 50]", "full edge lengths along x, y, z",
                       [](T t, V v) { t.object.extent = v.vector * kMm; }),
                {{"putty_bar", "[100, 35, 30]"}}));
  keys.push_back(
      for_kinds("teapot sphere box cylinder torus mug bottle key pen cup therapy_ball putty_bar peg jar "
                "tap_handle",
                integer("objects[].triangles", between(8, 2000000), "1000", "about how many triangles it has",
                        [](T t, V v) { t.object.triangles = static_cast<int>(v.integer); })));
  keys.push_back(vector("objects[].position_mm", "mm", between(-10000, 10000), "[0, 0, 0]",
                        "the object's centre in the world",
                        [](T t, V v) { t.object.pose.p = v.vector * kMm; }));
  keys.push_back(vector("objects[].rotation_deg", "deg", between(-360, 360), "[0, 0, 0]",
                        "roll, pitch, yaw as for the hand",
                        [](T t, V v) { t.object.pose.R = rotation_of(v.vector); }));
}

void add_contact_and_force(std::vector<KeySpec>& keys) {
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
  keys.push_back(flag("smoothing.enabled", "true", "S2's force smoothing",
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
                       "fastest believable joint; faster samples are slewed",
                       [](T t, V v) { t.scene.limits.joint_speed = v.off ? kInfinity : v.number; }));
}

void add_motion(std::vector<KeySpec>& keys) {
  constexpr NumberRange kPause = between(0, 600);
  constexpr NumberRange kMove = between(0.01, 600);
  keys.push_back(choice("motion.name", scripted_motion_names(), "\"power_grasp\"", "the scripted motion",
                        [](T t, V v) { t.scene.motion.script.name = v.text; }));
  keys.push_back(number("motion.start_s", "s", kPause, "0.2", "wait at the open hand",
                        [](T t, V v) { t.scene.motion.script.start_s = v.number; }));
  keys.push_back(number("motion.close_s", "s", kMove, "1", "time to close",
                        [](T t, V v) { t.scene.motion.script.close_s = v.number; }));
  keys.push_back(number("motion.hold_s", "s", kPause, "1", "time to hold",
                        [](T t, V v) { t.scene.motion.script.hold_s = v.number; }));
  keys.push_back(number("motion.open_s", "s", kMove, "1", "time to open",
                        [](T t, V v) { t.scene.motion.script.open_s = v.number; }));
  keys.push_back(integer("motion.repeat", between(1, 1000), "1", "how many times",
                         [](T t, V v) { t.scene.motion.script.repeat = static_cast<int>(v.integer); }));
  keys.push_back(number("motion.closure", "", between(0, 1), "0.6",
                        "how far it closes: 0 stays open, 1 a full posture of its kind",
                        [](T t, V v) { t.scene.motion.script.closure = v.number; }));
  for (int digit = 0; digit < kDigits; ++digit) {
    const std::string name(digit_name(digit));
    keys.push_back(number("motion." + name, "", between(0, 10), "1",
                          "the " + name + "'s closure relative to motion.closure", [digit](T t, V v) {
                            t.scene.motion.script.digit_closure[static_cast<std::size_t>(digit)] = v.number;
                          }));
  }
  keys.push_back(number("motion.tremor_deg", "deg", between(0, 20), "0",
                        "bound of a 5-12 Hz tremor on every moving joint",
                        [](T t, V v) { t.scene.motion.script.tremor_rad = v.number * kDeg; }));
  keys.push_back(word(KeyType::kFile, "motion.file", "",
                      "a CSV to play instead of the scripted motion: time_s and joint angles in rad",
                      [](T t, V v) { t.scene.motion.file = v.text; }));
  keys.push_back(word(KeyType::kName, "motion.mapping", "",
                      "how the CSV's columns become joint angles: a name in assets/mappings, or a path",
                      [](T t, V v) { t.scene.motion.mapping = v.text; }));
  keys.push_back(integer("motion.trial", between(1, 1000000), "",
                         "which trial of a CSV that holds several, from 1",
                         [](T t, V v) { t.scene.motion.trial = static_cast<int>(v.integer); }));
}

}  // namespace

const std::vector<KeySpec>& key_table() {
  static const std::vector<KeySpec> kTable = [] {
    std::vector<KeySpec> keys;
    add_general_and_hand(keys);
    add_objects(keys);
    add_contact_and_force(keys);
    add_smoothing_and_limits(keys);
    add_motion(keys);
    return keys;
  }();
  return kTable;
}

const std::string& KeySpec::default_for(const std::string& kind) const {
  for (const auto& [name, value] : kind_defaults)
    if (name == kind) return value;
  return default_toml;
}

std::string range_text(const KeySpec& key) {
  switch (key.type) {
    case KeyType::kNumber:
    case KeyType::kInteger:
    case KeyType::kVector:
      return key.range.text();
    case KeyType::kNumberOrOff:
      return key.range.text() + ", or \"off\"";
    case KeyType::kChoice:
      return fmt::format("{}", fmt::join(key.choices, ", "));
    case KeyType::kFlag:
      return "true, false";
    default:
      return "";
  }
}

}  // namespace phalanx

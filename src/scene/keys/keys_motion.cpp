// SPDX-License-Identifier: Apache-2.0
// Keys of the grasp, and of the motion that a simulation plays.
#include "phalanx/grasp/grasp_type.h"
#include "scene/keys/key_rows.h"

namespace phalanx {
namespace {

using T = const KeyTarget&;
using V = const KeyValue&;

}  // namespace

void add_motion_keys(std::vector<SceneKey>& keys) {
  const KeyRows new_station(keys, ChangeKind::kNewStation);
  constexpr NumberRange kPause = between(0, 600);
  constexpr NumberRange kMove = between(0.01, 600);
  std::vector<std::string> types = grasp_type_names();
  types.insert(types.begin(), "none");
  new_station.choice(
      "grasp.type", std::move(types), "none",
      "type of the grasp that is planned for hand and objects, with the wrist's pose and the motion; none: "
      "the scene states them",
      [](T t, V v) {
        if (v.integer > 0) t.scene.grasp.type = static_cast<GraspType>(v.integer - 1);
      });
  new_station.flag("grasp.other_types", false,
                   "where hand and objects allow no grasp of grasp.type, the other types are tried in the "
                   "order of its choices",
                   [](T t, V v) { t.scene.grasp.other_types = v.flag; });
  new_station.integer("grasp.seed", between(0, 9007199254740992.0), 1, "seed of the search for a grasp",
                      [](T t, V v) { t.scene.grasp.seed = static_cast<std::uint64_t>(v.integer); });
  new_station.vector(
      "grasp.forearm", "", between(-1, 1), 0,
      "direction from the object to the elbow, in the world; the planned one is at most 45 degrees off; "
      "[0, 0, 0]: any",
      [](T t, V v) { t.scene.grasp.forearm = v.vector; });
  new_station.vector("grasp.palm", "", between(-1, 1), 0, "direction out of the palm, likewise",
                     [](T t, V v) { t.scene.grasp.palm = v.vector; });
  new_station.word(
      KeyType::kText, "grasp.planned_for", "",
      "checksum of the hand and the objects for which the scene states wrist and motion; for all others the "
      "grasp is planned when the scene is loaded",
      [](T t, V v) { t.scene.grasp.planned_for = v.text; });
  new_station.choice("motion.name", scripted_motion_names(), "power_grasp", "the scripted motion",
                     [](T t, V v) { t.scene.motion.script.name = v.text; });
  new_station.number("motion.start_s", "s", kPause, 0.2, "time with the open hand before it closes",
                     [](T t, V v) { t.scene.motion.script.start_s = v.number; });
  new_station.number("motion.close_s", "s", kMove, 1, "time to close",
                     [](T t, V v) { t.scene.motion.script.close_s = v.number; });
  new_station.number("motion.hold_s", "s", kPause, 1, "time to hold",
                     [](T t, V v) { t.scene.motion.script.hold_s = v.number; });
  new_station.number("motion.open_s", "s", kMove, 1, "time to open",
                     [](T t, V v) { t.scene.motion.script.open_s = v.number; });
  new_station.integer("motion.repeat", between(1, 1000), 1, "number of repetitions",
                      [](T t, V v) { t.scene.motion.script.repeat = static_cast<int>(v.integer); });
  new_station.number("motion.closure", "", between(0, 1), 0.6,
                     "how far the hand closes: 0 stays open, 1 is a full posture of the motion",
                     [](T t, V v) { t.scene.motion.script.closure = v.number; });
  for (int digit = 0; digit < kDigits; ++digit) {
    const std::string name(digit_name(digit));
    new_station.number("motion." + name, "", between(0, 10), 1,
                       "the " + name + "'s closure relative to motion.closure", [digit](T t, V v) {
                         t.scene.motion.script.digit_closure[static_cast<std::size_t>(digit)] = v.number;
                       });
  }
  for (int joint = 0; joint < kJoints; ++joint) {
    const std::string name(joint_name(joint));
    new_station.number("motion.angle_deg." + name, "deg", between(-180, 180), std::nullopt,
                       "posture: this joint's angle at closure 1; without it the joint stays open",
                       [joint](T t, V v) {
                         t.scene.motion.script.posture[static_cast<std::size_t>(joint)] = v.number * kDeg;
                       });
  }
  new_station.number("motion.tremor_deg", "deg", between(0, 20), 0,
                     "amplitude bound of a 5-12 Hz tremor on every moving joint",
                     [](T t, V v) { t.scene.motion.script.tremor_rad = v.number * kDeg; });
  new_station.word(KeyType::kFile, "motion.file", std::nullopt,
                   "a CSV to play instead of the scripted motion: time_s and joint angles in rad",
                   [](T t, V v) { t.scene.motion.file = v.text; });
  new_station.word(KeyType::kName, "motion.mapping", std::nullopt,
                   "conversion of the CSV's columns to joint angles: a name in assets/mappings, or a path",
                   [](T t, V v) { t.scene.motion.mapping = v.text; });
  new_station.integer("motion.trial", between(1, 1000000), std::nullopt,
                      "number of the trial, from 1, in a CSV with several",
                      [](T t, V v) { t.scene.motion.trial = static_cast<int>(v.integer); });
  new_station.number("motion.lead_in_s", "s", between(0, 10), 0,
                     "time for the way from the open hand to the CSV's first sample",
                     [](T t, V v) { t.scene.motion.lead_in_s = v.number; });
}
}  // namespace phalanx

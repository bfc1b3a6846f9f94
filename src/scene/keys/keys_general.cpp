// SPDX-License-Identifier: Apache-2.0
// Keys of the scene as a whole and of its hand.
#include "phalanx/force/parameter_ranges.h"
#include "scene/keys/key_rows.h"

namespace phalanx {
namespace {

using T = const KeyTarget&;
using V = const KeyValue&;

}  // namespace

const std::vector<std::string>& scene_purpose_names() {
  static const std::vector<std::string> kNames = {"exercise", "study", "benchmark"};
  return kNames;
}

void add_general_keys(std::vector<SceneKey>& keys) {
  const KeyRows at_zero_torque(keys, ChangeKind::kAtZeroTorque);
  const KeyRows new_station(keys, ChangeKind::kNewStation);
  constexpr NumberRange kPlace = between(-10000, 10000);
  constexpr NumberRange kTurn = between(-360, 360);
  at_zero_torque.word(KeyType::kText, "description", "", "one line about the scene",
                      [](T t, V v) { t.scene.description = v.text; });
  at_zero_torque.choice("purpose", scene_purpose_names(), "exercise",
                        "the cockpit shows the scenes of exercises as pictures",
                        [](T t, V v) { t.scene.purpose = static_cast<ScenePurpose>(v.integer); });
  new_station.number("rate_hz", "Hz", ranges::kRate, 200, "ticks per second",
                     [](T t, V v) { t.scene.parameters.rate_hz = v.number; });
  new_station.number("seconds", "s", between(0, 86400), 0, "length of a simulation; 0: the motion's",
                     [](T t, V v) { t.scene.seconds = v.number; });
  new_station.integer("seed", between(0, 9007199254740992.0), 1, "seed of the random numbers (tremor)",
                      [](T t, V v) {
                        t.scene.seed = static_cast<std::uint64_t>(v.integer);
                        t.scene.motion.script.seed = t.scene.seed;
                      });
  new_station.flag("mirror", false,
                   "mirrors the whole scene in the plane x = 0: the other hand, its place and every object",
                   [](T t, V v) { t.scene.mirror = v.flag; });
  new_station.word(KeyType::kName, "hand.file", "adult", "the hand: a name in assets/hands, or a path",
                   [](T t, V v) { t.scene.hand.file = v.text; });
  new_station.choice("hand.side", {"right", "left"}, "right",
                     "side of the hand; a left hand is the mirror image of the right one", [](T t, V v) {
                       t.scene.hand.handedness = v.integer == 0 ? Handedness::kRight : Handedness::kLeft;
                     });
  new_station.word(KeyType::kName, "hand.profile", std::nullopt,
                   "a patient's profile: a name in assets/profiles, or a path; it replaces hand.file and "
                   "hand.side, which must not be stated too; the profile of a left hand mirrors the scene",
                   [](T t, V v) { t.scene.hand.profile = v.text; });
  new_station.choice(
      "hand.coupling", {"file", "none"}, "file",
      "rotations that follow from the joints' angles (the thumb's pronation, the palm's arch): those of the "
      "hand file, or none",
      [](T t, V v) { t.scene.hand.coupling = v.integer == 0 ? HandCoupling::kFile : HandCoupling::kNone; });
  new_station.choice(
      "hand.meshes", {"file", "capsules"}, "file",
      "source of the hand's meshes: the hand file (capsules if it names none), or capsules in any case",
      [](T t, V v) {
        t.scene.hand.mesh_source = v.integer == 0 ? HandMeshSource::kFile : HandMeshSource::kCapsules;
      });
  new_station.integer("hand.triangles", between(800, 2000000), 2250,
                      "capsules only: approximate number of triangles of the 16 segments together",
                      [](T t, V v) { t.scene.hand.triangles = static_cast<int>(v.integer); });
  new_station.vector("hand.position_mm", "mm", kPlace, 0, "position of the wrist in the world",
                     [](T t, V v) { t.scene.hand.pose.p = v.vector * kMm; });
  new_station.vector("hand.rotation_deg", "deg", kTurn, 0,
                     "the wrist's roll, pitch, yaw: R = Rz(yaw) Ry(pitch) Rx(roll); at 0 the fingers "
                     "point to -z, their backs to +y",
                     [](T t, V v) { t.scene.hand.pose.R = rotation_of(v.vector); });
}
}  // namespace phalanx

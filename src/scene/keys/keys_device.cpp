// SPDX-License-Identifier: Apache-2.0
// Keys of the simulated exoskeleton and patient. Every other key below them is the named file's own.
#include "scene/keys/key_rows.h"

namespace phalanx {
namespace {

using T = const KeyTarget&;
using V = const KeyValue&;

}  // namespace

void add_device_keys(std::vector<SceneKey>& keys) {
  const KeyRows new_station(keys, ChangeKind::kNewStation);
  new_station.word(
      KeyType::kName, "device.file", "beihang",
      "the simulated exoskeleton: a name in assets/devices, or a path; any other key below `device.` "
      "overlays that key of the file, e.g. `device.scale.sheath_friction` (docs/device-file.md)",
      [](T t, V v) { t.scene.device.file = v.text; });
  new_station.word(
      KeyType::kName, "patient.file", "adult",
      "the simulated patient: a name in assets/patients, or a path; any other key below `patient.` "
      "overlays that key of the file, e.g. `patient.press_n` (docs/device-file.md)",
      [](T t, V v) { t.scene.patient.file = v.text; });
}

}  // namespace phalanx

// SPDX-License-Identifier: Apache-2.0
#include "phalanx/study/laboratory/scene_inputs.h"

#include <filesystem>
#include <string>
#include <utility>

#include "phalanx/scene/data_paths.h"
#include "phalanx/scene/device_file.h"
#include "phalanx/scene/hand_file.h"
#include "phalanx/scene/patient_file.h"
#include "phalanx/scene/profile_file.h"
#include "phalanx/scene/scene_file.h"
#include "phalanx/study/laboratory/study_file.h"

namespace phalanx {
namespace {

namespace fs = std::filesystem;
using Files = std::vector<fs::path>;

void add_hand(const HandDescription& hand, Files& files) {
  std::string file = hand.file;
  fs::path folder = fs::current_path();
  if (!hand.profile.empty()) {
    files.push_back(find_data_file("profile", hand.profile, "assets/profiles", ".toml", folder));
    const Profile profile = load_profile(hand.profile);
    file = profile.hand;
    folder = profile.folder;
  }
  files.push_back(find_data_file("hand", file, "assets/hands", ".toml", folder));
  const HandFile read = read_hand_file(file, folder);
  if (!read.meshes || hand.mesh_source == HandMeshSource::kCapsules) return;
  for (int segment = 0; segment < kSegments; ++segment)
    files.push_back(HandMeshFiles::of_segment(read.meshes->collision, segment));
}

void add_motion(const MotionDescription& motion, Files& files) {
  if (motion.file.empty()) return;
  files.push_back(motion.file);
  if (motion.mapping.empty()) return;
  files.push_back(find_data_file("mapping", motion.mapping, "assets/mappings", ".toml", fs::current_path()));
}

}  // namespace

StudyCheck scene_check(const Study& study) {
  return [name = scene_of(study)](const Overrides& overrides) {
    const SceneDescription scene = SceneFile(name).scene(overrides);
    StudyInputs inputs;
    inputs.text = device_text(scene) + patient_text(scene);
    inputs.read = device_files(scene);
    for (auto& file : patient_files(scene)) inputs.read.push_back(std::move(file));
    inputs.files.push_back(find_data_file("scene", name, "scenes", ".toml", fs::current_path()));
    add_hand(scene.hand, inputs.files);
    add_motion(scene.motion, inputs.files);
    for (const ObjectDescription& object : scene.objects) {
      if (object.kind == "file") inputs.files.push_back(object.file);
    }
    return inputs;
  };
}

}  // namespace phalanx

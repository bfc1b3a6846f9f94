// SPDX-License-Identifier: Apache-2.0
#include "phalanx/scene/patient_file.h"

#include <fmt/format.h>

#include "phalanx/core/constants.h"
#include "scene/toml/layered_file.h"

namespace phalanx {
namespace {

constexpr double kMicro = 1e-6;
constexpr NumberRange kFactor = {.min = 0.0, .max = 1e3};

void read_joint(TomlTable table, int joint, PatientParameters& patient) {
  const auto j = static_cast<std::size_t>(joint);
  patient.stiffness[j] = table.number("stiffness_nm_per_rad", between(0.0, 1e4));
  patient.damping[j] = table.number_or("damping_nms_per_rad", between(0.0, 1e3), 0.0);
  table.finish();
}

void read_intent(TomlTable& root, PatientParameters& patient) {
  patient.press = root.number_or("press_n", between(0.0, 100.0), patient.press);
  patient.press_spread = root.number_or("press_spread", between(0.0, 1.0), patient.press_spread);
  patient.approach_min =
      root.number_or("approach_min_mm_per_s", above(0.0, 10e3), patient.approach_min / kMilli) * kMilli;
  patient.approach_max =
      root.number_or("approach_max_mm_per_s", above(0.0, 10e3), patient.approach_max / kMilli) * kMilli;
}

void read_disturbances(TomlTable& root, PatientParameters& patient) {
  patient.tremor = root.number_or("tremor_um", between(0.0, 1e5), patient.tremor / kMicro) * kMicro;
  patient.tremor_min_hz = root.number_or("tremor_min_hz", above(0.0, 100.0), patient.tremor_min_hz);
  patient.tremor_max_hz = root.number_or("tremor_max_hz", above(0.0, 100.0), patient.tremor_max_hz);
  patient.bump = root.number_or("bump_n", between(0.0, 100.0), patient.bump);
  patient.bump_start = root.number_or("bump_start_s", between(0.0, 86400.0), patient.bump_start);
  patient.bump_duration =
      root.number_or("bump_duration_ms", between(0.0, 1e6), patient.bump_duration / kMilli) * kMilli;
}

void apply_scale(TomlTable table, PatientParameters& patient) {
  const double stiffness = table.number_or("stiffness", kFactor, 1.0);
  const double damping = table.number_or("damping", kFactor, 1.0);
  patient.tremor *= table.number_or("tremor", kFactor, 1.0);
  patient.bump *= table.number_or("bump", kFactor, 1.0);
  table.finish();
  for (double& k : patient.stiffness) k *= stiffness;
  for (double& b : patient.damping) b *= damping;
}

PatientParameters read_patient(const LayeredFile& file) {
  TomlTable root = file.root();
  PatientParameters patient;
  patient.name = std::filesystem::path(file.origin()).stem().string();
  if (root.has("description")) patient.description = root.text("description");
  TomlTable joints = root.table("joints");
  for (int j = 0; j < kJoints; ++j)
    if (joints.has(joint_name(j))) read_joint(joints.table(joint_name(j)), j, patient);
  joints.finish();
  read_intent(root, patient);
  read_disturbances(root, patient);
  static_cast<void>(root.has("base"));  // known, although already handled, like the scales
  static_cast<void>(root.has("scale"));
  root.finish();
  for (const TomlTable& scale : file.scales()) apply_scale(scale, patient);
  try {
    check_patient(patient);
  } catch (const std::invalid_argument& error) {
    throw SceneError(fmt::format("{}: {}", file.in_words(), error.what()));
  }
  return patient;
}

}  // namespace

PatientParameters load_patient(const SceneDescription& scene) {
  LayeredFile file("patient");
  file.add_file(scene.patient.file, ".", scene.patient.stated_at);
  file.add_overlay(scene.patient.overlay);
  return read_patient(file);
}

std::vector<std::filesystem::path> patient_files(const SceneDescription& scene) {
  LayeredFile file("patient");
  file.add_file(scene.patient.file, ".", scene.patient.stated_at);
  return file.files();
}

PatientParameters load_patient_file(const std::string& name_or_path, const std::filesystem::path& folder) {
  LayeredFile file("patient");
  file.add_file(name_or_path, folder);
  return read_patient(file);
}

PatientParameters parse_patient(const std::string& text, const std::string& origin,
                                const std::filesystem::path& folder) {
  LayeredFile file("patient");
  file.add_text(text, origin, folder);
  return read_patient(file);
}

}  // namespace phalanx

// SPDX-License-Identifier: Apache-2.0
#include "phalanx/scene/scene_grasp.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <utility>

#include "phalanx/core/constants.h"
#include "phalanx/core/index.h"
#include "phalanx/scene/scene_file.h"

namespace phalanx {
namespace {

/// 64-bit FNV-1a hash of numbers in whole steps.
class StepHash {
 public:
  void add(std::int64_t value) {
    auto bits = static_cast<std::uint64_t>(value);
    for (int byte = 0; byte < 8; ++byte, bits >>= 8) hash_ = (hash_ ^ (bits & 0xffU)) * 0x100000001b3U;
  }
  /// @param number  [m] or [rad]
  void add_number(double number) { add(std::llround(number * 1e6)); }
  /// Adds a vector that has the same hash as its mirror image.
  void add_mirrored(const Vec3& v) {
    add_number(std::abs(v.x()));
    add_number(v.y());
    add_number(v.z());
  }
  void add_mesh(const TriangleMesh& mesh) {
    add(std::ssize(mesh.vertices));
    for (const Vec3& vertex : mesh.vertices) add_mirrored(vertex);
  }
  [[nodiscard]] std::string text() const { return fmt::format("{:016x}", hash_); }

 private:
  std::uint64_t hash_ = 0xcbf29ce484222325U;
};

std::string vector_text(const Vec3& v, int digits) {
  return fmt::format("[{:.{}f}, {:.{}f}, {:.{}f}]", v.x(), digits, v.y(), digits, v.z(), digits);
}

/// Roll, pitch and yaw of a rotation in degrees: R = Rz(yaw) Ry(pitch) Rx(roll). At a pitch of +-90 degrees, where only
/// the sum or difference of roll and yaw counts, the roll is 0.
Vec3 roll_pitch_yaw_deg(const Mat3& R) {
  const double pitch = std::atan2(-R(2, 0), std::hypot(R(2, 1), R(2, 2)));
  const double roll = std::hypot(R(2, 1), R(2, 2)) > 1e-9 ? std::atan2(R(2, 1), R(2, 2)) : 0.0;
  const double sine = std::sin(roll);
  const double cosine = std::cos(roll);
  const double yaw = std::atan2(sine * R(0, 2) - cosine * R(0, 1), cosine * R(1, 1) - sine * R(1, 2));
  return kRadToDeg * Vec3(roll, pitch, yaw);
}

}  // namespace

std::string grasp_checksum(const GraspDescription& grasp, const LoadedHand& hand, const TriangleMesh& world,
                           bool mirrored) {
  StepHash hash;
  hash.add(static_cast<std::int64_t>(grasp.type.value()));
  if (grasp.other_types) hash.add(1);
  hash.add(static_cast<std::int64_t>(grasp.seed));
  hash.add((hand.handedness == Handedness::kLeft) != mirrored ? 1 : 0);
  for (const Vec3& direction : {grasp.forearm, grasp.palm})
    for (const double number : {direction.x(), direction.y(), direction.z()}) hash.add_number(number);
  const HandParameters& numbers = hand.parameters;
  for (const DigitParameters& digit : numbers.digits) {
    for (const Vec3& v :
         {digit.base, digit.distal, digit.dorsal, digit.metacarpal_base, digit.metacarpal_axis})
      hash.add_mirrored(v);
    for (const DhRow& row : digit.dh)
      for (const double number : {row.a, row.alpha, row.d, row.theta}) hash.add_number(number);
    for (const double number : {digit.coupling.pronation_per_flexion, digit.coupling.pronation_per_abduction,
                                digit.coupling.metacarpal_per_flexion})
      hash.add_number(number);
  }
  for (const JointArray* angles : {&numbers.min_angle, &numbers.max_angle, &numbers.open_angle})
    for (const double angle : *angles) hash.add_number(angle);
  for (const TriangleMesh& mesh : hand.meshes.collision) hash.add_mesh(mesh);
  hash.add_mesh(world);
  return hash.text();
}

Overrides grasp_values(const PlannedGrasp& grasp, bool mirrored, const std::string& checksum) {
  Pose X_WH = grasp.X_WH;
  if (mirrored) {
    const Mat3 mirror = Vec3(-1.0, 1.0, 1.0).asDiagonal();
    X_WH.p = mirror * X_WH.p;
    X_WH.R = mirror * X_WH.R * mirror;
  }
  Overrides values;
  values.emplace_back("grasp.planned_for", toml_string(checksum));
  values.emplace_back("motion.name", toml_string("posture"));
  values.emplace_back("hand.position_mm", vector_text(X_WH.p / kMm, 4));
  values.emplace_back("hand.rotation_deg", vector_text(roll_pitch_yaw_deg(X_WH.R), 5));
  for (int j = 0; j < kJoints; ++j)
    values.emplace_back(fmt::format("motion.angle_deg.{}", joint_name(j)),
                        fmt::format("{:.3f}", grasp.press[idx(j)] * kRadToDeg));
  return values;
}

GraspSearch search_grasp(const ResolvedScene& scene, GraspType type, std::function<bool(double)> progress) {
  const GraspDescription& grasp = scene.description.grasp;
  const HandModel hand(scene.hand.parameters, scene.hand.handedness, Pose{}, scene.hand.meshes.collision);
  const ObjectModel object(scene.world, ObjectModel::kDefaultCreaseAngle, scene.friction);
  const Vec3 side(scene.mirrored ? -1.0 : 1.0, 1.0, 1.0);
  return plan_grasp(hand, object,
                    {.type = type,
                     .seed = grasp.seed,
                     .forearm = side.cwiseProduct(grasp.forearm),
                     .palm = side.cwiseProduct(grasp.palm),
                     .parameters = scene.description.parameters,
                     .progress = std::move(progress)});
}

}  // namespace phalanx

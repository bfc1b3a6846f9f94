// SPDX-License-Identifier: Apache-2.0
// Prints a hash over the bits of all forces and torques of a scripted motion, for every stabiliser and both
// contact modes. Programs that were compiled with other options than the library print the same. They share
// meshes, hands and snapshots with it, and use Eigen's aligned types and heap matrices of their own beside them.
#include <Eigen/Dense>

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <utility>
#include <vector>

#include "phalanx/mesh/objects.h"
#include "phalanx/mesh/primitives.h"
#include "phalanx/step/haptic_step.h"

using namespace phalanx;

namespace {

class Hash {
 public:
  void add(double value) noexcept {
    for (std::uint64_t bits = std::bit_cast<std::uint64_t>(value), i = 0; i < 8; ++i, bits >>= 8U)
      hash_ = (hash_ ^ (bits & 0xffU)) * 0x100000001b3ULL;
  }
  void add(const Vec3& v) noexcept {
    for (const double value : v) add(value);
  }
  [[nodiscard]] std::uint64_t value() const noexcept { return hash_; }

 private:
  std::uint64_t hash_ = 0xcbf29ce484222325ULL;
};

double law(void* /*user*/, double depth, double speed) noexcept { return 600.0 * depth + 0.5 * speed; }
double halve(void* /*user*/, const StabiliserInput& input, StabiliserMemory& memory) noexcept {
  return memory.own[0] = 0.5 * (input.force + memory.own[0]);
}

/// What a program does beside Phalanx: aligned types of fixed size and on the heap.
double work_of_the_program() {
  std::vector<Eigen::Matrix4d, Eigen::aligned_allocator<Eigen::Matrix4d>> turns(
      64, Eigen::Isometry3d(Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitX())).matrix());
  Eigen::Matrix4d product = Eigen::Matrix4d::Identity();
  for (const Eigen::Matrix4d& turn : turns) product *= turn;
  const Eigen::MatrixXd square = Eigen::MatrixXd::Constant(33, 33, product(1, 1));
  return (square * square).sum() + Eigen::VectorXd::LinSpaced(1001, 0.0, 1.0).squaredNorm();
}

void grasp(const HapticModel& model, const HapticParameters& parameters, Hash& hash, double& largest) {
  HapticState state(model, parameters);
  for (Sample sample; sample.time_s < 1.5; sample.time_s += parameters.period()) {
    const double closed = 0.5 - 0.5 * std::cos(4.0 * sample.time_s);
    for (int digit = 0; digit < kDigits; ++digit) {
      sample.angle[static_cast<std::size_t>(joint_index(digit, 0))] = 0.7 * closed;
      sample.angle[static_cast<std::size_t>(joint_index(digit, 2))] = (0.5 + 0.05 * digit) * closed;
    }
    step(model, parameters, sample, state);
    for (const double torque : state.snapshot().torque) hash.add(torque);
    for (const SegmentSnapshot& segment : state.snapshot().segment) {
      hash.add(segment.force);
      hash.add(segment.force * segment.normal);
      hash.add(segment.friction);
      largest = std::max(largest, segment.force);
    }
    for (const Pose& pose : state.snapshot().gdp_pose) hash.add(pose.p);
  }
}

}  // namespace

int main() {
  const double before = work_of_the_program();
  TriangleMesh ball;
  append(ball, make_sphere(0.07, 1500), {.p = {0.0, -0.05, -0.13}});
  TriangleMesh copy = ball;  // allocated here, freed in the library
  const HandModel hand = make_hand_model(straight_hand(), Handedness::kRight, {}, 2000);
  SegmentMeshes meshes = hand.meshes();
  const HapticModel model(HandModel(hand.parameters(), Handedness::kRight, {}, std::move(meshes)),
                          ObjectModel(std::move(copy)));
  Hash hash;
  double largest = 0.0;
  for (const ContactMode mode : {ContactMode::kStatic, ContactMode::kSliding}) {
    for (int method = 0; method <= static_cast<int>(Stabiliser::kOwn); ++method) {
      HapticParameters parameters;
      parameters.contact.mode = mode;
      parameters.stabiliser.method = static_cast<Stabiliser>(method);
      parameters.stabiliser.own.function = halve;
      if (parameters.stabiliser.method == Stabiliser::kOwn) parameters.force.law = ForceLaw::kOwn;
      parameters.force.own.function = law;
      grasp(model, parameters, hash, largest);
    }
  }
  if (!(largest > 0.5) || !(before > 0.0)) return 1;
  std::printf("%016llx\n", static_cast<unsigned long long>(hash.value()));
}

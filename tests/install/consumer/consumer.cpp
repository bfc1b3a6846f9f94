// SPDX-License-Identifier: Apache-2.0
// Uses phalanx::phalanx as installed: a straight hand of round numbers whose index finger presses on a box,
// one step at a time.
#include <cmath>
#include <cstdio>
#include <utility>

#include "phalanx/mesh/primitives.h"
#include "phalanx/step/haptic_step.h"

namespace {

phalanx::HandParameters straight_hand() {
  phalanx::HandParameters hand;
  hand.name = "straight";
  constexpr double kQuarterTurn = 1.5707963267948966;
  for (std::size_t d = 0; d < phalanx::kDigits; ++d) {
    auto& digit = hand.digits[d];
    digit.base = phalanx::Vec3(0.05 * static_cast<double>(d), 0.0, 0.0);
    digit.dh[0].alpha = kQuarterTurn;
    digit.dh[1] = {.a = 0.040, .alpha = -kQuarterTurn};
    digit.dh[2].a = 0.025;
    digit.dh[3].a = 0.020;
    hand.segments[3 * d] = {.length = 0.040, .radius_base = 0.008, .radius_tip = 0.007};
    hand.segments[3 * d + 1] = {.length = 0.025, .radius_base = 0.007, .radius_tip = 0.006};
    hand.segments[3 * d + 2] = {.length = 0.020, .radius_base = 0.006, .radius_tip = 0.005};
  }
  hand.palm = {.length = 0.08,
               .wrist_breadth = 0.06,
               .wrist_thickness = 0.03,
               .knuckle_breadth = 0.08,
               .knuckle_thickness = 0.025,
               .offset = phalanx::Vec3(0.0, 0.0, 0.15)};
  hand.min_angle.fill(-0.5);
  hand.max_angle.fill(1.5);
  return hand;
}

}  // namespace

int main() {
  // The box lies below the index finger (-Y is where flexion goes), 10 mm under its middle line's skin.
  phalanx::TriangleMesh box;
  phalanx::append(box, phalanx::make_box(phalanx::Vec3(0.03, 0.02, 0.06), 100),
                  phalanx::Pose{phalanx::Mat3::Identity(), phalanx::Vec3(0.05, -0.028, -0.07)});
  const phalanx::HapticModel model(
      phalanx::make_hand_model(straight_hand(), phalanx::Handedness::kRight, {}, 2000),
      phalanx::ObjectModel(std::move(box)));
  const phalanx::HapticParameters parameters;
  phalanx::HapticState state(model, parameters);

  const auto flexion = static_cast<std::size_t>(*phalanx::find_joint("index_mcp_flexion"));
  phalanx::Sample sample;
  for (int tick = 1; tick <= 100; ++tick) {
    sample.time_s = tick / parameters.rate_hz;
    sample.angle[flexion] = 0.006 * tick;
    phalanx::step(model, parameters, sample, state);
  }
  const double hcp = state.snapshot().hcp_angle[flexion];
  const double gdp = state.snapshot().gdp_angle[flexion];
  const double torque = state.snapshot().torque[flexion];
  std::printf("flexion measured %.4f rad, shown %.4f rad, torque %.4f Nm\n", hcp, gdp, torque);
  // The box stops the finger that is shown, and pushes the finger open.
  return hcp > 0.5 && gdp < hcp - 0.05 && torque < -1e-3 && std::isfinite(torque) ? 0 : 1;
}

// SPDX-License-Identifier: Apache-2.0
// An object of your own from vertex and index arrays, as an engine or a mesh library holds them, and a hand
// of a person's length. No file is read. A wrong index or a coordinate that is not finite is refused in words.
#include <array>
#include <cstdint>
#include <cstdio>
#include <stdexcept>

#include "phalanx/hand/fit.h"
#include "phalanx/mesh/triangle_mesh.h"
#include "phalanx/step/haptic_step.h"

using namespace phalanx;

int main() {
  // A wedge below the fingers: its ridge runs across them, 6 mm below. World frame, metres.
  const std::array coordinates{-0.06, -0.050, -0.10, 0.06, -0.050, -0.10,   // front edge
                               -0.06, -0.050, -0.20, 0.06, -0.050, -0.20,   // rear edge
                               -0.06, -0.015, -0.15, 0.06, -0.015, -0.15};  // ridge
  std::array<std::int32_t, 24> indices{0, 1, 5, 0, 5, 4, 3, 2, 4, 3, 4, 5,
                                       0, 4, 2, 1, 3, 5, 0, 2, 3, 0, 3, 1};
  const TriangleMesh wedge = mesh_from_arrays(coordinates, indices);
  std::printf("closed: %s, volume %.1f cm^3\n", is_closed(wedge) ? "yes" : "no", 1e6 * signed_volume(wedge));

  const HandParameters base = straight_hand();
  HandSize size;
  size.hand_length = 0.193;  // [m]; everything else is scaled in proportion
  const HandModel hand =
      make_hand_model(fitted_parameters(base, fit_hand(base, size)), Handedness::kLeft, {}, 2000);

  const HapticModel model(hand, ObjectModel(wedge));
  const HapticParameters parameters;
  HapticState state(model, parameters);
  for (Sample sample; sample.time_s < 1.0; sample.time_s += parameters.period()) {
    for (int digit = 1; digit < kDigits; ++digit) sample.angle[joint_index(digit, 0)] = 0.5 * sample.time_s;
    step(model, parameters, sample, state);
  }
  int touching = 0;
  for (const SegmentSnapshot& segment : state.snapshot().segment) touching += segment.force > 0.0 ? 1 : 0;
  std::printf("%d segments press on the wedge\n", touching);

  indices[4] = 17;
  try {
    (void)mesh_from_arrays(coordinates, indices);
  } catch (const std::invalid_argument& error) {
    std::printf("refused: %s\n", error.what());
    return is_closed(wedge) && signed_volume(wedge) > 0.0 && touching > 0 ? 0 : 1;
  }
  return 1;
}

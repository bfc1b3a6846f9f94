// SPDX-License-Identifier: Apache-2.0
// Conversion of the program's types to the views of the search's inner loops.
#pragma once

#include <cassert>

#include "contact/search/search_functions.h"
#include "phalanx/contact/proximity.h"

namespace phalanx::search {

[[nodiscard]] inline ObjectView view_of(const ObjectTree& object) noexcept {
  return {object.nodes(), object.blocks(), object.size()};
}

/// Begins a new query of the segment at its pose. Real-time.
[[nodiscard]] inline SegmentView view_of(const PlacedSegment& segment, const ObjectTree& object) noexcept {
  assert(segment.scratch.fits(segment.tree));
  SegmentView view;
  view.nodes = segment.tree.nodes();
  view.triangles = segment.tree.triangles();
  view.lenses = segment.scratch.lenses();
  view.placed = segment.scratch.triangles();
  view.query = segment.scratch.next_query();
  const Vec3 relative = segment.X_WS.p - object.centre();
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      view.R[i][j] = segment.X_WS.R(i, j);
      view.lens_R[i][j] = static_cast<float>(view.R[i][j]);
    }
    view.p[i] = segment.X_WS.p[i];
    view.object_centre[i] = object.centre()[i];
    view.lens_p[i] = static_cast<float>(relative[i]);
  }
  // Single precision rounds by 6e-8 of the value, about a dozen times.
  const double held = relative.cwiseAbs().maxCoeff() + segment.tree.extent() + object.extent();
  view.slack = static_cast<float>(2e-6 * held);
  return view;
}

[[nodiscard]] inline MotionView view_of(const SegmentMotion& motion) noexcept {
  MotionView view;
  for (int i = 0; i < 3; ++i) {
    view.angular[i] = motion.angular[i];
    view.linear[i] = motion.linear[i];
    view.angular_rate[i] = motion.angular_rate[i];
    view.linear_rate[i] = motion.linear_rate[i];
  }
  view.speed = motion.speed;
  view.bend = motion.bend;
  view.jerk = motion.jerk;
  return view;
}

}  // namespace phalanx::search

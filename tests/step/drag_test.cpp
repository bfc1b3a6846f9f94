// SPDX-License-Identifier: Apache-2.0
// A finger is drawn slowly across an object: from tick to tick its force changes by its own motion, and by
// what is inherent in contacts that do not slide.
#include <gmock/gmock.h>

#include <algorithm>
#include <cstdio>
#include <numbers>
#include <vector>

#include "phalanx/mesh/primitives.h"
#include "support/lone_finger.h"
#include "support/sanitized.h"
#include "support/sheets.h"

namespace phalanx {
namespace {

using test::Approach;
using test::LoneFinger;

constexpr double kDragStiffness = 1000.0;  // LoneFinger's
const Vec3 kDragY = Vec3::UnitY();
const Vec3 kDragZ = Vec3::UnitZ();

/// A finger drawn slowly across, 10 mm/s at 1 kHz, by turning its abduction; the first joint keeps the
/// fingertip at a height over the touching one, which a series of presses has found.
class Drag {
 public:
  Drag(TriangleMesh mesh, const Approach& approach) : finger_(ObjectModel(std::move(mesh))) {
    const double start = finger_.aim(approach);
    const double stroke = 2.0 * std::asin(0.5 * approach.reach / LoneFinger::lever());
    for (int i = 0; i <= kWays; ++i) {
      test::Runner hand(finger_.model());
      hand.tick(LoneFinger::pose(start));
      hand.move(LoneFinger::pose(start, abduction(i)), 20);
      double touched = start;
      for (int n = 1; n <= 80 && LoneFinger::contacts(hand.now()) == 0; ++n) {
        hand.tick(LoneFinger::pose(start + stroke * n / 80.0, abduction(i)));
        touched = test::index_gdp(hand.now(), 0);
      }
      touched_.push_back(touched);
    }
    start_ = start;
  }

  struct Result {
    int ticks = 0;
    int contacts = 0;      ///< begun
    int slips = 0;         ///< a contact let go and another began in the same tick
    double largest = 0.0;  ///< change of the force in a tick beside slips, over k times the HCP's own motion
    double largest_slip = 0.0;   ///< [N]
    double largest_force = 0.0;  ///< [N]
  };

  /// @param depth  of the fingertip below the touching height, as a function of time [m]
  template <class Depth>
  Result run(Depth&& depth) {
    Result result;
    test::Runner hand(finger_.model());
    hand.tick(LoneFinger::pose(start_));
    hand.move(LoneFinger::pose(start_, abduction(0)), 100);
    const double width = (kTo - kFrom) * LoneFinger::lever();
    const int ticks = static_cast<int>(width / 10e-3 * 1000.0);
    Snapshot last = hand.now();
    for (int n = -200; n <= ticks; ++n) {  // first down to the surface
      const double at = std::clamp(static_cast<double>(n) / ticks, 0.0, 1.0) * kWays;
      const int i = std::min(static_cast<int>(at), kWays - 1);
      const auto k = static_cast<std::size_t>(i);
      const double ground = touched_[k] + (at - i) * (touched_[k + 1] - touched_[k]);
      const double below =
          n < 0 ? ground - (ground - start_) * n / -200.0 : ground + depth(n * 1e-3) / LoneFinger::lever();
      const Snapshot& now = hand.tick(LoneFinger::pose(below, kFrom + (kTo - kFrom) * at / kWays));
      const SegmentSnapshot& a = test::index_segment(last, 2);
      const SegmentSnapshot& b = test::index_segment(now, 2);
      const double change = (b.force * b.normal - a.force * a.normal).norm();
      const std::size_t tip = static_cast<std::size_t>(segment_index(test::kIndex, 2));
      const Vec3 p_S = now.gdp_pose[tip].inverse() * b.point;
      const double moved = (now.hcp_pose[tip] * p_S - last.hcp_pose[tip] * p_S).norm();
      const bool slip =
          a.contact && a.force > 0.0 && b.contact && (a.normal != b.normal || a.point != b.point);
      if (b.contact && !a.contact) ++result.contacts;
      if (slip) {
        ++result.slips;
        result.largest_slip = std::max(result.largest_slip, change);
      } else if (b.contact || a.contact) {
        const Vec3 q_S = last.gdp_pose[tip].inverse() * a.point;
        const double moved_a = (now.hcp_pose[tip] * q_S - last.hcp_pose[tip] * q_S).norm();
        const double own = kDragStiffness * std::max(b.contact ? moved : 0.0, a.contact ? moved_a : 0.0);
        if (change > 0.0) result.largest = std::max(result.largest, own > 0.0 ? change / own : 1e9);
      }
      result.largest_force = std::max(result.largest_force, b.force);
      ++result.ticks;
      last = now;
    }
    return result;
  }

 private:
  static constexpr int kWays = 200;
  static constexpr double kFrom = -0.15;
  static constexpr double kTo = 0.15;
  static double abduction(int i) { return kFrom + (kTo - kFrom) * i / kWays; }

  LoneFinger finger_;
  std::vector<double> touched_;
  double start_ = 0.0;
};

struct DragOver {
  const char* name;
  TriangleMesh mesh;
  Approach approach;
};
/// Under a sanitizer two of them.
std::vector<DragOver> drags() {
  std::vector<DragOver> all{
      {"sphere",
       make_sphere(0.06, 1000),
       {.from = Vec3(0, 0.0007, 0.045), .along = -kDragZ, .heading = kDragY, .reach = 0.03}},
      {"teapot, side",
       make_teapot(0.15, 1000),
       {.from = Vec3(0, -0.06, 0), .along = kDragY, .heading = -kDragZ, .reach = 0.04}},
      {"torus",
       make_torus(0.08, 0.03, 2000),
       {.from = Vec3(0.04, 0, 0.03), .along = -kDragZ, .heading = kDragY, .reach = 0.03}},
      {"box",
       make_box(Vec3(0.06, 0.06, 0.06), 300),
       {.from = Vec3(0.01, 0, 0.04), .along = -kDragZ, .heading = kDragY, .reach = 0.03}},
      {"arched sheet, from inside",
       test::grid_sheet(16, 0.05),
       {.from = Vec3(0, 0.003, -0.02), .along = kDragZ, .heading = kDragY, .reach = 0.03}}};
  if (test::kSlowBuild) return {all[1], all[4]};
  return all;
}

// Between two touches nothing but the HCP's own motion changes the force.
TEST(Drag, ADraggedFingerThatDipsInAndOutFeelsNoChangeBeyondItsOwnMotion) {
  for (const DragOver& over : drags()) {
    Drag drag(over.mesh, over.approach);
    const Drag::Result r =
        drag.run([](double t) { return -1e-3 - 2e-3 * std::cos(2.0 * std::numbers::pi * 4.0 * t); });
    std::printf(
        "%s, dipping: %d ticks, %d contacts, %d slips up to %.4f N, change over k |motion| %.6f, force up to "
        "%.3f N\n",
        over.name, r.ticks, r.contacts, r.slips, r.largest_slip, r.largest, r.largest_force);
    EXPECT_GE(r.contacts, 5) << over.name;
    EXPECT_LE(r.largest, 1.0 + 1e-6) << over.name;
  }
}
TEST(Drag, AFingerDraggedAtADepthChangesItsForceByItsOwnMotionUnlessItSlips) {
  for (const DragOver& over : drags()) {
    Drag drag(over.mesh, over.approach);
    const Drag::Result r = drag.run([](double) { return 1e-3; });
    std::printf(
        "%s, at depth: %d ticks, %d contacts, %d slips up to %.4f N, change over k |motion| %.6f, force up "
        "to %.3f N\n",
        over.name, r.ticks, r.contacts, r.slips, r.largest_slip, r.largest, r.largest_force);
    EXPECT_GE(r.contacts, 1) << over.name;
    EXPECT_LE(r.largest, 1.0 + 1e-6) << over.name;
    // Inherent in contacts that do not slide: one lets go while the finger is still inside beside it, and the
    // next begins with the depth that the finger has there.
    EXPECT_LE(r.largest_slip, 1.1 * kDragStiffness * 1e-3) << over.name;
  }
}

}  // namespace
}  // namespace phalanx

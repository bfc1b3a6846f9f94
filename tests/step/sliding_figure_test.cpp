// SPDX-License-Identifier: Apache-2.0
// The figure of docs/sliding.md: made here, and compared with the picture that the document shows. PHALANX_PICTURES=DIR writes it to
// DIR/sliding.svg.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "phalanx/figures/chart.h"
#include "support/sliding_finger.h"

namespace phalanx {
namespace {

using test::block;
using test::LoneFinger;
using test::Pressed;
using test::sliding_finger;

constexpr double kPressedBy = 3e-3;  // [m]
constexpr double kPerTick = 0.6e-3;  // abduction [rad]
constexpr int kOff = 400;            // [ms]; a tick is 1 ms
constexpr int kOut = 200;

/// Force of the law while the finger is led sideways off a bar of 16 mm. @param beside  gets how far the measured
/// fingertip is beside the bar's middle at the end [m]
ChartSeries off_the_bar(const char* name, ContactMode mode, double& beside) {
  LoneFinger finger = sliding_finger(block(0.016, 0.016), 0.6);
  finger.model().parameters.contact.mode = mode;
  Pressed press(finger, kPressedBy);
  ChartSeries curve{.name = name, .x = {}, .y = {}, .low = {}, .high = {}};
  const auto tip = static_cast<std::size_t>(segment_index(test::kIndex, 2));
  for (int ms = 0; ms <= kOff; ++ms) {
    const Snapshot& s = press.hand.tick(LoneFinger::pose(press.goal, kPerTick * ms));
    curve.x.push_back(1e-3 * ms);
    curve.y.push_back(test::raw_force(s));
    beside = std::abs((s.hcp_pose[tip] * Vec3(0.0, 0.0, -test::kLength3)).x());
  }
  return curve;
}

/// Friction by normal force along the way out, while the finger is dragged over a broad block, out and back.
ChartSeries dragged(const char* name, double mu) {
  LoneFinger finger = sliding_finger(block(0.1, 0.016), mu);
  Pressed press(finger, kPressedBy);
  ChartSeries curve{.name = name, .x = {}, .y = {}, .low = {}, .high = {}};
  for (int ms = 0; ms <= 2 * kOut; ++ms) {
    press.hand.tick(LoneFinger::pose(press.goal, kPerTick * (ms <= kOut ? ms : 2 * kOut - ms)));
    curve.x.push_back(1e-3 * ms);
    const Vec3 force =
        press.tip().force * press.tip().normal;  // on the finger; the block's top is horizontal
    curve.y.push_back(std::copysign(std::hypot(force.x(), force.y()), force.x()) / force.z());
  }
  return curve;
}

std::string content(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST(SlidingFigure, IsThatOfTheDocument) {
  double beside = 0.0;
  const ChartPanel off{.title = "A finger is led sideways off a bar of 16 mm",
                       .y_label = "force of the law [N]",
                       .series = {off_the_bar("static contacts", ContactMode::kStatic, beside),
                                  off_the_bar("sliding contacts", ContactMode::kSliding, beside)},
                       .marks = {}};
  EXPECT_GT(off.series[0].y.back(), 1.0) << "static: the wall goes on beside the bar";
  EXPECT_EQ(off.series[1].y.back(), 0.0) << "sliding: it ends with the bar";
  EXPECT_GT(beside, 0.013);
  const ChartPanel drag{.title = "A finger is dragged over a broad block, out for 0.2 s and back",
                        .y_label = "friction by normal force",
                        .series = {dragged("friction 0.3", 0.3), dragged("friction 0.6", 0.6)},
                        .marks = {}};
  const std::string made = line_chart_svg({.title = "Sliding contacts",
                                           .subtitles = {},
                                           .x_label = "time [s]",
                                           .panels = {off, drag},
                                           .windows = {}});
  if (const char* folder = std::getenv("PHALANX_PICTURES")) {
    std::ofstream(std::filesystem::path(folder) / "sliding.svg", std::ios::binary) << made;
  }
  EXPECT_TRUE(content(PHALANX_SOURCE_DIR "/docs/pictures/sliding.svg") == made)
      << "make it again: PHALANX_PICTURES=docs/pictures ./test -R SlidingFigure";
}

}  // namespace
}  // namespace phalanx

// SPDX-License-Identifier: Apache-2.0
// An index finger alone with an object: the other digits and the palm are metres away. Its distal segment
// points at the object and is pressed along a straight line, so that one surface can be felt place by place.
#pragma once

#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "phalanx/core/constants.h"
#include "phalanx/mesh/primitives.h"
#include "support/simple_hand.h"

namespace phalanx::test {

/// Where the finger comes from, in the world.
struct Approach {
  Vec3 from = Vec3::Zero();      ///< the fingertip's centre before the press [m]
  Vec3 along = -Vec3::UnitZ();   ///< unit; the way it is pressed
  Vec3 heading = Vec3::UnitY();  ///< unit, across `along`; the way the straight finger points
  double reach = 0.02;           ///< gives up after this much [m], below 60 mm
};

/// What a press is felt as.
struct Press {
  Vec3 force = Vec3::Zero();   ///< on the finger, sum over its segments [N]
  Vec3 point = Vec3::Zero();   ///< contact point on the GDP of the segment with the greatest force [m]
  Vec3 normal = Vec3::Zero();  ///< its direction
  double depth = 0.0;          ///< its depth [m]
  double travel = 0.0;         ///< of the fingertip until it touched [m]
  int segment = -1;            ///< which one: 0 proximal, 1 middle, 2 distal
  int contacts = 0;            ///< segments in contact
  Snapshot snapshot;
};

class LoneFinger {
 public:
  static constexpr double kBend = std::numbers::pi / 3.0;  ///< of the last joint
  static constexpr double kTipRadius = 0.005;              ///< of the simple hand's distal segment [m]

  explicit LoneFinger(ObjectModel object, int hand_triangles = 2250)
      : meshes_(make_capsule_meshes(simple_parameters(), Handedness::kRight, hand_triangles)),
        model_(hand_at(Pose{}, 0.0), std::move(object)) {
    turn_limits_off(model_);
    model_.parameters.force.stiffness = 1000.0;
    model_.parameters.rate_hz = 1000.0;
  }

  [[nodiscard]] Setup& model() { return model_; }

  /// Distance of the fingertip's centre from the first joint [m].
  [[nodiscard]] static double lever() { return std::hypot(along_bone(), below_bone()); }

  /// Puts the open hand so that the press of `approach` is a turn of the first joint about its middle, and
  /// returns the first joint's angle at the start.
  double aim(const Approach& approach) {
    const Vec3 y = -approach.along;
    const Vec3 z = -approach.heading;
    Mat3 R;
    R.col(0) = y.cross(z);
    R.col(1) = y;
    R.col(2) = z;
    const double down = std::asin(0.5 * approach.reach / lever());  // the stroke is from -down to +down
    const double start = -std::atan2(below_bone(), along_bone()) - down;
    const Vec3 tip(0.0, lever() * std::sin(down), -lever() * std::cos(down));
    model_.hand = hand_at(Pose{R, approach.from - R * tip}, start);
    return start;
  }

  /// Presses until something is touched and then `depth` deeper along the fingertip's way.
  /// @returns nothing if nothing is met within the reach
  std::optional<Press> press(const Approach& approach, double depth) {
    const double start = aim(approach);
    Runner hand(model_);
    const int ticks = static_cast<int>(std::ceil(approach.reach / 0.5e-3));
    const double stroke = 2.0 * std::asin(0.5 * approach.reach / lever());
    hand.tick(pose(start));
    for (int n = 1; n <= ticks; ++n) {
      hand.tick(pose(start + stroke * n / ticks));
      if (contacts(hand.now()) == 0) continue;
      const double touched = index_gdp(hand.now(), 0);
      hand.tick(pose(touched + depth / lever()));
      return felt(hand.now(), (touched - start) * lever());
    }
    return std::nullopt;
  }

  [[nodiscard]] static JointArray pose(double mcp, double abduction = 0.0) {
    return index_angles(mcp, 0.0, kBend, abduction);
  }

  static int contacts(const Snapshot& s) {
    int count = 0;
    for (int k = 0; k < kSegmentsPerDigit; ++k) count += index_segment(s, k).contact ? 1 : 0;
    return count;
  }

  static Press felt(const Snapshot& s, double travel) {
    Press press;
    press.snapshot = s;
    press.travel = travel;
    press.contacts = contacts(s);
    double largest = -1.0;
    for (int k = 0; k < kSegmentsPerDigit; ++k) {
      const SegmentSnapshot& contact = index_segment(s, k);
      press.force += contact.force * contact.normal;
      if (!contact.contact || contact.force <= largest) continue;
      largest = contact.force;
      press.segment = k;
      press.point = contact.point;
      press.normal = contact.normal;
      press.depth = contact.depth;
    }
    return press;
  }

 private:
  static double along_bone() { return kLength1 + kLength2 + kLength3 * std::cos(kBend); }
  static double below_bone() { return kLength3 * std::sin(kBend); }

  [[nodiscard]] HandModel hand_at(const Pose& X_WH, double start) const {
    HandParameters hand = simple_parameters();
    for (std::size_t d = 0; d < kDigits; ++d) {
      hand.digits[d].base =
          d == kIndex ? Vec3(Vec3::Zero()) : Vec3(3.0 + 0.2 * static_cast<double>(d), 3.0, 3.0);
    }
    hand.palm.offset = Vec3(-3.0, 3.0, 3.0);
    const JointArray open = pose(start);
    for (int i = 0; i < kJointsPerDigit; ++i) {
      const auto j = static_cast<std::size_t>(joint_index(kIndex, i));
      hand.min_angle[j] = -1.5;
      hand.max_angle[j] = 2.0;
      hand.open_angle[j] = open[j];
    }
    SegmentMeshes meshes = meshes_;
    return HandModel(hand, Handedness::kRight, X_WH, std::move(meshes));
  }

  SegmentMeshes meshes_;
  Setup model_;
};

/// Returns the sizes and poses of two boxes whose faces meet below the origin along the finger, and that the tip touches
/// together when its centre is at the origin. The groove ends 5 mm above these places.
/// @param opening  angle between the faces [rad]
inline std::array<std::pair<Vec3, Pose>, 2> groove_boxes(double opening) {
  const double half = 0.5 * opening;
  const double length = LoneFinger::kTipRadius / std::tan(half) + 5e-3;
  const double depth = LoneFinger::kTipRadius / std::sin(half);
  std::array<std::pair<Vec3, Pose>, 2> boxes;
  for (const double side : {-1.0, 1.0}) {
    Pose X;
    X.R = Eigen::AngleAxisd(side * (half - kPi / 2.0), Vec3::UnitY()).toRotationMatrix();
    X.p = X.R * Vec3(side * 0.5 * length, 0.0, -0.01) + Vec3(0.0, 0.009, -depth);
    boxes[side < 0.0 ? 0 : 1] = {Vec3(length, 0.03, 0.02), X};
  }
  return boxes;
}

/// Returns them as one mesh.
inline TriangleMesh groove(double opening) {
  TriangleMesh mesh;
  for (const auto& [size, X] : groove_boxes(opening)) append(mesh, make_box(size, 12), X);
  return mesh;
}

}  // namespace phalanx::test

// SPDX-License-Identifier: Apache-2.0
// Kapandji's opposition test on the shipped hands: the postures of assets/postures, geometry of the collision
// meshes. The positions: Kapandji A., "Cotation clinique de l'opposition et de la contre-opposition du pouce",
// Ann. Chir. Main 5(1), 1986. The thumb's pulp touches the index finger's radial side at the intermediate (1)
// and the distal (2) phalanx, the tips of index (3), middle (4), ring (5) and little finger (6), then the little
// finger's palmar side at the DIP joint (7), at the PIP joint (8) and at the proximal phalanx (9), and the
// distal palmar crease (10). That each place is one patch of a mesh with the bounds below is our own choice.
//
// Pad: triangles of the distal half of a digit's distal segment with normals within 60 deg of a direction 30
// deg distal of palmar. Gap: least distance between two patches. Facing: angle between the one patch's normal,
// the mean of its triangles' by area, and the reverse of the other's. Depth: of the points of one segment's
// surface, about 1 mm apart, the deepest inside another segment. Not counted:
// - neighbours at a joint, and the thumb's metacarpal with the palm, in which it lies;
// - proximal phalanges of neighbouring fingers, which share the web between them;
// - of a finger's proximal phalanx what is nearer than 14 mm to its MCP joint along the bone, or beyond it, with
//   palm, fingers and the thumb's metacarpal: a dome inside the palm, so that the joint closes at all angles;
// - of the thumb's proximal phalanx what lies behind its MCP joint, over the metacarpal, with the palm: there up
//   to 2.5 mm are allowed. These 14 and 2.5 mm are the adult's, others' in proportion to the hand's breadth.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <ostream>
#include <string>
#include <vector>

#include "phalanx/core/constants.h"
#include "phalanx/core/index.h"
#include "phalanx/mesh/import_cache.h"
#include "phalanx/scene/hand_meshes.h"
#include "phalanx/scene/posture_file.h"
#include "support/sanitized.h"
#include "support/segment_rims.h"

namespace phalanx::opposition {
namespace {

constexpr int kThumb = static_cast<int>(Digit::kThumb);
constexpr int kThumbProximal = 1, kThumbDistal = 2;
// Of the adult's hand; another hand's are in proportion to its breadth.
constexpr double kRoot = 14.0 * kMm, kThumbRoot = 2.5 * kMm;

/// Points all over a triangle, at most `spacing` apart along its sides.
void append_points(std::vector<Vec3>& points, const std::array<Vec3, 3>& corner, double spacing) {
  const Vec3 u = corner[1] - corner[0], v = corner[2] - corner[0];
  const int n =
      std::max(1, static_cast<int>(std::ceil(std::max({u.norm(), v.norm(), (u - v).norm()}) / spacing)));
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= n - i; ++j) points.emplace_back(corner[0] + (u * i + v * j) / n);
}

std::array<Vec3, 3> corners(const TriangleMesh& mesh, const Triangle& t) {
  const auto at = [&](std::size_t k) { return mesh.vertices[static_cast<std::size_t>(t[k])]; };
  return {at(0), at(1), at(2)};
}

/// A closed mesh that says quickly which points are inside it.
class DepthMesh {
 public:
  explicit DepthMesh(const TriangleMesh& mesh) {
    for (const Triangle& t : mesh.triangles) {
      triangles_.push_back(corners(mesh, t));
      append_points(points_, triangles_.back(), 1.0 * kMm);
    }
    for (const Vec3& v : mesh.vertices) {
      box_.extend(v);
      radius_ = std::max(radius_, v.norm());
    }
    columns_.resize(static_cast<std::size_t>(column(box_.max().x(), 0) + 1) *
                    static_cast<std::size_t>(column(box_.max().y(), 1) + 1));
    for (std::size_t i = 0; i < triangles_.size(); ++i) {
      Eigen::AlignedBox3d box;
      for (const Vec3& v : triangles_[i]) box.extend(v);
      for (int y = column(box.min().y(), 1); y <= column(box.max().y(), 1); ++y)
        for (int x = column(box.min().x(), 0); x <= column(box.max().x(), 0); ++x)
          columns_[at(x, y)].push_back(i);
    }
  }

  [[nodiscard]] const std::vector<Vec3>& points() const { return points_; }
  /// Of the points from the joint.
  [[nodiscard]] double radius() const { return radius_; }

  /// The depth of p if it is inside and deeper than `least`, else `least`.
  [[nodiscard]] double depth(const Vec3& p, double least) const {
    if (!box_.contains(p) || !inside(p)) return least;
    double nearest = test::kFar;
    for (const auto& [a, b, c] : triangles_) {
      nearest = std::min(nearest, test::distance_to_triangle(p, a, b, c));
      if (nearest <= least) return least;
    }
    return nearest;
  }

 private:
  static constexpr double kColumn = 2.0 * kMm;

  [[nodiscard]] int column(double x, int axis) const {
    return static_cast<int>((x - box_.min()[axis]) / kColumn);
  }
  [[nodiscard]] std::size_t at(int x, int y) const {
    return static_cast<std::size_t>(y * (column(box_.max().x(), 0) + 1) + x);
  }

  /// True if the line through p along x passes the side at larger x; equal for both triangles at the side.
  static bool passes(Vec3 a, Vec3 b, const Vec3& p) {
    if ((a.y() > p.y()) == (b.y() > p.y())) return false;
    if (a.y() > b.y()) std::swap(a, b);
    return p.x() < a.x() + (p.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
  }

  /// Counts the triangles above p.
  [[nodiscard]] bool inside(const Vec3& p) const {
    bool odd = false;
    for (const std::size_t i : columns_[at(column(p.x(), 0), column(p.y(), 1))]) {
      const auto& [a, b, c] = triangles_[i];
      if ((passes(a, b, p) != passes(b, c, p)) == passes(c, a, p)) continue;
      const Vec3 n = (b - a).cross(c - a);
      if ((a - p).dot(n) / n.z() > 0.0) odd = !odd;
    }
    return odd;
  }

  std::vector<std::array<Vec3, 3>> triangles_;
  std::vector<Vec3> points_;
  Eigen::AlignedBox3d box_;
  double radius_ = 0.0;
  std::vector<std::vector<std::size_t>> columns_;
};

/// A patch of a segment's surface, in its frame S.
struct Patch {
  int segment = 0;
  Vec3 normal = Vec3::Zero();
  std::vector<std::array<Vec3, 3>> triangles;
  std::vector<Vec3> points;
};

/// One side of the hand with its solids.
struct Hand {
  HandModel model;
  std::vector<DepthMesh> solids;

  Hand(const HandParameters& parameters, Handedness side, const SegmentMeshes& meshes)
      : model(parameters, side, {}, meshes) {
    for (const TriangleMesh& mesh : meshes) solids.emplace_back(mesh);
  }
  [[nodiscard]] const HandParameters& numbers() const { return model.parameters(); }
  [[nodiscard]] double mirror() const { return model.handedness() == Handedness::kRight ? 1.0 : -1.0; }

  /// The triangles with centres in the box and normals within 60 deg of `direction`, both of a right hand.
  [[nodiscard]] Patch patch(int segment, Vec3 direction, const Eigen::AlignedBox3d& box) const {
    direction.x() *= mirror();
    Patch patch{.segment = segment, .normal = Vec3::Zero(), .triangles = {}, .points = {}};
    for (const Triangle& t : model.mesh(segment).triangles) {
      const auto [a, b, c] = corners(model.mesh(segment), t);
      const Vec3 area = 0.5 * (b - a).cross(c - a);
      Vec3 centre = (a + b + c) / 3.0;
      centre.x() *= mirror();
      if (!box.contains(centre) || area.dot(direction) < 0.5 * area.norm()) continue;
      patch.normal += area;
      patch.triangles.push_back({a, b, c});
      append_points(patch.points, patch.triangles.back(), 0.4 * kMm);
    }
    EXPECT_FALSE(patch.triangles.empty()) << segment_name(segment);
    patch.normal.normalize();
    return patch;
  }
};

/// A box that is bounded along the bone only: from `from` to `to` of `unit`, from the joint to the tip.
Eigen::AlignedBox3d along(double from, double to, double unit) {
  return {Vec3(-1.0, -1.0, -to * unit), Vec3(1.0, 1.0, -from * unit)};
}

const Vec3 kPalmar = -Vec3::UnitY(), kRadial = -Vec3::UnitX();
const Vec3 kPad(0.0, -std::cos(30.0 * kDeg), -std::sin(30.0 * kDeg));

/// From the joint to the mesh's far end.
double mesh_length(const Hand& hand, int segment) {
  double length = 0.0;
  for (const Vec3& v : hand.model.mesh(segment).vertices) length = std::max(length, -v.z());
  return length;
}

Patch pad(const Hand& hand, int digit) {
  const int segment = segment_index(digit, 2);
  return hand.patch(segment, kPad, along(0.5, 2.0, mesh_length(hand, segment)));
}

/// The place that the thumb's pad touches in one of Kapandji's positions.
Patch target(const Hand& hand, int position) {
  constexpr int kIndex = 1, kLittle = 4;
  const auto bone = [&](int digit, int k) { return hand.numbers().digits[idx(digit)].dh[idx(k + 1)].a; };
  const auto on_bone = [&](int digit, int k, const Vec3& direction, double from, double to) {
    return hand.patch(segment_index(digit, k), direction, along(from, to, bone(digit, k)));
  };
  const int tip = segment_index(kIndex, 2);
  const PalmShape& palm = hand.numbers().palm;
  const Vec3& base = hand.numbers().digits[idx(kLittle)].base;
  switch (position) {
    case 1:
      return on_bone(kIndex, 1, kRadial, 0.2, 0.8);
    case 2:
      return hand.patch(tip, kRadial, along(0.2, 0.9, mesh_length(hand, tip)));
    case 7:
      return on_bone(kLittle, 1, kPalmar, 0.7, 1.1);
    case 8:
      return on_bone(kLittle, 0, kPalmar, 0.75, 1.1);
    case 9:
      return on_bone(kLittle, 0, kPalmar, 0.35, 0.65);
    case 10:  // the distal crease, below ring and little finger
      return hand.patch(kPalm, kPalmar,
                        {base + Vec3(-0.2 * palm.knuckle_breadth, -1.0, 0.06 * palm.length),
                         base + Vec3(0.1 * palm.knuckle_breadth, 1.0, 0.36 * palm.length)});
    default:
      return pad(hand, position - 2);
  }
}

std::array<Pose, kSegments> poses(const Hand& hand, const JointArray& angle) {
  HandPoses digits;
  hand.model.poses(angle, digits);
  std::array<Pose, kSegments> X_WS;
  for (int s = 0; s < kPalm; ++s)
    X_WS[idx(s)] = digits.digit[idx(digit_of_segment(s))].segment[idx(s % kSegmentsPerDigit)];
  X_WS[kPalm] = hand.model.palm_pose();
  return X_WS;
}

struct Meeting {
  double gap = test::kFar;  ///< [m]
  double facing = 0.0;      ///< [deg]
};

Meeting meet(const Patch& a, const Patch& b, const std::array<Pose, kSegments>& X_WS) {
  const Pose X_BA = X_WS[idx(b.segment)].inverse() * X_WS[idx(a.segment)];
  Meeting meeting;
  for (const Vec3& p_A : a.points) {
    const Vec3 p = X_BA * p_A;
    for (const auto& [x, y, z] : b.triangles)
      meeting.gap = std::min(meeting.gap, test::distance_to_triangle(p, x, y, z));
  }
  meeting.facing = std::acos(std::clamp(-(X_BA.R * a.normal).dot(b.normal), -1.0, 1.0)) * kRadToDeg;
  return meeting;
}

bool is_finger_root(int s) {
  return s != kPalm && s % kSegmentsPerDigit == 0 && digit_of_segment(s) != kThumb;
}

/// True if overlaps of the two segments are not counted at all.
bool not_counted(int a, int b) {
  if (a > b) std::swap(a, b);
  if (b == kPalm) return a % kSegmentsPerDigit == 0;
  if (digit_of_segment(a) == digit_of_segment(b)) return b == a + 1;
  return is_finger_root(a) && is_finger_root(b) && digit_of_segment(b) == digit_of_segment(a) + 1;
}

struct Depths {
  double counted = 0.0;     ///< [m]
  double thumb_root = 0.0;  ///< of the thumb's proximal phalanx behind its joint, in the palm or it in it [m]
  std::string where;
};

/// The hand's breadth, relative to the adult's.
double breadth(const Hand& hand) { return hand.numbers().palm.knuckle_breadth / (81.5 * kMm); }

/// The part of segment s that counts against `other`: what is farther than this from the joint, along the bone.
double counted_from(const Hand& hand, int s, int other) {
  if (s == kThumbProximal && other == kPalm) return 0.0;
  if (!is_finger_root(s) || other == kThumbProximal || other == kThumbDistal) return -1.0;
  return kRoot * breadth(hand);
}

Depths depths(const Hand& hand, const std::array<Pose, kSegments>& X_WS) {
  Depths depths;
  for (int a = 0; a < kSegments; ++a) {
    for (int b = 0; b < kSegments; ++b) {
      if (a == b || not_counted(a, b)) continue;
      const DepthMesh& solid = hand.solids[idx(b)];
      const Pose X_BA = X_WS[idx(b)].inverse() * X_WS[idx(a)];
      if (X_BA.p.norm() > solid.radius() + hand.solids[idx(a)].radius()) continue;
      const double from_a = counted_from(hand, a, b), from_b = counted_from(hand, b, a);
      const bool root = std::min(a, b) == kThumbProximal && std::max(a, b) == kPalm;
      for (const Vec3& p_A : hand.solids[idx(a)].points()) {
        const Vec3 p = X_BA * p_A;
        if (-p_A.z() >= from_a && -p.z() >= from_b) {
          const double depth = solid.depth(p, depths.counted);
          if (depth > depths.counted)
            depths.where = std::string(segment_name(a)) + " in " + std::string(segment_name(b));
          depths.counted = depth;
        } else if (root) {
          depths.thumb_root = solid.depth(p, depths.thumb_root);
        }
      }
    }
  }
  return depths;
}

/// |angle - middle| / half of the range of motion, the largest of all joints.
double eccentricity(const HandParameters& hand, const JointArray& angle) {
  double worst = 0.0;
  for (std::size_t j = 0; j < kJoints; ++j) {
    const double middle = 0.5 * (hand.min_angle[j] + hand.max_angle[j]);
    worst = std::max(worst, std::abs(angle[j] - middle) / (hand.max_angle[j] - middle));
  }
  return worst;
}

JointArray posture(const std::string& file, const std::string& name) {
  for (const Posture& posture : load_postures(file))
    if (posture.name == name) return posture.angle;
  ADD_FAILURE() << file << " has no " << name;
  return {};
}

HandDescription described(const std::string& name) {
  HandDescription description;
  if (name != "adult") description.profile = name;
  return description;
}

/// The hand of this name, as a right or a left one.
Hand load(const std::string& name, Handedness side, HandCoupling coupling = HandCoupling::kFile) {
  HandDescription description = described(name);
  description.coupling = coupling;
  static ImportCache imports;
  LoadedHand loaded = load_hand(description, HandDetail::kCollision, &imports);
  if (loaded.handedness != side) mirror(loaded.meshes.collision);
  return {loaded.parameters, side, loaded.meshes.collision};
}

struct Case {
  const char* hand;  ///< and name of its postures
  Handedness side;
};
void PrintTo(const Case& one, std::ostream* out) {
  *out << one.hand << (one.side == Handedness::kRight ? ", right" : ", left");
}

class Kapandji : public ::testing::TestWithParam<Case> {
 protected:
  const Hand hand = load(GetParam().hand, GetParam().side);

  /// Prints the values, and checks those that all postures have in common.
  void examine(const std::string& name, const JointArray& angle, const Meeting& meeting) {
    const Depths depth = depths(hand, poses(hand, angle));
    std::printf(
        "%-12s %-14s gap %.2f mm, facing %4.1f deg, depth %.2f mm (%s), thumb's root %.2f mm, joints %.3f\n",
        GetParam().hand, name.c_str(), meeting.gap / kMm, meeting.facing, depth.counted / kMm,
        depth.where.c_str(), depth.thumb_root / kMm, eccentricity(hand.numbers(), angle));
    EXPECT_LT(meeting.gap, 1.0 * kMm);
    EXPECT_LT(depth.counted, 1.0 * kMm) << depth.where;
    EXPECT_LT(depth.thumb_root, kThumbRoot * breadth(hand));
    EXPECT_LT(eccentricity(hand.numbers(), angle), 1.0);
  }
};

TEST_P(Kapandji, ThePadReachesAllTenPositions) {
  for (int position = 1; position <= 10; ++position) {
    const std::string name = "kapandji_" + std::to_string(position);
    SCOPED_TRACE(name);
    const JointArray angle = posture(GetParam().hand, name);
    const Meeting meeting = meet(pad(hand, kThumb), target(hand, position), poses(hand, angle));
    examine(name, angle, meeting);
    const bool finger_tip = position >= 3 && position <= 6;
    EXPECT_LE(meeting.facing, finger_tip ? 30.0 : 60.0);
    if (finger_tip) {
      EXPECT_LT(eccentricity(hand.numbers(), angle), 0.9);
    }
  }
}

TEST_P(Kapandji, PulpPinchesAreNearTheMiddleOfTheRanges) {
  for (int digit = 1; digit < kDigits; ++digit) {
    const std::string name = "pinch_" + std::string(digit_name(digit));
    SCOPED_TRACE(name);
    const JointArray angle = posture(GetParam().hand, name);
    const Meeting meeting = meet(pad(hand, kThumb), pad(hand, digit), poses(hand, angle));
    examine(name, angle, meeting);
    EXPECT_LE(meeting.facing, 45.0);
    // PIP and DIP joints of the other fingers are near straight, at 0.7 and 0.82; only the two digits count.
    JointArray two = angle;
    for (int j = 0; j < kJoints; ++j)
      if (digit_of_joint(j) != kThumb && digit_of_joint(j) != digit)
        two[idx(j)] = 0.5 * (hand.numbers().min_angle[idx(j)] + hand.numbers().max_angle[idx(j)]);
    constexpr std::array<double, kDigits> kMost = {0.0, 0.51, 0.61, 0.61, 0.71};
    EXPECT_LT(eccentricity(hand.numbers(), two), kMost[idx(digit)]);
  }
}

/// Of these, one with a sanitizer, which takes a hundred times as long.
std::vector<Case> cases() {
  if (test::kSlowBuild) return {{"large-man", Handedness::kLeft}};
  return {{"adult", Handedness::kRight},       {"adult", Handedness::kLeft},
          {"small-woman", Handedness::kRight}, {"small-woman", Handedness::kLeft},
          {"large-man", Handedness::kRight},   {"large-man", Handedness::kLeft}};
}

INSTANTIATE_TEST_SUITE_P(Hands, Kapandji, ::testing::ValuesIn(cases()), [](const auto& one) {
  std::string name = one.param.hand;
  std::replace(name.begin(), name.end(), '-', '_');
  return name + (one.param.side == Handedness::kRight ? "_right" : "_left");
});

// A thumb that does not pronate and a palm without an arch, at the same joint angles.
TEST(KapandjiCoupling, CarriesThePadsOfRingAndLittleFinger) {
  const Hand stiff = load("adult", Handedness::kRight, HandCoupling::kNone);
  for (const int position : {5, 6}) {
    const JointArray angle = posture("adult", "kapandji_" + std::to_string(position));
    const Meeting meeting = meet(pad(stiff, kThumb), target(stiff, position), poses(stiff, angle));
    EXPECT_TRUE(meeting.facing > 30.0 || meeting.gap > 1.0 * kMm)
        << position << ": " << meeting.facing << " deg, " << meeting.gap / kMm << " mm";
  }
}

TEST(KapandjiDepth, SeesAThumbThatIsMovedIntoAFinger) {
  const Hand hand = load("adult", Handedness::kRight);
  JointArray angle = posture("adult", "kapandji_3");
  angle[6] += 5.0 * kDeg;  // index PIP: its tip moves by 3 mm towards the thumb
  EXPECT_GT(depths(hand, poses(hand, angle)).counted, 1.0 * kMm);
  angle[6] -= 10.0 * kDeg;
  EXPECT_GT(meet(pad(hand, kThumb), target(hand, 3), poses(hand, angle)).gap, 1.0 * kMm);
}

TEST(PosturesOfTheWholeHand, HaveNoSegmentInAnother) {
  const Hand hand = load("adult", Handedness::kRight);
  for (const char* name : {"fist", "cup"}) {
    const JointArray angle = posture("adult", name);
    const Depths depth = depths(hand, poses(hand, angle));
    EXPECT_LT(depth.counted, 1.0 * kMm) << name << ": " << depth.where;
    EXPECT_LT(depth.thumb_root, kThumbRoot) << name;
    EXPECT_LT(eccentricity(hand.numbers(), angle), 1.0) << name;
  }
}

}  // namespace
}  // namespace phalanx::opposition

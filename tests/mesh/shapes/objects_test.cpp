// SPDX-License-Identifier: Apache-2.0
// Every object of daily life and therapy at many resolutions.
#include "phalanx/mesh/objects.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <ostream>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "mesh/mesh_checks.h"
#include "mesh/shapes/maker_refusal.h"
#include "mesh/shapes/object_shapes.h"
#include "phalanx/core/constants.h"
#include "phalanx/mesh/primitives.h"
#include "support/sanitized.h"

namespace phalanx {
namespace {

using mesh::SpunShape;

struct Thing {
  std::string name;
  std::function<TriangleMesh(int)> make;
  int least;   ///< from this count on it is met within 15 %
  int smooth;  ///< from this count on only the edges that are meant turn by 30 degrees or more
  int euler;
  double volume;                           ///< exact [m^3]
  Vec3 extents;                            ///< exact [m]
  std::function<double(const Vec3&)> off;  ///< distance of a point from the exact surface [m]
};

void PrintTo(const Thing& thing, std::ostream* out) { *out << thing.name; }

/// pi r^2 dz along the profile; with lobes of depth d the section's area is pi r^2 ((1 - d/2)^2 + d^2/8).
double spun_volume(const SpunShape& shape) {
  double volume = 0.0;
  for (const mesh::ProfilePiece& piece : shape.pieces()) {
    constexpr int kParts = 20'000;
    const auto area = [&](double f) {
      const double d = piece.lobes_from + f * (piece.lobes_to - piece.lobes_from);
      const double r = piece.rz(f).x();
      return kPi * r * r * ((1.0 - 0.5 * d) * (1.0 - 0.5 * d) + d * d / 8.0);
    };
    for (int i = 0; i < kParts; ++i) {
      const double f0 = static_cast<double>(i) / kParts;
      const double f1 = static_cast<double>(i + 1) / kParts;
      volume += 0.5 * (area(f0) + area(f1)) * (piece.rz(f1).y() - piece.rz(f0).y());
    }
  }
  return volume;
}

/// Distance from p to the curve that the surface cuts out of the half plane through z and p.
double off_spun(const SpunShape& shape, const Vec3& p) {
  const double r = p.head<2>().norm();
  const Eigen::Vector2d c = r > 0.0 ? Eigen::Vector2d(p.head<2>() / r) : Eigen::Vector2d(1.0, 0.0);
  double best = std::numeric_limits<double>::infinity();
  for (std::size_t piece = 0; piece < shape.pieces().size(); ++piece) {
    const auto distance = [&](double f) { return (shape.point(c, piece, f) - p).norm(); };
    constexpr int kParts = 200;
    int nearest = 0;
    for (int i = 1; i <= kParts; ++i)
      if (distance(static_cast<double>(i) / kParts) < distance(static_cast<double>(nearest) / kParts))
        nearest = i;
    double low = std::max(0.0, (nearest - 1.0) / kParts);
    double high = std::min(1.0, (nearest + 1.0) / kParts);
    for (int i = 0; i < 80; ++i) {
      const double a = low + (high - low) / 3.0;
      const double b = high - (high - low) / 3.0;
      (distance(a) < distance(b) ? high : low) = distance(a) < distance(b) ? b : a;
    }
    best = std::min({best, distance(0.5 * (low + high)), distance(0.0), distance(1.0)});
  }
  return best;
}

Thing spun(std::string name, std::function<TriangleMesh(int)> make, int least, int smooth,
           const SpunShape& shape, const Vec3& extents) {
  return {std::move(name),
          std::move(make),
          least,
          smooth,
          2,
          spun_volume(shape),
          extents,
          [shape](const Vec3& p) { return off_spun(shape, p); }};
}

constexpr double kKeyLength = 0.057;
constexpr double kKeyBreadth = 0.025;
constexpr double kKeyThickness = 0.0022;

/// Both edges as straight lines between their corners: trapezia, less the piece of the bow's disc inside.
double key_volume() {
  const double bow = 0.5 * kKeyBreadth;
  const double blade = mesh::kKeyBlade * bow;  // half its breadth
  const double length = kKeyLength - kKeyBreadth;
  const auto cut_away = [&](std::span<const mesh::KeyCut> edge) {
    double area = 0.0;
    for (std::size_t i = 0; i + 1 < edge.size(); ++i)
      area += 0.5 * (edge[i].depth + edge[i + 1].depth) * (edge[i + 1].along - edge[i].along);
    return area * 2.0 * blade * length;
  };
  // Between the rim and the line x = bow that the blade's length counts from.
  const double angle = std::asin(mesh::kKeyBlade);
  const double beside_disc = 2.0 * blade * bow - blade * bow * std::cos(angle) - bow * bow * angle;
  const double hole = mesh::kKeyHole * bow;
  return kKeyThickness * (kPi * (bow * bow - hole * hole) + beside_disc + 2.0 * blade * length -
                          cut_away(mesh::key_lower_edge()) - cut_away(mesh::key_upper_edge()));
}

/// A vertex of the key is on its two flat sides or on its walls; the walls stand on the outline.
double off_key(const Vec3& v) {
  const double flat = std::abs(std::abs(v.z()) - 0.5 * kKeyThickness);
  const double bow = 0.5 * kKeyBreadth;
  const Eigen::Vector2d p(v.x() + 0.5 * kKeyLength - bow, v.y());
  double wall = std::min(std::abs(p.norm() - bow), std::abs(p.norm() - mesh::kKeyHole * bow));
  const double half = mesh::kKeyBlade * bow;
  const auto line = [&](std::span<const mesh::KeyCut> edge, double sign) {
    for (std::size_t i = 0; i + 1 < edge.size(); ++i) {
      const auto at = [&](const mesh::KeyCut& cut) {
        const double x = i == 0 && &cut == &edge[0] ? bow * std::sqrt(1.0 - mesh::kKeyBlade * mesh::kKeyBlade)
                                                    : bow + cut.along * (kKeyLength - kKeyBreadth);
        return Eigen::Vector2d(x, sign * half * (1.0 - 2.0 * cut.depth));
      };
      const Eigen::Vector2d a = at(edge[i]);
      const Eigen::Vector2d ab = at(edge[i + 1]) - a;
      const double t = std::clamp((p - a).dot(ab) / ab.squaredNorm(), 0.0, 1.0);
      wall = std::min(wall, (p - a - t * ab).norm());
    }
  };
  line(mesh::key_lower_edge(), -1.0);
  line(mesh::key_upper_edge(), 1.0);
  wall = std::min(wall, std::abs(v.x() - 0.5 * kKeyLength));  // the tip
  return std::min(flat, wall);
}

/// Each bump adds  2 pi  integral of (R(s)^3 - low^3) / 3  sin s ds  to the ball between the bumps.
double ball_volume(double diameter, double bump) {
  const double low = 0.5 * diameter - bump;
  double volume = 4.0 / 3.0 * kPi * low * low * low;
  constexpr int kParts = 20'000;
  for (int i = 0; i < kParts; ++i) {
    const double u = (i + 0.5) / kParts;
    const double s = u * mesh::kBallBumpAngle;
    const double r = low + bump * (1.0 - u * u) * (1.0 - u * u);
    volume += mesh::kBallBumps * 2.0 * kPi / 3.0 * (r * r * r - low * low * low) * std::sin(s) *
              mesh::kBallBumpAngle / kParts;
  }
  return volume;
}

/// Steiner: box, slabs over its sides, quarter cylinders over its edges, the corners' ball.
double bar_volume(const Vec3& size) {
  const double r = mesh::kBarFillet * size.minCoeff();
  const Vec3 a = size.array() - 2.0 * r;
  return a.prod() + 2.0 * r * (a.x() * a.y() + a.y() * a.z() + a.z() * a.x()) + kPi * r * r * a.sum() +
         4.0 / 3.0 * kPi * r * r * r;
}

double off_bar(const Vec3& size, const Vec3& p) {
  const double r = mesh::kBarFillet * size.minCoeff();
  const Vec3 core = 0.5 * size.array() - r;
  return std::abs((p - p.cwiseMax(-core).cwiseMin(core)).norm() - r);
}

const Vec3 kBar{0.1, 0.035, 0.03};

const std::vector<Thing>& things() {
  static const std::vector<Thing> kThings = {
      spun("bottle", [](int n) { return make_bottle(0.065, 0.205, n); }, 300, 1000,
           mesh::bottle_shape(0.065, 0.205), {0.065, 0.065, 0.205}),
      spun("cup", [](int n) { return make_cup(0.075, 0.09, n); }, 500, 1500, mesh::cup_shape(0.075, 0.09),
           {0.075, 0.075, 0.09}),
      spun("pen", [](int n) { return make_pen(0.01, 0.14, n); }, 300, 1000, mesh::pen_shape(0.01, 0.14),
           {0.01, 0.01, 0.14}),
      spun("dowel", [](int n) { return make_peg(0.009, 0.032, 0.0, n); }, 300, 300,
           mesh::peg_shape(0.009, 0.032, 0.0), {0.009, 0.009, 0.032}),
      spun("peg", [](int n) { return make_peg(0.01, 0.05, 0.024, n); }, 300, 300,
           mesh::peg_shape(0.01, 0.05, 0.024), {0.024, 0.024, 0.05}),
      spun("jar", [](int n) { return make_jar(0.08, 0.11, 0.07, n); }, 300, 1000,
           mesh::jar_shape(0.08, 0.11, 0.07), {0.08, 0.08, 0.11}),
      spun("tap_handle", [](int n) { return make_tap_handle(0.06, 0.05, n); }, 400, 2500,
           mesh::tap_handle_shape(0.06, 0.05), {0.06, 0.06, 0.05}),
      {"key",
       [](int n) { return make_key(kKeyLength, kKeyBreadth, kKeyThickness, n); },
       500,
       500,
       0,
       key_volume(),
       {kKeyLength, kKeyBreadth, kKeyThickness},
       off_key},
      {"therapy_ball", [](int n) { return make_therapy_ball(0.07, 0.004, n); }, 300, 40'000, 2,
       ball_volume(0.07, 0.004), Vec3::Constant(0.07),
       [](const Vec3& p) { return p.norm() - mesh::ball_radius(0.07, 0.004, p.normalized()); }},
      {"smooth_ball", [](int n) { return make_therapy_ball(0.07, 0.0, n); }, 300, 1000, 2,
       kPi / 6.0 * 0.07 * 0.07 * 0.07, Vec3::Constant(0.07), [](const Vec3& p) { return p.norm() - 0.035; }},
      {"putty_bar", [](int n) { return make_putty_bar(kBar, n); }, 500, 500, 2, bar_volume(kBar), kBar,
       [](const Vec3& p) { return off_bar(kBar, p); }},
  };
  return kThings;
}

/// Length of all edges whose triangles meet at 30 degrees or more [m].
double crease_length(const TriangleMesh& mesh) {
  std::map<std::pair<std::int32_t, std::int32_t>, std::size_t> of_edge;
  std::vector<Vec3> normal;
  const auto at = [&](std::int32_t i) { return mesh.vertices[static_cast<std::size_t>(i)]; };
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& [a, b, c] = mesh.triangles[t];
    normal.push_back((at(b) - at(a)).cross(at(c) - at(a)).normalized());
    for (const auto& edge : {std::pair{a, b}, std::pair{b, c}, std::pair{c, a}}) of_edge[edge] = t;
  }
  double length = 0.0;
  for (const auto& [edge, t] : of_edge) {
    if (edge.first > edge.second) continue;
    const std::size_t other = of_edge.at({edge.second, edge.first});
    if (normal[t].dot(normal[other]) <= std::cos(kPi / 6.0))
      length += (at(edge.first) - at(edge.second)).norm();
  }
  return length;
}

class Object : public ::testing::TestWithParam<Thing> {};

TEST_P(Object, IsOneClosedManifoldOfItsGenusAtAnyResolution) {
  for (double n = 1; n < 120'000; n = std::max(n * 1.9, n + 60.0)) {
    const TriangleMesh mesh = GetParam().make(static_cast<int>(n));
    ASSERT_EQ(test::manifold_flaw(mesh), "") << n;
    ASSERT_EQ(test::euler_characteristic(mesh), GetParam().euler) << n;
    ASSERT_GT(signed_volume(mesh), 0.0) << n;
    ASSERT_GT(test::worst_shape(mesh), 0.005) << n;
  }
}

TEST_P(Object, HasAboutAsManyTrianglesAsAskedUpToAMillion) {
  constexpr int kMost = test::kSlowBuild ? 100'000 : 1'000'000;
  for (double n = GetParam().least; n < 0.3 * kMost; n *= 1.11) {
    const auto count = static_cast<double>(GetParam().make(static_cast<int>(n)).triangles.size());
    EXPECT_NEAR(count / n, 1.0, 0.15) << n;
  }
  const TriangleMesh most = GetParam().make(kMost);
  EXPECT_NEAR(static_cast<double>(most.triangles.size()), kMost, 0.05 * kMost);
  EXPECT_TRUE(is_closed(most));
  EXPECT_GT(test::worst_shape(most), 0.005);
}

TEST_P(Object, HasItsExactExtentsAndIsCentred) {
  for (const int n : {1, 300, 777, 1000, 10'000, 100'000}) {
    const Bounds b = bounds(GetParam().make(n));
    EXPECT_LT((b.max - b.min - GetParam().extents).cwiseAbs().maxCoeff(), 1e-12) << n;
    EXPECT_LT((b.max + b.min).cwiseAbs().maxCoeff(), 1e-12) << n;
  }
}

TEST_P(Object, HasEveryVertexOnItsSurface) {
  for (const int n : {300, 3000})
    for (const Vec3& v : GetParam().make(n).vertices)
      ASSERT_LT(std::abs(GetParam().off(v)), 1e-9) << n << ": " << v.transpose();
}

// Chords miss the surface by O(h^2), and h^2 goes with 1/n.
TEST_P(Object, VolumeConvergesToTheExactOne) {
  const auto miss = [&](int n) {
    return std::abs(signed_volume(GetParam().make(n)) / GetParam().volume - 1.0);
  };
  EXPECT_LT(miss(1000), 0.10);
  EXPECT_LT(miss(10'000), 0.02);
  EXPECT_LT(miss(100'000), 0.002);
  if (!test::kSlowBuild) {
    EXPECT_LT(miss(1'000'000), 2.5e-4);
  }
}

TEST_P(Object, DoesNotCrossItself) {
  for (const int n : {1, 100, 300, 500, 1000, 2000, 8000})
    EXPECT_EQ(test::self_intersections(GetParam().make(n)), 0U) << n;
}

TEST_P(Object, HasItsEdgesAsCreasesAndNothingElse) {
  const double exact = crease_length(GetParam().make(200'000));
  for (const int n : {GetParam().smooth, 2 * GetParam().smooth, 7 * GetParam().smooth})
    EXPECT_NEAR(crease_length(GetParam().make(n)), exact, 0.05 * exact + 1e-12) << n;
}

TEST_P(Object, IsTheSameBitsEachTime) {
  for (const int n : {300, 5000}) {
    const TriangleMesh a = GetParam().make(n);
    const TriangleMesh b = GetParam().make(n);
    EXPECT_EQ(a.triangles, b.triangles);
    EXPECT_TRUE(a.vertices == b.vertices);
  }
}

INSTANTIATE_TEST_SUITE_P(All, Object, ::testing::ValuesIn(things()),
                         [](const auto& each) { return each.param.name; });

// By hand from the proportions in object_shapes.h: where the pieces of each profile end, (radius, z) in mm. A
// piece begins where the one before it ends, to the last bit.
TEST(ObjectShapes, HaveTheProfilesThatTheirProportionsMake) {
  struct Profile {
    const char* name;
    SpunShape shape;
    std::vector<std::pair<double, double>> ends;
  };
  const double rise = 12.0 / 98.4;  // of a cup's radius, 28 to 40 mm over the 98.4 mm from bottom to rim
  const Profile profiles[] = {
      {"bottle",
       mesh::bottle_shape(100, 300),
       {{42, -150}, {50, -142}, {50, 83}, {21, 123}, {21, 128}, {24, 128}, {24, 147}, {21, 150}, {0, 150}}},
      {"cup",
       mesh::cup_shape(80, 100),
       {{24 + 4 * rise, -50},
        {28 + 4 * rise, -46},
        {40, 48.4},
        {38.4, 50},
        {36.8, 48.4},
        {24.8 + 12.8 * rise, -37.2},
        {16.8 + 12.8 * rise, -45.2},
        {0, -45.2}}},
      {"pen", mesh::pen_shape(10, 140), {{0.5, -69.5}, {5, -54.5}, {5, 67.5}, {2.5, 70}, {0, 70}}},
      {"peg",
       mesh::peg_shape(10, 50, 24),
       {{3.8, -25}, {5, -23.8}, {5, 5}, {10.8, 5}, {12, 6.2}, {12, 23.8}, {10.8, 25}, {0, 25}}},
      {"short dowel", mesh::peg_shape(10, 10, 0), {{4, -5}, {5, -4}, {5, 4}, {4, 5}, {0, 5}}},
      {"jar",
       mesh::jar_shape(80, 110, 70),
       {{33.6, -55},
        {40, -48.6},
        {40, 24.6},
        {31.5, 34.2},
        {31.5, 37.4},
        {35, 37.4},
        {35, 52.6},
        {32.6, 55},
        {0, 55}}},
      {"tap handle",
       mesh::tap_handle_shape(60, 40),
       {{12, -20}, {12, -4}, {25.2, -4}, {30, 0.8}, {30, 12}, {25.2, 16.8}, {0, 20}}},
      {"long tap handle",
       mesh::tap_handle_shape(60, 100),
       {{12, -50}, {12, -10}, {24, -10}, {30, -4}, {30, 36}, {24, 42}, {0, 50}}}};
  for (const Profile& profile : profiles) {
    SCOPED_TRACE(profile.name);
    const std::vector<mesh::ProfilePiece>& pieces = profile.shape.pieces();
    ASSERT_EQ(pieces.size(), profile.ends.size());
    Eigen::Vector2d at = pieces[0].rz(0.0);
    EXPECT_EQ(at.x(), 0.0);
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      EXPECT_EQ(pieces[i].rz(0.0), at) << i;
      at = pieces[i].rz(1.0);
      EXPECT_NEAR(at.x(), profile.ends[i].first, 1e-9) << i;
      EXPECT_NEAR(at.y(), profile.ends[i].second, 1e-9) << i;
    }
  }
}

// In mm, with c = cos 45 degrees. Half way along a quarter arc: the bottle's foot from (42, -150) to (50,
// -142) leaves along r, the jar's shoulder from (40, 24.6) to (31.5, 34.2) along z. A quarter along a half
// cosine: the bottle's shoulder from (50, 83) to (21, 123), the tap handle's dome from (25.2, 16.8) to (0,
// 20), whose lobes, 0.3 deep, have gone down to 3/4 of that.
TEST(ObjectShapes, HaveArcsAndHalfCosinesBetweenTheirEnds) {
  const double c = std::sqrt(0.5);
  const auto expect = [](const SpunShape& shape, std::size_t piece, double f, double r, double z) {
    const Eigen::Vector2d rz = shape.pieces()[piece].rz(f);
    EXPECT_NEAR(rz.x(), r, 1e-12);
    EXPECT_NEAR(rz.y(), z, 1e-12);
  };
  expect(mesh::bottle_shape(100, 300), 1, 0.5, 42 + 8 * c, -150 + 8 * (1 - c));
  expect(mesh::jar_shape(80, 110, 70), 3, 0.5, 40 - 8.5 * (1 - c), 24.6 + 9.6 * c);
  expect(mesh::bottle_shape(100, 300), 3, 0.25, 50 - 14.5 * (1 - c), 93);
  const SpunShape tap = mesh::tap_handle_shape(60, 40);
  expect(tap, 6, 0.25, 18.9, 16.8 + 1.6 * (1 - c));
  const double between = 18.9 * (1.0 - 0.75 * 0.3) * c;
  EXPECT_LT((tap.point({c, c}, 6, 0.25) - Vec3(between, between, 16.8 + 1.6 * (1 - c))).norm(), 1e-12);
}

// By hand: 0.1 and 0.05 m long and broad, so that the bow's centre is at x = -25 mm; hole and blade are 0.42
// and 0.38 of its radius of 25 mm.
TEST(Key, HasItsHoleItsBladeAndItsFiveCuts) {
  double hole = 1.0;
  double blade = 0.0;
  for (const Vec3& v : make_key(0.1, 0.05, 0.005, 2000).vertices) {
    hole = std::min(hole, std::hypot(v.x() + 0.025, v.y()));
    if (v.x() > 0.0) blade = std::max(blade, v.y());
  }
  EXPECT_NEAR(hole, 0.0105, 1e-12);
  EXPECT_NEAR(blade, 0.0095, 1e-12);
  // Five cuts, each 0.05 of the blade long, 0.14 apart, with 0.06 of its breadth cut away between them.
  const std::vector<std::pair<double, double>> lower = {
      {0.0, 0.0},    {0.22, 0.0},  {0.275, 0.30}, {0.325, 0.30}, {0.37, 0.06}, {0.415, 0.18},
      {0.465, 0.18}, {0.51, 0.06}, {0.555, 0.36}, {0.605, 0.36}, {0.65, 0.06}, {0.695, 0.22},
      {0.745, 0.22}, {0.79, 0.06}, {0.835, 0.32}, {0.885, 0.32}, {0.93, 0.10}, {1.0, 0.45}};
  const std::vector<std::pair<double, double>> upper = {{0.0, 0.0}, {0.93, 0.0}, {1.0, 0.35}};
  for (const auto& [edge, corners] :
       {std::pair{mesh::key_lower_edge(), &lower}, {mesh::key_upper_edge(), &upper}}) {
    ASSERT_EQ(edge.size(), corners->size());
    for (std::size_t i = 0; i < edge.size(); ++i) {
      EXPECT_NEAR(edge[i].along, (*corners)[i].first, 1e-12) << i;
      EXPECT_NEAR(edge[i].depth, (*corners)[i].second, 1e-12) << i;
    }
  }
}

// A bump of 4 mm on a ball of 70 mm ends 11 degrees from its top; half way down its height is (1 - 1/4)^2 of
// that.
TEST(TherapyBall, HasBumpsOfElevenDegrees) {
  const auto radius = [](double degrees) {
    const double angle = degrees * kPi / 180.0;
    return mesh::ball_radius(0.07, 0.004, {std::cos(angle), 0.0, std::sin(angle)});
  };
  EXPECT_NEAR(radius(0.0), 0.035, 1e-15);
  EXPECT_NEAR(radius(5.5), 0.03325, 1e-12);
  EXPECT_NEAR(radius(11.0), 0.031, 1e-12);
  EXPECT_GT(radius(10.9), 0.031);
  EXPECT_NEAR(radius(30.0), 0.035, 1e-12) << "the next row";
}

// 30 mm is the smallest length: the flat top ends 9 mm from the sides.
TEST(PuttyBar, IsRoundedByThreeTenthsOfItsSmallestLength) {
  Vec3 flat = Vec3::Zero();
  for (const Vec3& v : make_putty_bar(kBar, 2000).vertices)
    if (v.z() == 0.5 * kBar.z()) flat = flat.cwiseMax(v);
  EXPECT_LT((flat - Vec3(0.041, 0.0085, 0.015)).norm(), 1e-12);
}

// By hand: cylinder of 9 mm between two frusta from 9 to 6.84 mm (chamfer 0.12 * 9 mm = 1.08 mm).
TEST(Peg, HasTheVolumeOfADowelWithChamfers) {
  const double r = 4.5;
  const double s = 4.5 - 1.08;
  const double volume = kPi * r * r * (32.0 - 2.16) + 2.0 * kPi * 1.08 / 3.0 * (r * r + r * s + s * s);
  EXPECT_NEAR(signed_volume(make_peg(0.009, 0.032, 0.0, 200'000)) / (volume * 1e-9), 1.0, 1e-3);
}

// By hand, in mm: half a ball of radius 0.5 (a tenth of the barrel's), a cone of length 15 (one and a half
// diameters) from there to the radius 5, the barrel of length 140 - 0.5 - 15 - 2.5, and the end, rounded with
// 2.5 (a quarter of the diameter): pi 2.5^3 times the integral of (1 + cos a)^2 cos a over a right angle,
// which is 5/3 + pi/2. In all 0.26 + 435.90 + 9581.86 + 158.92 mm^3.
TEST(Pen, HasTheVolumeOfItsParts) {
  const double tip = 2.0 / 3.0 * kPi * 0.5 * 0.5 * 0.5;
  const double cone = kPi * 15.0 / 3.0 * (0.5 * 0.5 + 0.5 * 5.0 + 5.0 * 5.0);
  const double barrel = kPi * 5.0 * 5.0 * 122.0;
  const double end = kPi * 2.5 * 2.5 * 2.5 * (5.0 / 3.0 + 0.5 * kPi);
  EXPECT_NEAR(spun_volume(mesh::pen_shape(0.01, 0.14)) * 1e9, tip + cone + barrel + end, 1e-3);
}

TEST(Cup, IsHollow) {
  // The point halfway up on the axis is outside the material: the cup's volume is far below its hull's.
  const double hull = kPi / 12.0 * 0.09 * (0.075 * 0.075 + 0.075 * 0.0525 + 0.0525 * 0.0525);
  EXPECT_LT(signed_volume(make_cup(0.075, 0.09, 20'000)), 0.3 * hull);
}

TEST(Objects, AreMadeForTheWholeRangeOfProportions) {
  std::vector<TriangleMesh> made;
  for (const int n : {700, 4000}) {
    for (const double ratio : {1.5, 3.0, 8.0}) made.push_back(make_bottle(0.06, 0.06 * ratio, n));
    for (const double ratio : {0.5, 1.0, 3.0}) made.push_back(make_cup(0.07, 0.07 * ratio, n));
    for (const double ratio : {4.0, 15.0, 40.0}) made.push_back(make_pen(0.01, 0.01 * ratio, n));
    for (const double ratio : {1.0, 4.0, 20.0})
      for (const double head : {0.0, 1.2, 6.0}) made.push_back(make_peg(0.01, 0.01 * ratio, 0.01 * head, n));
    for (const double ratio : {0.7, 1.5, 5.0})
      for (const double lid : {0.5, 0.8, 1.05}) made.push_back(make_jar(0.08, 0.08 * ratio, 0.08 * lid, n));
    for (const double ratio : {0.3, 1.0, 2.0}) made.push_back(make_tap_handle(0.06, 0.06 * ratio, n));
    for (const double bump : {0.0, 0.001, 0.0105}) made.push_back(make_therapy_ball(0.07, bump, n));
    for (const double ratio : {1.8, 2.3, 4.0})
      for (const double thick : {0.02, 0.1, 0.3})
        made.push_back(make_key(0.025 * ratio, 0.025, 0.025 * thick, n));
    for (const Vec3& size : {Vec3(0.05, 0.05, 0.05), Vec3(0.02, 0.2, 0.2), Vec3(0.02, 0.02, 0.2)})
      made.push_back(make_putty_bar(size, n));
  }
  for (std::size_t i = 0; i < made.size(); ++i) {
    EXPECT_EQ(test::manifold_flaw(made[i]), "") << i;
    EXPECT_EQ(test::self_intersections(made[i]), 0U) << i;
    EXPECT_GT(signed_volume(made[i]), 0.0) << i;
  }
}

// Every length of every maker, and the count.
TEST(ObjectRefusals, NameEachLengthThatIsNone) {
  using Lengths = std::vector<double>;
  struct Maker {
    std::string name;
    std::vector<std::string> names;
    Lengths good;
    std::function<TriangleMesh(const Lengths&, int)> make;
  };
  const std::string any = "a length";
  const std::string edge = "an edge length";
  const std::vector<Maker> makers = {
      {"make_bottle",
       {"diameter", "length"},
       {0.06, 0.2},
       [](const Lengths& l, int n) { return make_bottle(l[0], l[1], n); }},
      {"make_cup",
       {"diameter", "length"},
       {0.07, 0.09},
       [](const Lengths& l, int n) { return make_cup(l[0], l[1], n); }},
      {"make_pen",
       {"diameter", "length"},
       {0.01, 0.14},
       [](const Lengths& l, int n) { return make_pen(l[0], l[1], n); }},
      {"make_peg",
       {"diameter", "length", "head_diameter"},
       {0.01, 0.05, 0.024},
       [](const Lengths& l, int n) { return make_peg(l[0], l[1], l[2], n); }},
      {"make_jar",
       {"diameter", "length", "lid_diameter"},
       {0.08, 0.11, 0.07},
       [](const Lengths& l, int n) { return make_jar(l[0], l[1], l[2], n); }},
      {"make_tap_handle",
       {"diameter", "length"},
       {0.06, 0.05},
       [](const Lengths& l, int n) { return make_tap_handle(l[0], l[1], n); }},
      {"make_key",
       {"length", "breadth", "thickness"},
       {0.057, 0.025, 0.0022},
       [](const Lengths& l, int n) { return make_key(l[0], l[1], l[2], n); }},
      {"make_therapy_ball",
       {"diameter"},
       {0.07},
       [](const Lengths& l, int n) { return make_therapy_ball(l[0], 0.004, n); }},
      {"make_putty_bar",
       {any, any, any},
       {0.1, 0.035, 0.03},
       [](const Lengths& l, int n) { return make_putty_bar({l[0], l[1], l[2]}, n); }},
      {"make_box",
       {edge, edge, edge},
       {0.1, 0.1, 0.1},
       [](const Lengths& l, int n) { return make_box({l[0], l[1], l[2]}, n); }},
      {"make_sphere", {"diameter"}, {0.1}, [](const Lengths& l, int n) { return make_sphere(l[0], n); }},
      {"make_cylinder",
       {"diameter", "length"},
       {0.1, 0.1},
       [](const Lengths& l, int n) { return make_cylinder(l[0], l[1], n); }},
      {"make_torus",
       {"ring_diameter", "tube_diameter"},
       {0.1, 0.03},
       [](const Lengths& l, int n) { return make_torus(l[0], l[1], n); }},
      {"make_mug",
       {"diameter", "height"},
       {0.08, 0.1},
       [](const Lengths& l, int n) { return make_mug(l[0], l[1], n); }},
      {"make_teapot", {"length"}, {0.2}, [](const Lengths& l, int n) { return make_teapot(l[0], n); }}};
  for (const Maker& maker : makers) {
    EXPECT_EQ(maker_refusal([&] { (void)maker.make(maker.good, 0); }),
              maker.name + ": triangles is 0; give 1 to 50000000");
    for (std::size_t i = 0; i < maker.good.size(); ++i) {
      for (const auto& [bad, words] :
           {std::pair{-0.01, "-0.01"}, {std::numeric_limits<double>::quiet_NaN(), "nan"}}) {
        Lengths lengths = maker.good;
        lengths[i] = bad;
        EXPECT_EQ(maker_refusal([&] { (void)maker.make(lengths, 300); }),
                  maker.name + ": " + maker.names[i] + " is " + words + " m; give a finite length above 0");
      }
    }
  }
}

// A thousandth beyond each end of each range of proportions in objects.h.
TEST(ObjectRefusals, NameTheRangeOfEachProportion) {
  struct Proportion {
    double least, most;
    std::string words;
    std::function<TriangleMesh(double)> make;
  };
  const std::vector<Proportion> proportions = {
      {1.5, 8.0, "make_bottle: a length", [](double k) { return make_bottle(0.06, 0.06 * k, 300); }},
      {0.5, 3.0, "make_cup: a length", [](double k) { return make_cup(0.07, 0.07 * k, 300); }},
      {4.0, 40.0, "make_pen: a length", [](double k) { return make_pen(0.01, 0.01 * k, 300); }},
      {1.0, 20.0, "make_peg: a length", [](double k) { return make_peg(0.01, 0.01 * k, 0.0, 300); }},
      {1.2, 6.0, "make_peg: a head_diameter", [](double k) { return make_peg(0.01, 0.05, 0.01 * k, 300); }},
      {0.7, 5.0, "make_jar: a length", [](double k) { return make_jar(0.08, 0.08 * k, 0.07, 300); }},
      {0.5, 1.05, "make_jar: a lid_diameter", [](double k) { return make_jar(0.08, 0.1, 0.08 * k, 300); }},
      {0.3, 2.0, "make_tap_handle: a length", [](double k) { return make_tap_handle(0.06, 0.06 * k, 300); }},
      {1.8, 4.0, "make_key: a length", [](double k) { return make_key(0.025 * k, 0.025, 0.002, 300); }},
      {0.02, 0.3, "make_key: a thickness", [](double k) { return make_key(0.05, 0.025, 0.025 * k, 300); }},
      {0.5, 3.0, "make_mug: a height", [](double k) { return make_mug(0.08, 0.08 * k, 300); }}};
  for (const Proportion& proportion : proportions)
    for (const double ratio : {0.999 * proportion.least, 1.001 * proportion.most})
      EXPECT_EQ(maker_refusal([&] { (void)proportion.make(ratio); }).find(proportion.words), 0U)
          << proportion.words << " " << ratio;
  EXPECT_NE(maker_refusal([] { (void)make_putty_bar({0.2002, 0.02, 0.02}, 300); }).find("give 1 to 10 times"),
            std::string::npos);
}

TEST(ObjectRefusals, NameTheMakerTheValueAndTheRemedy) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(maker_refusal([] { (void)make_bottle(-0.1, 0.2, 100); }),
            "make_bottle: diameter is -0.1 m; give a finite length above 0");
  EXPECT_EQ(maker_refusal([] { (void)make_bottle(0.1, 0.1, 100); }),
            "make_bottle: a length of 0.1 m is 1 times the diameter of 0.1 m; give 1.5 to 8 times");
  EXPECT_EQ(maker_refusal([] { (void)make_pen(0.01, 0.1, 0); }),
            "make_pen: triangles is 0; give 1 to 50000000");
  EXPECT_EQ(maker_refusal([&] { (void)make_cup(0.1, kNan, 100); }),
            "make_cup: length is nan m; give a finite length above 0");
  EXPECT_EQ(maker_refusal([] { (void)make_therapy_ball(0.07, 0.02, 100); }),
            "make_therapy_ball: bump is 0.02 m; give 0 (smooth) to 0.15 of the diameter of 0.07 m");
  EXPECT_NE(maker_refusal([&] { (void)make_therapy_ball(0.07, kNan, 100); }).find("bump is nan"),
            std::string::npos);
  EXPECT_NE(maker_refusal([] { (void)make_key(0.1, 0.02, 0.002, 100); }).find("1.8 to 4 times"),
            std::string::npos);
  EXPECT_NE(maker_refusal([] { (void)make_key(0.05, 0.02, 0.02, 100); }).find("thickness"),
            std::string::npos);
  EXPECT_NE(maker_refusal([] { (void)make_putty_bar({0.1, 0.0, 0.1}, 100); }).find("a length is 0 m"),
            std::string::npos);
  EXPECT_NE(maker_refusal([] { (void)make_putty_bar({0.2, 0.01, 0.1}, 100); }).find("1 to 10 times"),
            std::string::npos);
  EXPECT_NE(maker_refusal([] { (void)make_peg(0.01, 0.05, 0.011, 100); }).find("head_diameter"),
            std::string::npos);
  EXPECT_NE(maker_refusal([] { (void)make_peg(0.01, 0.05, -0.02, 100); }).find("head_diameter is -0.02"),
            std::string::npos);
  EXPECT_NE(maker_refusal([] { (void)make_jar(0.08, 0.1, 0.1, 100); }).find("0.5 to 1.05 times"),
            std::string::npos);
  EXPECT_NE(maker_refusal([] { (void)make_tap_handle(0.05, 0.2, 100); }).find("0.3 to 2 times"),
            std::string::npos);
}

}  // namespace
}  // namespace phalanx

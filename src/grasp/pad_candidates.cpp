// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>

#include "grasp/candidates.h"
#include "phalanx/core/constants.h"
#include "phalanx/core/index.h"

namespace phalanx {
namespace {

/// Posture whose pads face each other, in the hand's frame.
struct OpposedPads {
  double width = 0.0;  ///< between the pads [m]
  Vec3 middle = Vec3::Zero();
  Vec3 direction = Vec3::Zero();  ///< from the thumb's pad to the other
  JointArray angle{};
};

/// Two places of the object that face away from each other.
struct OpposedPlaces {
  double width = 0.0;
  Vec3 middle = Vec3::Zero();
  Vec3 direction = Vec3::Zero();
};

constexpr int kPoints = 500;  // drawn on the surface
constexpr std::size_t kMostPlaces = 4000;
constexpr double kFacing = 0.8;           // least cosine between a pad and the line to the other one
constexpr double kLeastWidth = 1e-3;      // [m]
constexpr double kWidthTolerance = 3e-3;  // between object and posture [m]
constexpr double kMostNarrowing = 12e-3;  // of the narrowest postures on a thin object [m]
constexpr std::ptrdiff_t kNarrowest = 200;
constexpr double kPadAlong = 0.5;  // place of the pad along the distal bone
constexpr double kPadBand = 3e-3;  // half width of the band in which its surface is looked for [m]
constexpr double kThrough = 1.3;   // the digits close to this part of the way from the open hand

/// Returns the surface point of a segment that is farthest in a direction of its frame, at a share of its length.
SurfacePoint pad_of(const TriangleMesh& mesh, const Vec3& direction, double share) {
  const Bounds box = bounds(mesh);
  const double z = share * box.min.z();
  Vec3 best(0.0, 0.0, z);
  double most = -kInfinity;
  for (const Vec3& v : mesh.vertices) {
    if (std::abs(v.z() - z) > kPadBand || direction.dot(v) <= most) continue;
    most = direction.dot(v);
    best = v;
  }
  best.z() = z;
  return {best, direction};
}

class PadCandidates : public GraspCandidates {
 public:
  PadCandidates(GraspType type, const HandModel& hand, const TriangleMesh& object, const ObjectShape& shape,
                double friction, Random& random)
      : type_(type), hand_(hand) {
    list_postures();
    list_places(object, shape, friction, random);
  }

  std::optional<GraspCandidate> draw(Random& random) const override {
    if (places_.empty() || postures_.empty()) return std::nullopt;
    const OpposedPlaces& places = places_[index(random, places_.size())];
    const auto by_width = [](const OpposedPads& pads, double width) { return pads.width < width; };
    const auto first =
        std::lower_bound(postures_.begin(), postures_.end(), places.width - kWidthTolerance, by_width);
    auto last = std::lower_bound(first, postures_.end(), places.width + kWidthTolerance, by_width);
    if (first == postures_.begin() &&
        first == last) {  // thinner than any posture: the narrowest ones close on it
      last += std::min(kNarrowest, std::ssize(postures_));
      if (first->width > places.width + kMostNarrowing) return std::nullopt;
    }
    if (first == last) return std::nullopt;
    const OpposedPads& pads =
        first[static_cast<std::ptrdiff_t>(index(random, static_cast<std::size_t>(last - first)))];
    const double turn = random.between(0.0, 2.0 * std::numbers::pi);
    const Vec3 u = pads.direction.unitOrthogonal();
    const Vec3 v = places.direction.unitOrthogonal();
    Mat3 in_hand;
    in_hand << pads.direction, u, pads.direction.cross(u);
    const Vec3 w = std::cos(turn) * v + std::sin(turn) * places.direction.cross(v);
    Mat3 in_world;
    in_world << places.direction, w, places.direction.cross(w);
    GraspCandidate out;
    out.X_WH.R = in_world * in_hand.transpose();
    out.X_WH.p = places.middle - out.X_WH.R * pads.middle;
    out.close = pads.angle;
    const HandParameters& limits = hand_.parameters();
    for (int j = 0; j < kJoints; ++j) {
      if (!grasp_rule(type_).digit[idx(digit_of_joint(j))]) continue;  // beside the object, not through it
      const double open = limits.open_angle[idx(j)];
      out.close[idx(j)] = std::clamp(open + kThrough * (out.close[idx(j)] - open), limits.min_angle[idx(j)],
                                     limits.max_angle[idx(j)]);
    }
    return out;
  }

 private:
  static std::size_t index(Random& random, std::size_t size) {
    return std::min(size - 1, static_cast<std::size_t>(random.uniform() * static_cast<double>(size)));
  }

  /// Pad of a digit at its angles, in the hand's frame.
  [[nodiscard]] SurfacePoint placed_pad(int digit, const DigitAngles& angle, int k,
                                        const SurfacePoint& pad) const {
    DigitPose pose;
    hand_.digit_pose(digit, angle, pose);
    const Pose& X_HS = pose.segment[idx(k)];
    return {X_HS * pad.point, X_HS.R * pad.normal};
  }

  void list_postures() {
    const bool lateral = type_ == GraspType::kLateral;
    const double side = hand_.handedness() == Handedness::kRight ? -1.0 : 1.0;  // of the thumb
    const SurfacePoint thumb_pad = pad_of(hand_.mesh(segment_index(0, 2)), -Vec3::UnitY(), kPadAlong);
    struct Half {
      DigitAngles angle;
      SurfacePoint pad;
    };
    std::vector<Half> thumbs;
    for (double flexion = 0.0; flexion <= 60.0; flexion += 5.0)
      for (const double abduction : {-25.0, -18.0, -11.0, -4.0, 4.0})
        for (const double mcp : {0.0, 12.0, 25.0, 40.0})
          for (const double ip : {0.0, 15.0, 30.0}) {
            const DigitAngles q = {flexion * kDeg, abduction * kDeg, mcp * kDeg, ip * kDeg};
            if (within_range(0, q)) thumbs.push_back({q, placed_pad(0, q, 2, thumb_pad)});
          }
    for (double mcp = lateral ? 20.0 : 10.0; mcp <= 80.0; mcp += 5.0) {
      for (double pip = lateral ? 55.0 : 10.0; pip <= (lateral ? 100.0 : 85.0); pip += 6.0) {
        const DigitAngles q = {mcp * kDeg, 0.0, pip * kDeg, (lateral ? 0.4 : 0.7) * pip * kDeg};
        const int last_finger = lateral ? kDigits - 1 : type_ == GraspType::kTripod ? 2 : 1;
        bool possible = true;
        for (int digit = 1; digit <= last_finger; ++digit) possible = possible && within_range(digit, q);
        if (!possible) continue;
        SurfacePoint other;
        if (lateral) {
          other =
              placed_pad(1, q, 1, pad_of(hand_.mesh(segment_index(1, 1)), side * Vec3::UnitX(), kPadAlong));
        } else {
          for (int digit = 1; digit <= last_finger; ++digit) {
            const SurfacePoint pad = placed_pad(
                digit, q, 2, pad_of(hand_.mesh(segment_index(digit, 2)), -Vec3::UnitY(), kPadAlong));
            other.point += pad.point / last_finger;
            other.normal += pad.normal / last_finger;
          }
          other.normal.normalize();
        }
        for (const Half& thumb : thumbs) {
          const Vec3 way = other.point - thumb.pad.point;
          const double width = way.norm();
          if (width < kLeastWidth) continue;
          const Vec3 along = way / width;
          if (thumb.pad.normal.dot(along) < kFacing || -other.normal.dot(along) < kFacing) continue;
          OpposedPads pads{width, 0.5 * (other.point + thumb.pad.point), along,
                           hand_.parameters().open_angle};
          set_digit(pads.angle, 0, thumb.angle);
          for (int digit = 1; digit <= last_finger; ++digit) set_digit(pads.angle, digit, q);
          postures_.push_back(pads);
        }
      }
    }
    std::stable_sort(postures_.begin(), postures_.end(),
                     [](const OpposedPads& a, const OpposedPads& b) { return a.width < b.width; });
  }

  [[nodiscard]] bool within_range(int digit, const DigitAngles& q) const {
    const HandParameters& limits = hand_.parameters();
    for (int i = 0; i < kJointsPerDigit; ++i) {
      const std::size_t j = idx(joint_index(digit, i));
      if (q[idx(i)] < limits.min_angle[j] || q[idx(i)] > limits.max_angle[j]) return false;
    }
    return true;
  }

  /// Lists pairs of places whose normals are within the friction cone about the line between them, as far from each
  /// other as two pads can be.
  void list_places(const TriangleMesh& object, const ObjectShape& shape, double friction, Random& random) {
    if (postures_.empty()) return;
    const double widest = postures_.back().width + kWidthTolerance;
    const double cosine = 1.0 / std::sqrt(1.0 + 0.64 * friction * friction);
    const std::vector<SurfacePoint> points = surface_points(object, kPoints, random);
    for (const SurfacePoint& a : points) {
      for (const SurfacePoint& b : points) {
        const Vec3 way = b.point - a.point;
        const double width = way.norm();
        if (width < kLeastWidth || width > widest) continue;
        const Vec3 along = way / width;
        if (-a.normal.dot(along) < cosine || b.normal.dot(along) < cosine) continue;
        places_.push_back({width, 0.5 * (a.point + b.point), along});
      }
    }
    // Near the object's centre its weight turns it least.
    std::stable_sort(places_.begin(), places_.end(), [&](const OpposedPlaces& a, const OpposedPlaces& b) {
      return (a.middle - shape.centre).squaredNorm() < (b.middle - shape.centre).squaredNorm();
    });
    if (places_.size() > kMostPlaces) places_.resize(kMostPlaces);
  }

  GraspType type_;
  const HandModel& hand_;
  std::vector<OpposedPads> postures_;
  std::vector<OpposedPlaces> places_;
};

}  // namespace

std::unique_ptr<GraspCandidates> pad_candidates(GraspType type, const HandModel& hand,
                                                const TriangleMesh& object, const ObjectShape& shape,
                                                double friction, Random& random) {
  return std::make_unique<PadCandidates>(type, hand, object, shape, friction, random);
}

}  // namespace phalanx

// SPDX-License-Identifier: Apache-2.0
// docs/architecture.md, "The GDP, exactly", written a second time, slowly and plainly: what the program is
// held against. Its own kinematics, triangles, contacts and forces; every pair of triangles is looked at, at
// every place; nothing is remembered from place to place. Of the program it uses the meshes, the numbers of
// the hand and surface_normals() of the mesh folder.
#pragma once

#include <array>
#include <vector>

#include "phalanx/contact/contact_parameters.h"
#include "phalanx/force/force_parameters.h"
#include "phalanx/hand/hand_model.h"
#include "phalanx/mesh/corner_normals.h"

namespace phalanx::test {

/// "The GDP, exactly": a stopped segment's clearance is the margin to within this much below it [m].
inline constexpr double kStopBand = 10e-9;
/// Pairs of triangles tie for a contact within this much of the least distance [m].
inline constexpr double kTieBand = 5e-6;

struct ReferenceRecord {
  bool active = false;
  Vec3 p_S = Vec3::Zero();           ///< the material point, in the segment's frame [m]
  Vec3 n_c = Vec3::Zero();           ///< in W
  Vec3 force_normal = Vec3::Zero();  ///< in W
  double offset = 0.0;               ///< d0 [m]
  bool along = false;                ///< its depth is counted along the way
  bool fades = false;                ///< d0 shrinks as the HCP moves
};

/// What is remembered from tick to tick.
struct ReferenceState {
  JointArray angle{};      ///< q_gdp [rad]
  JointArray hcp_angle{};  ///< q_hcp of the last tick [rad]
  std::array<bool, kDigits> started{};
  std::array<bool, kDigits> inside{};
  std::array<ReferenceRecord, kSegments> record;
};

/// A stop of one digit in the last tick.
struct ReferenceStop {
  int digit = 0;
  int segment = -1;  ///< the one that decides
  double s = 0.0;
  DigitAngles angle{};   ///< q(s) [rad]
  DigitAngles rate{};    ///< dq/ds of the joints that were free until then [rad]
  double closing = 0.0;  ///< speed at which the deciding pair closes, of the segment's greatest [0..1]
};

/// One contact of all pairs that tie.
struct ReferencePatch {
  bool any = false;
  double distance = 0.0;
  Vec3 on_segment = Vec3::Zero();
  Vec3 n_c = Vec3::Zero();
  Vec3 force_normal = Vec3::Zero();
  double extent = 0.0;  ///< of the places that tie [m]
  /// How far n_c may turn with the order in which pairs are gathered into places: 0 where every order gives
  /// the same places [rad].
  double doubt = 0.0;
  /// How far the force's direction may turn with the place on a triangle that the contact is beside, not on:
  /// a mean of several places. "Nearest" is there what a weight of its corners makes of it [rad].
  double normal_doubt = 0.0;
  // Of the pair that closes fastest, if one does:
  bool leads = false;
  Vec3 lead = Vec3::Zero();            ///< on the segment [m]
  Vec3 lead_direction = Vec3::Zero();  ///< from the object to the segment
  double lead_extent = 0.0;            ///< how far others that close as fast are from there [m]
};

/// Force of each segment and torque of each joint, by Hooke's law, with the fingertip cap.
struct ReferenceCommand {
  std::array<double, kSegments> force{};
  JointArray torque{};
};

class ReferenceGdp {
 public:
  ReferenceGdp(const HandModel& hand, const TriangleMesh& object, const ContactParameters& parameters);

  ReferenceState state;

  /// "The GDP, exactly", 1 to 4, of the whole hand.
  void tick(const JointArray& hcp, const std::array<bool, kDigits>& measured);
  /// Of the last tick, in their order.
  [[nodiscard]] const std::vector<ReferenceStop>& stops() const { return stops_; }

  /// X_WS by the product of D-H transforms.
  [[nodiscard]] Pose pose(int digit, int k, const DigitAngles& angle) const;
  /// Distance of the segment from the object, or `cap` if that is less [m].
  [[nodiscard]] double gap(int digit, int k, const DigitAngles& angle, double cap) const;
  /// The contact of all pairs within the margin.
  /// @param rate  how the joints moved until the segment stopped; null where it did not decide a stop
  [[nodiscard]] ReferencePatch patch(int digit, int k, const DigitAngles& angle,
                                     const DigitAngles* rate) const;
  /// How deep the record's point is behind its plane: (p_gdp - p_hcp) . n_c, or along the way [m].
  [[nodiscard]] double penetration(int digit, int k, const ReferenceRecord& record, const DigitAngles& gdp,
                                   const DigitAngles& hcp) const;
  /// Whether a segment nearer the palm than k pushes.
  [[nodiscard]] bool nearer_pushes(int digit, int k, const DigitAngles& gdp, const DigitAngles& hcp,
                                   const ReferenceState& at) const;
  /// Whether a segment of the digit crosses the object at these angles.
  [[nodiscard]] bool goes_through(int digit, const DigitAngles& angle) const;
  /// How a digit was when a tick began.
  struct Begin {
    bool lagged = false;                            ///< the GDP was not at the HCP
    std::array<double, kSegmentsPerDigit> depth{};  ///< with which each segment was pushed [m]
  };
  [[nodiscard]] Begin begin(const ReferenceState& at, int digit) const;
  /// d0 of a record that fades, after the HCP has gone `from` here `to` there. It was `deep` before.
  [[nodiscard]] double faded(int digit, int k, const ReferenceRecord& record, double deep,
                             const DigitAngles& gdp, const DigitAngles& from, const DigitAngles& to) const;
  /// Forces of `at`'s records between its GDP and its HCP.
  [[nodiscard]] ReferenceCommand command(const ReferenceState& at, const ForceLawParameters& law,
                                         const LimitParameters& limits) const;
  /// Greatest speed of any point of the segment for these rates, at any angles [m].
  [[nodiscard]] double speed(int digit, int k, const DigitAngles& rate) const;

 private:
  /// A triangle, a ball around it and its plane.
  struct Piece {
    std::array<Vec3, 3> corner;
    Vec3 centre;
    Vec3 normal;  ///< unit, or zero
    double radius;
  };
  struct Pair {
    std::size_t mine;
    std::size_t theirs;
    std::array<Vec3, 3> a;  ///< the segment's, in W
    Vec3 on_a;
    Vec3 on_b;
    double distance;
    [[nodiscard]] Vec3 direction() const { return (on_a - on_b) / distance; }
  };
  struct View;

  static bool beyond(const std::array<Vec3, 3>& points, const Piece& piece, double limit);
  static std::vector<Piece> pieces_of(const TriangleMesh& mesh);
  /// Calls use(pair) for every pair of triangles within the limit; use() returns the limit from there on.
  template <class Use>
  void for_each_pair(int digit, int k, const DigitAngles& angle, double limit, Use&& use) const;
  [[nodiscard]] View view(int digit, const DigitAngles& from, const DigitAngles& rate, double s,
                          bool look_ahead) const;
  [[nodiscard]] ReferenceStop first_stop(int digit, const DigitAngles& from, const DigitAngles& rate,
                                         double s) const;
  /// d0 of a new record of segment k: rule 3. `hcp` is the HCP at this moment of the tick, `hcp_end` at its
  /// end.
  void set_offset(int digit, int k, const Begin& start, const DigitAngles& gdp, const DigitAngles& hcp,
                  const DigitAngles& hcp_end, ReferenceRecord& fresh) const;
  void tick_digit(int digit, const DigitAngles& hcp, bool measured);
  /// How fast the point x of the segment closes along -n, by a difference of poses [m per unit of s].
  [[nodiscard]] double closing_speed(int digit, int k, const DigitAngles& angle, const DigitAngles& rate,
                                     const Vec3& n, const Vec3& x) const;
  [[nodiscard]] Vec3 object_normal(const std::vector<Pair>& tied, const Vec3& contact, const Vec3& n_c,
                                   double& doubt) const;

  HandParameters hand_;
  bool left_;
  Pose X_WH_;
  ContactParameters parameters_;
  std::array<std::vector<Piece>, kSegments> segment_;
  std::array<double, kSegments> radius_{};  ///< farthest vertex from the segment's origin [m]
  std::vector<Piece> object_;
  SurfaceNormals normals_;
  std::vector<ReferenceStop> stops_;
};

}  // namespace phalanx::test

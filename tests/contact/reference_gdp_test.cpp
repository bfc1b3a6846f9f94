// SPDX-License-Identifier: Apache-2.0
// The program beside a slow, plain second writing of "The GDP, exactly", tick by tick.
//
// Smooth motions run from the reference's own state: it is never told what the program found. Motions that
// jump far in each tick are begun from the program's state at every tick: a finger that glances off an edge
// may pass it in the one and stop in the other, both within the 10 nm that the margin leaves them, and from
// there on they are two different fingers. Where that happens in a smooth motion, the reference goes on from
// the program's state too; it is counted, and must be rare.
//
// PHALANX_FULL=1 runs more seeds, without a sanitizer. PHALANX_REFERENCE_MOTION=FILE.csv[:FILE.csv...] runs
// recordings of a glove (columns thumb_mcp, index_pip, ... in rad), in front of the mesh file
// PHALANX_REFERENCE_MESH if there is one.
#include "support/reference/reference_gdp.h"

#include <gmock/gmock.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <numbers>
#include <sstream>

#include "phalanx/contact/gdp.h"
#include "phalanx/core/index.h"
#include "phalanx/force/force_stage.h"
#include "phalanx/mesh/import.h"
#include "phalanx/mesh/primitives.h"
#include "phalanx/step/haptic_step.h"
#include "support/human_motion.h"
#include "support/reference/surface_bound.h"
#include "support/sanitized.h"
#include "support/search_cases.h"
#include "support/simple_hand.h"

namespace phalanx {
namespace {

using test::kStopBand;
using test::ReferenceCommand;
using test::ReferenceGdp;
using test::ReferencePatch;
using test::ReferenceRecord;
using test::ReferenceState;
using test::ReferenceStop;

bool runs_whole_range() {
  const char* full = std::getenv("PHALANX_FULL");
  return !test::kSlowBuild && full != nullptr && *full != '\0' && std::string(full) != "0";
}

ReferenceState values_of(const GdpState& gdp) {
  ReferenceState out{gdp.angle, gdp.hcp_angle, gdp.started, gdp.inside, {}};
  for (std::size_t s = 0; s < kSegments; ++s) {
    const ContactRecord& r = gdp.record[s];
    out.record[s] = {r.active, r.p_S, r.n_c, r.force_normal, r.offset, r.along, r.fades};
  }
  return out;
}

/// Whether it is the same contact, to the last bit. Its d0 and how its depth is counted may have changed
/// since.
bool same_contact(const ReferenceRecord& a, const ReferenceRecord& b) {
  return a.active == b.active && a.p_S == b.p_S && a.n_c == b.n_c && a.force_normal == b.force_normal;
}

/// What has been compared, and the largest differences.
struct Compared {
  int ticks = 0;
  int stops = 0;
  int records = 0;  ///< new ones
  int offsets = 0;  ///< of them with d0 > 0
  int renewed = 0;  ///< of them in place of another in a segment that did not move
  int fading = 0;   ///< of them with a d0 that fades
  int along = 0;    ///< of them with their depth counted along the way
  int grazing = 0;
  int hovering = 0;
  int exhausted = 0;
  int between = 0;            ///< records whose contact is the mean of places apart, beside all triangles
  double displacement = 0.0;  ///< between the two GDP [m]
  double point = 0.0;         ///< of new records, at the same pose [m]
  double direction = 0.0;     ///< of n_c [rad]
  double normal = 0.0;        ///< of the force's direction [rad]
  double depth = 0.0;         ///< [m]
  double force = 0.0;         ///< [N]
  double torque = 0.0;        ///< [Nm]

  void add(const Compared& other) {
    stops += other.stops;
    records += other.records;
    offsets += other.offsets;
    renewed += other.renewed;
    fading += other.fading;
    along += other.along;
  }

  void print(const std::string& name) const {
    std::printf(
        "%s: %d ticks, %d stops, %d new records, %d of them with d0, %d renewed, %d fading, %d along the "
        "way; grazing "
        "%d, hovering %d, "
        "exhausted %d, between places %d; apart "
        "%.1e m; point %.1e m, n_c %.1e rad, n %.1e rad; depth %.1e m, force %.1e N, torque %.1e Nm\n",
        name.c_str(), ticks, stops, records, offsets, renewed, fading, along, grazing, hovering, exhausted,
        between, displacement, point, direction, normal, depth, force, torque);
  }
};

enum class From { kOwnState, kProgramsState };

class Beside {
 public:
  Beside(const test::Setup& model, From from)
      : model_(model),
        contact_{model.hand, model.trees(), model.object, model.parameters.contact},
        from_(from),
        reference_(model.hand, model.object.mesh(), model.parameters.contact),
        gdp_(contact_),
        step_(model, model.parameters) {
    model.hand.poses(model.hand.parameters().open_angle, force_.hcp_before);
  }

  void tick(const JointArray& hcp) {
    std::array<bool, kDigits> measured{};
    measured.fill(true);
    before_ = values_of(gdp_);
    if (from_ == From::kProgramsState) reference_.state = before_;
    reference_before_ = reference_.state;

    HandPoses poses;
    model_.hand.poses(hcp, poses);
    const Status status = advance_gdp(contact_, hcp, poses, measured, gdp_);
    compute_command(model_.parameters, gdp_, poses, false, force_);
    now_ = values_of(gdp_);
    if (has(status, Status::kSearchExhausted)) {  // it stops early, and says so: nothing to compare but that
                                                  // it is clear
      ++out.exhausted;
      reference_.state = now_;
      for (int s = 0; s < kPalm; ++s) {
        const int d = digit_of_segment(s);
        ASSERT_GE(reference_.gap(d, s % kSegmentsPerDigit, angles(now_, d), 1e-3),
                  model_.parameters.contact.margin - kStopBand);
      }
      step(model_, model_.parameters, Sample{time_ += 1.0 / model_.parameters.rate_hz, hcp}, step_);
      return;
    }
    reference_.tick(hcp, measured);

    ++out.ticks;
    out.stops += static_cast<int>(reference_.stops().size());
    for (int d = 0; d < kDigits; ++d) {
      SCOPED_TRACE(::testing::Message() << "tick " << out.ticks << " " << digit_name(d));
      ASSERT_NO_FATAL_FAILURE(check_digit(d));
    }
    ASSERT_NO_FATAL_FAILURE(check_command());
    ASSERT_NO_FATAL_FAILURE(check_step(hcp, status));
  }

  Compared out;

 private:
  [[nodiscard]] DigitAngles angles(const ReferenceState& state, int d) const {
    return digit_angles(state.angle, d);
  }

  /// How far two poses of the digit's segment are apart at most [m].
  [[nodiscard]] double apart(int d, int k, const ReferenceState& a, const ReferenceState& b) const {
    DigitAngles difference = angles(a, d);
    for (std::size_t i = 0; i < difference.size(); ++i) difference[i] -= angles(b, d)[i];
    return reference_.speed(d, k, difference);
  }

  void check_digit(int d) {
    const double margin = model_.parameters.contact.margin;
    const DigitAngles ours = angles(now_, d);
    bool record = false;
    for (int k = 0; k < kSegmentsPerDigit; ++k) {
      const std::size_t segment = idx(segment_index(d, k));
      // The reference's own kinematics: 20 products of numbers below 0.5 m round by less than 1e-14 m.
      const Pose& X = gdp_.poses.digit[idx(d)].segment[idx(k)];
      const Pose own = reference_.pose(d, k, ours);
      ASSERT_LT((X.p - own.p).norm() + (X.R - own.R).norm(), 1e-13);
      ASSERT_GE(reference_.gap(d, k, ours, 1.1 * margin), margin - kStopBand) << "segment " << k;
      record = record || now_.record[segment].active;
    }
    ASSERT_TRUE(record || ours == digit_angles(now_.hcp_angle, d));
    if (!agree_on_stops(d)) {
      reference_.state = state_with_digit_of_program(d);
      return;
    }
    ASSERT_EQ(now_.inside[idx(d)], reference_.state.inside[idx(d)]);
    for (int k = 0; k < kSegmentsPerDigit; ++k) ASSERT_NO_FATAL_FAILURE(check_record(d, k));
  }

  [[nodiscard]] ReferenceState state_with_digit_of_program(int d) const {
    ReferenceState state = reference_.state;
    for (int i = 0; i < kJointsPerDigit; ++i)
      state.angle[idx(joint_index(d, i))] = now_.angle[idx(joint_index(d, i))];
    state.inside[idx(d)] = now_.inside[idx(d)];
    for (int k = 0; k < kSegmentsPerDigit; ++k)
      state.record[idx(segment_index(d, k))] = now_.record[idx(segment_index(d, k))];
    return state;
  }

  /// Whether both stopped in the same place with the same records. Where they need not: counts it, false.
  bool agree_on_stops(int d) {
    const double margin = model_.parameters.contact.margin;
    double was = 0.0;
    double is = 0.0;
    for (int k = 0; k < kSegmentsPerDigit; ++k) {
      was = std::max(was, apart(d, k, before_, reference_before_));
      is = std::max(is, apart(d, k, now_, reference_.state));
    }
    // A stop lies where the clearance is the margin to within the band. A pair that closes at the share c of
    // the greatest speed goes (what they were apart + band) / c in that. Each stop adds what it shifts by.
    double allowed = was + 1e-12;
    bool glances = false;
    for (const ReferenceStop& stop : reference_.stops()) {
      if (stop.digit != d) continue;
      glances = glances || stop.closing < 0.02;
      allowed += (allowed + kStopBand) / stop.closing;
    }
    std::vector<int> flags;
    for (int k = 0; k < kSegmentsPerDigit; ++k) {
      const std::size_t s = idx(segment_index(d, k));
      if (now_.record[s].active != reference_.state.record[s].active) flags.push_back(k);
    }
    if (is <= allowed && flags.empty()) {
      out.displacement = std::max(out.displacement, is);
      return true;
    }
    if (is <= allowed) {
      // The same place, but a segment that nothing stops is within the margin in the one, beyond in the
      // other.
      for (const int k : flags) {
        const double clearance = reference_.gap(d, k, angles(now_, d), 2.0 * margin);
        EXPECT_LE(std::abs(clearance - margin), kStopBand + is)
            << "a record of segment " << k << " in one only";
      }
      ++out.hovering;
      return false;
    }
    // One stopped where the other went on: only if nothing between is nearer than the band allows, and where
    // either rests there is a segment in the band.
    constexpr int kPlaces = 64;
    double nearest = 1.0;
    for (int n = 0; n <= kPlaces; ++n) {
      DigitAngles q = angles(now_, d);
      for (std::size_t i = 0; i < q.size(); ++i)
        q[i] += (angles(reference_.state, d)[i] - q[i]) * n / kPlaces;
      for (int k = 0; k < kSegmentsPerDigit; ++k)
        nearest = std::min(nearest, reference_.gap(d, k, q, 2.0 * margin));
    }
    EXPECT_GE(nearest, margin - kStopBand)
        << "apart " << is << ", allowed " << allowed << ", glances " << glances;
    for (const ReferenceState* state : std::array<const ReferenceState*, 2>{&now_, &reference_.state}) {
      if (angles(*state, d) == digit_angles(now_.hcp_angle, d)) continue;
      double least = 1.0;
      for (int k = 0; k < kSegmentsPerDigit; ++k)
        least = std::min(least, reference_.gap(d, k, angles(*state, d), 2.0 * margin));
      EXPECT_LE(least, margin + 1e-12)
          << (state == &now_ ? "the program" : "the reference") << " stopped early";
    }
    ++out.grazing;
    return false;
  }

  void check_record(int d, int k) {
    const std::size_t s = idx(segment_index(d, k));
    const ReferenceRecord& ours = now_.record[s];
    const ReferenceRecord& theirs = reference_.state.record[s];
    if (!ours.active) return;
    // First order in what differs: the place of the GDP; the point, which the turn between GDP and HCP
    // carries; the direction; the moment of the tick, with which the HCP moves; d0.
    const DigitAngles gdp = angles(now_, d);
    const DigitAngles hcp = digit_angles(now_.hcp_angle, d);
    double turn = 0.0;
    for (std::size_t i = 0; i < gdp.size(); ++i) turn += std::abs(gdp[i] - hcp[i]);
    const double way = (reference_.pose(d, k, gdp) * ours.p_S - reference_.pose(d, k, hcp) * ours.p_S).norm();
    double tolerance = apart(d, k, now_, reference_.state) + turn * (ours.p_S - theirs.p_S).norm() +
                       way * (ours.n_c - theirs.n_c).norm() + 1e-12;
    ASSERT_EQ(ours.along, theirs.along) << "segment " << k;
    ASSERT_EQ(ours.fades, theirs.fades) << "segment " << k;
    if (ours.along) tolerance *= 3.0;  // the parabola's start counts beside its end
    const bool kept = same_contact(theirs, reference_before_.record[s]);
    if (kept) {
      ASSERT_TRUE(same_contact(ours, before_.record[s]))
          << "segment " << k << ": a record changed without a reason";
    } else {
      ASSERT_NO_FATAL_FAILURE(check_new_record(d, k));
    }
    if (std::isinf(ours.offset)) {  // of a search that gave up: both had it from the program
      ASSERT_EQ(ours.offset, theirs.offset);
      return;
    }
    const double before =
        kept ? std::abs(before_.record[s].offset - reference_before_.record[s].offset) : 0.0;
    ASSERT_NEAR(ours.offset, theirs.offset,
                before + (ours.fades ? 4.0 : 1.0) * tolerance +
                    hcp_way(d, k) * (moment_apart(d, k) + (ours.n_c - theirs.n_c).norm()));
    tolerance += std::abs(ours.offset - theirs.offset);
    const double depth = reference_.penetration(d, k, ours, gdp, hcp) - ours.offset;
    const double their_depth =
        reference_.penetration(d, k, theirs, angles(reference_.state, d), hcp) - theirs.offset;
    ASSERT_NEAR(depth, their_depth, tolerance);
    ASSERT_NEAR(depth, gdp_.record[s].depth, ours.along ? 1e-12 : 1e-13);
    ASSERT_EQ(gdp_.record[s].silent, now_.inside[idx(d)]);
    out.depth = std::max(out.depth, std::abs(depth - their_depth));
  }

  /// How far the HCP of the segment goes in this tick at most [m].
  [[nodiscard]] double hcp_way(int d, int k) const {
    DigitAngles rate = digit_angles(now_.hcp_angle, d);
    for (std::size_t i = 0; i < rate.size(); ++i) rate[i] -= digit_angles(before_.hcp_angle, d)[i];
    return reference_.speed(d, k, rate);
  }

  /// The last stop that made a record of segment k: the first one that fixed it.
  [[nodiscard]] const ReferenceStop* stop_of(int d, int k) const {
    for (const ReferenceStop& stop : reference_.stops()) {
      if (stop.digit == d && stop.segment >= k) return &stop;
    }
    for (const ReferenceStop& stop : reference_.stops()) {
      if (stop.digit == d) return &stop;
    }
    return nullptr;
  }

  /// s of the program at that stop, from the angle of the joint that moved most.
  [[nodiscard]] double moment(int d, const ReferenceStop& stop) const {
    int fastest = 0;
    for (int i = 0; i < stop.segment + 2; ++i) {
      if (std::abs(stop.rate[idx(i)]) > std::abs(stop.rate[idx(fastest)])) fastest = i;
    }
    const std::size_t j = idx(joint_index(d, fastest));
    return (now_.angle[j] - before_.angle[j]) / (now_.hcp_angle[j] - before_.angle[j]);
  }
  [[nodiscard]] double moment_apart(int d, int k) const {
    const ReferenceStop* stop = stop_of(d, k);
    return stop == nullptr ? 0.0 : std::abs(moment(d, *stop) - stop->s);
  }

  /// The program's new record against the reference's at the program's own pose: no tolerance for the place.
  void check_new_record(int d, int k) {
    const std::size_t s = idx(segment_index(d, k));
    const ReferenceRecord& ours = now_.record[s];
    const DigitAngles gdp = angles(now_, d);
    ++out.records;
    out.renewed += before_.record[s].active && apart(d, k, before_, now_) == 0.0 ? 1 : 0;
    out.offsets += ours.offset > 0.0 ? 1 : 0;
    out.fading += ours.fades ? 1 : 0;
    out.along += ours.along ? 1 : 0;
    const ReferenceStop* stop = stop_of(d, k);
    ASSERT_NE(stop, nullptr) << "a new record without a stop";
    ReferencePatch expected = reference_.patch(d, k, gdp, stop->segment == k ? &stop->rate : nullptr);
    ASSERT_TRUE(expected.any);
    if (ours.along) {
      ASSERT_TRUE(expected.leads);
      expected.on_segment = expected.lead;
      expected.n_c = expected.force_normal = expected.lead_direction;
      expected.normal_doubt = 0.0;
    }
    const double point = (reference_.pose(d, k, gdp) * ours.p_S - expected.on_segment).norm();
    const double direction = test::angle_of(ours.n_c, expected.n_c);
    const double normal = test::angle_of(ours.force_normal, expected.force_normal);
    // Both have the same poses to 1e-13 m. A weight is a share of the band of 5 um, known to 2e-8 then; it
    // moves the point by that share of the extent of what ties, and turns a direction by that.
    EXPECT_LE(point, 1e-10 + (ours.along ? expected.lead_extent : 1e-7 * expected.extent));
    EXPECT_LE(direction, 1e-7 + expected.doubt);
    EXPECT_LE(test::angle_of(ours.force_normal, ours.n_c), std::numbers::pi / 6.0 + 1e-9);
    // The mean of places apart may hover beside all triangles. What is nearest to it on each is then not
    // defined to the last: the program clamps weights, the reference goes to the nearest edge. Only 30
    // degrees are sure.
    if (expected.normal_doubt <= 1e-2) {
      EXPECT_LE(normal, 1e-6 + expected.doubt + expected.normal_doubt)
          << "the program takes normals within 1e-6 for one";
    } else {
      ++out.between;
    }
    out.point = std::max(out.point, point);
    out.direction = std::max(out.direction, direction);
    out.normal = std::max(out.normal, normal);
    // d0 of the program's record at the program's moment.
    DigitAngles hcp = digit_angles(before_.started[idx(d)] ? before_.hcp_angle : now_.hcp_angle, d);
    const double s_now = moment(d, *stop);
    for (std::size_t i = 0; i < hcp.size(); ++i)
      hcp[i] += s_now * (digit_angles(now_.hcp_angle, d)[i] - hcp[i]);
    ReferenceRecord expected_record = ours;
    expected_record.offset = 0.0;
    const ReferenceRecord& theirs = reference_.state.record[s];
    if (theirs.fades || theirs.offset > 0.0) {
      const double deep = reference_.penetration(d, k, ours, gdp, hcp);
      expected_record.offset = std::max(0.0, deep - reference_.begin(before_, d).depth[idx(k)]);
      expected_record.offset =
          reference_.faded(d, k, expected_record, deep, gdp, hcp, digit_angles(now_.hcp_angle, d));
    }
    ASSERT_NEAR(ours.offset, expected_record.offset, 1e-10) << "segment " << k << " d0";
  }

  void check_command() {
    // The same records: what rounding leaves, and the differences' own error (h^2 / 6 = 2e-11 of a force).
    const ReferenceCommand same = reference_.command(now_, model_.parameters.force, model_.parameters.limits);
    const ReferenceCommand own =
        reference_.command(reference_.state, model_.parameters.force, model_.parameters.limits);
    for (int s = 0; s < kPalm; ++s) {
      ASSERT_NEAR(force_.segment[idx(s)].sent, same.force[idx(s)], 1e-9) << segment_name(s);
      out.force = std::max(out.force, std::abs(own.force[idx(s)] - same.force[idx(s)]));
    }
    for (int j = 0; j < kJoints; ++j) {
      ASSERT_NEAR(force_.torque[idx(j)], same.torque[idx(j)], 1e-9) << joint_name(j);
      out.torque = std::max(out.torque, std::abs(own.torque[idx(j)] - same.torque[idx(j)]));
    }
  }

  /// The whole step says the same as its stages.
  void check_step(const JointArray& hcp, Status status) {
    time_ += 1.0 / model_.parameters.rate_hz;
    const Status whole = step(model_, model_.parameters, Sample{time_, hcp}, step_);
    const Snapshot& s = step_.snapshot();
    ASSERT_EQ(s.gdp_angle, now_.angle);
    ASSERT_EQ(s.hcp_angle, hcp);
    ASSERT_EQ(s.torque, force_.torque);
    ASSERT_EQ(has(whole, Status::kStartInside), has(status, Status::kStartInside));
    ASSERT_EQ(has(whole, Status::kSlid), has(status, Status::kSlid));
    bool slid = false;
    for (int i = 0; i < kPalm; ++i) {
      const SegmentSnapshot& segment = s.segment[idx(i)];
      const ReferenceRecord& record = now_.record[idx(i)];
      const int d = digit_of_segment(i);
      const int k = i % kSegmentsPerDigit;
      ASSERT_EQ(segment.contact, record.active);
      if (!record.active) continue;
      const Vec3 p_gdp = reference_.pose(d, k, angles(now_, d)) * record.p_S;
      const Vec3 p_hcp = reference_.pose(d, k, digit_angles(hcp, d)) * record.p_S;
      ASSERT_LT((segment.point - p_gdp).norm(), 1e-13);
      ASSERT_EQ(segment.normal, record.force_normal);
      const double depth = reference_.penetration(d, k, record, angles(now_, d), digit_angles(hcp, d));
      ASSERT_NEAR(segment.depth, std::max(0.0, depth - record.offset), record.along ? 1e-12 : 1e-13);
      const double tangential = record.n_c.cross(p_gdp - p_hcp).norm();
      ASSERT_NEAR(segment.slid, tangential, 1e-12);
      slid = slid || tangential > model_.parameters.contact.slid_distance;
    }
    ASSERT_EQ(has(whole, Status::kSlid), slid);
  }

  const test::Setup& model_;
  ContactModel contact_;
  From from_;
  ReferenceGdp reference_;
  GdpState gdp_;
  ForceState force_;
  HapticState step_;
  ReferenceState before_;
  ReferenceState now_;
  ReferenceState reference_before_;
  double time_ = 0.0;
};

/// A hand of 800 triangles with its fingers 22 mm apart, so that several reach the same object.
HandModel close_hand(Handedness side = Handedness::kRight, bool with_coupling = false) {
  HandParameters hand = test::simple_parameters();
  for (int d = 0; d < kDigits; ++d) {
    hand.digits[idx(d)].base.x() = 0.022 * (d - 2);
    // Chains that no test could confuse with each other: each axis is a little off the textbook's.
    for (int i = 0; i < kJointsPerDigit; ++i) {
      hand.digits[idx(d)].dh[idx(i)].alpha += 0.02 * (d - 1) * (i % 2 == 0 ? 1 : -1);
      hand.digits[idx(d)].dh[idx(i)].theta += 0.01 * (d - 2);
      if (i > 0) hand.digits[idx(d)].dh[idx(i)].d += 0.0005 * (d - 2);
    }
  }
  hand.digits[0].dorsal = Vec3(0.3, 1.0, 0.0);
  return make_hand_model(with_coupling ? test::coupled(hand) : hand, side, Pose{}, 800);
}

struct Place {
  std::string name;
  TriangleMesh object;
};

std::vector<Place> places() {
  using test::at;
  using test::moved;
  const Pose across{rotation_about(Vec3::UnitY(), std::numbers::pi / 2.0), Vec3::Zero()};
  TriangleMesh sheet;
  sheet.vertices = {Vec3(-0.06, -0.022, -0.2), Vec3(0.06, -0.03, -0.2), Vec3(0.06, -0.03, 0.1),
                    Vec3(-0.06, -0.022, 0.1)};
  sheet.triangles = {{0, 1, 2}, {0, 2, 3}};
  TriangleMesh bars = moved(make_cylinder(0.012, 0.13, 48), at(0.0, -0.026, -0.028) * across);
  append(bars, make_cylinder(0.006, 0.13, 40), at(0.0, -0.030, -0.075) * across);
  return {{"ball", moved(make_sphere(0.05, 160), at(0.004, -0.042, -0.045))},
          {"bars", bars},
          {"torus", moved(make_torus(0.06, 0.014, 140),
                          Pose{rotation_about(Vec3::UnitX(), 1.2), Vec3(0.0, -0.045, -0.05)})},
          {"box", moved(make_box(Vec3(0.05, 0.03, 0.03), 48),
                        Pose{rotation_about(Vec3(1, 1, 0).normalized(), 0.6), Vec3(0.0, -0.045, -0.05)})},
          {"sheet", sheet}};
}

test::Setup model_before(const TriangleMesh& object, Handedness side = Handedness::kRight,
                         bool with_coupling = false) {
  test::Setup model(close_hand(side, with_coupling), ObjectModel(object));
  test::turn_limits_off(model);
  return model;
}

void expect_rare(const Compared& out) {
  // A stop is undecided where a pair closes at less than 2 % of the greatest speed or a second segment is
  // within 10 nm of the margin: of directions and distances that are spread evenly, a few in a hundred.
  EXPECT_LE(out.grazing + out.hovering, 3 + out.stops / 20);
  EXPECT_LE(out.exhausted, 1) << "1,000 places in one tick are for ways that no hand takes";
}

/// What is compared happens: the hand touches, also where a nearer segment already pushes.
void expect_touches(const Compared& all) {
  if (test::kSlowBuild) return;  // few ticks
  EXPECT_GT(all.stops, 0);
  EXPECT_GT(all.records, 0);
  EXPECT_GT(all.offsets, 0);
}

/// A glove's recording in this hand's angles: a column of the same name counts, with flexion negative, as the
/// gloves have it; the hand's range of motion clamps. Every sample is a tick.
std::vector<JointArray> recorded(const std::string& file, const HandParameters& hand) {
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  std::vector<int> joint_of_column;
  std::stringstream header(line);
  for (std::string name; std::getline(header, name, ',');) {
    const std::string flexion = name.ends_with("abduction") ? name : name + "_flexion";
    std::string full = flexion;
    for (const char* digit : {"index", "middle", "ring", "little"}) {
      if (name == std::string(digit) + "_abduction") full = std::string(digit) + "_mcp_abduction";
    }
    joint_of_column.push_back(find_joint(full).value_or(-1));
  }
  std::vector<JointArray> out;
  while (std::getline(in, line)) {
    JointArray q = hand.open_angle;
    std::stringstream row(line);
    std::string cell;
    for (std::size_t c = 0; c < joint_of_column.size() && std::getline(row, cell, ','); ++c) {
      if (joint_of_column[c] < 0) continue;
      const auto j = static_cast<std::size_t>(joint_of_column[c]);
      const bool abduction = j % kJointsPerDigit == kAbductionJoint;
      q[j] = std::clamp((abduction ? 1.0 : -1.0) * std::stod(cell), hand.min_angle[j], hand.max_angle[j]);
    }
    out.push_back(q);
  }
  return out;
}

TEST(ReferenceGdp, AgreesFromItsOwnStateOverRecordingsGivenByHand) {
  const char* files = std::getenv("PHALANX_REFERENCE_MOTION");
  if (files == nullptr) GTEST_SKIP() << "PHALANX_REFERENCE_MOTION names no recording";
  std::vector<Place> objects = places();
  if (const char* mesh = std::getenv("PHALANX_REFERENCE_MESH")) {
    objects = {
        {mesh, test::moved(import_and_check(mesh, {.size = 0.06}).mesh, test::at(0.0, -0.05, -0.045))}};
  }
  std::stringstream list(files);
  for (std::string file; std::getline(list, file, ':');) {
    for (const Place& place : objects) {
      SCOPED_TRACE(file + " before " + place.name);
      const test::Setup model = model_before(place.object);
      Beside beside(model, From::kOwnState);
      for (const JointArray& q : recorded(file, model.hand.parameters()))
        ASSERT_NO_FATAL_FAILURE(beside.tick(q));
      beside.out.print(file + " before " + place.name);
      expect_rare(beside.out);
    }
  }
}

void compare_over_human_motions(bool with_coupling) {
  const int seeds = runs_whole_range() ? 20 : test::kSlowBuild || with_coupling ? 1 : 3;
  Compared all;
  for (const Place& place : places()) {
    SCOPED_TRACE(place.name);
    const Handedness side = with_coupling && place.name == "bars" ? Handedness::kLeft : Handedness::kRight;
    const test::Setup model = model_before(place.object, side, with_coupling);
    for (int seed = 1; seed <= seeds; ++seed) {
      SCOPED_TRACE(::testing::Message() << "seed " << seed);
      Beside beside(model, From::kOwnState);
      test::HumanMotion motion(model.hand.parameters(), static_cast<std::uint64_t>(seed));
      const int ticks = test::kSlowBuild ? 40 : 240;
      for (int n = 0; n < ticks; ++n) ASSERT_NO_FATAL_FAILURE(beside.tick(motion.next(0.005)));
      beside.out.print(place.name + " human, seed " + std::to_string(seed));
      expect_rare(beside.out);
      all.add(beside.out);
    }
  }
  expect_touches(all);
}

TEST(ReferenceGdp, AgreesFromItsOwnStateOverHumanMotions) { compare_over_human_motions(false); }

TEST(ReferenceGdp, AgreesFromItsOwnStateOverHumanMotionsOfACoupledHand) { compare_over_human_motions(true); }

TEST(ReferenceGdp, AgreesTickByTickOverRandomMotions) {
  const int seeds = runs_whole_range() ? 20 : 1;
  Compared sum;
  const std::vector<Place> all = places();
  for (std::size_t p = 0; p < all.size(); ++p) {
    for (int seed = 1; seed <= seeds; ++seed) {
      SCOPED_TRACE(::testing::Message() << all[p].name << " seed " << seed);
      test::Setup model = model_before(all[p].object, p % 2 == 0 ? Handedness::kRight : Handedness::kLeft);
      if (p % 2 == 1) model.parameters.limits.fingertip_force_enabled = true;
      if (p == 3) model.parameters.contact.normal = ForceNormal::kContact;
      Beside beside(model, From::kProgramsState);
      test::Random random(static_cast<std::uint64_t>(seed));
      const HandParameters& hand = model.hand.parameters();
      const int phases = test::kSlowBuild ? 2 : 7;
      JointArray from = hand.open_angle;
      for (int phase = 0; phase < phases; ++phase) {
        JointArray goal{};
        for (std::size_t j = 0; j < kJoints; ++j)
          goal[j] = phase % 6 == 5 ? hand.open_angle[j]
                                   : test::between(random, hand.min_angle[j], hand.max_angle[j]);
        const int ticks = 5 + static_cast<int>(test::between(random, 0.0, 20.0));
        for (int n = 1; n <= ticks; ++n) {
          JointArray q{};
          for (std::size_t j = 0; j < kJoints; ++j)
            q[j] = std::clamp(from[j] + (goal[j] - from[j]) * n / ticks + test::between(random, -0.03, 0.03),
                              hand.min_angle[j], hand.max_angle[j]);
          ASSERT_NO_FATAL_FAILURE(beside.tick(q));
        }
        from = goal;
      }
      beside.out.print(all[p].name + " random, seed " + std::to_string(seed));
      expect_rare(beside.out);
      sum.add(beside.out);
    }
  }
  expect_touches(sum);
  if (!test::kSlowBuild) {
    EXPECT_GT(sum.renewed, 0);
    EXPECT_GT(sum.fading, 0);
  }
}

}  // namespace
}  // namespace phalanx

// SPDX-License-Identifier: Apache-2.0
#include "peer_gdp.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "peer_record.h"

namespace phalanx::bench {
namespace {

constexpr int kMostSteps = 1000;
/// A stopped segment's clearance lies between the margin and this much below it [m].
constexpr double kBand = 5e-9;
/// By how much a d0 that fades shrinks for each length that the contact's point goes on the HCP [-].
constexpr double kFade = 0.2;
/// Pairs this near are followed one by one: a pair along which the segment slides must not stop it [m].
constexpr double kNearWindow = 50e-6;

/// The pairs are farther apart than the margin, or they are within it and may not come nearer.
struct Floors {
  double margin;
  double of(double distance) const {
    const double floor = margin - kBand;
    return distance <= margin ? std::min(floor, distance - 5e-10) : floor;
  }
  /// Less than a nanometre a tick is no motion, as long as there is room for it.
  double creep(double distance) const { return distance > margin - kBand ? 1e-9 : 0.0; }
};

}  // namespace

struct PeerGdp::Tick {
  int digit;
  DigitAngles from;     ///< where the path begins [rad]
  DigitAngles rate;     ///< along the path [rad]
  DigitAngles hcp_was;  ///< the last tick's measured angles [rad]
  DigitAngles hcp;      ///< this tick's [rad]
  const DigitPose& hcp_pose;
  DigitAngles angle;
  DigitPose pose;
  double s = 0.0;
  int fixed = 0;
  int steps = 0;
  bool exhausted = false;
  bool lagged = false;                             ///< the GDP was not at the HCP
  std::array<double, kSegmentsPerDigit> pushed{};  ///< depth of each record that pushed when the tick began

  [[nodiscard]] int first_moving() const {
    for (int i = 0; i < kJointsPerDigit; ++i) {
      if (rate[idx(i)] != 0.0) return segment_in_digit_of_joint(i);
    }
    return kSegmentsPerDigit;
  }
  void go_to(const HandModel& hand, double to) {
    s = to;
    for (int i = fixed; i < kJointsPerDigit; ++i)
      angle[idx(i)] = s < 1.0 ? from[idx(i)] + s * rate[idx(i)] : hcp[idx(i)];
    hand.digit_pose(digit, angle, pose);
  }
};

struct PeerGdp::Stop {
  int segment = -1;  ///< -1: came to the end of the path
};

struct PeerGdp::Step {
  double length = 0.0;
  bool blocked = false;
  bool near = false;  ///< may be within the margin after the step
};

PeerGdp::PeerGdp(const HapticModel& model, const ContactParameters& parameters, DistanceEngine& engine,
                 Pruning pruning)
    : model_(model),
      parameters_(parameters),
      engine_(engine),
      pruning_(pruning),
      clearance_(model.hand, model.object.mesh(), engine, pruning) {}

Status PeerGdp::advance(const JointArray& hcp_angle, const HandPoses& hcp,
                        const std::array<bool, kDigits>& measured, GdpState& state) {
  Status status = Status::kOk;
  for (std::vector<ClosePair>& tied : tied_) tied.clear();
  for (int d = 0; d < kDigits; ++d) {
    Tick tick{.digit = d,
              .from = digit_angles(state.angle, d),
              .rate = {},
              .hcp_was = digit_angles(state.started[idx(d)] ? state.hcp_angle : hcp_angle, d),
              .hcp = digit_angles(hcp_angle, d),
              .hcp_pose = hcp.digit[idx(d)],
              .angle = digit_angles(state.angle, d),
              .pose = state.poses.digit[idx(d)]};
    tick.lagged = state.started[idx(d)] && tick.angle != tick.hcp_was;
    advance_digit(tick, state);
    state.poses.digit[idx(d)] = tick.pose;
    for (int i = 0; i < kJointsPerDigit; ++i) state.angle[idx(joint_index(d, i))] = tick.angle[idx(i)];

    const bool clear = tick.angle == tick.hcp;
    state.inside[idx(d)] = !clear && (state.inside[idx(d)] || !state.started[idx(d)]);
    state.started[idx(d)] = state.started[idx(d)] || measured[idx(d)];
    if (tick.exhausted) status |= Status::kSearchExhausted;
    if (state.inside[idx(d)]) status |= Status::kStartInside;
    for (int k = 0; k < kSegmentsPerDigit; ++k) {
      ContactRecord& record = state.record[idx(segment_index(d, k))];
      if (!record.active) continue;
      follow(tick, k, record);
      record.silent = state.inside[idx(d)];
    }
  }
  state.hcp_angle = hcp_angle;
  return status;
}

// Depth and points of a record of segment k.
void PeerGdp::measure(const Tick& tick, int k, const DigitAngles& hcp_angle, const DigitPose& hcp,
                      ContactRecord& record) const {
  record.p_gdp = tick.pose.segment[idx(k)] * record.p_S;
  record.p_hcp = hcp.segment[idx(k)] * record.p_S;
  double& deep = record.penetration;
  deep = (record.p_gdp - record.p_hcp).dot(record.n_c);
  if (record.along) {
    DigitAngles way{};
    for (std::size_t i = 0; i < way.size(); ++i) way[i] = hcp_angle[i] - tick.angle[i];
    const double v = field_of(model_.hand, tick.digit, k, tick.pose, way).closing(record.n_c, record.p_gdp);
    if (v > 0.0 && v > 2.0 * deep) deep = v * v / (4.0 * (v - deep));
  }
  record.depth = deep - record.offset;
}

// The same at the end of the tick, with what d0 has shrunk by.
void PeerGdp::follow(const Tick& tick, int k, ContactRecord& record) const {
  const ContactRecord was = record;
  measure(tick, k, tick.hcp, tick.hcp_pose, record);
  if (!record.fades) return;
  const double gone = (record.p_hcp - was.p_hcp - (record.p_gdp - was.p_gdp)).norm();
  const double deeper = std::max(0.0, record.penetration - was.penetration);
  record.offset = std::max(0.0, record.offset - kFade * std::max(0.0, gone - deeper));
  if (record.penetration <= 0.0) {
    record.offset = 0.0;
  } else if (record.penetration < was.penetration) {
    record.offset *= record.penetration / was.penetration;
  }
  record.depth = record.penetration - record.offset;
}

bool PeerGdp::nearer_pushes(const Tick& tick, int k, const DigitAngles& hcp_angle, const DigitPose& hcp,
                            const GdpState& state) const {
  for (int nearer = 0; nearer < k; ++nearer) {
    ContactRecord other = state.record[idx(segment_index(tick.digit, nearer))];
    if (!other.active) continue;
    measure(tick, nearer, hcp_angle, hcp, other);
    if (other.depth > 0.0) return true;
  }
  return false;
}

// Whether the digit at its measured angles crosses the object's surface.
bool PeerGdp::goes_through(const Tick& tick) {
  for (int k = 0; k < kSegmentsPerDigit; ++k) {
    list_pairs(segment_index(tick.digit, k), tick.hcp_pose.segment[idx(k)], 1e-9);
    for (const ClosePair& pair : pairs_)
      if (!(pair.distance > 0.0)) return true;
  }
  return false;
}

// Rule 1.
int PeerGdp::held_joints(Tick& tick, GdpState& state) {
  int held = 0;
  for (int k = 0; k < kSegmentsPerDigit; ++k) {
    ContactRecord& record = state.record[idx(segment_index(tick.digit, k))];
    if (!record.active) continue;
    tick.pushed[idx(k)] = record.silent ? 0.0 : std::max(0.0, record.depth);
    record.along = record.along && goes_through(tick);
    follow(tick, k, record);
    if (record.depth > 0.0) held = joints_that_move(k);
  }
  return held;
}

// Rules 2 to 4.
void PeerGdp::advance_digit(Tick& tick, GdpState& state) {
  const double margin = parameters_.margin;
  tick.fixed = held_joints(tick, state);
  for (int i = 0; i < kJointsPerDigit; ++i) tick.rate[idx(i)] = tick.hcp[idx(i)] - tick.angle[idx(i)];
  bool asked = false;
  while (tick.fixed < kJointsPerDigit) {
    for (int i = 0; i < tick.fixed; ++i) tick.rate[idx(i)] = 0.0;
    if (tick.first_moving() == kSegmentsPerDigit) break;
    asked = true;
    const Stop stop = next_stop(tick, state);
    if (stop.segment < 0) break;
    ContactRecord& record = state.record[idx(segment_index(tick.digit, stop.segment))];
    if (record.active) {
      follow(tick, stop.segment, record);
      if (record.penetration <= 0.0 ||
          (!(record.depth > 0.0) && !nearer_pushes(tick, stop.segment, tick.hcp, tick.hcp_pose, state)))
        record.active = false;
    }
    const SegmentField field = field_of(model_.hand, tick.digit, stop.segment, tick.pose, tick.rate);
    for (int k = 0; k < kSegmentsPerDigit; ++k) {
      const int segment = segment_index(tick.digit, k);
      if (state.record[idx(segment)].active) continue;
      if (k != stop.segment &&
          clearance_.of(tick.digit, k, tick.angle, tick.pose.segment[idx(k)], margin) > margin) {
        continue;
      }
      make_record(tick, k, k == stop.segment ? &field : nullptr, state);
    }
    tick.fixed = joints_that_move(stop.segment);
  }
  if (!asked && pruning_ == Pruning::kNone) {  // does not know that nothing moves
    for (int k = 0; k < kSegmentsPerDigit; ++k) {
      static_cast<void>(clearance_.of(tick.digit, k, tick.angle, tick.pose.segment[idx(k)], margin));
    }
  }
}

PeerGdp::Stop PeerGdp::next_stop(Tick& tick, GdpState& state) {
  const int first = tick.first_moving();
  while (tick.steps++ < kMostSteps) {
    double length = 1.0 - tick.s;
    bool near = false;
    int blocked = -1;
    for (int k = pruning_ == Pruning::kNone ? 0 : first; k < kSegmentsPerDigit; ++k) {
      const Step step = step_of(tick, k, length);
      if (k < first) continue;
      if (step.blocked) {
        blocked = k;
      } else {
        length = std::min(length, step.length);
      }
      near = near || step.near;
    }
    if (blocked >= 0) return {blocked};
    if (tick.s >= 1.0) return {};
    const bool last = length >= 1.0 - tick.s;
    const double from = tick.s;
    tick.go_to(model_.hand, last ? 1.0 : tick.s + length);
    for (int k = first; k < kSegmentsPerDigit; ++k)
      state.record[idx(segment_index(tick.digit, k))].active = false;
    if (last && !near) return {};
    if (!last && !(tick.s > from)) break;
  }
  tick.exhausted = true;
  return {kSegmentsPerDigit - 1};
}

PeerGdp::Step PeerGdp::step_of(const Tick& tick, int k, double longest) {
  const Floors floors{parameters_.margin};
  const SegmentField field = field_of(model_.hand, tick.digit, k, tick.pose, tick.rate);
  const Pose& X_WS = tick.pose.segment[idx(k)];
  const double needed = floors.margin + field.speed * longest;
  const double distance = clearance_.of(tick.digit, k, tick.angle, X_WS, needed);
  if (distance > needed) return {.length = longest};
  const double window = floors.margin + kNearWindow;
  // Whatever is farther away than `apart` comes no nearer than the floor in this step.
  const double apart = std::max(distance, window);
  const double straight = (apart - floors.of(apart)) / field.speed;
  Step step{.length = std::min(longest, straight), .near = straight <= longest || apart <= needed};
  if (distance > window) return step;

  const int segment = segment_index(tick.digit, k);
  list_pairs(segment, X_WS, window);
  const TriangleMesh& mesh = model_.hand.mesh(segment);
  for (const ClosePair& pair : pairs_) {
    const Vec3 n = pair.direction();
    if (!(pair.distance > 0.0) ||
        (pair.distance <= floors.margin && field.closing(n, pair.on_segment) > floors.creep(pair.distance))) {
      return {.length = 0.0, .blocked = true, .near = true};
    }
    for (const std::int32_t corner : mesh.triangles[idx(pair.segment_triangle)]) {
      const Vec3 x = X_WS * mesh.vertices[idx(corner)];
      const double height = n.dot(x - pair.on_object);
      const double v = field.closing(n, x);
      step.length = std::min(step.length, safe_step(height, v, field.acceleration, floors.of(pair.distance)));
    }
    step.near = true;
  }
  return step;
}

void PeerGdp::list_pairs(int segment, const Pose& X_WS, double limit) {
  ++lists_;
  engine_.pairs_within(segment, X_WS, limit, pairs_);
}

void PeerGdp::make_record(const Tick& tick, int k, const SegmentField* field, GdpState& state) {
  const int segment = segment_index(tick.digit, k);
  const Pose& X_WS = tick.pose.segment[idx(k)];
  const double margin = parameters_.margin;
  // A search that gave up stops wherever it is; what is nearest there may be far away.
  const double cap =
      field != nullptr && tick.exhausted
          ? std::max(margin, clearance_.of(tick.digit, k, tick.angle, X_WS, 1.0) * (1.0 + 1e-12))
          : margin;
  list_pairs(segment, X_WS, cap + kTie);
  std::vector<ClosePair>& tied = tied_[idx(segment)];
  if (!choose_contact(pairs_, cap, tick.exhausted ? nullptr : field, tied)) return;
  const ClosePair& nearest = tied.front();
  ContactRecord record;
  record.active = true;
  record.p_S = X_WS.R.transpose() * (nearest.on_segment - X_WS.p);
  record.n_c = nearest.direction();
  record.force_normal = record.n_c;
  record.silent = state.inside[idx(tick.digit)];
  if (field != nullptr && !tick.exhausted && parameters_.depth == DepthOrigin::kContinuous) {
    measure(tick, k, tick.hcp, tick.hcp_pose, record);
    const auto closes = [&](const ClosePair& p) {
      return p.distance <= cap ? field->closing(p.direction(), p.on_segment) : 0.0;
    };
    const auto lead =
        std::max_element(pairs_.begin(), pairs_.end(),
                         [&](const ClosePair& p, const ClosePair& q) { return closes(p) < closes(q); });
    if (!(record.depth > 0.0) && closes(*lead) > 0.0) {
      const ClosePair alone = *lead;
      if (goes_through(tick)) {
        record.along = true;
        record.p_S = X_WS.R.transpose() * (alone.on_segment - X_WS.p);
        record.n_c = record.force_normal = alone.direction();
        tied = {alone};
      }
    }
  }
  if (tick.exhausted && nearest.distance > margin) {
    record.offset = std::numeric_limits<double>::infinity();
  } else {
    set_offset(tick, k, state, record);
  }
  state.record[idx(segment)] = record;
}

// Rule 3's d0.
void PeerGdp::set_offset(const Tick& tick, int k, const GdpState& state, ContactRecord& record) const {
  if (parameters_.depth != DepthOrigin::kContinuous) return;
  DigitAngles hcp_angle{};
  for (std::size_t i = 0; i < hcp_angle.size(); ++i)
    hcp_angle[i] = tick.hcp_was[i] + tick.s * (tick.hcp[i] - tick.hcp_was[i]);
  DigitPose hcp;
  model_.hand.digit_pose(tick.digit, hcp_angle, hcp);
  const bool pushed = nearer_pushes(tick, k, hcp_angle, hcp, state);
  if (!pushed && !tick.lagged) return;
  measure(tick, k, hcp_angle, hcp, record);
  record.offset = std::max(0.0, record.penetration - tick.pushed[idx(k)]);
  record.fades = !pushed || !nearer_pushes(tick, k, tick.hcp, tick.hcp_pose, state);
}

}  // namespace phalanx::bench

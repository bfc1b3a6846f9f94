// SPDX-License-Identifier: Apache-2.0
#include "compare.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "one_place.h"

namespace phalanx::bench {
namespace {

double segment_distance(DistanceEngine& engine, const GdpValues& state, int segment) {
  const Pose& X = state.poses.digit[idx(digit_of_segment(segment))].segment[idx(segment % kSegmentsPerDigit)];
  return engine.nearest(segment, X, 1.0).distance;
}

/// Whether some segment of the digit stands at the margin, within the band in which a stop may lie.
bool stands_at_margin(DistanceEngine& engine, const GdpValues& state, int digit, double margin) {
  for (int k = 0; k < kSegmentsPerDigit; ++k) {
    const double clearance = segment_distance(engine, state, segment_index(digit, k));
    if (std::abs(clearance - margin) <= kStopBand) return true;
  }
  return false;
}

/// Whether no segment of the digit is nearer than the band allows anywhere between two answers: then the one
/// that went on did not go through anything.
bool keeps_clear_between(const HapticModel& model, const HapticParameters& parameters, DistanceEngine& engine,
                         const GdpValues& from, const GdpValues& to, int digit) {
  constexpr int kSamples = 64;
  for (int n = 0; n <= kSamples; ++n) {
    DigitAngles angle{};
    for (int i = 0; i < kJointsPerDigit; ++i) {
      const std::size_t j = idx(joint_index(digit, i));
      angle[idx(i)] = from.angle[j] + (to.angle[j] - from.angle[j]) * n / kSamples;
    }
    DigitPose pose;
    model.hand.digit_pose(digit, angle, pose);
    for (int k = 0; k < kSegmentsPerDigit; ++k) {
      const Nearest nearest = engine.nearest(segment_index(digit, k), pose.segment[idx(k)], 1.0);
      if (nearest.distance < parameters.contact.margin - kStopBand) return false;
    }
  }
  return true;
}

/// Whether the digit's search ran out of steps in this tick: its last segment then has a record that neither
/// pushes nor holds.
bool gave_up(const GdpValues& state, int digit) {
  const ContactRecord& last = state.record[idx(segment_index(digit, kSegmentsPerDigit - 1))];
  return last.active && std::isinf(last.offset);
}

/// What differs in one digit.
struct Difference {
  double angle = 0.0;  ///< largest [rad]
  std::vector<int> flags;
  std::string contact;  ///< in words; empty if unique contacts agree
  [[nodiscard]] bool none() const { return angle <= kSameAngle && flags.empty() && contact.empty(); }
};

void compare_contact(const HapticModel& model, const GdpValues& before, const GdpValues& ours,
                     const GdpValues& peer, const PeerGdp& gdp, int segment, Difference& out,
                     Agreement& agreement) {
  const std::vector<ClosePair>& tied = gdp.tied(segment);
  const ContactRecord& was = before.record[idx(segment)];
  const ContactRecord& a = ours.record[idx(segment)];
  const ContactRecord& b = peer.record[idx(segment)];
  if (!a.active || !b.active) return;
  // A record that is made anew where the last one was has the same bits: only the reverse shows.
  if (tied.empty() && (!was.active || a.p_S != was.p_S)) {
    out.contact += fmt::format(" {}: a new record only in ours;", segment_name(segment));
    return;
  }
  if (tied.empty()) return;
  ++agreement.records;
  const Pose& X = peer.poses.digit[idx(digit_of_segment(segment))].segment[idx(segment % kSegmentsPerDigit)];
  if (!one_place(model.hand.mesh(segment), X, model.object.mesh(), tied)) return;
  ++agreement.unique;
  const double point = (a.p_gdp - b.p_gdp).norm();
  const double depth = std::abs(a.depth - b.depth);
  if (point > kSamePoint || depth > kSamePoint) {
    out.contact += fmt::format(" {}: points {:.2e} m apart, depths {:.3e} and {:.3e} m, n_c {:.1e} apart;",
                               segment_name(segment), point, a.depth, b.depth, (a.n_c - b.n_c).norm());
    return;
  }
  agreement.point = std::max(agreement.point, point);
  agreement.depth = std::max(agreement.depth, depth);
}

Difference difference_of(const HapticModel& model, const GdpValues& before, const GdpValues& ours,
                         const GdpValues& peer, const PeerGdp& gdp, int digit, Agreement& agreement) {
  Difference out;
  for (int i = 0; i < kJointsPerDigit; ++i) {
    const std::size_t j = idx(joint_index(digit, i));
    out.angle = std::max(out.angle, std::abs(ours.angle[j] - peer.angle[j]));
  }
  for (int k = 0; k < kSegmentsPerDigit; ++k) {
    const int segment = segment_index(digit, k);
    if (ours.record[idx(segment)].active != peer.record[idx(segment)].active) out.flags.push_back(segment);
  }
  if (out.angle > kSameAngle) return out;  // records at different places are not to be compared
  agreement.angle = std::max(agreement.angle, out.angle);
  for (int k = 0; k < kSegmentsPerDigit; ++k)
    compare_contact(model, before, ours, peer, gdp, segment_index(digit, k), out, agreement);
  return out;
}

/// Both answers keep the rules to within the band that is stated for them.
bool grazes(const HapticModel& model, const HapticParameters& parameters, const GdpValues& before,
            const GdpValues& ours, const GdpValues& peer, DistanceEngine& engine, int digit,
            const Difference& difference) {
  const double margin = parameters.contact.margin;
  if (gave_up(ours, digit) || gave_up(peer, digit)) {
    return keeps_clear_between(model, parameters, engine, ours, peer, digit);
  }
  if (!difference.contact.empty()) return false;
  if (difference.angle > kSameAngle) {
    const auto way = [&](const GdpValues& state) {
      double sum = 0.0;
      for (int i = 0; i < kJointsPerDigit; ++i) {
        const std::size_t j = idx(joint_index(digit, i));
        sum += std::abs(state.angle[j] - before.angle[j]);
      }
      return sum;
    };
    const auto stopped = [&](const GdpValues& state) {
      return digit_angles(state.angle, digit) != digit_angles(state.hcp_angle, digit);
    };
    const bool ours_first = way(ours) < way(peer);
    const GdpValues& first = ours_first ? ours : peer;
    const GdpValues& second = ours_first ? peer : ours;
    return stands_at_margin(engine, first, digit, margin) &&
           (!stopped(second) || stands_at_margin(engine, second, digit, margin)) &&
           keeps_clear_between(model, parameters, engine, first, second, digit);
  }
  return std::all_of(difference.flags.begin(), difference.flags.end(), [&](int segment) {
    const ContactRecord& made =
        ours.record[idx(segment)].active ? ours.record[idx(segment)] : peer.record[idx(segment)];
    return made.depth <= kTouchBand &&
           std::abs(segment_distance(engine, ours, segment) - margin) <= kTouchBand &&
           std::abs(segment_distance(engine, peer, segment) - margin) <= kTouchBand;
  });
}

std::string describe(double margin, const GdpValues& ours, const GdpValues& peer, DistanceEngine& engine,
                     int digit, const Difference& difference) {
  std::string text = fmt::format("{}: angles {:.2e} rad apart;", digit_name(digit), difference.angle);
  if (gave_up(ours, digit)) text += " our search gave up;";
  if (gave_up(peer, digit)) text += " the peer's search gave up;";
  for (const int segment : difference.flags) {
    text += fmt::format(" {} in contact only in {};", segment_name(segment),
                        ours.record[idx(segment)].active ? "ours" : "the peer's");
  }
  text += difference.contact + " clearance less the margin [nm], ours / the peer's:";
  for (int k = 0; k < kSegmentsPerDigit; ++k) {
    const int segment = segment_index(digit, k);
    const auto nanometres = [&](const GdpValues& state) {
      return (segment_distance(engine, state, segment) - margin) * 1e9;
    };
    text += fmt::format(" {:.2f} / {:.2f}", nanometres(ours), nanometres(peer));
  }
  return text;
}

}  // namespace

void Agreement::add(const Agreement& other) {
  ticks += other.ticks;
  records += other.records;
  unique += other.unique;
  angle = std::max(angle, other.angle);
  point = std::max(point, other.point);
  depth = std::max(depth, other.depth);
  grazing.insert(grazing.end(), other.grazing.begin(), other.grazing.end());
  different.insert(different.end(), other.different.begin(), other.different.end());
}

Verdict compare(const HapticModel& model, const HapticParameters& parameters, const GdpValues& before,
                const GdpValues& ours, const GdpValues& peer, const PeerGdp& gdp, DistanceEngine& engine,
                const std::string& where, Agreement& agreement) {
  ++agreement.ticks;
  Verdict verdict = Verdict::kSame;
  for (int d = 0; d < kDigits; ++d) {
    const Difference difference = difference_of(model, before, ours, peer, gdp, d, agreement);
    if (difference.none()) continue;
    const bool grazing = grazes(model, parameters, before, ours, peer, engine, d, difference);
    const std::string line =
        where + ", " + describe(parameters.contact.margin, ours, peer, engine, d, difference);
    (grazing ? agreement.grazing : agreement.different).push_back(line);
    if (!grazing) verdict = Verdict::kDifferent;
    if (grazing && verdict == Verdict::kSame) verdict = Verdict::kGrazing;
  }
  return verdict;
}

}  // namespace phalanx::bench

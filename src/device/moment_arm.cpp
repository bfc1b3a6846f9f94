// SPDX-License-Identifier: Apache-2.0
#include "phalanx/device/moment_arm.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "phalanx/core/constants.h"
#include "phalanx/device/exoskeleton.h"

namespace phalanx {
namespace {

constexpr int kCheckPoints = 2000;  ///< angles of the range at which a linkage is checked
constexpr std::size_t kMostCoefficients = 8;
constexpr std::size_t kMostPoints = 64;

/// Excursion from a fixed angle of the linkage [m], and its derivative [m].
struct LinkageValue {
  double excursion = 0.0;
  double arm = 0.0;
};

LinkageValue at_polynomial(const std::vector<double>& c, double q) noexcept {
  LinkageValue value;
  for (std::size_t k = c.size(); k-- > 0;) {
    value.arm = value.arm * q + c[k];
    value.excursion = value.excursion * q + c[k] / static_cast<double>(k + 1);
  }
  value.excursion *= q;
  return value;
}

LinkageValue at_table(const std::vector<ArmPoint>& table, double q) noexcept {
  LinkageValue value;
  std::size_t i = 0;
  for (; i + 2 < table.size() && q > table[i + 1].angle; ++i)
    value.excursion += 0.5 * (table[i].arm + table[i + 1].arm) * (table[i + 1].angle - table[i].angle);
  const ArmPoint& a = table[i];
  const ArmPoint& b = table[i + 1];
  value.arm = a.arm + (b.arm - a.arm) * (q - a.angle) / (b.angle - a.angle);
  value.excursion += 0.5 * (a.arm + value.arm) * (q - a.angle);
  return value;
}

/// End B of the rocker, with O2 at the origin and O4 on the first axis, and its distance from O2.
struct RockerEnd {
  double x = 0.0, y = 0.0, distance = 0.0;
};

RockerEnd rocker_end(const FourBar& bar, double q) noexcept {
  const double angle = bar.rocker_angle + q;
  const double x = bar.ground + bar.rocker * std::cos(angle);
  const double y = bar.rocker * std::sin(angle);
  return {x, y, std::hypot(x, y)};
}

/// @returns the crank's angle: that of B, and the triangle O2 A B beside it [rad].
double crank_angle(const FourBar& bar, const RockerEnd& end) noexcept {
  const double d = end.distance;
  const double cosine = (bar.crank * bar.crank + d * d - bar.coupler * bar.coupler) / (2.0 * bar.crank * d);
  const double beside = std::acos(std::clamp(cosine, -1.0, 1.0));
  return std::atan2(end.y, end.x) + (bar.crossed ? -beside : beside);
}

/// Computes the crank's angle from that in the middle of the range, and its derivative. The derivative is
/// that of the loop's closure  |A - B| = coupler:  (A - B) . (A' - B') = 0.
LinkageValue at_four_bar(const FourBar& bar, double middle, double q) noexcept {
  const RockerEnd end = rocker_end(bar, q);
  const double crank = crank_angle(bar, end);
  const double turned =
      std::remainder(crank - crank_angle(bar, rocker_end(bar, middle)), 2.0 * std::numbers::pi);
  const double x = bar.crank * std::cos(crank) - end.x;
  const double y = bar.crank * std::sin(crank) - end.y;
  const double angle = bar.rocker_angle + q;
  const double of_rocker = bar.rocker * (-x * std::sin(angle) + y * std::cos(angle));
  const double of_crank = bar.crank * (-x * std::sin(crank) + y * std::cos(crank));
  return {bar.drum * turned, bar.drum * of_rocker / of_crank};
}

LinkageValue value_inside(const JointLinkage& linkage, double q) noexcept {
  if (linkage.four_bar)
    return at_four_bar(*linkage.four_bar, 0.5 * (linkage.min_angle + linkage.max_angle), q);
  if (!linkage.table.empty()) return at_table(linkage.table, q);
  return at_polynomial(linkage.polynomial, q);
}

/// Continues the linkage beyond its range with the moment arm at the end.
LinkageValue value_at(const JointLinkage& linkage, double q) noexcept {
  const double inside = std::clamp(q, linkage.min_angle, linkage.max_angle);
  LinkageValue value = value_inside(linkage, inside);
  value.excursion += value.arm * (q - inside);
  return value;
}

double angle_of_check(const JointLinkage& linkage, int i) noexcept {
  const double share = static_cast<double>(i) / kCheckPoints;
  return linkage.min_angle + share * (linkage.max_angle - linkage.min_angle);
}

template <typename Better>
double extreme_arm(const JointLinkage& linkage, Better better) noexcept {
  double arm = moment_arm(linkage, linkage.min_angle);
  for (int i = 1; i <= kCheckPoints; ++i) {
    const double here = moment_arm(linkage, angle_of_check(linkage, i));
    if (better(std::abs(here), std::abs(arm))) arm = here;
  }
  for (const ArmPoint& point : linkage.table) {
    const bool inside = point.angle >= linkage.min_angle && point.angle <= linkage.max_angle;
    if (inside && better(std::abs(point.arm), std::abs(arm))) arm = point.arm;
  }
  return arm;
}

// ---- checks ----

[[noreturn]] void refuse_linkage(const std::string& place, const std::string& problem) {
  throw std::invalid_argument(place + ": " + problem);
}

double degrees(double angle) noexcept { return angle / kDeg; }
double millimetres(double length) noexcept { return 1e3 * length; }

void check_numbers(const JointLinkage& linkage, const std::string& place) {
  const auto finite = [&place](std::string_view name, double value) {
    if (!std::isfinite(value))
      refuse_linkage(place, fmt::format("{} = {}: must be finite; change the value", name, value));
  };
  finite("least angle [rad]", linkage.min_angle);
  finite("largest angle [rad]", linkage.max_angle);
  if (!(linkage.min_angle < linkage.max_angle))
    refuse_linkage(place, fmt::format("range = {:.1f} to {:.1f} deg: must increase; swap the two",
                                      degrees(linkage.min_angle), degrees(linkage.max_angle)));
  const int stated =
      (linkage.polynomial.empty() ? 0 : 1) + (linkage.table.empty() ? 0 : 1) + (linkage.four_bar ? 1 : 0);
  if (stated != 1)
    refuse_linkage(
        place,
        fmt::format("{} of polynomial, table and four-bar linkage are stated; state exactly one", stated));
  if (linkage.polynomial.size() > kMostCoefficients)
    refuse_linkage(place, fmt::format("the polynomial has {} coefficients; at most {} are supported",
                                      linkage.polynomial.size(), kMostCoefficients));
  for (const double c : linkage.polynomial) finite("a coefficient of the polynomial", c);
}

void check_table(const JointLinkage& linkage, const std::string& place) {
  const std::vector<ArmPoint>& table = linkage.table;
  if (table.empty()) return;
  if (table.size() < 2 || table.size() > kMostPoints)
    refuse_linkage(place,
                   fmt::format("the table has {} points; 2 to {} are supported", table.size(), kMostPoints));
  for (std::size_t i = 0; i < table.size(); ++i) {
    if (!std::isfinite(table[i].angle) || !std::isfinite(table[i].arm))
      refuse_linkage(place, fmt::format("point {} of the table is not finite; change the value", i + 1));
    if (i > 0 && !(table[i].angle > table[i - 1].angle))
      refuse_linkage(place, fmt::format("the table's angle {:.1f} deg follows {:.1f} deg; sort the points",
                                        degrees(table[i].angle), degrees(table[i - 1].angle)));
  }
  if (table.front().angle > linkage.min_angle + 1e-9 || table.back().angle < linkage.max_angle - 1e-9)
    refuse_linkage(
        place, fmt::format("the table ends at {:.1f} and {:.1f} deg, the range at {:.1f} and {:.1f} deg; add "
                           "points, or narrow the range",
                           degrees(table.front().angle), degrees(table.back().angle),
                           degrees(linkage.min_angle), degrees(linkage.max_angle)));
}

void check_four_bar(const JointLinkage& linkage, const std::string& place) {
  if (!linkage.four_bar) return;
  const FourBar& bar = *linkage.four_bar;
  for (const auto& [name, length] : {std::pair{"ground", bar.ground}, std::pair{"crank", bar.crank},
                                     std::pair{"coupler", bar.coupler}, std::pair{"rocker", bar.rocker}})
    if (!(length > 0.0 && length < 1.0))
      refuse_linkage(place, fmt::format("{} = {:g} mm: must be above 0 and below 1000 mm; change the value",
                                        name, millimetres(length)));
  if (!std::isfinite(bar.rocker_angle) || !std::isfinite(bar.drum) || bar.drum == 0.0)
    refuse_linkage(
        place, fmt::format(
                   "rocker_angle = {} rad, drum = {} m: must be finite, and the drum not 0; change the value",
                   bar.rocker_angle, bar.drum));
  const double least = std::abs(bar.crank - bar.coupler);
  const double most = bar.crank + bar.coupler;
  for (int i = 0; i <= kCheckPoints; ++i) {
    const double q = angle_of_check(linkage, i);
    const double d = rocker_end(bar, q).distance;
    if (d > least && d < most) continue;
    refuse_linkage(
        place,
        fmt::format("at {:.1f} deg the rocker's end is {:.2f} mm from the crank's axis; crank and coupler "
                    "reach {:.2f} to {:.2f} mm. Change a length, or narrow the range",
                    degrees(q), millimetres(d), millimetres(least), millimetres(most)));
  }
}

const char* singularity(const JointLinkage& linkage, bool small) noexcept {
  if (!linkage.four_bar) return small ? "the motor cannot hold the joint there" : "its unit may be wrong";
  return small ? "coupler and rocker are in line, and the motor cannot hold the joint there"
               : "coupler and crank are in line, and the joint cannot turn the motor there";
}

/// @param first  arm at the least angle, whose sign holds in the whole range [m]
void check_arm(const JointLinkage& linkage, double q, double arm, double first, const std::string& place) {
  const bool small = !(std::abs(arm) >= kLeastArm) || (arm > 0.0) != (first > 0.0);
  const bool large = !(std::abs(arm) <= kLargestArm);
  if (!small && !large) return;
  refuse_linkage(
      place, fmt::format("at {:.1f} deg the moment arm is {:.3f} mm: {}. It must keep its sign, with {:g} to "
                         "{:g} mm. Change the numbers, or narrow the range",
                         degrees(q), millimetres(arm), singularity(linkage, !large), millimetres(kLeastArm),
                         millimetres(kLargestArm)));
}

void check_arms(const JointLinkage& linkage, const std::string& place) {
  const double first = moment_arm(linkage, linkage.min_angle);
  // Between the points of a table the arm is linear: its extremes are at points or at the ends of the range.
  for (const ArmPoint& point : linkage.table) {
    const bool inside = point.angle >= linkage.min_angle && point.angle <= linkage.max_angle;
    if (inside) check_arm(linkage, point.angle, point.arm, first, place);
  }
  double before = excursion(linkage, linkage.min_angle);
  for (int i = 0; i <= kCheckPoints; ++i) {
    const double q = angle_of_check(linkage, i);
    check_arm(linkage, q, moment_arm(linkage, q), first, place);
    const double here = excursion(linkage, q);
    if (i > 0 && (here > before) != (first > 0.0))
      refuse_linkage(
          place,
          fmt::format("at {:.1f} deg the motor has turned more than half a turn from the middle of the "
                      "range; narrow the range",
                      degrees(q)));
    before = here;
  }
}

}  // namespace

double moment_arm(const JointLinkage& linkage, double angle) noexcept { return value_at(linkage, angle).arm; }

double excursion(const JointLinkage& linkage, double angle) noexcept {
  return value_at(linkage, angle).excursion - value_at(linkage, 0.0).excursion;
}

/// Newton's method inside a bracket, which halves where a step would leave it. Beyond the range e is linear.
double angle_of_excursion(const JointLinkage& linkage, double length) noexcept {
  const double at_min = excursion(linkage, linkage.min_angle);
  const double at_max = excursion(linkage, linkage.max_angle);
  const bool rises = at_max > at_min;
  if (rises ? length <= at_min : length >= at_min)
    return linkage.min_angle + (length - at_min) / moment_arm(linkage, linkage.min_angle);
  if (rises ? length >= at_max : length <= at_max)
    return linkage.max_angle + (length - at_max) / moment_arm(linkage, linkage.max_angle);
  if (!std::isfinite(length)) return linkage.min_angle;
  double low = linkage.min_angle;
  double high = linkage.max_angle;
  double q = low + (high - low) * (length - at_min) / (at_max - at_min);
  for (int i = 0; i < 60 && high - low > 1e-12; ++i) {
    const double error = excursion(linkage, q) - length;
    ((error > 0.0) == rises ? high : low) = q;
    const double next = q - error / moment_arm(linkage, q);
    if (std::abs(next - q) < 1e-12) return next;
    q = next > low && next < high ? next : 0.5 * (low + high);
  }
  return q;
}

double largest_arm(const JointLinkage& linkage) noexcept {
  return extreme_arm(linkage, [](double a, double b) { return a > b; });
}

double least_arm(const JointLinkage& linkage) noexcept {
  return extreme_arm(linkage, [](double a, double b) { return a < b; });
}

void check_linkage(const JointLinkage& linkage, const std::string& place) {
  check_numbers(linkage, place);
  check_table(linkage, place);
  check_four_bar(linkage, place);
  check_arms(linkage, place);
}

void add_linkage(ExoMotor& motor, JointLinkage linkage) {
  motor.arm[static_cast<std::size_t>(linkage.joint)] = largest_arm(linkage);
  motor.linkages.push_back(std::move(linkage));
}

}  // namespace phalanx

// SPDX-License-Identifier: Apache-2.0
#include "contact/contact_newton.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "phalanx/core/constants.h"
#include "phalanx/core/index.h"

namespace phalanx {
namespace {

/// Displacements of the joints [rad], then those of the springs of the segments that have contacts, three for each,
/// times 1 / sqrt(C) [rad].
constexpr std::size_t kMostUnknowns = kJointsPerDigit + 3 * kSegmentsPerDigit;
using Unknowns = std::array<double, kMostUnknowns>;
constexpr std::size_t kColumns = kJointsPerDigit + 3;  // of one contact: the joints and its segment's spring
using UnknownsMatrix = std::array<Unknowns, kMostUnknowns>;

/// Solves A x = b of n unknowns by elimination with row pivots. @returns false if A is singular
bool solve_linear(UnknownsMatrix& A, Unknowns b, std::size_t n, Unknowns& x) noexcept {
  for (std::size_t c = 0; c < n; ++c) {
    std::size_t pivot = c;
    for (std::size_t r = c + 1; r < n; ++r)
      if (std::abs(A[r][c]) > std::abs(A[pivot][c])) pivot = r;
    if (!(std::abs(A[pivot][c]) > 0.0)) return false;
    std::swap(A[c], A[pivot]);
    std::swap(b[c], b[pivot]);
    for (std::size_t r = c + 1; r < n; ++r) {
      const double factor = A[r][c] / A[c][c];
      for (std::size_t k = c; k < n; ++k) A[r][k] -= factor * A[c][k];
      b[r] -= factor * b[c];
    }
  }
  for (std::size_t c = n; c-- > 0;) {
    double sum = b[c];
    for (std::size_t k = c + 1; k < n; ++k) sum -= A[c][k] * x[k];
    x[c] = sum / A[c][c];
  }
  return true;
}

/// Products of a contact's rows with themselves, of joints that are free.
struct RowProducts {
  double normal = 0.0;   ///< [m^2]
  double sliding = 0.0;  ///< of the tangents: their mean, the normal's at least [m^2]
  double spin = 0.0;     ///< [rad^2/rad^2]

  RowProducts(const ProblemContact& contact, const HeldJoints& held) noexcept {
    const auto product = [&](ContactRow row) {
      const DigitAngles moves = free_part(contact.row[row], held);
      return dot(moves, moves);
    };
    normal = product(kNormalRow);
    sliding = std::max(normal, 0.5 * (product(kTangentRow) + product(kSecondTangentRow)));
    spin = product(kSpinRow);
  }
  [[nodiscard]] bool moves_normal() const noexcept { return normal > kLeastArm * kLeastArm; }
};

/// Compliances of one contact's rows [m^2], of the spin row [rad^2].
struct RowCompliance {
  double normal = 0.0;  ///< 0: the joints cannot move the contact along its normal
  double tangent = 0.0;
  double spin = 0.0;  ///< 0: they do not turn it about its normal
};

/// Slopes of a contact's multipliers over the displacements of its rows, negated.
struct LawSlopes {
  double normal = 0.0;
  std::array<double, 3> tangents{};  ///< of the first, of one over the other, of the second
  std::array<double, 2> tangent_over_normal{};
  double spin = 0.0;
  double spin_over_normal = 0.0;
};

/// Law of one contact as a function of the displacements of its rows.
struct RegularisedLaw {
  ContactRows multiplier{};
  LawSlopes slope;
  bool slips = false;
  bool spins = true;

  /// @param u       displacements of the rows, with room, spring and anchor
  /// @param offset  multipliers at which the compliances are at rest
  RegularisedLaw(const ProblemContact& contact, const RowCompliance& e, const ContactRows& u,
                 const ContactRows& offset) noexcept {
    const double normal = offset[kNormalRow] - u[kNormalRow] / e.normal;
    if (!(normal > 0.0)) return;
    multiplier[kNormalRow] = normal;
    slope.normal = 1.0 / e.normal;
    const double mu = contact.friction;
    slips = true;
    if (!(mu > 0.0)) return;
    const double bound = mu * std::min(normal, contact.most_friction_normal);
    const double bound_slope = normal < contact.most_friction_normal ? mu * slope.normal : 0.0;
    set_tangents(e.tangent, {offset[1] - u[1] / e.tangent, offset[2] - u[2] / e.tangent}, bound, bound_slope);
    if (!(e.spin > 0.0) || !(contact.spin_radius > 0.0)) return;
    const double spin = -u[kSpinRow] / e.spin;
    const double most = contact.spin_radius * bound;
    spins = std::abs(spin) > most;
    multiplier[kSpinRow] = std::clamp(spin, -most, most);
    if (spins) {
      slope.spin_over_normal = std::copysign(contact.spin_radius * bound_slope, spin);
    } else {
      slope.spin = 1.0 / e.spin;
    }
  }

 private:
  void set_tangents(double compliance, const std::array<double, 2>& sticking, double bound,
                    double bound_slope) noexcept {
    const double size = length_of(sticking[0], sticking[1]);
    slips = size > bound;
    if (!slips) {
      multiplier[1] = sticking[0];
      multiplier[2] = sticking[1];
      slope.tangents = {1.0 / compliance, 0.0, 1.0 / compliance};
      return;
    }
    const std::array<double, 2> d = {sticking[0] / size, sticking[1] / size};
    multiplier[1] = bound * d[0];
    multiplier[2] = bound * d[1];
    const double across = bound / (size * compliance);
    slope.tangents = {across * d[1] * d[1], -across * d[0] * d[1], across * d[0] * d[0]};
    slope.tangent_over_normal = {bound_slope * d[0], bound_slope * d[1]};
  }
};

class Newton {
 public:
  // Rounds of the augmented Lagrangian: with the small compliance, which solves most problems; if it does not, with
  // the greater one, which converges from farther away; and with the small one again.
  static constexpr int kBeginSoft = 2;
  static constexpr int kEndSoft = 6;
  static constexpr int kRounds = 9;
  static constexpr double kSoft = 1e-3;  // compliance, of the product of a row with itself
  static constexpr double kStiff = 1e-5;

  Newton(ContactProblem& problem, const HeldJoints& held) noexcept
      : problem_(problem),
        held_(held),
        count_(static_cast<std::size_t>(problem.count)),
        root_(std::sqrt(problem.spring_compliance)) {
    std::array<std::size_t, kSegmentsPerDigit> spring{};  // where its unknowns begin
    for (std::size_t i = 0; i < count_; ++i) {
      const ProblemContact& contact = problem.contact[i];
      for (std::size_t r = 0; r < kContactRows; ++r)
        std::copy(contact.row[r].begin(), contact.row[r].end(), row_[i][r].begin());
      columns_[i] = kJointsPerDigit;
      if (!(root_ > 0.0)) continue;
      std::size_t& begin = spring[idx(contact.segment)];
      if (begin == 0) {
        begin = unknowns_;
        unknowns_ += 3;
      }
      spring_[i] = begin;
      columns_[i] = kColumns;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        for (std::size_t t = 0; t < 2; ++t)
          row_[i][kTangentRow + t][kJointsPerDigit + axis] =
              root_ * contact.tangent[t][static_cast<Eigen::Index>(axis)];
      }
    }
    restart();
  }

  /// Goes back to the multipliers of the problem.
  void restart() noexcept {
    const DigitAngles x = displacement_of(problem_, held_);
    x_ = {};
    std::copy(x.begin(), x.end(), x_.begin());
    for (std::size_t i = 0; i < count_; ++i) {
      const ProblemContact& contact = problem_.contact[i];
      offset_[i] = contact.multiplier;
      for (std::size_t c = kJointsPerDigit; c < columns_[i]; ++c)
        x_[unknown(i, c)] += row_[i][1][c] * contact.multiplier[1] + row_[i][2][c] * contact.multiplier[2];
    }
  }

  void set_compliance(double share) noexcept {
    for (std::size_t i = 0; i < count_; ++i) {
      const ProblemContact& contact = problem_.contact[i];
      const RowProducts product(contact, held_);
      if (!product.moves_normal()) continue;
      compliance_[i] = {
          (contact.softness > 0.0 ? contact.softness : share) * product.normal,
          contact.tangent_compliance > 0.0 ? contact.tangent_compliance : share * product.sliding,
          product.spin > kLeastSpin ? ContactProblem::kSpinSoftness * product.spin : 0.0};
    }
  }

  /// Solves for the displacement, and moves the offsets to the multipliers, which it stores in the problem.
  /// @param budget  steps that are left; lowered by those taken
  void round(int& budget) noexcept {
    Unknowns F{};
    double size = evaluate(x_, F);
    bool still = false;
    for (int step = 0; step < kSteps && budget > 0 && size > 0.0 && !still; ++step, --budget) {
      Unknowns change{};
      UnknownsMatrix K = slopes();
      if (!solve_linear(K, F, unknowns_, change)) break;
      double greatest = 0.0;
      double of_joints = 0.0;
      for (std::size_t j = 0; j < unknowns_; ++j) {
        if (!(std::abs(change[j]) <= greatest)) greatest = std::abs(change[j]);
        if (j < kJointsPerDigit) of_joints = std::max(of_joints, std::abs(change[j]));
      }
      if (!std::isfinite(greatest)) break;  // the law has no slope there
      if (of_joints > kLongest) {
        for (double& c : change) c *= kLongest / of_joints;
      }
      still = greatest <= kStill;
      Unknowns next{};
      double next_size = 2.0 * size;
      double along = 1.0;
      for (int halving = 0; halving <= kHalvings && !(next_size < size); ++halving, along *= 0.5) {
        next = less(change, along);
        next_size = evaluate(next, F);
      }
      if (!(next_size < size)) {  // at a kink of the law: beyond it
        next = less(change, 1.0);
        next_size = evaluate(next, F);
      }
      x_ = next;
      size = next_size;
    }
    for (std::size_t i = 0; i < count_; ++i) {
      ProblemContact& contact = problem_.contact[i];
      contact.multiplier = multiplier_[i];
      contact.slips = slips_[i];
      contact.spins = spins_[i];
      offset_[i] = multiplier_[i];
    }
  }

 private:
  static constexpr int kSteps = 8;         // of Newton's method in a round
  static constexpr int kHalvings = 5;      // of a step that does not improve
  static constexpr double kStill = 1e-13;  // step that is the last [rad]
  static constexpr double kLongest = 0.5;  // step of a joint [rad]
  static constexpr std::size_t kMost = ContactProblem::kMostContacts;

  /// Returns the unknown that column c of contact i's rows moves.
  [[nodiscard]] std::size_t unknown(std::size_t i, std::size_t c) const noexcept {
    return c < kJointsPerDigit ? c : spring_[i] + (c - kJointsPerDigit);
  }

  /// @returns true for a joint that is not held, and for a spring
  [[nodiscard]] bool is_free(std::size_t unknown) const noexcept {
    return unknown >= held_.size() || held_[unknown] == Held::kNo;
  }

  [[nodiscard]] Unknowns less(const Unknowns& change, double along) const noexcept {
    Unknowns x = x_;
    for (std::size_t j = 0; j < unknowns_; ++j) x[j] -= along * change[j];
    return x;
  }

  /// Sets F = x - free - sum row^T p(x) for what is free. @returns |F|^2 [rad^2]
  double evaluate(const Unknowns& x, Unknowns& F) noexcept {
    for (std::size_t j = 0; j < unknowns_; ++j) {
      const double goal = j < problem_.free.size() ? problem_.free[j] : 0.0;
      F[j] = is_free(j) ? x[j] - goal : 0.0;
    }
    for (std::size_t i = 0; i < count_; ++i) {
      if (!(compliance_[i].normal > 0.0)) continue;
      const ProblemContact& contact = problem_.contact[i];
      const Vec3& elongation = problem_.elongation[idx(contact.segment)];
      ContactRows u = {contact.room, contact.tangent[0].dot(elongation), contact.tangent[1].dot(elongation),
                       contact.spin_anchor};
      for (std::size_t r = 0; r < kContactRows; ++r) {
        for (std::size_t c = 0; c < columns_[i]; ++c) u[r] += row_[i][r][c] * x[unknown(i, c)];
      }
      ContactRows offset = offset_[i];
      // Compliances that are part of the problem are at rest without a force.
      if (contact.softness > 0.0) offset[kNormalRow] = 0.0;
      if (contact.tangent_compliance > 0.0) offset[kTangentRow] = offset[kSecondTangentRow] = 0.0;
      const RegularisedLaw law(contact, compliance_[i], u, offset);
      multiplier_[i] = law.multiplier;
      slope_[i] = law.slope;
      slips_[i] = law.slips;
      spins_[i] = law.spins;
      for (std::size_t c = 0; c < columns_[i]; ++c) {
        const std::size_t j = unknown(i, c);
        if (!is_free(j)) continue;
        for (std::size_t r = 0; r < kContactRows; ++r) F[j] -= row_[i][r][c] * law.multiplier[r];
      }
    }
    double squared = 0.0;
    for (std::size_t j = 0; j < unknowns_; ++j) squared += F[j] * F[j];
    return squared;
  }

  /// Returns dF/dx where it was evaluated last.
  [[nodiscard]] UnknownsMatrix slopes() const noexcept {
    UnknownsMatrix K{};
    for (std::size_t j = 0; j < unknowns_; ++j) K[j][j] = 1.0;
    for (std::size_t i = 0; i < count_; ++i) {
      if (!(multiplier_[i][kNormalRow] > 0.0)) continue;
      const auto& row = row_[i];
      const LawSlopes& s = slope_[i];
      for (std::size_t k = 0; k < columns_[i]; ++k) {
        if (!is_free(unknown(i, k))) continue;
        const double n = row[kNormalRow][k];
        const double gradient[kContactRows] = {
            s.normal * n,
            s.tangents[0] * row[1][k] + s.tangents[1] * row[2][k] + s.tangent_over_normal[0] * n,
            s.tangents[1] * row[1][k] + s.tangents[2] * row[2][k] + s.tangent_over_normal[1] * n,
            s.spin * row[kSpinRow][k] + s.spin_over_normal * n};
        for (std::size_t j = 0; j < columns_[i]; ++j) {
          if (!is_free(unknown(i, j))) continue;
          double& slope = K[unknown(i, j)][unknown(i, k)];
          for (std::size_t r = 0; r < kContactRows; ++r) slope += row[r][j] * gradient[r];
        }
      }
    }
    return K;
  }

  ContactProblem& problem_;
  const HeldJoints& held_;
  std::size_t count_;
  double root_;  ///< of the springs' compliance [m]
  std::size_t unknowns_ = kJointsPerDigit;
  /// Rows of each contact over the joints and its own spring, the number of these, and where the spring's unknowns
  /// begin.
  std::array<std::array<std::array<double, kColumns>, kContactRows>, kMost> row_{};
  std::array<std::size_t, kMost> columns_{};
  std::array<std::size_t, kMost> spring_{};
  Unknowns x_{};
  std::array<RowCompliance, kMost> compliance_{};
  std::array<ContactRows, kMost> offset_{};
  std::array<ContactRows, kMost> multiplier_{};
  std::array<LawSlopes, kMost> slope_{};
  std::array<bool, kMost> slips_{};
  std::array<bool, kMost> spins_{};
};

}  // namespace

DigitAngles displacement_of(const ContactProblem& problem, const HeldJoints& held) noexcept {
  DigitAngles x{};
  for (std::size_t j = 0; j < x.size(); ++j)
    x[j] = held[j] == Held::kNo ? unlimited_displacement(problem, j) : held_displacement(problem, held, j);
  return x;
}

double contact_residual(const ContactProblem& problem, const HeldJoints& held) noexcept {
  constexpr double kArm = 0.02;  // length that makes a rotation a displacement [m]
  const DigitAngles x = displacement_of(problem, held);
  double worst = 0.0;
  const auto add = [&](double violated) {
    if (!(violated <= worst)) worst = std::isnan(violated) ? kInfinity : violated;
  };
  const SegmentVectors friction = tangential_multipliers(problem);
  for (int i = 0; i < problem.count; ++i) {
    const ProblemContact& contact = problem.contact[idx(i)];
    const ContactRows& p = contact.multiplier;
    const RowProducts product(contact, held);
    if (!product.moves_normal()) continue;
    const double u =
        dot(contact.row[kNormalRow], x) + contact.room + contact.softness * product.normal * p[kNormalRow];
    const double n = product.normal * p[kNormalRow];
    add(std::abs(u < n ? u : n));

    const double bound = contact.friction * std::min(p[kNormalRow], contact.most_friction_normal);
    const double stays = product.sliding - contact.tangent_compliance;
    const Vec3 spring =
        problem.elongation[idx(contact.segment)] + problem.spring_compliance * friction[idx(contact.segment)];
    const double t1 = stays * p[1] - dot(contact.row[1], x) - contact.tangent[0].dot(spring);
    const double t2 = stays * p[2] - dot(contact.row[2], x) - contact.tangent[1].dot(spring);
    const double size = length_of(t1, t2);
    const double share = size > product.sliding * bound ? product.sliding * bound / size : 1.0;
    add(length_of(product.sliding * p[1] - share * t1, product.sliding * p[2] - share * t2));

    if (!(product.spin > kLeastSpin) || !(contact.spin_radius > 0.0)) continue;
    const double most = contact.spin_radius * bound;
    const double turned = dot(contact.row[kSpinRow], x) + contact.spin_anchor +
                          ContactProblem::kSpinSoftness * product.spin * p[kSpinRow];
    add(kArm * product.spin *
        std::abs(p[kSpinRow] - std::clamp(p[kSpinRow] - turned / product.spin, -most, most)));
  }
  return worst;
}

double newton_contacts(ContactProblem& problem, const HeldJoints& held, double tolerance,
                       int& budget) noexcept {
  double least = contact_residual(problem, held);
  auto best = problem.contact;
  double residual = least;
  Newton newton(problem, held);
  for (int round = 0; round < Newton::kRounds && budget > 0 && !(least <= tolerance); ++round) {
    if (round == 0 || round == Newton::kBeginSoft || round == Newton::kEndSoft) {
      newton.set_compliance(round == Newton::kBeginSoft ? Newton::kSoft : Newton::kStiff);
      if (residual > least) {
        problem.contact = best;
        newton.restart();
      }
    }
    newton.round(budget);
    residual = contact_residual(problem, held);
    if (!(residual < least)) continue;
    least = residual;
    best = problem.contact;
  }
  problem.contact = best;
  return least;
}

}  // namespace phalanx

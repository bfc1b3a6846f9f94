// SPDX-License-Identifier: Apache-2.0
#include "contact/contact_problem.h"

#include <algorithm>
#include <cmath>

#include "contact/contact_newton.h"
#include "phalanx/core/constants.h"
#include "phalanx/core/index.h"

namespace phalanx {
namespace {

using Pair = std::array<double, 2>;

void add(DigitAngles& x, const DigitAngles& row, double multiplier) noexcept {
  for (std::size_t i = 0; i < x.size(); ++i) x[i] += multiplier * row[i];
}

/// Symmetric 2x2 matrix by its eigenvalues, largest first, and the unit vector of the first.
struct Spectrum {
  double large = 0.0;
  double small = 0.0;
  double c = 1.0;
  double s = 0.0;

  static Spectrum of(double a, double b, double d) noexcept {  // [a b; b d]
    const double mean = 0.5 * (a + d);
    const double half = 0.5 * (a - d);
    const double radius = length_of(half, b);
    Spectrum result{mean + radius, std::max(0.0, mean - radius), 1.0, 0.0};
    if (radius > 0.0) {
      // Of two equal forms of the eigenvector, the one without cancellation.
      const double x = half >= 0.0 ? half + radius : b;
      const double y = half >= 0.0 ? b : radius - half;
      const double length = length_of(x, y);
      if (length > 0.0) {
        result.c = x / length;
        result.s = y / length;
      }
    }
    return result;
  }
};

/// Returns the p with |p| <= radius that minimises p' A p / 2 + g' p: the friction of a contact whose
/// tangential displacement without it is g. On the bound, p opposes A p + g.
Pair least_on_disc(const Spectrum& A, const Pair& g, double radius) noexcept {
  const double g1 = A.c * g[0] + A.s * g[1];
  const double g2 = -A.s * g[0] + A.c * g[1];
  const double size = length_of(g1, g2);
  if (!(radius > 0.0) || !(size > 0.0)) return {0.0, 0.0};
  // p = -(A + shift)^-1 g with |p| = radius. 1 / |p| is nearly linear in the shift, and concave.
  constexpr int kSteps = 8;
  double shift = std::max(0.0, size / radius - A.large);
  double p1 = 0.0;
  double p2 = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    const double a1 = A.large + shift;
    const double a2 = A.small + shift;
    p1 = a1 > 0.0 ? -g1 / a1 : 0.0;
    p2 = a2 > 0.0 ? -g2 / a2 : 0.0;
    const double length = length_of(p1, p2);
    if (shift == 0.0 && length <= radius) break;
    const double slope = (a1 > 0.0 ? p1 * p1 / a1 : 0.0) + (a2 > 0.0 ? p2 * p2 / a2 : 0.0);
    if (!(slope > 0.0)) break;
    const double change = (length / radius - 1.0) * length * length / slope;
    shift = std::max(0.0, shift + change);
    if (std::abs(change) <= 1e-15 * a1) break;
  }
  const double length = length_of(p1, p2);
  if (length > radius) {
    p1 *= radius / length;
    p2 *= radius / length;
  }
  return {A.c * p1 - A.s * p2, A.s * p1 + A.c * p2};
}

using Triple = std::array<double, 3>;
using Square = std::array<Triple, 3>;

constexpr double kRegular = 1e-11;  // of a block's trace, added to the tangents' diagonal
constexpr double kStronglyRegular = 1e-6;
constexpr double kLeastDeterminant = 1e-14;  // of the cubed trace: below it rounding decides
constexpr double kLeastShare = 1e-6;         // of A_nn, for the denominator of the normal multiplier
constexpr double kArm = 0.02;  // length that makes a rotation a displacement, for the tolerance [m]

/// Products of the rows of normal and tangents, and what is constant in the iteration. A little is added to the
/// tangents' diagonal: A is then regular, also for a segment with two joints, and each contact has a solution.
struct Rows {
  Square A{};        ///< [m^2]
  Square inverse{};  ///< of A
  Spectrum sliding;  ///< of the tangents' products while the normal row is solved: A_tt - A_tn A_nt / A_nn

  static Rows of(const Square& A) noexcept {
    Rows rows;
    if (!rows.set(A, kRegular)) (void)rows.set(A, kStronglyRegular);  // one joint alone moves the contact
    return rows;
  }

 private:
  /// @returns false if the inverse is rounding noise
  bool set(const Square& products, double regular) noexcept {
    Square& B = A;
    B = products;
    const double trace = B[0][0] + B[1][1] + B[2][2];
    B[1][1] += regular * trace;
    B[2][2] += regular * trace;
    const auto minor = [&](std::size_t i, std::size_t j) {
      const std::size_t i1 = (i + 1) % 3;
      const std::size_t i2 = (i + 2) % 3;
      const std::size_t j1 = (j + 1) % 3;
      const std::size_t j2 = (j + 2) % 3;
      return B[i1][j1] * B[i2][j2] - B[i1][j2] * B[i2][j1];
    };
    const double determinant = B[0][0] * minor(0, 0) + B[0][1] * minor(0, 1) + B[0][2] * minor(0, 2);
    if (!(determinant > kLeastDeterminant * trace * trace * trace)) return false;
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) inverse[i][j] = minor(j, i) / determinant;
    }
    const auto reduced = [&](std::size_t i, std::size_t j) { return B[i][j] - B[i][0] * B[0][j] / B[0][0]; };
    sliding = Spectrum::of(reduced(1, 1), reduced(1, 2), reduced(2, 2));
    return true;
  }
};

/// One contact: its rows with the spin row free of friction, and with the spin row solved along.
struct Block {
  Rows alone;
  Rows with_spin;
  Square A{};         ///< products of normal and tangents, without compliances
  Triple beside{};    ///< products of the spin row with normal and tangents
  double spin = 0.0;  ///< product of the spin row with itself, and a little more; 0: not solved
  bool used = false;  ///< the joints can move the contact along its normal
};

Block block_of(const ProblemContact& contact, double spring_compliance) noexcept {
  Block block;
  Square A{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j <= i; ++j) A[i][j] = A[j][i] = dot(contact.row[i], contact.row[j]);
    block.beside[i] = dot(contact.row[i], contact.row[kSpinRow]);
  }
  block.A = A;
  A[1][1] += contact.tangent_compliance + spring_compliance;
  A[2][2] += contact.tangent_compliance + spring_compliance;
  block.used = A[0][0] > kLeastArm * kLeastArm;
  if (!block.used) return block;
  block.alone = Rows::of(A);
  block.spin = (1.0 + ContactProblem::kSpinSoftness) * dot(contact.row[kSpinRow], contact.row[kSpinRow]);
  if (!(block.spin > kLeastSpin)) {
    block.spin = 0.0;
    return block;
  }
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) A[i][j] -= block.beside[i] * block.beside[j] / block.spin;
  }
  // Where spin and closing go together, both cannot be solved at once.
  if (A[0][0] > 1e-6 * block.A[0][0]) {
    block.with_spin = Rows::of(A);
  } else {
    block.spin = 0.0;
  }
  return block;
}

Triple product(const Square& M, const Triple& v) noexcept {
  Triple result{};
  for (std::size_t i = 0; i < 3; ++i) result[i] = M[i][0] * v[0] + M[i][1] * v[1] + M[i][2] * v[2];
  return result;
}

/// Slipping contact without a bound on the normal multiplier that friction counts. With the direction d of
/// friction, p_n = -c_n / (A_nn + mu A_nt . d) and p_t = mu p_n d; d is sought that opposes the displacement
/// along the tangents.
class SlipDirection {
 public:
  SlipDirection(const Square& A, const Triple& c, double mu) noexcept
      : A_(A), c_(c), mu_(mu), tolerance_(kTolerance * (std::abs(c[0]) + std::abs(c[1]) + std::abs(c[2]))) {}

  /// Finds the direction, the nearest to `d` if there are several. @returns false if there is none; `d` is
  /// then unchanged
  [[nodiscard]] bool find(Pair& d) const noexcept {
    Pair tried = d;
    if (newton(tried)) {
      d = tried;
      return true;
    }
    // The directions all around between which across() changes its sign.
    constexpr int kAround = 32;
    constexpr double kCos = 0.98078528040323045;  // of 360 / 32 degrees
    constexpr double kSin = 0.19509032201612827;
    Pair before = {1.0, 0.0};
    double value_before = across(before);
    double nearest = -2.0;
    for (int i = 0; i < kAround; ++i) {
      const Pair at = {kCos * before[0] - kSin * before[1], kSin * before[0] + kCos * before[1]};
      const double value = across(at);
      if ((value_before < 0.0) != (value < 0.0)) {
        const Pair root = between(before, at, value_before < 0.0);
        const double cosine = root[0] * d[0] + root[1] * d[1];
        if (cosine > nearest && opposes(root)) {
          nearest = cosine;
          tried = root;
        }
      }
      before = at;
      value_before = value;
    }
    if (!(nearest > -2.0)) return false;
    d = tried;
    return true;
  }
  /// Returns p_n of a direction.
  [[nodiscard]] double normal(const Pair& d) const noexcept { return -c_[0] / share(d); }

 private:
  static constexpr double kTolerance = 1e-11;
  static constexpr double kNoMotion = 1e-4;  // of the tolerance, across the direction: it has converged

  [[nodiscard]] double share(const Pair& d) const noexcept {
    return A_[0][0] + mu_ * (A_[0][1] * d[0] + A_[0][2] * d[1]);
  }
  /// Returns the displacement along the tangents, times share(d).
  [[nodiscard]] Pair shared_motion(const Pair& d) const noexcept {
    const double s = share(d);
    return {c_[1] * s - c_[0] * (A_[1][0] + mu_ * (A_[1][1] * d[0] + A_[1][2] * d[1])),
            c_[2] * s - c_[0] * (A_[2][0] + mu_ * (A_[2][1] * d[0] + A_[2][2] * d[1]))};
  }
  [[nodiscard]] double across(const Pair& d) const noexcept {
    const Pair v = shared_motion(d);
    return d[0] * v[1] - d[1] * v[0];
  }
  [[nodiscard]] bool opposes(const Pair& d) const noexcept {
    const Pair v = shared_motion(d);
    const double s = share(d);
    return s > kLeastShare * A_[0][0] && d[0] * v[0] + d[1] * v[1] <= tolerance_ * s;
  }
  /// Returns the direction between a and b where across() changes its sign.
  [[nodiscard]] Pair between(Pair a, Pair b, bool rises) const noexcept {
    constexpr int kHalvings = 50;
    for (int i = 0; i < kHalvings; ++i) {
      const double x = a[0] + b[0];
      const double y = a[1] + b[1];
      const double length = length_of(x, y);
      const Pair middle = {x / length, y / length};
      if ((across(middle) < 0.0) == rises) {
        a = middle;
      } else {
        b = middle;
      }
    }
    return a;
  }
  /// Returns the displacement along the tangents.
  [[nodiscard]] Pair motion(const Pair& d) const noexcept {
    const double p = normal(d);
    return {c_[1] + p * (A_[1][0] + mu_ * (A_[1][1] * d[0] + A_[1][2] * d[1])),
            c_[2] + p * (A_[2][0] + mu_ * (A_[2][1] * d[0] + A_[2][2] * d[1]))};
  }
  /// Solves d x motion(d) = 0 by Newton's method. @returns true if the d found opposes the motion
  bool newton(Pair& d) const noexcept {
    constexpr int kSteps = 12;
    for (int i = 0; i < kSteps; ++i) {
      const Pair n = {-d[1], d[0]};
      const double denominator = share(d);
      if (!(denominator > kLeastShare * A_[0][0])) return false;  // it jams: there friction holds
      const double p = -c_[0] / denominator;
      const Pair v = motion(d);
      const double across = d[0] * v[1] - d[1] * v[0];
      const double along = d[0] * v[0] + d[1] * v[1];
      // Derivatives with respect to the angle of d.
      const double dp = -p * mu_ * (A_[0][1] * n[0] + A_[0][2] * n[1]) / denominator;
      const Pair dv = {dp / p * (v[0] - c_[1]) + p * mu_ * (A_[1][1] * n[0] + A_[1][2] * n[1]),
                       dp / p * (v[1] - c_[2]) + p * mu_ * (A_[2][1] * n[0] + A_[2][2] * n[1])};
      const double slope = d[0] * dv[1] - d[1] * dv[0] - along;
      if (std::abs(across) <= kNoMotion * tolerance_) return along <= tolerance_;
      if (!(slope > 0.0)) return false;  // not towards a direction that opposes the motion
      const double turn = std::clamp(-across / slope, -0.7, 0.7);
      const double x = d[0] + turn * n[0];
      const double y = d[1] + turn * n[1];
      const double length = length_of(x, y);
      d = {x / length, y / length};
      if (std::abs(turn) <= 1e-14) return along <= tolerance_;
    }
    return false;
  }

  const Square& A_;
  const Triple& c_;
  double mu_;
  double tolerance_;  ///< of a displacement [m]
};

/// Solves normal and tangents of one contact.
/// @param c       displacements of the rows without this contact, with room and spring [m]
/// @param before  multipliers of the last iteration, from which the slip direction is taken
/// @param slips   set to true if friction is at its bound
Triple solve_rows(const Rows& rows, const ProblemContact& contact, const Triple& c, const Triple& before,
                  bool& slips) noexcept {
  const double mu = contact.friction;
  const double cap = contact.most_friction_normal;
  const Square& A = rows.A;
  slips = true;
  if (!(c[0] < 0.0)) {
    slips = false;
    return {};
  }
  if (!(mu > 0.0)) return {-c[0] / ((1.0 + contact.softness) * A[0][0]), 0.0, 0.0};

  // Refined: A may be nearly singular.
  Triple stick{};
  for (int i = 0; i < 3; ++i) {
    Triple residual = product(A, stick);
    for (std::size_t r = 0; r < 3; ++r) residual[r] += c[r];
    const Triple step = product(rows.inverse, residual);
    for (std::size_t r = 0; r < 3; ++r) stick[r] -= step[r];
  }
  const double tangent = length_of(stick[1], stick[2]);
  if (stick[0] > 0.0 && tangent <= mu * std::min(stick[0], cap)) {
    slips = false;
    return stick;
  }
  // Friction that the bound on the counted normal limits is constant. With p_n = -(c_n + A_nt p_t) / A_nn the
  // tangents are then a problem of their own.
  if (cap < kInfinity) {
    const Pair g = {c[1] - A[1][0] * c[0] / A[0][0], c[2] - A[2][0] * c[0] / A[0][0]};
    const Pair t = least_on_disc(rows.sliding, g, mu * cap);
    const double normal = -(c[0] + A[0][1] * t[0] + A[0][2] * t[1]) / A[0][0];
    if (normal >= cap) return {normal, t[0], t[1]};
  }
  Pair d = {1.0, 0.0};
  if (const double size = length_of(before[1], before[2]); size > 0.0) {
    d = {before[1] / size, before[2] / size};
  } else if (tangent > 0.0) {
    d = {stick[1] / tangent, stick[2] / tangent};
  }
  if (const SlipDirection direction(A, c, mu); direction.find(d)) {
    if (const double p = direction.normal(d); p <= cap) return {p, mu * p * d[0], mu * p * d[1]};
  }
  // Neither: friction along d, as much as the normal multiplier that it leaves admits.
  const double along = mu * (A[0][1] * d[0] + A[0][2] * d[1]);
  const double counted = std::min(cap, -c[0] / std::max(A[0][0] + along, A[0][0]));
  const double normal = std::max(counted, -(c[0] + counted * along) / A[0][0]);
  return {normal, mu * counted * d[0], mu * counted * d[1]};
}

/// Solves one contact.
/// @param c  displacements of all rows without this contact, with room, spring and anchor
ContactRows solve_block(const Block& block, const ContactRows& c, ProblemContact& contact) noexcept {
  const Triple before = {contact.multiplier[0], contact.multiplier[1], contact.multiplier[2]};
  const auto with = [&](double spin) {
    return Triple{c[0] + block.beside[0] * spin, c[1] + block.beside[1] * spin,
                  c[2] + block.beside[2] * spin};
  };
  const double share = contact.friction * contact.spin_radius;
  const double cap = contact.most_friction_normal;
  contact.spins = true;
  if (!(c[0] < 0.0)) {
    contact.slips = false;
    return {};
  }
  if (block.spin > 0.0 && share > 0.0) {
    // Spin that friction holds.
    const Triple p =
        solve_rows(block.with_spin, contact, with(-c[kSpinRow] / block.spin), before, contact.slips);
    const double spin =
        -(c[kSpinRow] + block.beside[0] * p[0] + block.beside[1] * p[1] + block.beside[2] * p[2]) /
        block.spin;
    contact.spins = std::abs(spin) > share * std::min(p[0], cap);
    if (!contact.spins) return {p[0], p[1], p[2], spin};
    // Spin on its bound: the bound follows p_n, which changes little.
    double bound = std::copysign(share * std::min(p[0], cap), spin);
    Triple q{};
    for (int i = 0; i < 3; ++i) {
      q = solve_rows(block.alone, contact, with(bound), before, contact.slips);
      bound = std::copysign(share * std::min(q[0], cap), spin);
    }
    return {q[0], q[1], q[2], bound};
  }
  const Triple p = solve_rows(block.alone, contact, with(0.0), before, contact.slips);
  return {p[0], p[1], p[2], 0.0};
}

/// Adds to the normal multipliers after an iteration that has not converged, so that contacts close by no more than
/// their room. At most 10 sweeps; the continuous search stops what is left. Friction stays within its bound.
void open_contacts(ContactProblem& problem, const HeldJoints& held, double tolerance) noexcept {
  constexpr int kSweeps = 10;
  std::array<double, ContactProblem::kMostContacts> added{};
  double change = 2.0 * tolerance;
  for (int sweep = 0; sweep < kSweeps && change > tolerance; ++sweep) {
    change = 0.0;
    for (std::size_t i = 0; i < static_cast<std::size_t>(problem.count); ++i) {
      ProblemContact& contact = problem.contact[i];
      const DigitAngles moves = free_part(contact.row[kNormalRow], held);
      const double A = dot(moves, moves);
      if (!(A > kLeastArm * kLeastArm)) continue;
      const double closes = dot(contact.row[kNormalRow], problem.displacement) + contact.room;
      const double step = std::max(-added[i], -closes / ((1.0 + contact.softness) * A));
      added[i] += step;
      if (!(contact.multiplier[kNormalRow] > 0.0)) contact.slips = true;  // it has no friction
      contact.multiplier[kNormalRow] += step;
      add(problem.displacement, moves, step);
      change = std::max(change, std::abs(step) * A);
    }
  }
}

constexpr double kNearlySolved = 1e-9;  // residual [m]

/// Sweeps over the contacts with the joints of `held` fixed at their bounds, and goes on with Newton's method.
/// @returns true if the sweeps have converged
bool sweep_contacts(ContactProblem& problem, const HeldJoints& held, int sweeps, double tolerance,
                    int& newton_budget) noexcept {
  const auto count = static_cast<std::size_t>(problem.count);
  DigitAngles& x = problem.displacement;
  SegmentVectors friction = tangential_multipliers(problem);
  std::array<Block, ContactProblem::kMostContacts> block;
  std::array<ProblemContact, ContactProblem::kMostContacts> contact;
  for (std::size_t j = 0; j < x.size(); ++j)
    x[j] = held[j] == Held::kNo ? problem.free[j] : held_displacement(problem, held, j);
  for (std::size_t i = 0; i < count; ++i) {
    contact[i] = problem.contact[i];
    for (DigitAngles& row : contact[i].row) row = free_part(row, held);
    block[i] = block_of(contact[i], problem.spring_compliance);
    if (!block[i].used) {
      friction[idx(contact[i].segment)] -= tangential_multiplier(contact[i]);
      contact[i].multiplier = {};
    }
    for (std::size_t r = 0; r < kContactRows; ++r) add(x, contact[i].row[r], contact[i].multiplier[r]);
  }
  double change = 2.0 * tolerance;
  for (int sweep = 0; sweep < sweeps && change > tolerance; ++sweep) {
    change = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
      if (!block[i].used) continue;
      ProblemContact& at = contact[i];
      const ContactRows before = at.multiplier;
      const Triple own = product(block[i].A, {before[0], before[1], before[2]});
      const Triple& beside = block[i].beside;
      // The full rows: joints that are held move too, to their bounds.
      const auto& full = problem.contact[i].row;
      ContactRows c{};
      for (std::size_t r = 0; r < 3; ++r) c[r] = dot(full[r], x) - own[r] - beside[r] * before[kSpinRow];
      c[0] += at.room;
      Vec3& pulls = friction[idx(at.segment)];
      pulls -= tangential_multiplier(at);
      const Vec3 spring = problem.elongation[idx(at.segment)] + problem.spring_compliance * pulls;
      c[1] += at.tangent[0].dot(spring);
      c[2] += at.tangent[1].dot(spring);
      c[kSpinRow] = at.spin_anchor + dot(full[kSpinRow], x) - beside[0] * before[0] - beside[1] * before[1] -
                    beside[2] * before[2] - dot(at.row[kSpinRow], at.row[kSpinRow]) * before[kSpinRow];
      at.multiplier = solve_block(block[i], c, at);
      pulls += tangential_multiplier(at);
      for (std::size_t r = 0; r < kContactRows; ++r) {
        const double step = at.multiplier[r] - before[r];
        add(x, at.row[r], step);
        const double gives_way = r == kTangentRow || r == kSecondTangentRow
                                     ? at.tangent_compliance + problem.spring_compliance
                                     : 0.0;
        const double scale = r < 3 ? block[i].A[r][r] + gives_way : block[i].spin * kArm;
        change = std::max(change, std::abs(step) * scale);
      }
    }
  }
  for (std::size_t i = 0; i < count; ++i) {
    problem.contact[i].multiplier = contact[i].multiplier;
    problem.contact[i].slips = contact[i].slips;
    problem.contact[i].spins = contact[i].spins;
  }
  if (change <= tolerance) return true;
  // A single contact that the sweeps do not solve jams: Newton's method finds nothing better. It may find another of
  // several solutions, and the force would jump: it is left out where several contacts are nearly solved, too.
  const bool solved = count > 1 && contact_residual(problem, held) > kNearlySolved &&
                      newton_contacts(problem, held, tolerance, newton_budget) <= tolerance;
  x = displacement_of(problem, held);
  if (!solved) open_contacts(problem, held, tolerance);
  return false;
}

}  // namespace

SegmentVectors tangential_multipliers(const ContactProblem& problem) noexcept {
  SegmentVectors sum{Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
  for (int i = 0; i < problem.count; ++i)
    sum[idx(problem.contact[idx(i)].segment)] += tangential_multiplier(problem.contact[idx(i)]);
  return sum;
}

double solve_contacts(ContactProblem& problem, int sweeps, double tolerance) noexcept {
  // Joints at their limits are an active set, from the last solution on. After some rounds no joint is released
  // any more, so that the set settles.
  constexpr int kNewtonSteps = 60;  // of all rounds
  constexpr int kReleasingRounds = 3;
  constexpr int kRounds = kReleasingRounds + kJointsPerDigit;
  int newton_budget = kNewtonSteps;
  HeldJoints held{};
  for (std::size_t j = 0; j < held.size(); ++j) {
    if (problem.limit[j] != 0.0) held[j] = problem.limit[j] < 0.0 ? Held::kHighest : Held::kLowest;
  }
  bool changed = true;
  bool converged = false;
  HeldJoints solved_with = held;
  for (int round = 0; round < kRounds && changed; ++round) {
    solved_with = held;
    converged = sweep_contacts(problem, held, sweeps, tolerance, newton_budget);
    changed = false;
    for (std::size_t j = 0; j < held.size(); ++j) {
      // Computed from the multipliers alone, so that a contact that has let go leaves no rounding.
      const double without = unlimited_displacement(problem, j);
      const bool above = without > problem.highest[j];
      const bool below = without < problem.lowest[j];
      const Held wanted = above ? Held::kHighest : (below ? Held::kLowest : Held::kNo);
      if (wanted != held[j] && (held[j] == Held::kNo || round < kReleasingRounds)) {
        held[j] = wanted;
        changed = true;
      }
      problem.displacement[j] = held[j] == Held::kNo ? without : held_displacement(problem, held, j);
      problem.limit[j] = problem.displacement[j] - without;
    }
  }
  return converged && !changed ? tolerance : contact_residual(problem, solved_with);
}

}  // namespace phalanx

// SPDX-License-Identifier: Apache-2.0
// Siconos (https://nonsmooth.gricad-pages.univ-grenoble-alpes.fr/siconos), an independent solver of contact
// problems with Coulomb friction.
#pragma once

#include <gtest/gtest.h>
#include <siconos/numerics/FrictionContactProblem.h>
#include <siconos/numerics/Friction_cst.h>
#include <siconos/numerics/NonSmoothDrivers.h>
#include <siconos/numerics/NumericsMatrix.h>
#include <siconos/numerics/SolverOptions.h>
#include <siconos/numerics/fc3d_Solvers.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <optional>
#include <vector>

#include "contact/contact_newton.h"
#include "contact/contact_problem.h"

namespace phalanx::test {

/// Returns the joints' displacement, without spin, joint limits and a bound on the normal that friction counts.
/// Returns nothing if Siconos does not reach a residual of 1e-11.
inline std::optional<DigitAngles> solve_with_siconos(const ContactProblem& problem) {
  constexpr double kScale = 1.0 / 0.03;  // rows in units of 30 mm, so that numbers are near 1
  const int rows = 3 * problem.count;
  const auto row = [&](int i) -> const DigitAngles& {
    return problem.contact[static_cast<std::size_t>(i / 3)].row[static_cast<std::size_t>(i % 3)];
  };
  const auto tangent = [&](int i) -> const Vec3& {
    return problem.contact[static_cast<std::size_t>(i / 3)].tangent[static_cast<std::size_t>(i % 3 - 1)];
  };
  const auto dot = [](const DigitAngles& a, const DigitAngles& b) {
    double sum = 0.0;
    for (std::size_t j = 0; j < a.size(); ++j) sum += a[j] * b[j];
    return sum;
  };
  std::vector<double> W(static_cast<std::size_t>(rows * rows));
  std::vector<double> q(static_cast<std::size_t>(rows));
  std::vector<double> mu;
  for (int i = 0; i < rows; ++i) {
    const ProblemContact& contact = problem.contact[static_cast<std::size_t>(i / 3)];
    const Vec3& elongation = problem.elongation[static_cast<std::size_t>(contact.segment)];
    const double offset = i % 3 == 0 ? contact.room : tangent(i).dot(elongation);
    q[static_cast<std::size_t>(i)] = kScale * (dot(row(i), problem.free) + offset);
    if (i % 3 == 0) mu.push_back(contact.friction);
    for (int j = 0; j < rows; ++j) {
      double product = dot(row(i), row(j));
      const bool spring = i % 3 != 0 && j % 3 != 0 &&
                          contact.segment == problem.contact[static_cast<std::size_t>(j / 3)].segment;
      if (spring) product += problem.spring_compliance * tangent(i).dot(tangent(j));
      W[static_cast<std::size_t>(i + rows * j)] = kScale * kScale * product;
    }
    if (i % 3 != 0) W[static_cast<std::size_t>(i + rows * i)] += kScale * kScale * contact.tangent_compliance;
  }
  std::vector<double> reaction(q.size());
  std::vector<double> velocity(q.size());

  NumericsMatrix* matrix = NM_create_from_data(NM_DENSE, rows, rows, W.data());
  FrictionContactProblem described{};
  described.dimension = 3;
  described.numberOfContacts = problem.count;
  described.M = matrix;
  described.q = q.data();
  described.mu = mu.data();
  SolverOptions* options = solver_options_create(SICONOS_FRICTION_3D_NSGS);
  options->dparam[SICONOS_DPARAM_TOL] = 1e-14;
  options->iparam[SICONOS_IPARAM_MAX_ITER] = 200000;
  const int failed = fc3d_driver(&described, reaction.data(), velocity.data(), options);
  const double residual = options->dparam[SICONOS_DPARAM_RESIDU];
  // Siconos 4.4 clears the structures of the solver and of the solvers within it, and leaves their memory to us.
  std::vector<SolverOptions*> within(options->internalSolvers,
                                     options->internalSolvers + options->numberOfInternalSolvers);
  solver_options_delete(options);
  for (SolverOptions* solver : within) std::free(solver);
  std::free(options);
  matrix->matrix0 = nullptr;  // ours
  NM_clear(matrix);
  std::free(matrix);

  const bool wild =
      std::any_of(reaction.begin(), reaction.end(), [](double r) { return !(std::abs(r) < 1e4); });
  if (failed != 0 || !(residual <= 1e-11) || wild) return std::nullopt;
  DigitAngles x = problem.free;
  for (int i = 0; i < rows; ++i) {
    for (std::size_t j = 0; j < x.size(); ++j)
      x[j] += kScale * row(i)[j] * reaction[static_cast<std::size_t>(i)];
  }
  return x;
}

/// Returns by how much the solution violates the conditions of the problem without spin and limits [m].
inline double violation(const ContactProblem& problem) {
  double worst = 0.0;
  const SegmentVectors friction = tangential_multipliers(problem);
  for (int i = 0; i < problem.count; ++i) {
    const ProblemContact& contact = problem.contact[static_cast<std::size_t>(i)];
    const auto segment = static_cast<std::size_t>(contact.segment);
    const Vec3 spring = problem.elongation[segment] + problem.spring_compliance * friction[segment];
    std::array<double, 3> v{};
    for (std::size_t r = 0; r < 3; ++r) {
      for (std::size_t j = 0; j < problem.free.size(); ++j)
        v[r] += contact.row[r][j] * problem.displacement[j];
    }
    for (std::size_t r = 1; r < 3; ++r)
      v[r] += contact.tangent[r - 1].dot(spring) + contact.tangent_compliance * contact.multiplier[r];
    const double gap = v[0] + contact.room;
    const double normal = contact.multiplier[0];
    const double tangent = std::hypot(contact.multiplier[1], contact.multiplier[2]);
    const double slip = std::hypot(v[1], v[2]);
    const double bound = contact.friction * normal;
    worst = std::max({worst, -gap, -normal, tangent - bound * (1.0 + 1e-9)});
    if (normal > 0.0) worst = std::max(worst, std::abs(gap));
    if (normal > 0.0 && tangent < bound * (1.0 - 1e-6)) worst = std::max(worst, slip);
    if (normal > 0.0 && tangent >= bound * (1.0 - 1e-6) && slip > 0.0 && tangent > 0.0) {
      worst = std::max(worst, std::hypot(v[1] + contact.multiplier[1] / tangent * slip,
                                         v[2] + contact.multiplier[2] / tangent * slip));
    }
  }
  return worst;
}

/// Compares the joints' displacement at full convergence with Siconos. A problem may have several solutions: where the
/// two differ, ours must fulfil the conditions, and such problems must be few.
class SiconosComparison {
 public:
  void add(ContactProblem problem) {
    const auto reference = solve_with_siconos(problem);
    if (!reference) return;
    ++compared_;
    solve_contacts(problem, 5000, 1e-15);
    double apart = 0.0;
    for (std::size_t j = 0; j < reference->size(); ++j)
      apart = std::max(apart, std::abs((*reference)[j] - problem.displacement[j]));
    if (apart <= 1e-9) return;
    ++(violation(problem) <= 1e-9 ? other_solutions_ : unfinished_);
  }
  /// @param share  of the problems that may have another solution, and that may be unfinished
  void expect_agreement(int problems, double share) const {
    std::printf("%d compared, %d with another solution, %d not converged\n", compared_, other_solutions_,
                unfinished_);
    EXPECT_GE(compared_, problems * 9 / 10) << "Siconos solves the others to less than 1e-11";
    EXPECT_LE(other_solutions_, share * compared_);
    EXPECT_LE(unfinished_, share * compared_) << "some problems in which contacts jam are not solved";
  }

 private:
  int compared_ = 0;
  int other_solutions_ = 0;
  int unfinished_ = 0;
};

}  // namespace phalanx::test

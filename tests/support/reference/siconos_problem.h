// SPDX-License-Identifier: Apache-2.0
// Siconos (https://nonsmooth.gricad-pages.univ-grenoble-alpes.fr/siconos), an independent solver of contact
// problems with Coulomb friction.
#pragma once

#include <siconos/numerics/FrictionContactProblem.h>
#include <siconos/numerics/Friction_cst.h>
#include <siconos/numerics/NonSmoothDrivers.h>
#include <siconos/numerics/NumericsMatrix.h>
#include <siconos/numerics/SolverOptions.h>
#include <siconos/numerics/fc3d_Solvers.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <optional>
#include <vector>

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
    const double offset = i % 3 == 0 ? contact.room : contact.anchor[static_cast<std::size_t>(i % 3 - 1)];
    q[static_cast<std::size_t>(i)] = kScale * (dot(row(i), problem.free) + offset);
    if (i % 3 == 0) mu.push_back(contact.friction);
    for (int j = 0; j < rows; ++j)
      W[static_cast<std::size_t>(i + rows * j)] = kScale * kScale * dot(row(i), row(j));
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

}  // namespace phalanx::test

// SPDX-License-Identifier: Apache-2.0
// Contact problems that occur while fingers move over objects, against Siconos. The linker sends each call of
// solve_contacts() here first (-Wl,--wrap).
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <random>
#include <type_traits>
#include <utility>
#include <vector>

#include "contact/contact_problem.h"
#include "phalanx/core/constants.h"
#include "phalanx/mesh/primitives.h"
#include "support/lone_finger.h"
#include "support/reference/siconos_problem.h"
#include "support/sanitized.h"

namespace phalanx {

std::vector<ContactProblem>* seen_problems = nullptr;  // null: they are not kept

double solve_contacts_itself(ContactProblem& problem, int sweeps, double tolerance) noexcept
    __asm__("__real__ZN7phalanx14solve_contactsERNS_14ContactProblemEid");
double solve_contacts_seen(ContactProblem& problem, int sweeps, double tolerance) noexcept
    __asm__("__wrap__ZN7phalanx14solve_contactsERNS_14ContactProblemEid");

static_assert(std::is_same_v<decltype(&solve_contacts), decltype(&solve_contacts_seen)>);

double solve_contacts_seen(ContactProblem& problem, int sweeps, double tolerance) noexcept {
  if (seen_problems != nullptr) seen_problems->push_back(problem);
  return solve_contacts_itself(problem, sweeps, tolerance);
}

namespace {

using test::LoneFinger;

/// Returns every fifth problem with friction of a finger that wanders over an object, mostly pressed into it.
std::vector<ContactProblem> problems_over(TriangleMesh object, std::mt19937_64& random, int ticks) {
  LoneFinger finger(ObjectModel(std::move(object)));
  HapticParameters& parameters = finger.model().parameters;
  parameters.contact.mode = ContactMode::kSliding;
  parameters.contact.friction = std::uniform_real_distribution<double>(0.1, 1.2)(random);
  const double start = finger.aim({.from = Vec3(0.0, 0.0, LoneFinger::kTipRadius + 2e-3)});
  std::vector<ContactProblem> seen;
  test::Runner hand(finger.model());
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  DigitAngles at = {start, 0.0, LoneFinger::kBend, 0.0};
  DigitAngles goal = at;
  hand.tick(test::index_angles(at[0], at[1], at[2], at[3]));
  seen_problems = &seen;
  for (int i = 0; i < ticks; ++i) {
    if (i % 40 == 0)
      goal = {start + (3e-3 + 4e-3 * u(random)) / LoneFinger::lever() + 2e-3 / LoneFinger::lever(),
              0.05 * u(random), LoneFinger::kBend + 0.1 * u(random), 0.03 * u(random)};
    for (std::size_t j = 0; j < at.size(); ++j) at[j] += 0.05 * (goal[j] - at[j]);
    hand.tick(test::index_angles(at[0], at[1], at[2], at[3]));
  }
  seen_problems = nullptr;
  std::vector<ContactProblem> kept;
  int n = 0;
  for (const ContactProblem& problem : seen) {
    const bool has_friction = problem.contact[0].friction > 0.0;  // a recovery has none
    if (has_friction && n++ % 5 == 0) kept.push_back(problem);
  }
  return kept;
}

void expect_siconos_agrees_on_motions(std::uint64_t seed, int ticks) {
  SCOPED_TRACE(testing::Message() << "seed " << seed);
  std::mt19937_64 random(seed);
  test::SiconosComparison comparison;
  int problems = 0;
  int several = 0;
  const TriangleMesh objects[] = {test::moved(make_box({0.2, 0.03, 0.02}, 12), test::at(0.0, 0.009, -0.01)),
                                  test::moved(make_sphere(0.06, 500), test::at(0.0, 0.0, -0.03)),
                                  test::groove(2.8), test::groove(2.4), test::groove(1.6)};
  for (const TriangleMesh& object : objects) {
    for (ContactProblem& problem : problems_over(object, random, ticks)) {
      // Without what Siconos does not know: spin, joint limits, a bound on the normal multiplier that friction
      // counts. Both begin with nothing.
      for (int i = 0; i < problem.count; ++i) {
        ProblemContact& contact = problem.contact[static_cast<std::size_t>(i)];
        contact.spin_radius = 0.0;
        contact.most_friction_normal = kInfinity;
        contact.multiplier = {};
      }
      problem.lowest.fill(-10.0);
      problem.highest.fill(10.0);
      problem.limit = {};
      ++problems;
      several += problem.count > 1 ? 1 : 0;
      comparison.add(problem);
    }
  }
  std::printf("seed %llu: %d problems, %d with several contacts: ", static_cast<unsigned long long>(seed),
              problems, several);
  EXPECT_GT(several, problems / 10);
  comparison.expect_agreement(problems, 0.001);
}

TEST(ContactProblem, SiconosAgreesOnThoseOfMotions) { expect_siconos_agrees_on_motions(21, 400); }

/// The long version, for ./test --full: more than 10,000 problems, a third of them with sanitizers.
TEST(ManyContactProblems, SiconosAgreesOnThoseOfMotions) {
  for (std::uint64_t seed = 1; seed <= (test::kSlowBuild ? 1 : 3); ++seed)
    expect_siconos_agrees_on_motions(seed, 7000);
}

}  // namespace
}  // namespace phalanx

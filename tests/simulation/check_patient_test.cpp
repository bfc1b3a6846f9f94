// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "phalanx/simulation/patient.h"

namespace phalanx {
namespace {

template <typename Change>
void expect_patient_refused(Change change, const std::vector<std::string>& words) {
  PatientParameters patient;
  change(patient);
  try {
    check_patient(patient);
    ADD_FAILURE() << "accepted; expected a message with " << testing::PrintToString(words);
  } catch (const std::invalid_argument& error) {
    for (const std::string& word : words) EXPECT_THAT(std::string(error.what()), testing::HasSubstr(word));
  }
}

TEST(CheckPatient, AcceptsTheDefaults) { EXPECT_NO_THROW(check_patient({})); }

TEST(CheckPatient, RefusesNumbersOutOfRange) {
  for (const double bad :
       {-1.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    expect_patient_refused([&](PatientParameters& p) { p.stiffness[6] = bad; },
                           {"stiffness of index_pip_flexion", ">= 0"});
    expect_patient_refused([&](PatientParameters& p) { p.damping[0] = bad; },
                           {"damping of thumb_cmc_flexion", ">= 0"});
    expect_patient_refused([&](PatientParameters& p) { p.press = bad; }, {"press", ">= 0"});
    expect_patient_refused([&](PatientParameters& p) { p.press_spread = bad; }, {"press_spread", "0 .. 1"});
    expect_patient_refused([&](PatientParameters& p) { p.approach_min = bad; }, {"approach_min", "> 0"});
    expect_patient_refused([&](PatientParameters& p) { p.approach_max = bad; }, {"approach_max", "> 0"});
    expect_patient_refused([&](PatientParameters& p) { p.tremor = bad; }, {"tremor", ">= 0"});
    expect_patient_refused([&](PatientParameters& p) { p.tremor_min_hz = bad; }, {"tremor_min_hz", "> 0"});
    expect_patient_refused([&](PatientParameters& p) { p.tremor_max_hz = bad; }, {"tremor_max_hz", "> 0"});
    expect_patient_refused([&](PatientParameters& p) { p.bump = bad; }, {"bump", ">= 0"});
    expect_patient_refused([&](PatientParameters& p) { p.bump_start = bad; }, {"bump_start", ">= 0"});
    expect_patient_refused([&](PatientParameters& p) { p.bump_duration = bad; }, {"bump_duration", ">= 0"});
  }
}

TEST(CheckPatient, RefusesRangesThatAreUpsideDown) {
  expect_patient_refused([](PatientParameters& p) { p.approach_max = 0.01; },
                         {"approach_max", "at least approach_min, 0.03"});
  expect_patient_refused([](PatientParameters& p) { p.tremor_max_hz = 4.0; },
                         {"tremor_max_hz", "at least tremor_min_hz, 5"});
}

}  // namespace
}  // namespace phalanx

// SPDX-License-Identifier: Apache-2.0
#include "phalanx/scene/range_file.h"

#include <gtest/gtest.h>

#include "phalanx/core/constants.h"
#include "phalanx/core/index.h"
#include "scene/expect_error.h"

namespace phalanx {
namespace {

const std::string kRangeHead =
    "format = 1\ndevice = \"glove\"\nserial = \"1\"\ncalibration = \"2026-05-04T09:30:00Z\"\npatient = "
    "\"P07\"\n"
    "date = \"2026-05-04T09:45:00Z\"\nphalanx = \"0.1.0\"\n";

void expect_bad_range(const std::string& text, const std::vector<std::string>& words) {
  SCOPED_TRACE(text);
  expect_scene_error([&] { static_cast<void>(parse_range(text, "bad.toml")); }, words);
}

TEST(RangeFile, ReadsBackToAHundredthOfADegree) {
  MeasuredRange range{.device = "a \"glove\"",
                      .serial = "0007",
                      .calibration = "2026-05-04T09:30:00Z",
                      .patient = "P07",
                      .date = "2026-05-04T09:45:00Z",
                      .phalanx = "0.1.0"};
  const auto pip = idx(joint_index(1, 2));
  range.joint[pip] = AngleRange{.min = -0.05, .max = 40.0 * kDeg};
  const MeasuredRange read = parse_range(range_text(range), "round trip");
  EXPECT_EQ(read.device, range.device);
  EXPECT_EQ(read.serial, range.serial);
  EXPECT_EQ(read.calibration, range.calibration);
  EXPECT_EQ(read.patient, range.patient);
  EXPECT_EQ(read.date, range.date);
  EXPECT_EQ(read.phalanx, range.phalanx);
  for (std::size_t j = 0; j < kJoints; ++j) EXPECT_EQ(read.joint[j].has_value(), j == pip) << j;
  EXPECT_NEAR(read.joint[pip]->min, -0.05, 0.005 * kDeg + 1e-9);
  EXPECT_NEAR(read.joint[pip]->max, 40.0 * kDeg, 1e-9);
}

TEST(RangeFile, NamesWhatIsWrong) {
  const std::string joint = "[joints]\nindex_pip_flexion = ";
  EXPECT_NO_THROW(static_cast<void>(parse_range(kRangeHead + joint + "[2, 40]\n", "good.toml")));
  expect_bad_range("format = 2\n", {"bad.toml:1", "reads format 1"});
  expect_bad_range(kRangeHead, {"joints", "is missing"});
  expect_bad_range(kRangeHead + "[joints]\n", {"states no joint"});
  expect_bad_range(kRangeHead + joint + "[40, 2]\n", {"index_pip_flexion", "above the largest"});
  expect_bad_range(kRangeHead + joint + "[2, 400]\n", {"index_pip_flexion"});
  expect_bad_range(kRangeHead + joint + "[2]\n", {"index_pip_flexion"});
  expect_bad_range(kRangeHead + "[joints]\nindex_pip = [2, 40]\n", {"index_pip_flexion"});
  std::string no_date = kRangeHead;
  no_date.replace(no_date.find("2026-05-04T09:45:00Z"), 20, "today");
  expect_bad_range(no_date + joint + "[2, 40]\n", {"date", "2026-05-04T09:30:00Z"});
}

}  // namespace
}  // namespace phalanx

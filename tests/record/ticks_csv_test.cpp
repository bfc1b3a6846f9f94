// SPDX-License-Identifier: Apache-2.0
#include "phalanx/record/ticks_csv.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "phalanx/core/status.h"
#include "record/temporary_folder.h"

namespace phalanx {
namespace {

using testing::read_file;
using testing::TemporaryFolder;

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream in(line);
  for (std::string cell; std::getline(in, cell, ',');) cells.push_back(cell);
  return cells;
}

TEST(TicksCsv, HeaderNamesEveryColumnInOrder) {
  const auto cells = split(ticks_csv_header());
  ASSERT_EQ(cells.size(), 2U + 3U * 20U + 16U * 17U);
  EXPECT_EQ(cells[0], "tick");
  EXPECT_EQ(cells[1], "time_s");
  EXPECT_EQ(cells[2], "thumb_cmc_flexion_hcp_rad");
  EXPECT_EQ(cells[21], "little_dip_flexion_hcp_rad");
  EXPECT_EQ(cells[22], "thumb_cmc_flexion_gdp_rad");
  EXPECT_EQ(cells[42], "thumb_cmc_flexion_torque_nm");
  EXPECT_EQ(cells[61], "little_dip_flexion_torque_nm");
  const std::vector<std::string> first(cells.begin() + 62, cells.begin() + 79);
  EXPECT_THAT(
      first, ::testing::ElementsAre(
                 "thumb_metacarpal_contact", "thumb_metacarpal_depth_m", "thumb_metacarpal_force_raw_n",
                 "thumb_metacarpal_force_n", "thumb_metacarpal_px_m", "thumb_metacarpal_py_m",
                 "thumb_metacarpal_pz_m", "thumb_metacarpal_nx", "thumb_metacarpal_ny", "thumb_metacarpal_nz",
                 "thumb_metacarpal_slid_m", "thumb_metacarpal_force_tx_n", "thumb_metacarpal_force_ty_n",
                 "thumb_metacarpal_force_tz_n", "thumb_metacarpal_slip", "thumb_metacarpal_slip_mm_per_s",
                 "thumb_metacarpal_spin_nm"));
  EXPECT_EQ(cells.back(), "wrist_spin_nm");
  for (const std::string& cell : cells)
    EXPECT_THAT(cell, ::testing::MatchesRegex("[a-z][a-z0-9_]*")) << "a name in any programming language";
}

// Every field gets a number of its own, so that a swapped column cannot hide.
TEST(TicksCsv, ARowHoldsEveryFieldUnderItsColumn) {
  Snapshot snapshot;
  snapshot.tick = 7;
  snapshot.time_s = 0.035;
  for (std::size_t j = 0; j < kJoints; ++j) {
    snapshot.hcp_angle[j] = 100.0 + static_cast<double>(j);
    snapshot.gdp_angle[j] = 200.0 + static_cast<double>(j);
    snapshot.torque[j] = 300.0 + static_cast<double>(j);
  }
  for (std::size_t s = 0; s < kSegments; ++s) {
    const double base = 1000.0 * static_cast<double>(s + 1);
    snapshot.segment[s] = {.contact = s % 2 == 1,
                           .depth = base + 0.5,
                           .force_raw = base + 1,
                           .force = base + 2,
                           .point = Vec3(base + 3, base + 4, base + 5),
                           .normal = Vec3(base + 6, base + 7, base + 8),
                           .slid = base + 9,
                           .friction = Vec3(base + 10, base + 11, base + 12),
                           .spin = base + 14,
                           .slips = s % 3 == 1,
                           .slip_speed = 1e-3 * (base + 13)};
  }
  const TemporaryFolder folder;
  TicksCsv csv(folder / "ticks.csv");
  csv.write(snapshot);
  csv.commit();

  std::string expected = "7,0.035";
  for (const int base : {100, 200, 300}) {
    for (int j = 0; j < kJoints; ++j) expected += fmt::format(",{}", base + j);
  }
  for (int s = 0; s < kSegments; ++s) {
    const int base = 1000 * (s + 1);
    expected += fmt::format(",{},{}.5", s % 2, base);
    for (int i = 1; i <= 12; ++i) expected += fmt::format(",{}", base + i);
    expected += fmt::format(",{},{},{}", s % 3 == 1 ? 1 : 0, 1e3 * (1e-3 * (base + 13)), base + 14);
  }
  EXPECT_EQ(read_file(folder / "ticks.csv"), ticks_csv_header() + "\n" + expected + "\n");
}

// docs/outputs.md lists every status bit by number and name.
TEST(StatusBits, AreAllDocumented) {
  std::ifstream file(PHALANX_SOURCE_DIR "/docs/outputs.md");
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  for (int bit = 0; bit < kStatusBits; ++bit)
    EXPECT_THAT(text, ::testing::HasSubstr("| " + std::to_string(bit) + " | `" +
                                           std::string(status_name(bit)) + "` |"));
}

}  // namespace
}  // namespace phalanx

// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "apps/run_program.h"
#include "record/temporary_folder.h"

namespace phalanx {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;
using testing::TemporaryFolder;

/// A folder with one recording of a second.
class CliSession : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto run = run_program(folder, "run index_ball --headless --no-realtime --quiet --seconds 1");
    ASSERT_THAT(run.out, HasSubstr("recording: out/recordings/"));
    for (const auto& entry : fs::directory_iterator(folder / "out/recordings")) file = entry.path();
    ASSERT_TRUE(fs::exists(file));
  }
  /// @returns what a command says, with its exit code before it
  std::string said(const std::string& command) {
    const auto result = run_program(folder, command);
    return std::to_string(result.exit_code) + " " + result.out + result.err;
  }
  void cut_end() const { fs::resize_file(file, fs::file_size(file) - 300); }

  const TemporaryFolder folder;
  fs::path file;
};

TEST_F(CliSession, ListsShowsReplaysAndDeletes) {
  const std::string name = file.filename().string();
  EXPECT_THAT(said("session list"), HasSubstr(name));
  EXPECT_THAT(said("session list"), HasSubstr("index_ball       whole"));
  EXPECT_THAT(said("session show last --quiet"), HasSubstr("scene index_ball"));
  const std::string page = testing::read_file(fs::path(file).replace_extension(".html"));
  EXPECT_THAT(page, HasSubstr("<svg"));
  EXPECT_THAT(page, HasSubstr("scene index_ball, device beihang"));
  EXPECT_THAT(said("replay " + name + " --quiet"),
              HasSubstr("every force, angle and command has the same bits"));
  EXPECT_THAT(
      said("simulate pinch_ball --quiet --seconds 0.2 --motion out/recordings/" + name + " --out played"),
      HasSubstr("0 "));
  EXPECT_TRUE(fs::exists(folder / "played/ticks.csv"));
  EXPECT_THAT(said("session delete last"), HasSubstr("type the same with --yes"));
  EXPECT_TRUE(fs::exists(file));
  EXPECT_THAT(said("session delete " + name + " --yes"), HasSubstr("deleted"));
  EXPECT_FALSE(fs::exists(file));
  EXPECT_THAT(said("session show last"), HasSubstr("there is no recording in out/recordings"));
}

TEST_F(CliSession, ExportsTablesWithUnits) {
  const std::string all = said("session export last --out tables --quiet");
  EXPECT_THAT(all, HasSubstr("0 tables/steps.csv: steps, "));
  EXPECT_THAT(testing::read_file(folder / "tables/steps.csv"), HasSubstr("time_s,station,tick,host_time_s,"));
  EXPECT_THAT(testing::read_file(folder / "tables/steps.csv"), HasSubstr(",torque_nm_index_mcp_flexion"));
  EXPECT_THAT(testing::read_file(folder / "tables/events.csv"),
              HasSubstr("\"ended\",\"\",\"the station has ended\""));
  const std::string samples = testing::read_file(folder / "tables/samples.csv");
  EXPECT_GT(std::count(samples.begin(), samples.end(), '\n'), 100);
  EXPECT_THAT(said("session export last --out tables"),
              HasSubstr("2 phalanx: 'tables' exists; name a target that does not"));
  EXPECT_THAT(said("session export last --out part --parts steps,nope"),
              HasSubstr("there is no part 'nope' in this format; known: steps, samples"));
  EXPECT_THAT(said("session export last --out part --format xls"),
              HasSubstr("there is no format 'xls'; known: csv, hdf5, matlab, ros2, bids"));
  EXPECT_THAT(said("session export last --out part --columns nope"),
              HasSubstr("there is no column 'nope'; those of the tables are: steps: time station tick"));
  EXPECT_THAT(said("session export last --out part --format ros2 --columns torque"),
              HasSubstr("columns can be chosen for csv, hdf5 and matlab"));
  EXPECT_THAT(said("session export last --out part --format bids --subject \"A. B.\""),
              HasSubstr("'A. B.' is no label"));
  EXPECT_THAT(said("session export last --out part --parts events --columns torque"),
              HasSubstr("none of the chosen tables has any of the chosen columns"));
  EXPECT_THAT(said("session export last --out part --from 3 --to 2"),
              HasSubstr("from 3 s to 2 s there is no time"));
  EXPECT_FALSE(fs::exists(folder / "part"));
  // A part from before the 20th step to after the 40th, whenever this computer made them.
  std::vector<std::string> time;
  std::istringstream steps(testing::read_file(folder / "tables/steps.csv"));
  for (std::string line; std::getline(steps, line);) time.push_back(line.substr(0, line.find(',')));
  ASSERT_GT(time.size(), 42U);
  const auto before = [&](std::size_t step) {
    return 0.5 * (std::stod(time[step - 1]) + std::stod(time[step]));
  };
  const std::string range = "--from " + std::to_string(before(20)) + " --to " + std::to_string(before(41));
  EXPECT_THAT(said("session export last --out part --quiet " + range +
                   " --columns torque_nm_index_pip_flexion,stiffness"),
              HasSubstr("part/steps.csv: "));
  const std::string part = testing::read_file(folder / "part/steps.csv");
  EXPECT_THAT(part, StartsWith("time_s,station,tick,stiffness_n_per_m,torque_nm_index_pip_flexion\n" +
                               time[20] + ","));
  EXPECT_EQ(std::count(part.begin(), part.end(), '\n'), 1 + 21);
  EXPECT_FALSE(fs::exists(folder / "part/hand.csv"));
}

TEST_F(CliSession, WhatHasNoEndIsRepairedWhenItIsOpened) {
  cut_end();
  EXPECT_THAT(said("session list"), HasSubstr("no end: repair"));
  const std::string shown = said("replay last --quiet");
  EXPECT_THAT(shown, HasSubstr("it is whole again"));
  EXPECT_THAT(shown, HasSubstr(" 0 different"));
  EXPECT_TRUE(fs::exists(file.string() + ".torn"));
  EXPECT_THAT(said("session repair last"), HasSubstr("is whole"));
}

TEST_F(CliSession, HasMarkersThatComeByUdpAndExportsThatOtherProgramsRead) {
  const std::string port = std::to_string(20000 + ::getpid() % 30000);
  const auto run = run_program(
      folder,
      "run index_ball --headless --no-realtime --quiet --seconds 1 --record marked --marker-port " + port +
          " & while kill -0 $! 2>/dev/null; do sleep 0.1; bash -c 'printf \"Ton größer 3 \U0001F642\" "
          ">/dev/udp/127.0.0.1/" +
          port + "' 2>/dev/null; done");
  EXPECT_THAT(said("session show last --folder marked --quiet --out marked.html"), HasSubstr(" events"));
  const std::string page = testing::read_file(folder / "marked.html");
  EXPECT_THAT(page, HasSubstr("Ton größer 3 \U0001F642"));
  EXPECT_THAT(page, HasSubstr("127.0.0.1:"));
  std::string files;
  for (const std::string format : {"csv", "hdf5", "matlab", "bids"}) {
    EXPECT_THAT(
        said("session export last --folder marked --quiet --format " + format + " --out as_" + format),
        StartsWith("0 "));
    files += " as_" + format;
  }
  // h5py and scipy find the same numbers and texts as the CSV files have.
  const auto read =
      run_command(folder, "/usr/bin/python3 " PHALANX_SOURCE_DIR "/tests/record/read_exports.py" + files);
  EXPECT_EQ(read.exit_code, 0) << read.out << read.err;
  EXPECT_THAT(read.out, HasSubstr("BIDS is right"));
}

TEST_F(CliSession, IsDeletedByARuleAndRefusedByAQuota) {
  const std::string name = file.filename().string();
  EXPECT_THAT(said("session prune"),
              HasSubstr("2 phalanx: state what to keep: --keep-days D, --keep-gb G, or both"));
  EXPECT_THAT(said("session prune --keep-days nan"), HasSubstr("nan is no number from 0 to 36525"));
  EXPECT_THAT(said("session prune --keep-gb 0"), HasSubstr("0 0 recordings, 0.0 MB\n")) << "the newest stays";
  const std::string run = "run index_ball --headless --no-realtime --quiet --seconds 0.3 ";
  EXPECT_THAT(said(run + "--record-quota-gb 0.00001"),
              AllOf(StartsWith("2 phalanx: "), HasSubstr("--record-quota-gb allows 0.0 GB; delete some")));
  EXPECT_THAT(said(run + "--record-keep-days 1 --record-quota-gb 0.4"),
              AllOf(Not(HasSubstr("deleted")), HasSubstr("(0.4 GB of room)")));
  EXPECT_TRUE(fs::exists(file));
  EXPECT_THAT(said("session prune --keep-gb 0"), HasSubstr("would delete out/recordings/" + name));
  EXPECT_TRUE(fs::exists(file));
  EXPECT_THAT(said(run + "--record-keep-gb 0"), HasSubstr("deleted out/recordings/" + name));
  EXPECT_FALSE(fs::exists(file));
  EXPECT_THAT(said("session prune --keep-gb 0 --yes"), HasSubstr("deleted out/recordings/"));
}

TEST_F(CliSession, AFullDiskLeavesNothingOfAnExport) {
  for (const std::string format : {"csv", "hdf5", "matlab", "ros2", "bids"}) {
    const auto full = run_program(folder, "session export last --quiet --out taken --format " + format,
                                  ".out", "trap '' XFSZ && ulimit -f 8");
    EXPECT_EQ(full.exit_code, 1) << format << ": " << full.err;
    EXPECT_THAT(full.err, AllOf(HasSubstr("taken"), HasSubstr("cannot"))) << format;
    for (const auto& entry : fs::directory_iterator(folder.path()))
      EXPECT_THAT(entry.path().filename().string(), Not(StartsWith("taken"))) << format;
  }
}

TEST_F(CliSession, RefusesInWords) {
  EXPECT_THAT(said("replay nope"),
              HasSubstr("2 phalanx: there is no recording nope, and none of that name in out/recordings"));
  std::ofstream(folder / "text.mcap") << "a text";
  EXPECT_THAT(said("replay text.mcap"), HasSubstr("2 phalanx: text.mcap: it does not begin as an MCAP file"));
  EXPECT_THAT(said("session repair text.mcap"), HasSubstr("there is nothing to repair"));
  EXPECT_THAT(said("session list --folder nowhere"), HasSubstr("no recordings in nowhere"));
  std::ofstream(folder / "taken") << "a file";
  EXPECT_THAT(said("run index_ball --headless --no-realtime --seconds 1 --record taken"),
              HasSubstr("output folder 'taken' is a file"));
  EXPECT_THAT(said("run index_ball --headless --no-realtime --quiet --seconds 0.2 --record off"),
              Not(HasSubstr("recording:")));
}

}  // namespace
}  // namespace phalanx

// SPDX-License-Identifier: Apache-2.0
// However `phalanx run` ends, and whatever its terminal does: the torque goes, and what was logged stays.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/resource.h>
#include <sys/socket.h>

#include <algorithm>
#include <csignal>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "apps/run/running_station.h"
#include "support/sanitized.h"

namespace phalanx::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

const std::vector<std::string> kHeadless = {"--headless", "--no-realtime"};
constexpr const char* kTerminalLock = "\x13";  // Ctrl-S

class RunEnds : public ::testing::Test {
 protected:
  RunEnds() { std::signal(SIGPIPE, SIG_IGN); }

  /// Reads nothing, and what it says is not looked at.
  [[nodiscard]] RunningStation start_alone(const std::vector<std::string>& arguments = kHeadless,
                                           const std::string& script = {}) const {
    const Descriptor nothing(::open("/dev/null", O_RDWR | O_CLOEXEC));
    return {folder, {nothing.number(), nothing.number(), nothing.number()}, arguments, script};
  }
  /// Reads nothing, and says it to a pipe, of which only our end stays open here.
  [[nodiscard]] RunningStation start_into(Ends& output,
                                          const std::vector<std::string>& arguments = kHeadless) const {
    const Descriptor nothing(::open("/dev/null", O_RDONLY | O_CLOEXEC));
    return start_between(nothing, output, arguments);
  }
  /// The same with an end of a pipe to read from.
  [[nodiscard]] RunningStation start_between(const Descriptor& input, Ends& output,
                                             const std::vector<std::string>& arguments = kHeadless) const {
    const Descriptor theirs = std::move(output.theirs);
    return {folder, {input.number(), theirs.number(), theirs.number()}, arguments};
  }
  /// At a terminal, which goes when our end is closed.
  [[nodiscard]] RunningStation start_at(Ends& terminal, const std::vector<std::string>& arguments = kHeadless,
                                        const std::string& script = {}) const {
    const Descriptor theirs = std::move(terminal.theirs);
    return {folder, {theirs.number(), theirs.number(), theirs.number(), true}, arguments, script};
  }

  [[nodiscard]] std::vector<LoggedStep> steps() const { return read_steps(folder / "x.csv"); }
  /// As it was made where there is none.
  [[nodiscard]] LoggedStep last_step() const {
    const std::vector<LoggedStep> all = steps();
    return all.empty() ? LoggedStep() : all.back();
  }
  [[nodiscard]] nlohmann::json summary() const { return nlohmann::json::parse(read_file(folder / "x.json")); }
  /// A whole log of at least so many seconds, and the summary of the same steps.
  void expect_log_and_summary(double seconds) const {
    ASSERT_TRUE(std::filesystem::exists(folder / "x.csv"));
    EXPECT_FALSE(std::filesystem::exists(folder / "x.csv.partial"));
    EXPECT_GE(static_cast<double>(steps().size()), RunningStation::kRate * seconds);
    ASSERT_TRUE(std::filesystem::exists(folder / "x.json"));
    EXPECT_EQ(summary()["steps"], steps().size());
    EXPECT_EQ(summary()["records_lost"], 0);
  }
  /// It pushed; then it came to rest in state `stopped`, and stayed there for at least so long.
  void expect_stopped(double seconds) const {
    const std::vector<LoggedStep> rows = steps();
    EXPECT_TRUE(std::any_of(rows.begin(), rows.end(), [](const LoggedStep& s) {
      return s.largest_torque > 0.02;
    })) << "it never pushed";
    std::size_t at_rest = 0;
    while (at_rest < rows.size() && rows[rows.size() - 1 - at_rest].state == "stopped" &&
           rows[rows.size() - 1 - at_rest].largest_torque == 0.0)
      ++at_rest;
    EXPECT_GE(static_cast<double>(at_rest), RunningStation::kRate * seconds);
  }

  const TemporaryFolder folder;
};

TEST_F(RunEnds, ATerminalThatIsClosedEndsItInGoodOrder) {
  Ends terminal = make_terminal();
  RunningStation station = start_at(terminal);
  station.pass(2.5);
  terminal.ours.close();
  EXPECT_EQ(station.wait(), 0);
  expect_log_and_summary(2.0);
}

TEST_F(RunEnds, AReaderThatHasGoneIsNotMissed) {
  Ends input = pipe_to_program();
  Ends output = pipe_from_program();
  RunningStation station = start_between(input.theirs, output);
  output.ours.close();
  station.pass(0.5);
  write_text(input.ours, "hello\nset no.such.key=1\nset force.stiffness_n_per_mm=0.9\n");
  station.pass(2.0);
  ASSERT_TRUE(station.runs());
  write_text(input.ours, "quit\n");
  EXPECT_EQ(station.wait(), 0);
  expect_log_and_summary(2.0);
  EXPECT_NEAR(last_step().stiffness, 900.0, 1e-9);
}

TEST_F(RunEnds, StandardOutputOnAFullDiskChangesNoExitCode) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  const Descriptor full(::open("/dev/full", O_RDWR | O_CLOEXEC));
  const Descriptor nothing(::open("/dev/null", O_RDONLY | O_CLOEXEC));
  RunningStation station(folder, {nothing.number(), full.number(), full.number()}, kHeadless);
  station.pass(2.0);
  station.signal(SIGINT);
  EXPECT_EQ(station.wait(), 0);
  expect_log_and_summary(1.5);
}

// The folder of the fault reports is a file, and standard error has no reader.
TEST_F(RunEnds, AFaultWhoseReportCannotBeWrittenLosesNoLog) {
  Ends input = pipe_to_program();
  Ends output = pipe_from_program();
  std::ofstream(folder / "no_folder") << "a file";
  RunningStation station =
      start_between(input.theirs, output, {"--headless", "--no-realtime", "--fault-reports", "no_folder"});
  output.ours.close();
  station.pass(0.5);
  station.delay_loop(0.008);
  station.pass(1.0);
  station.delay_loop(0.0);
  station.pass(1.0);
  ASSERT_TRUE(station.runs());
  station.signal(SIGTERM);
  EXPECT_EQ(station.wait(), 1);
  expect_log_and_summary(0.5);
  EXPECT_EQ(last_step().fault, "overload");
}

TEST_F(RunEnds, StopTakesTheTorqueAwayWhileTheTerminalTakesNothing) {
  Ends terminal = make_terminal();
  RunningStation station = start_at(terminal);
  station.pass(1.0);
  write_text(terminal.ours, kTerminalLock);
  station.pass(0.1);
  static_cast<void>(read_waiting(terminal.ours));
  station.pass(2.2);
  ASSERT_EQ(read_waiting(terminal.ours), "") << "the terminal is not locked";
  write_text(terminal.ours, "set force.stiffness_n_per_mm=0.9\n");
  station.pass(0.5);
  write_text(terminal.ours, "stop\n");
  station.pass(2.0);
  ASSERT_TRUE(station.runs());
  station.signal(SIGTERM);
  EXPECT_EQ(station.wait(), 0);
  expect_log_and_summary(5.0);
  expect_stopped(1.5);
  EXPECT_NEAR(last_step().stiffness, 900.0, 1e-9);
}

// The stop is that of a station that ended in a fault. Status lines come each second: until the next one says
// so, it has not been shown, however often `resume` is typed.
TEST_F(RunEnds, ASecondResumeDoesNotTakeBackAStopThatHasNotBeenShown) {
  Ends input = pipe_to_program();
  Ends output = pipe_from_program();
  RunningStation station = start_between(input.theirs, output);
  const std::string refusal = "another stop or fault has come since; look, then resume again";
  station.pass(0.5);
  station.delay_loop(0.008);
  station.pass(0.7);
  station.delay_loop(0.0);
  write_text(input.ours, "set rate_hz=250\n");
  station.pass(0.4);
  static_cast<void>(read_waiting(output.ours));
  write_text(input.ours, "resume\nresume\n");
  station.pass(0.1);
  const std::string read = read_waiting(output.ours);
  EXPECT_THAT(read, HasSubstr(refusal));
  EXPECT_NE(read.find(refusal), read.rfind(refusal)) << read;
  station.pass(1.0);
  EXPECT_THAT(read_waiting(output.ours), HasSubstr("stopped"));
  write_text(input.ours, "resume\n");
  station.pass(2.0);
  EXPECT_THAT(read_waiting(output.ours), Not(HasSubstr(refusal)));
  write_text(input.ours, "quit\n");
  EXPECT_EQ(station.wait(), 0);
  const std::vector<LoggedStep> all = steps();
  EXPECT_TRUE(std::any_of(all.begin() + static_cast<std::ptrdiff_t>(all.size() / 2), all.end(),
                          [](const LoggedStep& s) { return s.state == "running"; }));
}

// Else the log would get the number of a stream that is closed, and with it the lines for that stream: among
// them the complaint that there is no such processor.
TEST_F(RunEnds, ClosedStandardStreamsDoNotEndUpInTheLog) {
  if (test::kSanitized) GTEST_SKIP() << "the shell is under the clock, too, whose library is sanitized";
  RunningStation station = start_alone({"--headless", "--cpu", "1000"}, R"(exec "$@" >&- 2>&- <&-)");
  station.pass(2.5);
  station.signal(SIGTERM);
  EXPECT_EQ(station.wait(), 0);
  expect_log_and_summary(2.0);
}

// A background job may not read its terminal; what is typed meanwhile waits there.
TEST_F(RunEnds, AJobThatComesBackToTheForegroundReadsItsTerminalAgain) {
  if (test::kSanitized) GTEST_SKIP() << "the shell is under the clock, too, whose library is sanitized";
  Ends terminal = make_terminal();
  RunningStation station =
      start_at(terminal, {"--headless", "--no-realtime", "--quiet"}, R"(set -m; "$@" & sleep 3; fg)");
  station.pass(1.0);
  write_text(terminal.ours, "stop\n");
  station.pass(3.5);
  write_text(terminal.ours, "quit\n");
  EXPECT_EQ(station.wait(), 0);
  expect_log_and_summary(3.5);
  expect_stopped(1.0);
}

TEST_F(RunEnds, AnUnreadPipeHoldsUpNeitherStopNorTheEnd) {
  Ends input = pipe_to_program();
  Ends output = pipe_from_program();
  ASSERT_EQ(::fcntl(output.theirs.number(), F_SETPIPE_SZ, 4096), 4096);
  write_text(output.theirs, std::string(4096, 'x'));
  RunningStation station = start_between(input.theirs, output);
  station.pass(3.0);
  write_text(input.ours, "stop\n");
  station.pass(2.0);
  ASSERT_TRUE(station.runs());
  station.signal(SIGTERM);
  EXPECT_EQ(station.wait(), 0);
  expect_log_and_summary(4.5);
  expect_stopped(1.5);
  EXPECT_EQ(read_waiting(output.ours), std::string(4096, 'x'));
}

TEST_F(RunEnds, LinesThatAreNotReadInTimeAreCounted) {
  Ends input = pipe_to_program();
  Ends output = pipe_from_program();
  RunningStation station = start_between(input.theirs, output);
  std::string lines;
  for (int i = 0; i < 100; ++i) lines += "hello\n";
  for (int i = 0; i < 25;
       ++i) {  // some 108 bytes an answer: 600 in the pipe, 1,000 wait, and 900 are left out
    write_text(input.ours, lines);
    station.pass(0.1);
  }
  std::string read;
  for (int i = 0; i < 10; ++i) {
    read += read_waiting(output.ours);
    write_text(input.ours, "hello\n");
    station.pass(0.1);
  }
  EXPECT_THAT(read, HasSubstr(" lines are missing here: they were not read in time)\n"));
  EXPECT_EQ(read.find("are missing here"), read.rfind("are missing here"));
  station.signal(SIGTERM);
  EXPECT_EQ(station.wait(), 0);
}

TEST_F(RunEnds, AfterAKillTheNextStartFinishesTheLog) {
  {
    RunningStation station = start_alone();
    station.pass(3.0);
    station.signal(SIGKILL);
    EXPECT_EQ(station.wait(), 128 + SIGKILL);
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "x.csv"));
  ASSERT_TRUE(std::filesystem::exists(folder / "x.csv.partial"));
  std::ofstream(folder / "x.csv.partial", std::ios::app) << "1,2,3";  // killed in the middle of a line
  Ends output = pipe_from_program();
  RunningStation station = start_into(output);
  station.pass(1.0);
  station.signal(SIGTERM);
  EXPECT_EQ(station.wait(), 0);
  EXPECT_THAT(read_waiting(output.ours),
              HasSubstr("the log of a run that did not end in good order is now x-recovered.csv\n"));
  expect_log_and_summary(0.5);
  EXPECT_GE(static_cast<double>(read_steps(folder / "x-recovered.csv").size()), RunningStation::kRate * 2.0)
      << "all but the last second";
}

TEST_F(RunEnds, ALogIsNotWrittenThroughALink) {
  std::ofstream(folder / "victim") << "precious";
  std::filesystem::create_symlink("victim", folder / "x.csv.partial");
  RunningStation station = start_alone();
  station.pass(1.0);
  station.signal(SIGTERM);
  EXPECT_EQ(station.wait(), 0);
  expect_log_and_summary(0.5);
  EXPECT_EQ(read_file(folder / "victim"), "precious");
}

// Files of this process do not grow beyond 100 kB: some 200 steps.
TEST_F(RunEnds, ALogOnAFullDiskIsKeptAsFarAsItGoes) {
  Ends output = pipe_from_program();
  rlimit before{};
  ::getrlimit(RLIMIT_FSIZE, &before);
  const rlimit small{.rlim_cur = 100'000, .rlim_max = before.rlim_max};
  ::setrlimit(RLIMIT_FSIZE, &small);  // the station inherits it
  RunningStation station = start_into(output);
  ::setrlimit(RLIMIT_FSIZE, &before);
  station.pass(3.0);
  ASSERT_TRUE(station.runs());
  station.signal(SIGTERM);
  EXPECT_EQ(station.wait(), 1);
  EXPECT_EQ(std::filesystem::file_size(folder / "x.csv.partial"), 100'000U);
  EXPECT_GT(summary()["steps"], 500);
  const std::string read = read_waiting(output.ours);
  const std::string complaint =
      "the log ends here: cannot write 'x.csv': File too large; what was written is in x.csv.partial\n";
  EXPECT_THAT(read, HasSubstr(complaint));
  EXPECT_EQ(read.find("the log ends here"), read.rfind("the log ends here")) << "once";
}

// No file of the station may grow at all.
TEST_F(RunEnds, ALogOfWhichNothingCouldBeWrittenIsNotNamed) {
  if (test::kSanitized) GTEST_SKIP() << "the shell is under the clock, too, whose library is sanitized";
  const Descriptor nothing(::open("/dev/null", O_RDWR | O_CLOEXEC));
  Ends output = pipe_from_program();
  RunningStation station(folder, {nothing.number(), output.theirs.number(), output.theirs.number()},
                         {"--headless", "--no-realtime", "--record", "off"}, R"(ulimit -f 0; exec "$@")");
  station.pass(1.0);
  ASSERT_TRUE(station.runs());
  station.signal(SIGTERM);
  EXPECT_EQ(station.wait(), 1);
  EXPECT_FALSE(std::filesystem::exists(folder / "x.csv.partial"));
  EXPECT_THAT(read_waiting(output.ours),
              HasSubstr("the log ends here: cannot write 'x.csv': File too large; nothing was written\n"));
}

// The page's port is another program's.
TEST_F(RunEnds, AStartThatFailsLeavesTheFinishedLogAlone) {
  const Descriptor other(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  auto* generic = reinterpret_cast<sockaddr*>(&address);
  ASSERT_EQ(::bind(other.number(), generic, size), 0);
  ASSERT_EQ(::listen(other.number(), 1), 0);
  ASSERT_EQ(::getsockname(other.number(), generic, &size), 0);
  std::ofstream(folder / "x.csv") << "of another day\n";
  std::ofstream(folder / "x.json") << "of another day\n";
  RunningStation station = start_alone({"--no-realtime", "--port", std::to_string(ntohs(address.sin_port))});
  EXPECT_EQ(station.wait(), 1);
  EXPECT_EQ(read_file(folder / "x.csv"), "of another day\n");
  EXPECT_EQ(read_file(folder / "x.json"), "of another day\n");
}

TEST_F(RunEnds, ASummaryThatCannotBeWrittenLosesNoLog) {
  Ends output = pipe_from_program();
  std::filesystem::create_directory(folder / "x.json");
  RunningStation station = start_into(output);
  station.pass(1.0);
  station.signal(SIGTERM);
  EXPECT_EQ(station.wait(), 1);
  EXPECT_GT(steps().size(), 100U);
  EXPECT_THAT(read_waiting(output.ours), HasSubstr("there is no summary: cannot write 'x.json'"));
}

TEST_F(RunEnds, ASummaryIsOfAllStationsOfTheSession) {
  Ends input = pipe_to_program();
  Ends output = pipe_from_program();
  RunningStation station = start_between(input.theirs, output);
  for (const char* change : {"set rate_hz=250\n", "set rate_hz=500\n"}) {
    station.pass(1.0);
    write_text(input.ours, change);
  }
  station.pass(2.0);
  station.signal(SIGTERM);
  EXPECT_EQ(station.wait(), 0);
  expect_log_and_summary(2.0);
  EXPECT_EQ(summary()["period_us"], 2000.0);
  EXPECT_EQ(summary()["step"]["count"], steps().size());
  EXPECT_GT(steps().size(), 1000U);
}

/// The pieces between line ends and carriage returns.
std::vector<std::string> shown_lines(const std::string& text) {
  std::vector<std::string> lines(1);
  for (const char c : text) {
    if (c == '\r' || c == '\n')
      lines.emplace_back();
    else
      lines.back() += c;
  }
  std::erase(lines, "");
  return lines;
}

TEST_F(RunEnds, TheStatusIsOneLineThatFitsTheTerminal) {
  Ends terminal = make_terminal(40);
  RunningStation station = start_at(terminal);
  station.pass(4.5);
  const std::string text = read_waiting(terminal.ours);
  const std::size_t begin = text.find("\r\033[K    1.0 s  ");
  ASSERT_NE(begin, std::string::npos) << text;
  const std::string status = text.substr(begin);
  EXPECT_EQ(status.find('\n'), std::string::npos) << "it is rewritten in place";
  const std::vector<std::string> lines = shown_lines(status);
  EXPECT_EQ(lines.size(), 4U);
  for (const std::string& line : lines) EXPECT_LE(line.size(), 39U + std::string("\033[K").size()) << line;
  EXPECT_THAT(lines.back(), HasSubstr(" N")) << "what the digits feel comes first";
  station.signal(SIGTERM);
  EXPECT_EQ(station.wait(), 0);
}

TEST_F(RunEnds, TheAddressIsTheIntroductionsLastLine) {
  Ends terminal = make_terminal();
  RunningStation station = start_at(terminal, {"--port", "0"});
  station.pass(0.9);
  const std::vector<std::string> lines = shown_lines(read_waiting(terminal.ours));
  ASSERT_FALSE(lines.empty());
  EXPECT_THAT(lines.back(), HasSubstr("\033[1mCockpit: http://127.0.0.1:"));
  station.signal(SIGTERM);
  EXPECT_EQ(station.wait(), 0);
}

TEST_F(RunEnds, TokensAreForTerminalsOnly) {
  Ends output = pipe_from_program();
  {
    RunningStation station = start_into(output, {"--port", "0", "--no-realtime", "--listen", "0.0.0.0"});
    station.pass(0.5);
    station.signal(SIGTERM);
    EXPECT_EQ(station.wait(), 0);
  }
  const std::string piped = read_waiting(output.ours);
  EXPECT_THAT(piped, Not(HasSubstr("token=")));
  EXPECT_THAT(piped, Not(HasSubstr("\u2580"))) << "a part of a QR code";
  EXPECT_THAT(piped, HasSubstr("shown on a terminal only"));
  EXPECT_THAT(piped, Not(HasSubstr("\033"))) << "bold type";
}

}  // namespace
}  // namespace phalanx::testing

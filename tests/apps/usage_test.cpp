// SPDX-License-Identifier: Apache-2.0
// The command line itself: help, version, exit codes, misspelt words.
#include <gmock/gmock.h>

#include "apps/run_program.h"
#include "support/sanitized.h"

namespace phalanx {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::run_program;
using testing::TemporaryFolder;

TEST(CliUsage, HelpNamesTheCommandsAndTheExitCodes) {
  const TemporaryFolder folder;
  const auto result = run_program(folder, "--help");
  EXPECT_EQ(result.exit_code, 0);
  for (const char* word :
       {"simulate", "experiment", "scene", "hand", "0 done, 1 failed, 2 wrong usage or input"}) {
    EXPECT_THAT(result.out, HasSubstr(word));
  }
}

TEST(CliUsage, SimulateHelpNamesEveryOption) {
  const TemporaryFolder folder;
  const auto result = run_program(folder, "simulate --help");
  EXPECT_EQ(result.exit_code, 0);
  for (const char* option :
       {"--out", "--poses", "--contacts", "--plot", "--picture", "--set", "--object", "--object-size-mm",
        "--profile", "--motion", "--mapping", "--trial", "--seconds", "--rate-hz", "--seed", "--quiet"}) {
    EXPECT_THAT(result.out, HasSubstr(option));
  }
}

TEST(CliUsage, VersionIsOneLine) {
  const TemporaryFolder folder;
  const auto result = run_program(folder, "--version");
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.out, ::testing::StartsWith("phalanx 0."));
}

struct Case {
  const char* arguments;
  const char* message;
};
class CliWrongUsage : public ::testing::TestWithParam<Case> {};

TEST_P(CliWrongUsage, ExitsWithTwoAndOneClearLine) {
  const TemporaryFolder folder;
  const auto result = run_program(folder, GetParam().arguments);
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.out, IsEmpty());
  EXPECT_THAT(result.err, ::testing::StartsWith("phalanx"));
  EXPECT_THAT(result.err, HasSubstr(GetParam().message));
  EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
}

INSTANTIATE_TEST_SUITE_P(
    All, CliWrongUsage,
    ::testing::Values(
        Case{"", "say what to do: run, simulate"}, Case{"simulat", "did you mean 'simulate'"},
        Case{"mine/my.toml",
             "'mine/my.toml' is a file, not a command; if it is a scene, type phalanx run mine/my.toml"},
        Case{"scene my.toml", "phalanx scene: unknown command 'my.toml'"},
        Case{"simulate --rate 3", "did you mean '--rate-hz'"},
        Case{"simulate --pictur a.png", "did you mean '--picture'"}, Case{"scene lst", "did you mean 'list'"},
        Case{"experiment s1-fig9", "did you mean 's1-fig8'"}, Case{"experiment", "say what to do: s1-fig8"},
        Case{"simulate a b", "'b' is one argument too many"}, Case{"simulate --seconds abc", "--seconds"},
        Case{"simulate --plot", "--plot needs"}, Case{"simulate --plot wave", "must end in .svg"},
        Case{"simulate --picture a.jpg", "must end in .png"}, Case{"simulate --poses", "--poses needs --out"},
        Case{"simulate --contacts", "--contacts needs --out"},
        Case{"simulate --contacts --out a", "leave --contacts out or add --set contact.mode=sliding"},
        Case{"simulate --object-size-mm 80", "needs --object"}, Case{"simulate --set force.law", "force.law"},
        Case{"simulate wavee", "did you mean \"wave\"? Known: "}, Case{"run nope", "nope.toml; Known: "},
        Case{"run --stifness 0.9", "did you mean '--set force.stiffness_n_per_mm=VALUE'? See"},
        Case{"run --xyzzyxyzzy", "unknown option '--xyzzyxyzzy'; See"},
        Case{"simulate wave --profile adult", "adult.toml; Known: large-man"},
        Case{"simulate wave --rate-hz 200Hz", "--rate-hz 200Hz: is not a number; write its digits alone"},
        Case{"run --port 1.5x", "--port 1.5x: is not a number"},
        Case{"run --seconds abc", "--seconds: abc: is not a number"},
        Case{"device simulate --slow-motion 1s", "--slow-motion 1s: is not a number"},
        Case{"run --rate-hz 5000", "rate_hz = 5000: a station runs at 200 to 2000 Hz"},
        Case{"run press_teapot --set hand.side=left --headless --no-realtime --seconds 1",
             "set mirror=true in place of"},
        Case{"run --tls-cert a.pem --tls-key b.pem", "--tls-cert a.pem: on 127.0.0.1 the page is for this"},
        Case{"run --tls-cert a.pem --tls-key b.pem --listen 0.0.0.0 --headless", "--headless runs without"},
        Case{"run --tls-key b.pem --listen 0.0.0.0", "--tls-cert and --tls-key: give both"},
        Case{"device probe udp:127.0.0.1", "expected HOST:PORT"},
        Case{"device test-link opengloves:/dev/null", "possible are udp:HOST:PORT and serial:PORT[:BAUD]\n"},
        Case{"device test-link simulated", "possible are udp:HOST:PORT and serial:PORT[:BAUD]\n"},
        Case{"device conform udp:127.0.0.1:9", "state --no-hand-in-device"},
        Case{"device conform --no-hand-in-device", "no DEVICE; give its address"},
        Case{"device conform opengloves:/dev/null --no-hand-in-device", "possible are udp:HOST:PORT"},
        Case{"device conform udp:127.0.0.1:9 --no-hand-in-device --torque-nm 0.5", "--torque-nm"},
        Case{"mesh check missing.stl", "missing.stl: there is no such file"},
        Case{"run --object-size-mm 80", "--object-size-mm needs --object"},
        Case{"run --object a.stl --object-size-mm 2001", "--object-size-mm"},
        Case{"run --object nope.stl --headless --no-realtime", "nope.stl"},
        Case{"run --rate-hz 100", "200 to 2000 Hz"}, Case{"run --device usb:0", "udp:HOST:PORT"},
        Case{"run --set limits.fingertip_force_n=8", "--clinician NAME"},
        Case{"run --set limits.fingertip_force_n=11 --clinician Ada", "at most 10 N"},
        Case{"run --set limits.torque_rate_nm_per_s=off", "every limit on"},
        Case{"run --slow-motion 2 --device serial:/dev/ttyACM0", "may be a real device"},
        Case{"run --calibration a.toml", "the simulated device needs none"},
        Case{"run --range a.toml", "--range: it limits a device on a wire"},
        Case{"run --range a.toml --device udp:127.0.0.1:9", "--range: it holds for one calibration"},
        Case{"device calibrate udp:127.0.0.1:9 --out none/c.toml", "--method"},
        Case{"device calibrate udp:127.0.0.1:9 --method guess --out c.toml", "jig"},
        Case{"device calibrate udp:127.0.0.1:9 --method stops --out c.toml", "needs --device-file"},
        Case{"device calibrate udp:127.0.0.1:9 --method jig --device-file beihang --out c.toml",
             "--device-file is for --method stops"},
        Case{"device calibrate udp:127.0.0.1:9 --method jig --only pinky --out c.toml", "--only pinky"},
        Case{"device range udp:127.0.0.1:9 --out r.toml", "--calibration"},
        Case{"run --watchdog-ms 200", "--watchdog-ms: it is for a glove (--device opengloves:PORT)"},
        Case{"run --watchdog-ms 200 --device udp:127.0.0.1:9", "the device is udp:127.0.0.1:9; leave it out"},
        Case{"run --no-force-feedback", "--no-force-feedback: it is for a glove (--device opengloves:PORT)"},
        Case{"run --no-force-feedback --watchdog-ms 200 --device opengloves:/dev/null", "--watchdog-ms"},
        Case{"run --watchdog-ms 0.9 --device opengloves:/dev/null",
             "--watchdog-ms 0.9: must be 1 to 1000 ms"},
        Case{"run --watchdog-ms 1001 --device opengloves:/dev/null",
             "--watchdog-ms 1001: must be 1 to 1000 ms"},
        Case{"run --watchdog-ms nan --device opengloves:/dev/null",
             "--watchdog-ms nan: must be 1 to 1000 ms"},
        Case{"run --seconds 0", "--seconds: 0: must be a number above 0; see"},
        Case{"device simulate --seconds -1", "--seconds: -1: must be a number above 0; see"},
        Case{"device simulate --fault dropp", "drop"}, Case{"device probe usb:0", "udp:HOST:PORT"},
        Case{"simulate wave --out ''", "--out \"\": the value is empty"},
        Case{"simulate wave --seconds ''", "--seconds"},
        Case{"experiment s1-fig8 --out ''", "--out \"\": the value is empty"},
        Case{"simulate wave --trial 99", "--trial 99: the scene plays no motion file"},
        Case{"simulate wave --mapping cyberglove", "--mapping cyberglove: the scene plays no motion file"},
        Case{"simulate --seed -1", "--seed -1: seed = -1: must be >= 0"},
        Case{"simulate --seconds -1", "--seconds -1: seconds = -1: must be >= 0, <= 86400 s; the default"},
        Case{"simulate --seconds nan", "--seconds nan: seconds = nan: must be"},
        Case{"simulate --object a.obj --object-size-mm nan", "--object-size-mm nan: objects.0.size_mm = nan"},
        Case{"simulate --object a.obj --object-size-mm 2001", "must be >= 0, <= 2000 mm"},
        Case{"simulate --set 'hand.position_mm=[1,2,nan]'", "hand.position_mm = [1, 2, nan]: must be"}));

// The scene's ball has a diameter, the file in its place has none.
TEST(CliUsage, RunPutsAFileInTheObjectsPlace) {
  const TemporaryFolder folder;
  testing::write_file(folder / "tetra.obj",
                      "v 0 0 0\nv 7 0 0\nv 0 7 0\nv 0 0 7\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n");
  const std::string command = "run index_ball --headless --no-realtime --seconds 0.1 --object tetra.obj";
  const auto seven_metres = run_program(folder, command);
  EXPECT_EQ(seven_metres.exit_code, 2);
  EXPECT_THAT(seven_metres.err, HasSubstr("type --set objects.0.unit=cm\n"));
  const auto as_ball = run_program(folder, command + " --object-size-mm 40 --set objects.0.diameter_mm=3");
  EXPECT_EQ(as_ball.exit_code, 2);
  EXPECT_THAT(as_ball.err, HasSubstr("a file has no such key"));
}

// The scene copies the index finger with a gain of its own.
TEST(CliUsage, RunWarnsOfCopiesOfAnOwnDeviceThatTheSceneReplaces) {
  const TemporaryFolder folder;
  testing::write_file(folder / "mine.toml",
                      "base = \"beihang\"\n[copy]\nmiddle = { of = \"index\", gain = 0.9 }\n");
  std::ifstream shipped(PHALANX_SOURCE_DIR "/scenes/index_ball.toml");
  const std::string text(std::istreambuf_iterator<char>(shipped), {});
  testing::write_file(folder / "copies.toml",
                      text + "\n[device.copy]\nmiddle = { of = \"index\", gain = 1.32 }\n");
  const std::string command = "run copies.toml --headless --no-realtime --seconds 0.1 --set device.file=";
  EXPECT_THAT(run_program(folder, command + "mine.toml").err,
              HasSubstr("mine.toml; to keep the file's, type --set device.copy.middle.of=index --set "
                        "device.copy.middle.gain=0.9"));
  EXPECT_THAT(run_program(folder, command + "light").err, ::testing::Not(HasSubstr("to keep the file's")));
}

// The file alone is refused, since its copy of the middle finger contradicts that finger's joint.
TEST(CliUsage, RunStartsWithADeviceFileThatItsOptionsComplete) {
  const TemporaryFolder folder;
  testing::write_file(folder / "mine.toml",
                      "base = \"beihang\"\n[joints.middle_mcp_flexion]\ninertia_kg_m2 = 0.0006\n"
                      "[copy]\nmiddle = { of = \"index\", gain = 0.9 }\n");
  const std::string command =
      "run tripod_ball --headless --no-realtime --seconds 0.1 --set device.file=mine.toml";
  EXPECT_EQ(run_program(folder, command).exit_code, 2);
  const auto completed = run_program(folder, command + " --set device.copy.middle.of=none");
  EXPECT_NE(completed.exit_code, 2) << completed.err;  // on a busy machine the station may end in a fault
  EXPECT_THAT(completed.out, HasSubstr("ended at zero torque"));
}

TEST(CliUsage, RunTakesAnObjectWhoseNameNeedsEscapes) {
  const TemporaryFolder folder;
  const std::string name = "a \"b\" \\ \x7f.obj";
  testing::write_file(folder / name,
                      "v 0 0 0\nv 7 0 0\nv 0 7 0\nv 0 0 7\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n");
  const auto run = run_program(
      folder, "run index_ball --device sliders --headless --no-realtime --seconds 0.1 --object '" + name +
                  "' --object-size-mm 40");
  EXPECT_NE(run.exit_code, 2) << run.err;  // on a busy machine the station may end in a fault
  EXPECT_THAT(run.out, HasSubstr("ended at zero torque"));
}

TEST(CliUsage, TooFewFileDescriptorsAreSaidInWords) {
  // The sanitizer asks through a pipe whether an object's memory can be read. Without a descriptor it calls
  // sound objects damaged.
  if (test::kSanitized) GTEST_SKIP() << "the sanitizer itself needs descriptors";
  const TemporaryFolder folder;
  const auto result = run_program(folder, "run --headless --seconds 0.1", ".out", "ulimit -n 5");
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, HasSubstr("Too many open files; allow more with `ulimit -n`"));
}

class CliFullDisk : public ::testing::TestWithParam<const char*> {};

TEST_P(CliFullDisk, IsNoSuccess) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  const TemporaryFolder folder;
  const auto result = run_program(folder, GetParam(), "/dev/full");
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(result.err, "phalanx: cannot write to standard output: No space left on device\n");
}

INSTANTIATE_TEST_SUITE_P(All, CliFullDisk,
                         ::testing::Values("--help", "--version", "simulate --help", "scene keys",
                                           "simulate wave --seconds 0.1", "experiment s1-fig8"));

}  // namespace
}  // namespace phalanx

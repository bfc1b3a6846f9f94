// SPDX-License-Identifier: Apache-2.0
// The reference conforms, and each defect fails exactly the rows that state the broken rule.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <span>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "apps/device/conform/fake_firmware.h"
#include "device/conform/conform_report.h"
#include "device/conform/transport_conform_port.h"
#include "phalanx/simulation/simulated_controller.h"
#include "simulation/squeezing_device.h"

namespace phalanx {
namespace {

using test::FakeFirmware;
using test::LinkBytes;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::UnorderedElementsAreArray;
using Rows = std::vector<std::string>;

Rows with(const ConformReport& report, ConformOutcome outcome) {
  Rows rows;
  for (const ConformResult& result : report.results)
    if (result.finding.outcome == outcome) rows.emplace_back(result.row->id);
  return rows;
}

std::string observed(const ConformReport& report, std::string_view id) {
  for (const ConformResult& result : report.results)
    if (result.row->id == id) return result.finding.observed;
  return "no such row";
}

struct Defect {
  const char* name;
  Rows fails;
  void (*apply)(FakeFirmware& firmware);
  bool serial = false;
};

/// The sample time of a command, and its flags, in a frame.
constexpr std::size_t kSampleTimeAt = 24;
constexpr std::size_t kCommandFlagsAt = 32;

void put_u64(LinkBytes& frame, std::size_t at, std::uint64_t value) {
  for (std::size_t i = 0; i < 8; ++i) frame[at + i] = static_cast<std::uint8_t>(value >> (8 * i));
}

const std::vector<Defect> kDefects{
    {"no watchdog: a step never grows old",
     {"watchdog", "repetition", "latch", "reset"},
     [](FakeFirmware& f) {
       f.before_tick = [](FakeFirmware& x) { x.controller.step.command.sample_time_us = x.time_us(); };
     }},
    {"a latch clears itself after 5 ms",
     {"watchdog", "repetition", "latch", "reset"},
     [](FakeFirmware& f) {
       f.before_tick = [since = 0](FakeFirmware& x) mutable {
         since = x.controller.fault == PHX_FAULT_STEP_TOO_OLD ? since + 1 : 0;
         if (since < 5) return;
         x.controller.fault = PHX_FAULT_NONE;
         x.controller.acting = false;
       };
     }},
    {"the CRC is not checked",
     {"crc"},
     [](FakeFirmware& f) {
       f.on_frame = [](FakeFirmware&, LinkBytes& frame) {
         if (frame.size() >= PHX_HEADER_SIZE + PHX_CRC_SIZE) ConformHost::seal(frame);
       };
     }},
    {"dropped frames are not counted",
     {"crc", "truncated", "oversize", "unknown_type", "reserved_bits", "own_frames", "not_finite",
      "invalid_values", "version_frames", "random", "future"},
     [](FakeFirmware& f) { f.on_sample = [](phx_message& m) { m.as.sample.corrupt = 0; }; }},
    {"a quarter of the promised rate",
     {"rate", "jitter"},
     [](FakeFirmware& f) { f.interval = [](int) { return 4e-3; }; }},
    {"ticks come in pairs",
     {"jitter"},
     [](FakeFirmware& f) { f.interval = [](int n) { return n % 2 == 0 ? 0.2e-3 : 1.8e-3; }; }},
    {"samples are not numbered",
     {"sequence"},
     [](FakeFirmware& f) { f.on_sample = [](phx_message& m) { m.header.sequence = 1; }; }},
    {"its clock is 3 % fast", {"rate", "clock"}, [](FakeFirmware& f) { f.clock_speed = 1.03; }},
    {"a second host takes the session",
     {"second_host"},
     [](FakeFirmware& f) {
       f.on_frame = [](FakeFirmware& x, LinkBytes& frame) {
         if (FakeFirmware::is(frame, PHX_HELLO) && frame[2] == PHX_VERSION && frame[16] == 2)
           x.controller.heard_us = 0;
       };
     }},
    {"NaN counts as 0",
     {"not_finite"},
     [](FakeFirmware& f) {
       f.on_frame = [](FakeFirmware&, LinkBytes& frame) {
         if (!FakeFirmware::is(frame, PHX_COMMAND)) return;
         FakeFirmware::change(frame, [](LinkBytes& bytes) {
           for (std::size_t i = 33; i + 4 <= bytes.size() - PHX_CRC_SIZE; i += 4)
             if ((bytes[i + 3] & 0x7fU) == 0x7fU && (bytes[i + 2] & 0x80U) != 0)
               std::fill_n(bytes.begin() + static_cast<std::ptrdiff_t>(i), 4, std::uint8_t{0});
         });
       };
     }},
    {"an older tick is taken",
     {"older_tick", "replay"},
     [](FakeFirmware& f) {
       f.on_frame = [](FakeFirmware& x, LinkBytes& frame) {
         if (FakeFirmware::is(frame, PHX_COMMAND)) x.controller.step.command.tick = 0;
       };
     }},
    {"a step of the future is taken",
     {"future"},
     [](FakeFirmware& f) {
       f.on_frame = [](FakeFirmware& x, LinkBytes& frame) {
         phx_message m{};
         if (phx_decode(frame.data(), frame.size(), &m) != PHX_OK || m.header.type != PHX_COMMAND ||
             m.as.command.sample_time_us <= x.time_us())
           return;
         FakeFirmware::change(frame, [&x](LinkBytes& bytes) { put_u64(bytes, kSampleTimeAt, x.time_us()); });
       };
     }},
    {"a stale step is taken",
     {"stale", "reset", "watchdog", "repetition"},
     [](FakeFirmware& f) {
       f.on_frame = [](FakeFirmware& x, LinkBytes& frame) {
         phx_message m{};
         if (phx_decode(frame.data(), frame.size(), &m) != PHX_OK || m.header.type != PHX_COMMAND) return;
         if (m.as.command.tick <= x.controller.step.command.tick || m.as.command.sample_time_us > x.time_us())
           return;
         FakeFirmware::change(frame, [&x](LinkBytes& bytes) { put_u64(bytes, kSampleTimeAt, x.time_us()); });
       };
     }},
    {"GOODBYE is ignored",
     {"goodbye"},
     [](FakeFirmware& f) {
       f.on_frame = [](FakeFirmware&, LinkBytes& frame) {
         if (FakeFirmware::is(frame, PHX_GOODBYE)) frame.clear();
       };
     }},
    {"a session never ends",
     {"silence", "reconnect"},
     [](FakeFirmware& f) { f.before_tick = [](FakeFirmware& x) { x.controller.heard_us = x.time_us(); }; }},
    {"commands of an old epoch are taken",
     {"old_epoch"},
     [](FakeFirmware& f) {
       f.on_frame = [](FakeFirmware& x, LinkBytes& frame) {
         if (!FakeFirmware::is(frame, PHX_COMMAND)) return;
         FakeFirmware::change(frame, [&x](LinkBytes& bytes) {
           for (std::size_t i = 0; i < 4; ++i)
             bytes[8 + i] = static_cast<std::uint8_t>(x.controller.epoch >> (8 * i));
         });
       };
     }},
    {"no start ramp",
     {"enable", "reset"},
     [](FakeFirmware& f) {
       f.before_tick = [](FakeFirmware& x) { x.controller.started_us = x.time_us() - 2'000'000; };
     }},
    {"a HELLO of another version is taken for one of this",
     {"version_hello"},
     [](FakeFirmware& f) {
       f.on_frame = [](FakeFirmware&, LinkBytes& frame) {
         if (FakeFirmware::is(frame, PHX_HELLO))
           FakeFirmware::change(frame, [](LinkBytes& bytes) { bytes[2] = PHX_VERSION; });
       };
     }},
    {"the flag FAULT is ignored",
     {"stop", "torque_off"},
     [](FakeFirmware& f) {
       f.on_frame = [](FakeFirmware&, LinkBytes& frame) {
         if (FakeFirmware::is(frame, PHX_COMMAND) && frame.size() > kCommandFlagsAt)
           FakeFirmware::change(frame, [](LinkBytes& bytes) { bytes[kCommandFlagsAt] &= 1U; });
       };
     }},
    {"the torque limit of CONFIGURE is ignored",
     {"torque_limit"},
     [](FakeFirmware& f) {
       f.after_frame = [](FakeFirmware& x, LinkBytes&) {
         if (x.controller.configured) x.controller.configure.torque_limit = 0.5F;
       };
     }},
    {"PONG has another stamp",
     {"ping"},
     [](FakeFirmware& f) {
       f.on_reply = [](phx_message& m) {
         if (m.header.type == PHX_PONG) ++m.as.ping.stamp;
       };
     }},
    {"two channels measure one joint",
     {"channels"},
     [](FakeFirmware& f) {
       f.on_reply = [](phx_message& m) {
         if (m.header.type == PHX_WELCOME) m.as.welcome.channel[1].index = m.as.welcome.channel[0].index;
       };
     }},
    {"a channel of 60 counts",
     {"resolution", "samples"},
     [](FakeFirmware& f) {
       f.on_reply = [](phx_message& m) {
         if (m.header.type != PHX_WELCOME) return;
         m.as.welcome.channel[1].gain = 0.1F;
         m.as.welcome.channel[1].raw_min = 0;
         m.as.welcome.channel[1].raw_max = 60;
       };
     }},
    {"a copy of a HELLO opens a session",
     {"repeated_hello"},
     [](FakeFirmware& f) {
       f.on_frame = [](FakeFirmware& x, LinkBytes& frame) {
         phx_message m{};
         if (phx_decode(frame.data(), frame.size(), &m) == PHX_OK && m.header.type == PHX_HELLO)
           x.controller.hello_sequence = m.header.sequence - 1U;
       };
     }},
    {"commands act before CONFIGURE",
     {"unconfigured"},
     [](FakeFirmware& f) {
       f.on_frame = [](FakeFirmware& x, LinkBytes& frame) {
         if (FakeFirmware::is(frame, PHX_COMMAND) && x.controller.session && !x.controller.configured)
           x.controller.configured = true, x.controller.configure.torque_limit = -1.0F;
       };
       f.after_frame = [](FakeFirmware& x, LinkBytes&) {
         if (x.controller.configure.torque_limit < 0.0F)
           x.controller.configured = false, x.controller.configure.torque_limit = 0.0F;
       };
     }},
    {"flags in a header are ignored",
     {"reserved_bits"},
     [](FakeFirmware& f) {
       f.on_frame = [](FakeFirmware&, LinkBytes& frame) {
         if (FakeFirmware::is(frame, PHX_COMMAND))
           FakeFirmware::change(frame, [](LinkBytes& bytes) { bytes[6] = bytes[7] = 0; });
       };
     }},
    {"three frames a tick, the others wait",
     {"flood"},
     [](FakeFirmware& f) {
       f.frames_per_tick = 3;
       f.queue = 64;
     }},
    {"serial: stops receiving after a piece that is no frame",
     {"oversize", "resync"},
     [](FakeFirmware& f) { f.stops_receiving_after_damage = true; },
     true},
};

ConformReport report_of(FakeFirmware& firmware) {
  ConformReport report = run_conformance(firmware, {});
  report.address = "memory";
  report.program = "a test";
  return report;
}

TEST(Conform, TheReferencePassesOverUdpAndOverASerialLine) {
  for (const bool serial : {false, true}) {
    FakeFirmware firmware(serial);
    const ConformReport report = report_of(firmware);
    EXPECT_THAT(with(report, ConformOutcome::kFail), UnorderedElementsAreArray(Rows{}))
        << conform_markdown(report);
    Rows by_hand{"hands", "power_cycle"};
    if (!serial) by_hand.insert(by_hand.end(), {"bytewise", "resync"});
    EXPECT_THAT(with(report, ConformOutcome::kNotApplicable), UnorderedElementsAreArray(by_hand));
    EXPECT_TRUE(report.conforms());
    EXPECT_FALSE(firmware.controller.session) << "it is left without a session";
  }
}

/// The controller of `phalanx device simulate`, with plant and patient.
class SimulatedFirmware final : public FakeFirmware {
 public:
  explicit SimulatedFirmware(const SimulatedDeviceSettings& settings)
      : simulated_(settings, "simulated", 500) {}

 private:
  phx_received take_frame(const LinkBytes& frame, std::array<std::uint8_t, PHX_FRAME_MAX>& reply,
                          std::size_t& size) override {
    return simulated_.receive(frame, reply, size);
  }
  const phx_output& make_tick() override { return simulated_.tick({}); }

  SimulatedController simulated_;
};

TEST(Conform, TheSimulatedDevicePasses) {
  SimulatedDeviceSettings settings = test::squeezing_settings();
  for (ExoJoint& joint : settings.exoskeleton.joints) joint.torque_sensor = false;  // a hand is in it
  SimulatedFirmware firmware(settings);
  const ConformReport report = report_of(firmware);
  EXPECT_THAT(with(report, ConformOutcome::kFail), UnorderedElementsAreArray(Rows{}))
      << conform_markdown(report);
  EXPECT_THAT(report.device, HasSubstr("serial number simulated, 1000 Hz, 4 channels"));
}

class ConformDefect : public testing::TestWithParam<std::size_t> {};

TEST_P(ConformDefect, FailsExactlyTheRowsThatStateTheBrokenRule) {
  const Defect& defect = kDefects[GetParam()];
  FakeFirmware firmware(defect.serial);
  defect.apply(firmware);
  const ConformReport report = report_of(firmware);
  EXPECT_THAT(with(report, ConformOutcome::kFail), UnorderedElementsAreArray(defect.fails))
      << defect.name << "\n"
      << conform_markdown(report);
  EXPECT_FALSE(report.conforms());
}

INSTANTIATE_TEST_SUITE_P(Of, ConformDefect, testing::Range(std::size_t{0}, kDefects.size()));

TEST(Conform, ADeviceThatDoesNotAnswerFailsTwoRowsAndTheOthersAreNotApplicable) {
  FakeFirmware firmware;
  firmware.on_frame = [](FakeFirmware&, LinkBytes& frame) { frame.clear(); };
  const ConformReport report = report_of(firmware);
  EXPECT_THAT(with(report, ConformOutcome::kFail), UnorderedElementsAreArray(Rows{"ping", "hello"}));
  EXPECT_EQ(report.count(ConformOutcome::kPass), 0);
  EXPECT_EQ(observed(report, "rate"), "no session was granted");
}

TEST(Conform, ADeviceWithoutTorqueChannelIsNotJudgedOnItsTorque) {
  phx_device device = test::conform_device();
  device.channel_count = 2;
  FakeFirmware firmware(false, device);
  const ConformReport report = report_of(firmware);
  EXPECT_TRUE(report.conforms());
  EXPECT_THAT(observed(report, "torque_limit"), HasSubstr("no TORQUE channel"));
  EXPECT_THAT(observed(report, "torque_off"), HasSubstr("no TORQUE channel"));
}

// A computer that stands still for 50 ms lets its commands grow old. That is not the device's fault, and the
// row is repeated. If the computer is late in each try, the row fails, and its text states why.
TEST(Conform, ARowInWhichThisComputerWasLateIsRepeated) {
  FakeFirmware firmware;
  for (double t = 0.5; t < 20.0; t += 1.7) firmware.stalls.insert(firmware.stalls.begin(), t);
  const ConformReport report = report_of(firmware);
  EXPECT_TRUE(firmware.stalls.size() < 4U) << "there were stalls";
  EXPECT_THAT(with(report, ConformOutcome::kFail), UnorderedElementsAreArray(Rows{}))
      << conform_markdown(report);
  FakeFirmware late;
  for (double t = 0.5; t < 60.0; t += 0.06) late.stalls.insert(late.stalls.begin(), t);
  const ConformReport failed = report_of(late);
  EXPECT_FALSE(failed.conforms());
  EXPECT_THAT(observed(failed, "enable"), HasSubstr("ms late, in each of 3 tries"));
}

/// Runs the test until the joint's torque is above 10 mNm, and ends it there by an exception.
struct EndedAtATorque {
  explicit EndedAtATorque(FakeFirmware& firmware) {
    firmware.on_frame = [this](FakeFirmware&, LinkBytes& frame) {
      phx_message message{};
      if (ended && phx_decode(frame.data(), frame.size(), &message) == PHX_OK) later.push_back(message);
    };
    firmware.on_sample = [this](phx_message& message) {
      counts = message.as.sample.raw[2];
      if (ended || counts <= 100) return;
      ended = true;
      throw std::runtime_error("interrupted");
    };
    EXPECT_THAT([&] { static_cast<void>(run_conformance(firmware, {})); },
                testing::ThrowsMessage<std::runtime_error>("interrupted"));
  }

  bool ended = false;
  std::int32_t counts = 0;         ///< of the torque, in the last sample
  std::vector<phx_message> later;  ///< what the firmware received after the exception
};

// Ctrl-C and a port that failed are exceptions in the middle of a row.
TEST(Conform, AnExceptionWhileATorqueActsEndsItAndTheSession) {
  FakeFirmware firmware;
  const EndedAtATorque test(firmware);
  ASSERT_TRUE(test.ended);
  int stops = 0;
  int goodbyes = 0;
  for (const phx_message& message : test.later) {
    if (message.header.type == PHX_GOODBYE) {
      ++goodbyes;
      continue;
    }
    ASSERT_EQ(message.header.type, PHX_COMMAND);
    ++stops;
    EXPECT_EQ(message.as.command.flags, PHX_COMMAND_FAULT);
    for (const float torque : message.as.command.torque) EXPECT_EQ(torque, 0.0F);
  }
  EXPECT_EQ(stops, 10);
  EXPECT_GE(goodbyes, 1);
  ASSERT_FALSE(test.later.empty());
  EXPECT_EQ(test.later.back().header.type, PHX_GOODBYE);
  EXPECT_EQ(test.counts, 0) << "the torque is zero";
  EXPECT_FALSE(firmware.controller.session);
}

TEST(Conform, AnExceptionOfTheLeavingItselfDoesNotHideTheFirstOne) {
  FakeFirmware firmware;
  int ticks = 0;
  firmware.before_tick = [&ticks](FakeFirmware&) {
    if (++ticks > 3000) throw std::runtime_error(ticks == 3001 ? "the first" : "a later one");
  };
  EXPECT_THAT([&] { static_cast<void>(run_conformance(firmware, {})); },
              testing::ThrowsMessage<std::runtime_error>("the first"));
  EXPECT_GT(ticks, 3001) << "it has tried to leave";
}

/// A transport of which only the address matters.
class NamedTransport final : public Transport {
 public:
  explicit NamedTransport(std::string address) : address_(std::move(address)) {}
  std::size_t receive(std::span<std::uint8_t>, Peer&) noexcept override { return 0; }
  bool send(std::span<const std::uint8_t>, Peer) noexcept override { return true; }
  bool wait(double) noexcept override { return false; }
  [[nodiscard]] bool lost() const noexcept override { return false; }
  [[nodiscard]] std::uint64_t dropped() const noexcept override { return 0; }
  [[nodiscard]] std::string address() const override { return address_; }

 private:
  std::string address_;
};

// By hand: 3 x 117 bytes x 10 bits / 115200 baud = 30.5 ms.
TEST(Conform, ASerialLineThatIsTooSlowForTheCommandsIsRefused) {
  const Clock clock;
  const auto open = [](const std::string& address) { return std::make_unique<NamedTransport>(address); };
  EXPECT_THAT([&] { static_cast<void>(open_conform_port("serial:/dev/ttyX:115200", open, clock)); },
              testing::ThrowsMessage<std::invalid_argument>(
                  AllOf(HasSubstr("serial:/dev/ttyX:115200: 115200 baud"), HasSubstr("every 30.5 ms"),
                        HasSubstr("at least 500000 baud"))));
  EXPECT_THROW(static_cast<void>(open_conform_port("serial:/dev/ttyX:499999", open, clock)),
               std::invalid_argument);
  const auto slowest = open_conform_port("serial:/dev/ttyX:500000", open, clock);
  EXPECT_NEAR(conform_command_period(slowest->bytes_per_second()), 7e-3, 0.05e-3);
  EXPECT_NO_THROW(static_cast<void>(open_conform_port("udp:127.0.0.1:4810", open, clock)));
}

TEST(Conform, FiguresAreMeasured) {
  FakeFirmware firmware;
  firmware.interval = [](int) { return 4e-3; };
  const ConformReport report = report_of(firmware);
  EXPECT_THAT(observed(report, "rate"), HasSubstr("promised 1000 Hz; 250 Hz by its own clock, 250 Hz"));
  EXPECT_THAT(observed(report, "watchdog"), HasSubstr("latched at an age of 20.0 ms"));
}

TEST(Conform, TheReportsHaveTheSameRowsAndAreEscaped) {
  FakeFirmware firmware;
  firmware.clock_speed = 1.03;
  ConformReport report = report_of(firmware);
  report.address = "udp:<b>&";
  EXPECT_THAT(conform_html(report), HasSubstr("udp:&lt;b&gt;&amp;"));
  EXPECT_THAT(conform_html(report), HasSubstr("<td class=\"FAIL\">FAIL<td>time_us increases"));
  EXPECT_THAT(conform_markdown(report), HasSubstr("| `clock` | FAIL |"));
  const auto json = nlohmann::json::parse(conform_json(report));
  EXPECT_EQ(json["conforms"], false);
  EXPECT_EQ(json["failed"], 2);
  ASSERT_EQ(json["rows"].size(), conform_rows().size());
  EXPECT_EQ(json["rows"][0]["row"], "ping");
  EXPECT_EQ(json["rows"][0]["result"], "pass");
}

TEST(Conform, TheTableStandsInTheDocumentation) {
  std::ifstream file(std::string(PHALANX_SOURCE_DIR) + "/docs/conform.md");
  std::stringstream text;
  text << file.rdbuf();
  EXPECT_THAT(text.str(), HasSubstr(conform_table())) << "`phalanx device conform --list` prints it";
}

}  // namespace
}  // namespace phalanx

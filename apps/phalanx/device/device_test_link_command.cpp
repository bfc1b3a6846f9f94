// SPDX-License-Identifier: Apache-2.0
// phalanx device test-link DEVICE: the round-trip time of a frame, and losses. It asks for no session: it may
// run beside a station (but not on a serial port, which only one program can open).
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "commands.h"
#include "device/device_text.h"
#include "device/round_trips.h"
#include "phalanx/device/clock.h"
#include "phalanx/device/link/phalanx_link.h"
#include "phalanx/station/open_device.h"
#include "terminal/emphasis.h"
#include "terminal/end_signals.h"
#include "usage.h"

namespace phalanx {
namespace {

/// Requirements of a station on its link. The controller fades at a step 14 ms old and latches at 20 ms. A
/// step period at 200 Hz and the step itself take up to 10 ms of this.
constexpr double kMostLoss = 0.01;
constexpr double kLongestRoundTrip = 5e-3;  // p99.9 [s]
constexpr double kLastAnswers = 1.0;        // wait for the last answers [s]

struct TestLinkOptions {
  std::string spec;
  double seconds = 10.0;
  double rate_hz = 1000.0;
  bool json = false;
};

class LinkTest {
 public:
  LinkTest(Transport& transport, const Clock& clock, std::size_t pings)
      : trips(pings), transport_(transport), clock_(clock) {}

  void run(double seconds, double rate_hz) {
    const double begin = clock_.now();
    for (double next = begin; next < begin + seconds && asked_to_end == 0;) {
      wait_until(next);
      ping();
      next += 1.0 / rate_hz;
      // Missed PINGs are left out: a burst would measure itself.
      if (const double late = clock_.now() - next; late > 0.0) next += std::ceil(late * rate_hz) / rate_hz;
    }
    const double end = clock_.now() + kLastAnswers;
    while (clock_.now() < end && trips.lost() > 0) wait_until(std::min(end, clock_.now() + 0.01));
  }

  RoundTrips trips;
  std::uint64_t corrupt = 0;

 private:
  void ping() {
    phx_message message{};
    message.header.type = PHX_PING;
    message.header.sequence = ++sequence_;
    message.as.ping.stamp = kFirstStamp + trips.send(clock_.now());
    std::array<std::uint8_t, PHX_FRAME_MAX> frame{};
    const std::size_t size = phx_encode(&message, frame.data(), frame.size());
    transport_.send({frame.data(), size}, 0);
  }
  void wait_until(double t) {
    while (true) {
      receive();
      const double left = t - clock_.now();
      if (left <= 0.0) return;
      transport_.wait(left);
    }
  }
  void receive() {
    std::array<std::uint8_t, PHX_FRAME_MAX> frame{};
    Peer from = 0;
    while (const std::size_t size = transport_.receive(frame, from)) {
      const double now = clock_.now();
      phx_message message{};
      if (phx_decode(frame.data(), size, &message) != PHX_OK) {
        ++corrupt;
      } else if (message.header.type == PHX_PONG) {
        trips.receive(message.as.ping.stamp - kFirstStamp, now);
      }
    }
  }

  static constexpr std::uint64_t kFirstStamp = std::uint64_t{0x7e57} << 48;  // unlike any other program's
  Transport& transport_;
  const Clock& clock_;
  std::uint32_t sequence_ = 0;
};

/// @returns why the link is not good enough for a station; empty if it is.
std::string complaint(const RoundTrips& trips, const RoundTripTimes& times) {
  if (trips.received() == 0)
    return "no device answers: is the controller switched on and connected, and is the address right?";
  std::string text;
  if (trips.loss() > kMostLoss)
    text += fmt::format("{:.2f} % are lost, more than {:g} %: look for a bad cable or a radio link. ",
                        100.0 * trips.loss(), 100.0 * kMostLoss);
  if (times.p999 > kLongestRoundTrip)
    text += fmt::format(
        "One round trip in a thousand takes {:.2f} ms or more, over {:g} ms: use a direct cable, and see "
        "docs/realtime.md for this computer. ",
        1e3 * times.p999, 1e3 * kLongestRoundTrip);
  if (!text.empty()) text.pop_back();
  return text;
}

void print_json(const TestLinkOptions& options, const LinkTest& test, const std::string& problem) {
  const RoundTrips& trips = test.trips;
  const RoundTripTimes t = trips.times();
  const auto us = [](double seconds) { return std::round(seconds * 1e7) / 10.0; };
  const nlohmann::ordered_json json = {{"device", options.spec},
                                       {"rate_hz", options.rate_hz},
                                       {"sent", trips.sent()},
                                       {"received", trips.received()},
                                       {"lost", trips.lost()},
                                       {"duplicates", trips.duplicates()},
                                       {"reordered", trips.reordered()},
                                       {"corrupt", test.corrupt},
                                       {"round_trip_us",
                                        {{"p50", us(t.p50)},
                                         {"p90", us(t.p90)},
                                         {"p99", us(t.p99)},
                                         {"p99_9", us(t.p999)},
                                         {"max", us(t.max)}}},
                                       {"good", problem.empty()},
                                       {"verdict", problem.empty() ? "good enough for a station" : problem}};
  fmt::print("{}\n", json.dump(2));
}

void print_text(const TestLinkOptions& options, const LinkTest& test, const std::string& problem) {
  const RoundTrips& trips = test.trips;
  const RoundTripTimes t = trips.times();
  fmt::print("{}, {:g} times a second\n", options.spec, options.rate_hz);
  fmt::print("  sent {}, lost {} ({:.3f} %), twice {}, out of order {}, corrupt {}\n", trips.sent(),
             trips.lost(), 100.0 * trips.loss(), trips.duplicates(), trips.reordered(), test.corrupt);
  if (trips.received() > 0) {
    fmt::print("  there and back [ms]  p50 {:.3f}  p90 {:.3f}  p99 {:.3f}  p99.9 {:.3f}  max {:.3f}\n",
               1e3 * t.p50, 1e3 * t.p90, 1e3 * t.p99, 1e3 * t.p999, 1e3 * t.max);
    fmt::print("{}", trips.histogram());
  }
  const bool colour = takes_colour(STDOUT_FILENO);
  fmt::print("{}\n", problem.empty() ? emphasised(Emphasis::kStrong, "Good enough for a station.", colour)
                                     : emphasised(Emphasis::kError, problem, colour));
}

int test_link(const TestLinkOptions& options) {
  const Clock clock;
  const auto transport = open_transport(options.spec);
  end_on_interrupt();
  LinkTest test(*transport, clock, static_cast<std::size_t>(options.seconds * options.rate_hz) + 2);
  test.run(options.seconds, options.rate_hz);
  test.corrupt += transport->dropped();
  const std::string problem = complaint(test.trips, test.trips.times());
  if (options.json) {
    print_json(options, test, problem);
  } else {
    print_text(options, test, problem);
  }
  return problem.empty() ? kDone : kFailed;
}

}  // namespace

void add_device_test_link(CLI::App& device, Job& job) {
  auto options = std::make_shared<TestLinkOptions>();
  CLI::App* command = device.add_subcommand("test-link", "Round-trip times and losses of a device's link");
  command->footer(
      "DEVICE is udp:HOST:PORT or serial:PORT[:BAUD]. A session is not asked for: over UDP it may run beside "
      "a "
      "station.\nExit codes: 0 good enough for a station; 1 more than 1 % lost, or one round trip in a "
      "thousand "
      "over 5 ms;\n2 wrong usage.");
  command->add_option("DEVICE", options->spec, "its address")->required()->type_name("");
  command->add_option("--seconds", options->seconds, "test for so long [10]")
      ->check(CLI::Range(0.1, 86400.0))
      ->type_name("N");
  command->add_option("--rate", options->rate_hz, "frames a second [1000]")
      ->check(CLI::Range(1.0, 5000.0))
      ->type_name("HZ");
  command->add_flag("--json", options->json, "the result as JSON");
  command->callback([options, command, &job] {
    refuse_empty_values(*command);
    job = [options] { return test_link(*options); };
  });
}

}  // namespace phalanx

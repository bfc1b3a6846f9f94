// SPDX-License-Identifier: Apache-2.0
// Sessions: who has one, and when it ends.
#include <cmath>
#include <cstring>

#include "device/conform/conform_checks.h"
#include "device/conform/conform_host.h"

namespace phalanx {
namespace {

constexpr double kSessionEnds = 1e-6 * PHX_SESSION_US;  // [s], as all times here
constexpr double kSessionEndsWithin = 0.1;

}  // namespace

ConformFinding check_second_host(ConformHost& host) {
  host.open();
  host.enable();
  host.forget();
  host.send(host.hello(host.settings().host_id + 1U, 77), ConformSender::kOtherHost);
  host.settle();
  const auto refused = host.answer(PHX_REFUSED);
  const auto welcome = host.answer(PHX_WELCOME);
  if (welcome) return conform_if(false, "the other host was granted epoch {}", welcome->message.header.epoch);
  if (!refused) return conform_if(false, "the other host got no answer");
  const phx_refused& r = refused->message.as.refused;
  return conform_if(r.reason == PHX_REFUSED_BUSY && r.host_id == host.settings().host_id + 1U &&
                        refused->message.header.sequence == 77 && conform_acts(host.newest()),
                    "REFUSED with reason {}; the session {}", r.reason,
                    conform_acts(host.newest()) ? "goes on" : "was disturbed");
}

ConformFinding check_repeated_hello(ConformHost& host) {
  host.open();
  const std::uint32_t epoch = host.epoch();
  int answers = 0;
  for (const std::uint32_t back : {0U, 1U}) {
    host.forget();
    host.send(host.hello(host.settings().host_id, host.hello_sequence() - back));
    host.settle();
    const auto welcome = host.answer(PHX_WELCOME);
    if (welcome && welcome->message.header.epoch == epoch) ++answers;
  }
  const bool configured = !host.samples().empty() && (host.newest().flags & PHX_SAMPLE_CONFIGURED) != 0;
  return conform_if(answers == 2 && configured, "{} of 2 copies answered with epoch {}; the session {}",
                    answers, epoch, configured ? "goes on" : "was disturbed");
}

ConformFinding check_new_session(ConformHost& host) {
  host.open();
  host.enable();
  const std::uint32_t before = host.epoch();
  host.open_unconfigured();
  const phx_sample& now = host.newest();
  return conform_if(host.epoch() != before && host.epoch() != 0 && now.state == PHX_STATE_READY &&
                        (now.flags & PHX_SAMPLE_CONFIGURED) == 0 && now.acted_tick == 0,
                    "epoch {} after {}; state {}, {}, step acted on {}", host.epoch(), before, now.state,
                    (now.flags & PHX_SAMPLE_CONFIGURED) != 0 ? "still configured" : "not configured",
                    now.acted_tick);
}

ConformFinding check_old_epoch(ConformHost& host) {
  host.open();
  const std::uint32_t old = host.epoch();
  host.open();
  host.enable();
  host.settle();
  const ConformCounts before = host.counts();
  for (int i = 0; i < 5; ++i) {
    phx_message command = host.command(PHX_COMMAND_ENABLE);
    command.header.epoch = old;
    command.as.command.tick += 1'000'000U;
    host.send(command);
    host.pass(host.command_period());
  }
  host.settle();
  const ConformCounts more = host.counts() - before;
  const bool newest_acts = host.newest().acted_tick <= host.last_tick();
  return conform_if(more.refused == 5 && more.corrupt == 0 && newest_acts && conform_acts(host.newest()),
                    "5 commands of epoch {} sent, {} counted as refused; {}", old, more.refused,
                    newest_acts ? "none acts" : "one acts");
}

ConformFinding check_goodbye(ConformHost& host) {
  host.open();
  host.enable();
  host.settle();
  const ConformCounts before = host.counts();
  host.be_quiet();
  const phx_message late = host.command(PHX_COMMAND_ENABLE);
  host.send(host.message(PHX_GOODBYE));
  host.settle();
  host.forget();
  host.send(late);
  host.pass(0.1);
  const std::size_t after = host.samples().size();
  host.open_unconfigured();
  const ConformCounts more = host.counts() - before;
  return conform_if(
      after == 0 && more.refused == 1 && host.newest().state == PHX_STATE_READY,
      "{} samples in 0.1 s after GOODBYE; 1 command without a session, {} counted as refused; then READY: {}",
      after, more.refused, host.newest().state == PHX_STATE_READY ? "yes" : "no");
}

ConformFinding check_silence(ConformHost& host) {
  host.open();
  host.configure(host.settings().torque);
  const double begin = host.now();
  host.be_quiet();
  host.pass(kSessionEnds + 3.0 * kSessionEndsWithin);
  const double last = host.samples().empty() ? 0.0 : host.samples().back().at - begin;
  host.open_unconfigured();
  const bool ready = host.newest().state == PHX_STATE_READY;
  return conform_if(
      std::abs(last - kSessionEnds) <= kSessionEndsWithin && ready,
      "the last sample came {:.3f} s after the last frame; a new session is {}", last,
      ready ? "READY" : fmt::format("in state {}, fault {}", host.newest().state, host.newest().fault));
}

ConformFinding check_reconnect(ConformHost& host) {
  host.open();
  const phx_welcome before = *host.welcome();
  host.be_quiet();
  host.pass(kSessionEnds + 2.0 * kSessionEndsWithin);
  host.forget();
  host.send(host.hello(host.settings().host_id + 1U, 5), ConformSender::kOtherHost);
  host.settle();
  const auto welcome = host.answer(PHX_WELCOME);
  if (!welcome)
    return conform_if(false, "another host was not granted a session 1.2 s after the first had left");
  phx_message goodbye = host.message(PHX_GOODBYE);
  goodbye.header.epoch = welcome->message.header.epoch;
  host.send(goodbye, ConformSender::kOtherHost);
  host.settle();
  const double begin = host.now();
  host.open();
  const bool same = std::memcmp(host.welcome()->serial, before.serial, sizeof before.serial) == 0 &&
                    host.welcome()->channel_count == before.channel_count &&
                    host.welcome()->rate_hz == before.rate_hz;
  return conform_if(welcome->message.as.welcome.host_id == host.settings().host_id + 1U && same,
                    "another host got epoch {}; the first one again within {:.0f} ms, {} device",
                    welcome->message.header.epoch, 1e3 * (host.now() - begin), same ? "the same" : "another");
}

ConformFinding check_hands(ConformHost&) {
  return not_applicable(
      "a person has to press the emergency stop and pull a sensor's plug, with `phalanx device monitor` "
      "running");
}

ConformFinding check_power_cycle(ConformHost&) {
  return not_applicable(
      "a person has to switch the device off and on; run this test again and compare the epochs");
}

}  // namespace phalanx

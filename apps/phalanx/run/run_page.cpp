// SPDX-License-Identifier: Apache-2.0
#include "run/run_page.h"

#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <utility>
#include <vector>

#include "phalanx/scene/data_paths.h"
#include "phalanx/serve/cockpit.h"
#include "phalanx/serve/reach.h"
#include "phalanx/serve/web_server.h"
#include "run/run_registry.h"

namespace phalanx {
namespace {

namespace fs = std::filesystem;

/// @returns the folder of an installed program's page, or that of the source tree.
fs::path site_folder() {
  const fs::path data = data_folder();
  std::error_code ignored;
  return fs::exists(data / "web/index.html", ignored) && !fs::exists(data / "web/package.json", ignored)
             ? data / "web"
             : data / "web/dist";
}

fs::path own_certificates() {
  if (const char* config = std::getenv("XDG_CONFIG_HOME"); config != nullptr && *config != '\0')
    return fs::path(config) / "phalanx";
  const char* home = std::getenv("HOME");
  return fs::path(home != nullptr && *home != '\0' ? home : ".") / ".config/phalanx";
}

void secure(const RunOptions& o, WebServerSettings& settings) {
  if (o.certificate.empty()) {
    std::vector<std::string> names = machine_names();
    for (const std::string& address : machine_addresses()) names.push_back(address);
    for (const std::string& address : reachable_addresses(o.listen)) names.push_back(address);
    const CertificateFiles own = make_self_signed_certificate(own_certificates(), names);
    settings.certificate = own.certificate;
    settings.key = own.key;
  } else {
    settings.certificate = o.certificate;
    settings.key = o.key;
  }
  settings.operator_token = random_token();
  settings.viewer_token = random_token();
}

WebServerSettings server_settings(const RunOptions& o) {
  WebServerSettings settings;
  settings.address = o.listen;
  settings.port = static_cast<std::uint16_t>(o.port);
  settings.next_free_port = !o.port_stated;
  settings.site = site_folder();
  settings.site_missing =
      "The station runs, but its page has not been built here. In the project's folder type ./run once: it "
      "builds the page.\n";
  if (!is_loopback(o.listen)) secure(o, settings);
  return settings;
}

CockpitSettings cockpit_settings(const RunOptions& o, RunRecorder& recorder, PagePatients patients) {
  CockpitSettings settings;
  if (patients.registry) settings.exercises = exercises_for_pages;
  settings.registry = std::move(patients.registry);
  settings.exercises_host = std::move(patients.exercises);
  settings.recording = [&recorder] { return recorder.recording(); };
  if (o.recordings != "off") settings.recordings = o.recordings;
  settings.on_notice = [&recorder](const std::string& code, const std::string& who, const std::string& text) {
    recorder.event(code, who, text);
  };
  settings.log = o.audit;
  settings.uploads = o.uploads;
  settings.version = PHALANX_VERSION;
  return settings;
}

}  // namespace

struct RunPage::Parts {
  Parts(const RunOptions& o, Session& session, RunRecorder& recorder, PagePatients patients)
      : options(o),
        settings(server_settings(o)),
        cockpit(session, cockpit_settings(o, recorder, std::move(patients))),
        server(settings, cockpit) {
    cockpit.attach(server, is_loopback(o.listen)
                               ? std::vector<std::string>()
                               : lan_urls(options.listen, server.port(), settings.viewer_token));
  }

  /// Writes how to reach the page. The addresses come last, where a reader looks for them.
  void introduce(RunConsole& console) const {
    if (!is_loopback(options.listen)) {
      introduce_to_the_network(console);
    } else if (const std::string line = ssh_line(server.port()); !line.empty()) {
      console.say("You are here over SSH; on your own computer type");
      console.say("  " + line);
      console.say("and open the address below there.");
    }
    say_addresses(console);
  }

  void introduce_to_the_network(RunConsole& console) const {
    if (options.certificate.empty()) {
      console.say("The browser asks once whether to trust this machine; its certificate's SHA-256 is");
      console.say("  " + certificate_fingerprint(settings.certificate));
    }
    if (!console.is_terminal()) return;
    std::string code;
    if (const auto to_operate = lan_urls(options.listen, server.port(), settings.operator_token);
        !to_operate.empty())
      code = qr_text(to_operate.front());
    if (!code.empty()) code.pop_back();
    console.say(code);
  }

  void say_addresses(RunConsole& console) const {
    if (is_loopback(options.listen)) return console.say("Cockpit: " + server.url(), Emphasis::kStrong);
    if (lan_urls(options.listen, server.port(), "").empty())
      return console.say(
          "Cockpit: no other computer reaches this one; connect it to a network and start again.");
    if (!console.is_terminal()) {
      for (const std::string& url : lan_urls(options.listen, server.port(), ""))
        console.say("Cockpit: " + url, Emphasis::kStrong);
      return console.say(
          "  It asks for a token, which is shown on a terminal only: start `phalanx run` on one, without a "
          "pipe or a file behind it.");
    }
    for (const std::string& url : lan_urls(options.listen, server.port(), settings.viewer_token))
      console.say("Cockpit, to look on:  " + url, Emphasis::kStrong);
    for (const std::string& url : lan_urls(options.listen, server.port(), settings.operator_token))
      console.say("Cockpit, to operate:  " + url, Emphasis::kStrong);
  }

  const RunOptions& options;
  const WebServerSettings settings;
  Cockpit cockpit;
  WebServer server;
};

void check_page_options(const RunOptions& o) {
  if (o.headless && !o.data.empty())
    throw std::invalid_argument(fmt::format(
        "--data {}: --headless runs without the page, which alone uses it; leave one of them out", o.data));
  if (o.certificate.empty() != o.key.empty())
    throw std::invalid_argument(
        "--tls-cert and --tls-key: give both, or neither for a certificate of our own");
  if (!o.certificate.empty() && (o.headless || is_loopback(o.listen))) {
    throw std::invalid_argument(fmt::format(
        "--tls-cert {}: {}, so no certificate is used; add --listen ADDRESS, such as 0.0.0.0, or leave "
        "--tls-cert and --tls-key out",
        o.certificate,
        o.headless ? "--headless runs without the page"
                   : fmt::format("on {} the page is for this computer alone, without TLS", o.listen)));
  }
}

RunPage::RunPage(const RunOptions& options, Session& session, RunRecorder& recorder, RunConsole& console,
                 PagePatients patients)
    : parts_(std::make_unique<Parts>(options, session, recorder, std::move(patients))) {
  parts_->server.start();
  parts_->introduce(console);
}

RunPage::~RunPage() { parts_->server.stop(); }

void RunPage::say_addresses(RunConsole& console) const { parts_->say_addresses(console); }

void RunPage::tell(const std::string& code, const std::string& text, bool fault) {
  parts_->cockpit.notify(code, text, fault);
}

void RunPage::typed(const std::string& code, const std::string& text) { parts_->cockpit.typed(code, text); }

void RunPage::fault_reported(const std::string& file, double fault_time) {
  parts_->cockpit.fault_reported(file, fault_time);
}

}  // namespace phalanx

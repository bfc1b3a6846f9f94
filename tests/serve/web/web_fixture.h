// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <string>

#include "phalanx/serve/web_server.h"
#include "serve/web/fake_application.h"
#include "serve/web/raw_client.h"

namespace phalanx {

/// Fixture with a server on a free port of 127.0.0.1, a small site, and an application that
/// records its calls.
class WebTest : public testing::Test {
 protected:
  void SetUp() override {
    const testing::TestInfo& test = *testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::temp_directory_path() /
              (std::string("phalanx-web-") + test.name() + "-" + std::to_string(::getpid()));
    write("site/index.html", "<!doctype html><title>hand</title>\n");
    write("site/assets/app-1a2b.js", script());
    write("site/mark.svg", "<svg/>");
    write("site/.hidden", "hidden");
    write("secret.txt", "secret");
    settings_.port = 0;
    settings_.site = folder_ / "site";
    settings_.site_missing = "the front-end is not built";
  }
  void TearDown() override {
    server_.reset();
    std::filesystem::remove_all(folder_);
  }

  void start() {
    server_ = std::make_unique<WebServer>(settings_, application_);
    server_->start();
  }
  [[nodiscard]] std::uint16_t port() const { return server_->port(); }
  std::string ask(const std::string& request) const { return phalanx::ask(port(), request); }
  /// Expects that the server still serves the site.
  void expect_alive() const { EXPECT_EQ(status_of(ask(get("/"))), 200); }

  void write(const std::string& name, const std::string& text) const {
    const std::filesystem::path path = folder_ / name;
    std::filesystem::create_directories(path.parent_path());
    std::ofstream(path, std::ios::binary) << text;
  }
  static std::string script() {
    std::string text;
    for (int i = 0; i < 500; ++i) text += "console.log('a line like many others');\n";
    return text;
  }

  std::filesystem::path folder_;
  WebServerSettings settings_;
  FakeApplication application_;
  std::unique_ptr<WebServer> server_;
};

}  // namespace phalanx

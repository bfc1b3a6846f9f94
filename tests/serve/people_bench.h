// SPDX-License-Identifier: Apache-2.0
// Requests to the addresses below /people, without a server.
#pragma once

#include <gmock/gmock.h>

#include <algorithm>
#include <chrono>
#include <future>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "record/temporary_folder.h"
#include "serve/people.h"
#include "serve/people_registry.h"

namespace phalanx::test {

inline const std::string kTherapist = "a.meier";
inline const std::string kPassword = "a long password";

/// Response with its body as text and, if it is some, as JSON.
struct PeopleAnswer {
  int status = 0;
  std::string text;
  nlohmann::json value = {};
};

class PeopleTest : public ::testing::Test {
 protected:
  ~PeopleTest() override { EXPECT_TRUE(people_->finish(std::chrono::minutes(5))); }

  /// Sends a request of this computer, as one that may operate.
  static std::future<PeopleAnswer> send(People& people, WebRequest request) {
    auto promise = std::make_shared<std::promise<PeopleAnswer>>();
    std::future<PeopleAnswer> future = promise->get_future();
    people.request(request, [promise](const WebResponse& response) {
      PeopleAnswer answer{.status = response.status, .text = response.body ? *response.body : ""};
      if (response.type == "application/json") answer.value = nlohmann::json::parse(answer.text);
      promise->set_value(std::move(answer));
    });
    return future;
  }
  static WebRequest request_for(const std::string& path, const std::string& session) {
    WebRequest request;
    request.method = "GET";
    request.path = path;
    request.session = session;
    request.client = {.address = "127.0.0.1", .may_operate = true};
    return request;
  }
  [[nodiscard]] PeopleAnswer get(const std::string& path, const std::string& session) {
    return send(*people_, request_for(path, session)).get();
  }
  PeopleAnswer post_text(const std::string& path, const std::string& body, const std::string& session) {
    WebRequest request = request_for(path, session);
    request.method = "POST";
    request.body = body;
    return send(*people_, request).get();
  }
  PeopleAnswer post(const std::string& path, const nlohmann::json& body, const std::string& session) {
    return post_text(path, body.dump(), session);
  }
  /// Edits a patient as the page does: from the fields as they are now.
  PeopleAnswer edit(const std::string& path, nlohmann::json fields, const std::string& session) {
    fields["revision"] = get(path, session).value.value("revision", "");
    return post(path, fields, session);
  }
  [[nodiscard]] std::size_t audited(const std::string& account, const std::string& action) {
    const auto all = registry_->audit(registry_->has_accounts() ? chief_ : Actor::owner());
    return static_cast<std::size_t>(std::count_if(all.begin(), all.end(), [&](const AuditEntry& entry) {
      return entry.account == account && entry.action == action;
    }));
  }
  PeopleAnswer sign_in(const std::string& account = "", const std::string& password = "") {
    return post("/people/sign_in", {{"account", account}, {"password", password}}, "");
  }
  /// @returns the secret of the owner's session
  std::string owner() { return sign_in().value.at("session").get<std::string>(); }
  /// Adds an administrator and a therapist. @returns the secret of the therapist's session
  std::string therapist() {
    registry_->add_account(Actor::owner(), {.name = "chief", .role = Role::kAdministrator}, kPassword);
    registry_->add_account(chief_, {.name = kTherapist, .role = Role::kTherapist}, kPassword);
    return sign_in(kTherapist, kPassword).value.at("session").get<std::string>();
  }
  std::string patient(const std::string& code) {
    return registry_->add_patient(Actor::owner(), ready_patient(code)).record;
  }

  const Actor chief_{.account = "chief", .role = Role::kAdministrator};
  const testing::TemporaryFolder folder_;
  const std::shared_ptr<RegistryClocks> clocks_ = std::make_shared<RegistryClocks>();
  const std::shared_ptr<Registry> registry_ = make_registry(folder_.path(), clocks_);
  std::shared_ptr<People> people_ = std::make_shared<People>(
      registry_,
      [] {
        return std::vector<ListedExercise>{
            {.name = "press", .title = "Press and hold", .kind = "assessment", .measure = "press_and_hold"}};
      },
      [clocks = clocks_] { return clocks->utc.load(); });
};

}  // namespace phalanx::test

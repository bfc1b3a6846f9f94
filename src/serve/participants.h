// SPDX-License-Identifier: Apache-2.0
// The participants of a session: the people at the pages, and which of them operates. No clock and no thread
// of its own: each call states the time.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "phalanx/registry/accounts.h"
#include "phalanx/serve/web_server.h"

namespace phalanx {

/// Participant: the person at one page. A page that reconnects with its secret is the same participant.
struct Participant {
  std::uint32_t number = 0;  ///< as people read it: "page 2"
  std::string secret;        ///< with which a page proves after a reconnect that it is the same one
  std::string name;
  std::string account = {};   ///< that is signed in at this page; empty: none
  Role role = Role::kLookOn;  ///< of that account
  ClientInfo client;
  bool greeted = false;  ///< its page has sent Hello
  bool patient_screen =
      false;  ///< its page is the patient's screen, which never operates: Hello.patient_screen
  bool released_control = false;  ///< it was the operator and gave control back

  /// @returns "page 2 (127.0.0.1), Anna"; "page 2 (127.0.0.1, account a.meier), Anna" if an account is signed in. The name
  /// comes last, so that it cannot imitate an account
  [[nodiscard]] std::string label() const;
};

/// All participants. One of them at a time is the operator. The first that may operate becomes it. If the
/// operator's page leaves, it remains the operator for kGrace, so that a reload changes nothing. Afterwards
/// there is no operator, until a page joins, takes control, or is the only one that may operate.
class Participants {
 public:
  static constexpr double kGrace = 10.0;           ///< to reconnect as the operator [s]
  static constexpr double kRemember = 3600.0;      ///< to reconnect as the same participant [s]
  static constexpr std::size_t kRemembered = 256;  ///< participants that have left, at most
  static constexpr std::size_t kNameLength = 40;   ///< [bytes]

  /// Adds the participant of a page that has connected.
  /// @param secret  a new one; it is replaced if the page states an earlier one in reconnect()
  const Participant& join(PageId page, const ClientInfo& client, std::string secret, double now);

  struct Reconnection {
    PageId replaced = 0;           ///< page that was this participant until now and is removed; 0: none
    bool became_operator = false;  ///< there was no operator
  };
  /// Handles the Hello of a page, with the secret that it had before. If the secret is known, the page is
  /// that participant again, with number, name and role. A connection that broke silently counts as open for
  /// a while; then the older page is replaced.
  /// @param patient_screen  Hello.patient_screen: the page is no operator, even if it was
  Reconnection reconnect(PageId page, const std::string& secret, double now, bool patient_screen = false);
  void leave(PageId page, double now);

  /// Makes a page the operator. @returns the label of the previous one; empty if there was none
  /// @throws std::invalid_argument if the page may only view, or is the patient's screen
  std::string take_control(PageId page, double now);
  /// @returns true if the page was the operator
  bool release_control(PageId page);
  /// Makes the only page that may operate the operator, if there is none and the page has
  /// not released control.
  /// @returns the new operator; null if nothing has changed
  const Participant* give_to_only_page(double now);
  /// Sets a name: one line, at most kNameLength bytes.
  void name(PageId page, const std::string& name);
  /// Sets the account that is signed in at a page, also at one that may reconnect; empty: none.
  void sign_in(const std::string& secret, const std::string& account, Role role = Role::kLookOn);

  /// @returns null if there is none
  [[nodiscard]] const Participant* find(PageId page) const;
  /// @returns the connected participant with that secret; null if there is none
  [[nodiscard]] const Participant* with_secret(const std::string& secret) const;
  [[nodiscard]] bool operates(PageId page) const;
  [[nodiscard]] bool operates(const Participant& participant) const;
  /// @returns the operator, also during kGrace; null if there is none
  [[nodiscard]] const Participant* current_operator(double now) const;
  /// @returns true if a connected page is the patient's screen
  [[nodiscard]] bool any_patient_screen() const noexcept;
  /// @returns the number of connected pages
  [[nodiscard]] std::size_t count() const noexcept { return page_.size(); }

 private:
  struct Away {
    Participant participant;
    double since = 0.0;  ///< [s]
  };
  bool operate_if_free(const Participant& participant, double now);
  [[nodiscard]] PageId page_with(const std::string& secret) const;
  void forget(double now);

  std::map<PageId, Participant> page_;
  std::map<std::string, Away> away_;  ///< participants that have left, by their secret
  std::uint32_t last_number_ = 0;
  std::uint32_t operator_number_ = 0;  ///< 0: there is no operator
};

}  // namespace phalanx

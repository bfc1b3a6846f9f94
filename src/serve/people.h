// SPDX-License-Identifier: Apache-2.0
// The patients of the station for its page: signing in, and the addresses below /people.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "phalanx/registry/registry.h"
#include "phalanx/serve/web_server.h"
#include "serve/people_routes.h"
#include "serve/station_files.h"

namespace phalanx {

/// The registry behind HTTP, through the functions that the commands call, too.
///
/// Access. A client that may only view gets 403. The account of a patient's screen signs in and out, and gets 403 for
/// all that is about patients. A locked session may watch the exercise that runs, without its patient. All requests but GET /people and a sign-in need the secret
/// of a session in the field X-Phalanx-Session. A page of another site can neither read it nor send this
/// field. Without accounts a client of this computer signs in as the owner, without a password; other
/// computers are refused. The registry delays sign-ins after wrong passwords, locks idle sessions, checks
/// roles, and writes the audit log. A stop needs none of this: its address is not below /people.
///
/// A thread of its own calls the registry, so that neither a stop nor a tick waits for the disk or a
/// password. It reads one request after the other, and ends when none waits.
class People : public std::enable_shared_from_this<People> {
 public:
  using Respond = std::function<void(WebResponse)>;
  static constexpr std::size_t kBodyLimit = 32U * 1024U;  ///< [bytes]
  static constexpr std::size_t kMostWaiting = 32;         ///< requests
  static constexpr std::size_t kMostSignIns = 64;         ///< that wait for take_sign_ins()
  static constexpr std::size_t kMostNamed = 256;          ///< sessions that check_sessions() looks at
  static constexpr std::size_t kLongestName = 64;         ///< of an account [bytes]

  /// @param registry   null: the station keeps no patients
  /// @param exercises  list of the exercises; empty: there are none. Called on the thread
  /// @param utc        UTC [s since 1970]; empty: the system's clock. For tests
  /// @param host       carries out exercises; null: none
  explicit People(std::shared_ptr<Registry> registry, people::ListExercises exercises = {},
                  std::function<double()> utc = {}, std::shared_ptr<ExerciseHost> host = {});

  /// @returns true if the path is that of patients
  [[nodiscard]] static bool is_one(const std::string& path) noexcept {
    return path == "/people" || path.starts_with("/people/");
  }
  /// @returns how long the body of a request may be [bytes]; 0: it is refused without it
  [[nodiscard]] std::size_t body_limit(const WebRequest& head) const noexcept;
  /// Responds from the thread, or at once with a refusal in words. Any thread; allocates.
  void request(const WebRequest& request, Respond respond);

  /// Waits until no request is being answered, so that a change that has begun is completed before
  /// the program ends.
  /// @returns false if that took longer than `timeout`
  bool finish(std::chrono::milliseconds timeout);

  /// Account that signed in or out at a page of the cockpit.
  struct SignIn {
    std::string page_secret;  ///< WebRequest::page_secret; empty: no page of the cockpit opened that one
    std::string account;
    bool in = false;  ///< false: signed out, or locked
    Role role = Role::kLookOn;
  };
  /// @returns what has happened since the last call, for the log of changes. Any thread.
  [[nodiscard]] std::vector<SignIn> take_sign_ins();
  /// Looks on the thread for sessions that the registry has locked or ended: take_sign_ins() then has them,
  /// too. Any thread.
  /// @param accounts  has_accounts() is read again, too
  void check_sessions(bool accounts = false);
  /// @returns true if accounts exist, as it was read last. Any thread; at once.
  [[nodiscard]] bool has_accounts() const noexcept { return has_accounts_; }

  /// States which keys of recordings a request may use. With accounts, those of a session that is signed in
  /// and not locked. Without accounts, those of the owner at this computer. The first key that a session or
  /// the owner needs makes one entry in the audit log. A request does not put a session's lock off. Any
  /// thread; it reads the disk. The registry's errors become refusals.
  [[nodiscard]] RecordingAccess recording_access(const WebRequest& request);

 private:
  struct Request {
    WebRequest request;
    Respond respond;
  };
  void work();
  /// Starts the thread. Needs mutex_. @returns false if the computer has none left
  bool start_thread();
  [[nodiscard]] WebResponse response_to(const WebRequest& request);
  [[nodiscard]] WebResponse answer(const WebRequest& request);
  [[nodiscard]] WebResponse sign_in(const WebRequest& request);
  [[nodiscard]] WebResponse end_session(const WebRequest& request, bool only_lock);
  [[nodiscard]] WebResponse unlock(const WebRequest& request);
  [[nodiscard]] bool is_owner(const WebRequest& request) const;
  /// @returns the account of a request's session, or the owner
  /// @throws RegistryError kSignIn if the session is unknown or locked
  /// @param touch   the request puts the session's lock off
  /// @param locked  a locked session is enough
  [[nodiscard]] Actor actor_of(const WebRequest& request, bool touch, bool locked = false);
  void begin_name(const std::string& session, const SignIn& sign_in);
  /// Reports that an account is no longer signed in, once. Needs mutex_.
  void end_name(const std::string& session);
  void report_ended_sessions();
  void read_accounts() noexcept;
  /// @param session  empty: the owner
  [[nodiscard]] std::optional<RecordingKey> recording_key(const Actor& actor, const std::string& session,
                                                          const std::string& id);

  const std::shared_ptr<Registry> registry_;
  const people::ListExercises exercises_;
  const std::function<double()> utc_;
  const std::shared_ptr<ExerciseHost> host_;
  const std::string owner_secret_;         ///< of the owner's session; of this process
  std::atomic<bool> has_accounts_ = true;  ///< until it is known that there are none
  std::mutex mutex_;                       ///< of the members up to keys_mutex_
  std::deque<Request> requests_;
  std::vector<SignIn> sign_ins_;
  std::map<std::string, SignIn> named_;           ///< sessions whose account the log of changes names
  bool checks_ = false;                           ///< the thread looks for sessions that have ended
  bool working_ = false;                          ///< the thread runs
  std::condition_variable ended_;                 ///< working_ has become false
  std::mutex keys_mutex_;                         ///< of the next member
  std::map<std::string, FindRecordingKey> keys_;  ///< by session; "": of the owner
};

}  // namespace phalanx

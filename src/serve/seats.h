// SPDX-License-Identifier: Apache-2.0
// Who is at the pages, and who operates. Pure: time comes in.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "phalanx/serve/web_server.h"

namespace phalanx {

/// A page as others read it: "page 2 (127.0.0.1), Anna".
struct Seat {
  std::uint32_t number = 0;  ///< for people; a page that comes back has the one it had
  std::string secret;        ///< proves that a page that comes back is the same one
  std::string name;
  Visitor visitor;
  bool greeted = false;    ///< it has said hello
  bool gave_back = false;  ///< it had control and released it

  [[nodiscard]] std::string label() const;
};

/// One page at a time operates. The first that may does; when it leaves, its seat is kept for kGrace, so that
/// a reload changes nothing; then the seat is free, and a page that comes next, asks first, or is the only
/// one that may operate has it.
class Seats {
 public:
  static constexpr double kGrace = 10.0;           ///< [s]
  static constexpr double kRemember = 3600.0;      ///< pages that have left [s]
  static constexpr std::size_t kRemembered = 256;  ///< at most so many of them
  static constexpr std::size_t kNameLength = 40;   ///< [bytes]

  /// @param secret  a fresh one, in case the page has none. @returns the new seat
  const Seat& join(PageId page, const Visitor& visitor, std::string secret, double now);
  /// What a page that says hello finds.
  struct Return {
    PageId replaced = 0;    ///< the page that sat on its seat until now, and is here no more; 0: none
    bool sat_down = false;  ///< it operates from now on, because nobody did
  };
  /// The page says that it had this secret before: if it is known it has its seat again, with number, name
  /// and role. A line that broke without a word counts as open for a while, so that a page which still
  /// seems to be here gives way.
  Return come_back(PageId page, const std::string& secret, double now);
  void leave(PageId page, double now);

  /// Gives the operator's seat to a page, whoever has it. @returns who had it; nobody: an empty label.
  /// @throws std::invalid_argument if the page may only look
  std::string take(PageId page, double now);
  /// @returns whether the page had it
  bool release(PageId page);
  /// Gives control to the only page that may operate, if no page has it and this one has not released it.
  /// @returns the seat of that page; null: nothing changes
  const Seat* give_to_only_page(double now);
  void name(PageId page, const std::string& name);  ///< its first kNameLength bytes

  [[nodiscard]] const Seat* find(PageId page) const;
  [[nodiscard]] const Seat* with_secret(const std::string& secret) const;
  [[nodiscard]] bool operates(PageId page) const;
  [[nodiscard]] bool operates(const Seat& seat) const;
  /// Its seat, also during the grace; null: nobody.
  [[nodiscard]] const Seat* operating(double now) const;
  [[nodiscard]] std::size_t here() const noexcept { return page_.size(); }

 private:
  struct Away {
    Seat seat;
    double since = 0.0;
  };
  bool sit_if_free(const Seat& seat, double now);
  [[nodiscard]] PageId page_with(const std::string& secret) const;
  void forget(double now);

  std::map<PageId, Seat> page_;
  std::map<std::string, Away> away_;  ///< by secret
  std::uint32_t last_number_ = 0;
  std::uint32_t operator_number_ = 0;  ///< 0: nobody
};

}  // namespace phalanx

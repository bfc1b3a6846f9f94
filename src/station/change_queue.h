// SPDX-License-Identifier: Apache-2.0
// What people ask a StationHost to change, until its worker does it.
#pragma once

#include <cstddef>
#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "phalanx/station/station_host.h"

namespace phalanx {

/// Values to be laid over the scene, and who waits for the answer.
struct SetPart {
  Overrides changes;
  StationHost::Done done;
  std::vector<StationHost::Done> overtaken;  ///< of older values of the same keys, oldest first
};

/// What became of a part of a request.
struct ChangeAnswer {
  StationHost::Done done;
  std::vector<StationHost::Done> overtaken;
  std::string refused;  ///< empty: it is done
};

struct ChangeRequest {
  std::string text;            ///< for people, while it is made
  std::function<void()> work;  ///< throws what is refused; empty: `sets` it is
  StationHost::Done done;      ///< of `work`
  std::vector<SetPart> sets;
  bool retry = false;  ///< another try to make a station: one of them is enough
};

/// Bounded. A slider that is dragged asks faster than changes are made, so neighbouring sets become one
/// request, and a value that waits is overtaken by a newer one of the same keys: it is never tried, and
/// answered so, before the newer one. Any thread; stop() does not come by here.
class ChangeQueue {
 public:
  static constexpr std::size_t kRequests = 16;   ///< that wait
  static constexpr std::size_t kParts = 16;      ///< of one request, with different keys
  static constexpr std::size_t kAnswers = 1024;  ///< that are waited for: 5 s at 200 sets a second

  /// @throws std::runtime_error if too many wait already
  void ask(ChangeRequest request);
  void ask_set(Overrides changes, StationHost::Done done);
  [[nodiscard]] std::optional<ChangeRequest> take();
  void clear();

 private:
  [[nodiscard]] bool join(ChangeRequest& later);
  [[nodiscard]] bool retries() const;

  std::mutex mutex_;
  std::deque<ChangeRequest> waiting_;
  std::size_t answers_ = 0;  ///< waited for
};

/// What became of a part, to all who wait for it.
[[nodiscard]] ChangeAnswer answer_to(SetPart part, std::string refused);

/// "force.law = hooke, rate_hz = as in the scene", for people.
[[nodiscard]] std::string text_of(const Overrides& changes);

}  // namespace phalanx

// SPDX-License-Identifier: Apache-2.0
// Queue of the changes that a StationHost has been asked for and its worker has not begun.
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

/// Values to be laid over the scene, and the callbacks that wait for the answer.
struct SetPart {
  Overrides changes;
  StationHost::Done done;
  std::vector<StationHost::Done> overtaken;  ///< callbacks of older values of the same keys, oldest first
};

/// Answer to a part of a request.
struct ChangeAnswer {
  StationHost::Done done;
  std::vector<StationHost::Done> overtaken;
  std::string refused;  ///< reason; empty: done
};

/// One change of the station. Either `work` or `sets` describes it.
struct ChangeRequest {
  std::string text;            ///< description for people, while it is made
  std::function<void()> work;  ///< throws if the change is refused; empty: `sets` is the change
  StationHost::Done done;      ///< callback of `work`
  std::vector<SetPart> sets;
  bool retry = false;  ///< another try to make a station; one of them is enough
};

/// Bounded queue. A dragged slider asks faster than changes are made. Neighbouring sets therefore become one
/// request, and a newer value overtakes a waiting one of the same keys. An overtaken value is never tried,
/// and is answered as overtaken before the newer one. For any thread; StationHost::stop() does not
/// pass this queue.
class ChangeQueue {
 public:
  static constexpr std::size_t kRequests = 16;   ///< waiting requests
  static constexpr std::size_t kParts = 16;      ///< parts of one request, with different keys
  static constexpr std::size_t kAnswers = 1024;  ///< callbacks that wait: 5 s at 200 sets a second

  /// Appends a change.
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
  std::size_t answers_ = 0;  ///< callbacks that wait
};

/// Makes the answer for all callbacks of a part.
[[nodiscard]] ChangeAnswer answer_to(SetPart part, std::string refused);

/// Writes changes for people: "force.law = hooke, rate_hz = as in the scene".
[[nodiscard]] std::string text_of(const Overrides& changes);

}  // namespace phalanx

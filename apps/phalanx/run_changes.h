// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <future>
#include <memory>
#include <string>
#include <vector>

#include "phalanx/scene/scene.h"
#include "phalanx/station/assemble.h"
#include "phalanx/station/station.h"
#include "run_options.h"

namespace phalanx {

/// The lines `set KEY=VALUE` of a running station, one after the other. What a change needs is made on a
/// thread of its own, beside the loop and beside the terminal, so that stop and Ctrl-C never wait for it.
class LiveChanges {
 public:
  /// @param overrides  the scene's, as the station began
  LiveChanges(const RunOptions& options, Overrides overrides)
      : options_(options), overrides_(std::move(overrides)) {}

  void ask(std::string key_and_value) { waiting_.push_back(std::move(key_and_value)); }
  /// Hands over what is made, begins the next. Does not wait. @returns what there is to say
  [[nodiscard]] std::vector<std::string> go_on(Station& station);

 private:
  struct Change {
    std::string text;
    Overrides overrides;
    std::unique_ptr<HapticModel> blended;  ///< whose parameters are taken over in contact
    std::unique_ptr<LiveModel> exchanged;  ///< or this, at zero torque
  };
  static Change make(const RunOptions& options, Overrides overrides, const std::string& text);

  const RunOptions& options_;
  Overrides overrides_;
  std::deque<std::string> waiting_;
  std::future<Change> making_;
};

}  // namespace phalanx

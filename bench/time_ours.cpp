// SPDX-License-Identifier: Apache-2.0
#include "time_ours.h"

#include <algorithm>

#include "force_hash.h"
#include "stopwatch.h"

namespace phalanx::bench {
namespace {

constexpr double kPeriod = 1e-3;  // [s]

/// Plays one motion; before(tick) is called before each step, after(tick, us) after it.
template <class Before, class After>
void play(const HapticModel& model, const HapticParameters& parameters, const BenchMotion& motion,
          HapticState& state, Before&& before, After&& after) {
  for (std::size_t tick = 0; tick < motion.angle.size(); ++tick) {
    const Sample sample{static_cast<double>(tick) * kPeriod, motion.angle[tick]};
    before(tick);
    const Stopwatch watch;
    static_cast<void>(step(model, parameters, sample, state));
    after(tick, watch.us());
  }
}

/// Reads one byte of every cache line of 64 MB.
class CacheFlush {
 public:
  void operator()() {
    for (std::size_t i = 0; i < bytes_.size(); i += 64) sum_ = sum_ + bytes_[i];
  }

 private:
  std::vector<unsigned char> bytes_ = std::vector<unsigned char>(std::size_t{64} << 20U, 1);
  volatile unsigned sum_ = 0;
};

}  // namespace

std::vector<double> OurTimes::least(int repeats) const {
  std::vector<double> out = repeat_us.front();
  for (std::size_t r = 1; r < static_cast<std::size_t>(repeats); ++r) {
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = std::min(out[i], repeat_us[r][i]);
  }
  return out;
}

std::vector<double> OurTimes::greatest() const {
  std::vector<double> out = repeat_us.front();
  for (const std::vector<double>& repeat : repeat_us) {
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = std::max(out[i], repeat[i]);
  }
  return out;
}

OurTimes time_ours(const HapticModel& model, const HapticParameters& parameters,
                   const std::vector<BenchMotion>& motions) {
  const auto nothing = [](std::size_t) {};
  HapticState warm_up(model, parameters);
  play(model, parameters, motions.front(), warm_up, nothing, [](std::size_t, double) {});

  OurTimes times;
  for (int repeat = 0; repeat < kRepeats; ++repeat) {
    Hash hash;
    std::vector<double> us;
    for (const BenchMotion& motion : motions) {
      HapticState state(model, parameters);
      us.reserve(us.size() + motion.angle.size());
      play(model, parameters, motion, state, nothing, [&](std::size_t, double step_us) {
        us.push_back(step_us);
        hash.add(state.snapshot());
      });
    }
    if (repeat == 0) times.hash = hash.value();
    times.same_hash = times.same_hash && hash.value() == times.hash;
    times.repeat_us.push_back(std::move(us));
  }
  return times;
}

std::vector<ColdTime> time_cold(const HapticModel& model, const HapticParameters& parameters,
                                const std::vector<BenchMotion>& motions, int every) {
  CacheFlush flush;
  std::vector<ColdTime> out;
  for (int repeat = 0; repeat < kColdRepeats; ++repeat) {
    std::size_t first = 0;
    std::size_t entry = 0;
    for (const BenchMotion& motion : motions) {
      HapticState state(model, parameters);
      const auto is_cold = [&](std::size_t tick) {
        return (first + tick) % static_cast<std::size_t>(every) == 0;
      };
      play(
          model, parameters, motion, state,
          [&](std::size_t tick) {
            if (is_cold(tick)) flush();
          },
          [&](std::size_t tick, double us) {
            if (!is_cold(tick)) return;
            if (repeat == 0) {
              out.push_back({first + tick, us});
            } else {
              out[entry].us = std::min(out[entry].us, us);
            }
            ++entry;
          });
      first += motion.angle.size();
    }
  }
  return out;
}

}  // namespace phalanx::bench

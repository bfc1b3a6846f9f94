// SPDX-License-Identifier: Apache-2.0
#include <array>

#include "c_api/calls.h"
#include "phalanx/core/status.h"
#include "phalanx/hand/joints.h"

static_assert(PHALANX_DIGITS == phalanx::kDigits);
static_assert(PHALANX_JOINTS == phalanx::kJoints);
static_assert(PHALANX_SEGMENTS == phalanx::kSegments);
static_assert(PHALANX_STATUS_OSCILLATING == static_cast<int>(phalanx::Status::kOscillating));
static_assert(PHALANX_STATUS_SAMPLE_STALE == static_cast<int>(phalanx::Status::kSampleStale));
static_assert(PHALANX_STATUS_SEARCH_EXHAUSTED == static_cast<int>(phalanx::Status::kSearchExhausted));
static_assert(PHALANX_STATUS_START_INSIDE == static_cast<int>(phalanx::Status::kStartInside));

namespace {

bool is_below(int32_t number, int count) noexcept { return number >= 0 && number < count; }

}  // namespace

const char* phalanx_version(void) { return PHALANX_VERSION; }

const char* phalanx_result_name(phalanx_result result) {
  static constexpr std::array kNames = {
      "PHALANX_OK",           "PHALANX_ERROR_NULL",    "PHALANX_ERROR_HANDLE",  "PHALANX_ERROR_SIZE",
      "PHALANX_ERROR_INDEX",  "PHALANX_ERROR_REFUSED", "PHALANX_ERROR_NOT_NOW", "PHALANX_ERROR_FAILED",
      "PHALANX_ERROR_MEMORY", "PHALANX_ERROR_INTERNAL"};
  return is_below(result, static_cast<int>(kNames.size())) ? kNames[static_cast<std::size_t>(result)]
                                                           : "unknown";
}

// The names are literals, which end with a zero byte.

const char* phalanx_digit_name(int32_t digit) {
  return is_below(digit, PHALANX_DIGITS) ? phalanx::digit_name(digit).data() : nullptr;
}

const char* phalanx_joint_name(int32_t joint) {
  return is_below(joint, PHALANX_JOINTS) ? phalanx::joint_name(joint).data() : nullptr;
}

const char* phalanx_segment_name(int32_t segment) {
  return is_below(segment, PHALANX_SEGMENTS) ? phalanx::segment_name(segment).data() : nullptr;
}

const char* phalanx_status_name(int32_t bit) {
  return is_below(bit, phalanx::kStatusBits) ? phalanx::status_name(bit).data() : nullptr;
}

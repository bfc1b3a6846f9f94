// SPDX-License-Identifier: Apache-2.0
#include "c_api/handles.h"

#include <array>
#include <atomic>
#include <mutex>
#include <stdexcept>

namespace phalanx::c_api {
namespace {

// A number is  (count << 20) | (kind << 16) | slot.
constexpr unsigned kKindShift = 16;
constexpr unsigned kCountShift = 20;
constexpr std::uint64_t kSlotMask = kMostHandles - 1;

struct Slot {
  std::atomic<std::uint64_t> number{0};  ///< of the handle; 0: free
  std::atomic<void*> object{nullptr};
};

struct Table {
  std::mutex mutex;         ///< of insertions and removals
  std::uint64_t count = 0;  ///< handles given out so far
  std::uint64_t next = 0;   ///< where the search for a free slot begins
  std::array<Slot, kMostHandles> slot;
};

/// The process's table: zero pages, which take memory slot by slot.
constinit Table table;

Slot* slot_of(std::uint64_t kind, std::uint64_t number) noexcept {
  if ((number >> kKindShift & 0xFU) != kind) return nullptr;
  Slot& slot = table.slot[number & kSlotMask];
  return slot.number.load(std::memory_order_acquire) == number ? &slot : nullptr;
}

}  // namespace

std::uint64_t insert_handle(std::uint64_t kind, void* object) {
  const std::lock_guard lock(table.mutex);
  for (std::uint64_t tried = 0; tried < kMostHandles; ++tried) {
    const std::uint64_t place = table.next++ & kSlotMask;
    Slot& slot = table.slot[place];
    if (slot.number.load(std::memory_order_relaxed) != 0) continue;
    const std::uint64_t number = ++table.count << kCountShift | kind << kKindShift | place;
    slot.object.store(object, std::memory_order_relaxed);
    slot.number.store(number, std::memory_order_release);
    return number;
  }
  throw std::runtime_error("there are 65536 handles already; destroy those that are not used");
}

void* find_handle(std::uint64_t kind, std::uint64_t number) noexcept {
  const Slot* slot = slot_of(kind, number);
  return slot == nullptr ? nullptr : slot->object.load(std::memory_order_relaxed);
}

void* remove_handle(std::uint64_t kind, std::uint64_t number) noexcept {
  const std::lock_guard lock(table.mutex);
  Slot* slot = slot_of(kind, number);
  if (slot == nullptr) return nullptr;
  slot->number.store(0, std::memory_order_relaxed);
  return slot->object.exchange(nullptr, std::memory_order_relaxed);
}

}  // namespace phalanx::c_api

// SPDX-License-Identifier: Apache-2.0
// Handles of the C interface. A handle is a number in the form of a pointer, and is never dereferenced: it
// names a slot of a table, the kind of its object, and how often slots were given out. So a handle that is
// destroyed, of another kind or invented is recognised.
#pragma once

#include <cstdint>

namespace phalanx::c_api {

struct Scene;
struct Model;
struct TimedMotion;
struct State;
struct Recorder;
struct Recording;

/// Kind of an object, as a number in its handle.
template <class Object>
inline constexpr std::uint64_t kKind = 0;
template <>
inline constexpr std::uint64_t kKind<Scene> = 1;
template <>
inline constexpr std::uint64_t kKind<Model> = 2;
template <>
inline constexpr std::uint64_t kKind<TimedMotion> = 3;
template <>
inline constexpr std::uint64_t kKind<State> = 4;
template <>
inline constexpr std::uint64_t kKind<Recorder> = 5;
template <>
inline constexpr std::uint64_t kKind<Recording> = 6;

/// Most handles that exist at one time.
inline constexpr std::uint64_t kMostHandles = 1U << 16U;

/// Puts an object into the table. Takes a lock. @returns its number. @throws std::runtime_error if the
/// table is full
[[nodiscard]] std::uint64_t insert_handle(std::uint64_t kind, void* object);
/// @returns the object; null if the number is not of a handle of this kind. Real-time.
[[nodiscard]] void* find_handle(std::uint64_t kind, std::uint64_t number) noexcept;
/// Takes an object out of the table. Takes a lock. @returns as find_handle()
void* remove_handle(std::uint64_t kind, std::uint64_t number) noexcept;

/// @returns the number of a handle.
template <class Handle>
[[nodiscard]] std::uint64_t number_of(const Handle* handle) noexcept {
  static_assert(sizeof(void*) == sizeof(std::uint64_t), "the number of a handle has 64 bits");
  return reinterpret_cast<std::uintptr_t>(handle);
}

/// @returns the object of a handle; null if it is not of this kind, or destroyed. Real-time.
template <class Object, class Handle>
[[nodiscard]] Object* object_of(const Handle* handle) noexcept {
  return static_cast<Object*>(find_handle(kKind<Object>, number_of(handle)));
}

}  // namespace phalanx::c_api

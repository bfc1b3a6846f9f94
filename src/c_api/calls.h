// SPDX-License-Identifier: Apache-2.0
// What every function of the C interface does: it checks handles, pointers and sizes, and turns an exception
// into a result and a text.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <memory>
#include <string>
#include <string_view>

#include "c_api/handles.h"
#include "phalanx/phalanx.h"

namespace phalanx::c_api {

/// Keeps the text for phalanx_error_text() of this thread. @returns the result. It allocates nothing.
phalanx_result failed(phalanx_result result, std::string_view text) noexcept;
/// @returns PHALANX_ERROR_NULL for the argument `name`.
phalanx_result null_argument(const char* name) noexcept;
/// @returns PHALANX_ERROR_HANDLE for a handle that should be of `what`.
phalanx_result wrong_handle(const char* what) noexcept;
/// @returns the result for the exception that is being handled; its text is that of the C++ library.
phalanx_result failed_by_exception() noexcept;

/// Runs the body of a function that may throw.
template <class Body>
phalanx_result guarded(const Body& body) noexcept {
  try {
    return body();
  } catch (...) {
    return failed_by_exception();
  }
}

/// Checks a struct's size. @returns PHALANX_OK, or PHALANX_ERROR_SIZE. Real-time.
/// @param smallest, known  sizes that the library allows
phalanx_result check_size(std::uint32_t stated, std::size_t smallest, std::size_t known,
                          const char* name) noexcept;

/// Copies as much of a struct of the caller as it states; the rest of `into` stays as it is. Real-time.
template <class Struct>
phalanx_result read_struct(const Struct* from, std::size_t smallest, Struct& into,
                           const char* name) noexcept {
  if (from == nullptr) return null_argument(name);
  const phalanx_result size = check_size(from->struct_size, smallest, sizeof(Struct), name);
  if (size != PHALANX_OK) return size;
  std::memcpy(&into, from, from->struct_size);
  return PHALANX_OK;
}

/// Copies as much of `from` as the caller's struct has room for; its struct_size stays. Real-time.
template <class Struct>
phalanx_result write_struct(Struct& from, std::size_t smallest, Struct* into, const char* name) noexcept {
  if (into == nullptr) return null_argument(name);
  const phalanx_result size = check_size(into->struct_size, smallest, sizeof(Struct), name);
  if (size != PHALANX_OK) return size;
  from.struct_size = into->struct_size;
  std::memcpy(into, &from, into->struct_size);
  return PHALANX_OK;
}

/// Puts a new object into the table, and gives its handle to the caller.
template <class Object, class Handle>
void make_handle(std::unique_ptr<Object> object, Handle** handle) {
  *handle =
      reinterpret_cast<Handle*>(insert_handle(kKind<Object>, object.get()));  // NOLINT: never dereferenced
  static_cast<void>(object.release());
}

/// Frees an object. Null has no effect.
template <class Object, class Handle>
phalanx_result destroy(Handle* handle, const char* what) noexcept {
  if (handle == nullptr) return PHALANX_OK;
  const std::unique_ptr<Object> object(static_cast<Object*>(remove_handle(kKind<Object>, number_of(handle))));
  return object ? PHALANX_OK : wrong_handle(what);
}

/// Copies a text with its zero byte, for phalanx_scene_get().
phalanx_result copy_text(const std::string& value, char* text, std::size_t size,
                         std::size_t* needed) noexcept;

}  // namespace phalanx::c_api

// SPDX-License-Identifier: Apache-2.0
#include "c_api/calls.h"

#include <array>
#include <cstdio>
#include <exception>
#include <new>
#include <stdexcept>
#include <system_error>

#include "phalanx/scene/scene.h"

namespace phalanx::c_api {
namespace {

constexpr std::size_t kErrorText = 2048;  // with the zero byte

/// Of each thread. A plain array: a thread needs no memory for it but that of the loader.
thread_local std::array<char, kErrorText> error_of_thread{};

bool continues_character(char byte) noexcept { return (static_cast<unsigned char>(byte) & 0xC0U) == 0x80U; }

}  // namespace

phalanx_result failed(phalanx_result result, std::string_view text) noexcept {
  std::size_t size = std::min(text.size(), kErrorText - 1);
  if (size < text.size())  // not within a character of UTF-8
    while (size > 0 && continues_character(text[size])) --size;
  std::copy_n(text.data(), size, error_of_thread.begin());
  error_of_thread[size] = '\0';
  return result;
}

phalanx_result null_argument(const char* name) noexcept {
  std::array<char, 128> text{};
  std::snprintf(text.data(), text.size(), "%s is null", name);
  return failed(PHALANX_ERROR_NULL, text.data());
}

phalanx_result wrong_handle(const char* what) noexcept {
  std::array<char, 128> text{};
  std::snprintf(text.data(), text.size(), "this is no handle of a %s, or it is destroyed", what);
  return failed(PHALANX_ERROR_HANDLE, text.data());
}

phalanx_result failed_by_exception() noexcept {
  try {
    throw;
  } catch (const std::bad_alloc&) {
    return failed(PHALANX_ERROR_MEMORY, "out of memory");
  } catch (const std::invalid_argument& error) {  // SceneError among them
    return failed(PHALANX_ERROR_REFUSED, error.what());
  } catch (const std::logic_error& error) {
    return failed(PHALANX_ERROR_INTERNAL, error.what());
  } catch (const std::exception& error) {
    return failed(PHALANX_ERROR_FAILED, error.what());
  } catch (...) {
    return failed(PHALANX_ERROR_INTERNAL, "an exception of an unknown type");
  }
}

phalanx_result check_size(std::uint32_t stated, std::size_t smallest, std::size_t known,
                          const char* name) noexcept {
  if (stated >= smallest && stated <= known && stated % 8 == 0) return PHALANX_OK;
  std::array<char, 160> text{};
  std::snprintf(text.data(), text.size(),
                "%s: struct_size is %u; this library takes %zu to %zu, in multiples of 8", name, stated,
                smallest, known);
  return failed(PHALANX_ERROR_SIZE, text.data());
}

phalanx_result copy_text(const std::string& value, char* text, std::size_t size,
                         std::size_t* needed) noexcept {
  if (needed != nullptr) *needed = value.size() + 1;
  if (size == 0) return PHALANX_OK;
  if (text == nullptr) return null_argument("text");
  if (size < value.size() + 1) return failed(PHALANX_ERROR_SIZE, "the text does not fit; see `needed`");
  std::memcpy(text, value.c_str(), value.size() + 1);
  return PHALANX_OK;
}

}  // namespace phalanx::c_api

extern "C" const char* phalanx_error_text(void) { return phalanx::c_api::error_of_thread.data(); }

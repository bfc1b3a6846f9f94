// SPDX-License-Identifier: Apache-2.0
// Reading of a JSON object whose fields are all known.
#pragma once

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>
#include <string>
#include <string_view>

namespace phalanx::registry {

/// Reads the fields of one JSON object. An absent field keeps its value. finish() refuses unknown fields. All
/// functions throw std::invalid_argument naming the field.
class JsonFields {
 public:
  /// @param what  of the object, for messages: "patient"
  JsonFields(std::string_view text, std::string what) : what_(std::move(what)) {
    object_ = nlohmann::json::parse(text, nullptr, false);
    require_object();
  }
  JsonFields(nlohmann::json object, std::string what) : object_(std::move(object)), what_(std::move(what)) {
    require_object();
  }

  [[nodiscard]] bool has(const char* name) {
    read_.insert(name);
    return object_.contains(name) && !object_.at(name).is_null();
  }
  template <typename T>
  void read(const char* name, T& value) {
    if (!has(name)) return;
    try {
      value = object_.at(name).get<T>();
    } catch (const nlohmann::json::exception&) {
      throw std::invalid_argument(fmt::format("{}: the field \"{}\" has another type ({})", what_, name,
                                              object_.at(name).type_name()));
    }
  }
  /// Reads an object in this object, or an array's elements, by a function of JSON.
  template <typename Function>
  void read_with(const char* name, const Function& function) {
    if (has(name)) function(object_.at(name));
  }
  void finish() const {
    for (const auto& [name, value] : object_.items())
      if (!read_.contains(name))
        throw std::invalid_argument(fmt::format("{}: the field \"{}\" is unknown; remove it", what_, name));
  }

 private:
  void require_object() const {
    if (!object_.is_object()) throw std::invalid_argument(fmt::format("{}: it is no JSON object", what_));
  }

  nlohmann::json object_;
  std::string what_;
  std::set<std::string> read_;
};

/// @returns JSON as one line. @throws std::invalid_argument if a text is not UTF-8
[[nodiscard]] inline std::string json_line(const nlohmann::json& object, const char* what) {
  try {
    return object.dump();
  } catch (const nlohmann::json::exception&) {
    throw std::invalid_argument(fmt::format("{}: a text is not UTF-8", what));
  }
}

}  // namespace phalanx::registry

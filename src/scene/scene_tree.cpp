// SPDX-License-Identifier: Apache-2.0
#include "scene/scene_tree.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <optional>
#include <vector>

#include "phalanx/scene/scene_keys.h"
#include "scene/toml/toml_bounds.h"

namespace phalanx {
namespace {

std::vector<std::string> split(std::string_view path) {
  std::vector<std::string> parts;
  for (std::size_t begin = 0;;) {
    const std::size_t dot = path.find('.', begin);
    parts.emplace_back(path.substr(begin, dot - begin));
    if (dot == std::string_view::npos) return parts;
    begin = dot + 1;
  }
}

std::optional<std::size_t> as_index(std::string_view part) {
  std::size_t index = 0;
  const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), index);
  if (error != std::errc() || end != part.data() + part.size()) return std::nullopt;
  return index;
}

/// Parses the value as TOML; if it is not TOML, takes it as a string.
toml::table parse_value(const std::string& value, const std::string& origin) {
  try {
    toml::table table = parse_bounded_toml("v = " + value, origin);
    if (table.size() == 1) return table;
  } catch (const toml::parse_error&) {
  }
  return toml::table{{"v", value}};
}

bool is_bare_key(std::string_view key) {
  const auto bare = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_' || c == '-'; };
  return !key.empty() && std::all_of(key.begin(), key.end(), bare);
}

/// Makes paths absolute: a typed path is relative to the working directory, not to the scene file.
void make_paths_absolute(toml::node& node, const std::string& pattern) {
  if (toml::table* table = node.as_table()) {
    for (auto&& [key, child] : *table) make_paths_absolute(child, fmt::format("{}.{}", pattern, key.str()));
  } else if (toml::array* array = node.as_array()) {
    for (toml::node& child : *array) make_paths_absolute(child, pattern + "[]");
  } else if (toml::value<std::string>* text = node.as_string()) {
    const SceneKey* key = find_scene_key(pattern);
    if (key == nullptr || !key->is_path(text->get()) || text->get().find('\0') != std::string::npos) return;
    *text = std::filesystem::absolute(text->get()).lexically_normal().string();
  }
}

}  // namespace

SceneTree::SceneTree(const std::string& text, std::string origin, const Overrides& overrides)
    : origin_(std::move(origin)), root_(parse_toml(text, origin_)), overrides_(overrides) {
  for (const auto& [key, value] : overrides_) apply(key, value);
}

void SceneTree::apply(const std::string& key, const std::string& value) {
  const std::string origin = fmt::format("--set {}={}", key, value);
  toml::table parsed = parse_value(value, origin);
  toml::node& leaf = *parsed.get("v");
  make_paths_absolute(leaf, pattern_of(key));

  const std::vector<std::string> parts = split(key);
  if (parts.size() > kMostKeyParts)
    throw SceneError(fmt::format("--set {:.40}...: the key has {} parts; a key has at most {}", key,
                                 parts.size(), kMostKeyParts));
  toml::node* at = &root_;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (parts[i].empty())
      throw SceneError(fmt::format("{}: the key has an empty part; write e.g. force.law=hooke", origin));
    const bool last = i + 1 == parts.size();
    const bool next_is_index = !last && as_index(parts[i + 1]).has_value();
    const auto put = [&](auto&& insert) {
      if (last) {
        leaf.visit([&](auto& node) { insert(std::move(node)); });
      } else if (next_is_index) {
        insert(toml::array{});
      } else {
        insert(toml::table{});
      }
    };
    if (toml::table* table = at->as_table()) {
      if (last || !table->contains(parts[i]))
        put([&](auto&& node) { table->insert_or_assign(parts[i], std::move(node)); });
      at = table->get(parts[i]);
    } else if (toml::array* array = at->as_array()) {
      const auto index = as_index(parts[i]);
      if (!index || *index > array->size()) {
        throw SceneError(fmt::format(
            "{}: \"{}\" is no element of an array of {}; write an index from 0 to {} (the last one appends)",
            origin, parts[i], array->size(), array->size()));
      }
      if (*index == array->size()) {
        put([&](auto&& node) { array->push_back(std::move(node)); });
      } else if (last) {
        put([&](auto&& node) {
          array->replace(array->cbegin() + static_cast<std::ptrdiff_t>(*index), std::move(node));
        });
      }
      at = array->get(*index);
    } else {
      throw SceneError(fmt::format("{}: \"{}\" has no parts, it is {}; shorten the key", origin,
                                   parts[i == 0 ? 0 : i - 1], type_name(*at)));
    }
  }
}

const toml::node* SceneTree::find(std::string_view path) const {
  const toml::node* at = &root_;
  for (const std::string& part : split(path)) {
    if (const toml::table* table = at->as_table()) {
      at = table->get(part);
    } else if (const toml::array* array = at->as_array()) {
      const auto index = as_index(part);
      at = index && *index < array->size() ? array->get(*index) : nullptr;
    } else {
      return nullptr;
    }
    if (at == nullptr) return nullptr;
  }
  return at;
}

std::string SceneTree::place(std::string_view path) const {
  for (auto it = overrides_.rbegin(); it != overrides_.rend(); ++it) {
    const std::string& key = it->first;
    const bool covers = path == key || (path.size() > key.size() && path.substr(0, key.size()) == key &&
                                        path[key.size()] == '.');
    if (covers) return fmt::format("--set {}={}", key, it->second);
  }
  for (std::string_view at = path; !at.empty();) {
    const toml::node* node = find(at);
    if (node != nullptr && node->source().begin.line > 0)
      return fmt::format("{}:{}", origin_, node->source().begin.line);
    const std::size_t dot = at.rfind('.');
    at = dot == std::string_view::npos ? std::string_view() : at.substr(0, dot);
  }
  return origin_;
}

std::vector<OverlaidValue> SceneTree::values_over_file(const std::string& name) const {
  std::vector<OverlaidValue> values;
  const toml::node* found = find(name);
  if (found != nullptr && found->is_table())
    add_values_below(*found->as_table(), name, name.size() + 1, values);
  return values;
}

void SceneTree::add_values_below(const toml::table& table, const std::string& path, std::size_t skip,
                                 std::vector<OverlaidValue>& values) const {
  for (const auto& [key, value] : table) {
    const std::string name(key.str());
    const std::string at = fmt::format("{}.{}", path, name);
    if (at.substr(skip) == "file") continue;
    if (!is_bare_key(name))
      fail(path, fmt::format("\"{}\": such a key exists in no file; write letters, digits, _ and -", name));
    const toml::table* below = value.as_table();
    if (below != nullptr && !below->empty())
      add_values_below(*below, at, skip, values);
    else
      values.push_back({at.substr(skip), below != nullptr ? "{}" : toml_text(value), place(at)});
  }
}

std::string SceneTree::statement(std::string_view path) const {
  const toml::node* node = find(path);
  if (node == nullptr || node->is_table()) return fmt::format("{}: {}", place(path), path);
  return fmt::format("{}: {} = {}", place(path), path, show(*node));
}

void SceneTree::fail(std::string_view path, const std::string& problem) const {
  throw SceneError(fmt::format("{}: {}", statement(path), problem));
}

}  // namespace phalanx

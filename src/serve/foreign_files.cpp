// SPDX-License-Identifier: Apache-2.0
#include "serve/foreign_files.h"

#include <algorithm>
#include <string_view>
#include <vector>

#include "phalanx/scene/scene_keys.h"
#include "scene/scene_tree.h"
#include "serve/plain_text.h"

namespace phalanx {
namespace {

namespace fs = std::filesystem;

/// Whether only a path will do, not a name of what is shipped.
bool is_for_paths(const std::string& pattern) {
  static const std::vector<SceneKey> keys = scene_keys();
  const auto key =
      std::find_if(keys.begin(), keys.end(), [&](const SceneKey& k) { return k.path == pattern; });
  return key != keys.end() ? key->type == "file" : pattern.ends_with(".file");
}

/// Of the names that take_upload() gives: letters, digits, - and _, and one ending.
bool is_own_upload(const std::string& text, const fs::path& uploads) {
  const std::string own = (fs::absolute(uploads).lexically_normal() / "").string();
  if (!text.starts_with(own)) return false;
  const std::string_view name = std::string_view(text).substr(own.size());
  const std::size_t dot = name.find('.');
  return dot != std::string_view::npos && dot > 0 &&
         std::all_of(name.begin(), name.begin() + dot, is_plain) &&
         std::all_of(name.begin() + dot + 1, name.end(), is_plain);
}

bool is_foreign(const std::string& text, const std::string& pattern, const fs::path& uploads) {
  if (text.empty() || is_own_upload(text, uploads)) return false;
  const bool path = text.find('/') != std::string::npos || text.find('\0') != std::string::npos ||
                    text.find(".toml") != std::string::npos;
  return path || is_for_paths(pattern);
}

bool holds_foreign(const toml::node& node, const std::string& pattern, const fs::path& uploads) {
  if (const toml::table* table = node.as_table())
    return std::any_of(table->begin(), table->end(), [&](const auto& entry) {
      return holds_foreign(entry.second, pattern + "." + std::string(entry.first.str()), uploads);
    });
  if (const toml::array* array = node.as_array())
    return std::any_of(array->begin(), array->end(), [&](const toml::node& child) {
      return holds_foreign(child, pattern + "[]", uploads);
    });
  const toml::value<std::string>* text = node.as_string();
  return text != nullptr && is_foreign(text->get(), pattern, uploads);
}

}  // namespace

bool names_foreign_file(const std::string& key, const std::string& value, const fs::path& uploads) {
  const std::string pattern = pattern_of(key);
  try {
    const toml::table parsed = parse_bounded_toml("v = " + value, key);
    if (parsed.size() == 1) return holds_foreign(*parsed.get("v"), pattern, uploads);
  } catch (const toml::parse_error&) {  // then it is text as it stands
  }
  return is_foreign(value, pattern, uploads);
}

}  // namespace phalanx

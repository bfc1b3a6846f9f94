// SPDX-License-Identifier: Apache-2.0
#include "serve/settings_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <sstream>
#include <vector>

#include "phalanx/scene/scene.h"
#include "scene/toml/toml_reader.h"

namespace phalanx {
namespace {

std::string text_of(const toml::node& node) {
  if (const auto* text = node.as_string()) return std::filesystem::path(text->get()).filename().string();
  std::ostringstream out;
  node.visit([&out](const auto& value) { out << value; });
  return out.str();
}

/// The kind of an object stands first, and without its key; so does the file of a mesh.
std::string text_of(const toml::table& table) {
  std::vector<std::string> parts;
  const toml::node* file = table.get("file");
  if (const toml::node* kind = table.get("kind"))
    parts.push_back(file != nullptr ? "mesh " + text_of(*file) : text_of(*kind));
  for (const auto& [key, value] : table)
    if (parts.empty() || (key != "kind" && key != "file"))
      parts.push_back(fmt::format("{} {}", key.str(), text_of(value)));
  return fmt::format("{}", fmt::join(parts, ", "));
}

std::string text_of(const std::string& value) {
  if (value.empty()) return "as in the scene";
  try {
    const toml::table parsed = parse_bounded_toml("v = " + value, "setting");
    const toml::node* node = parsed.size() == 1 ? parsed.get("v") : nullptr;
    if (node == nullptr) return value;
    if (const toml::table* table = node->as_table()) return text_of(*table);
    if (const auto* text = node->as_string(); text != nullptr && text->get().find('/') != std::string::npos)
      return text_of(*node);
  } catch (const toml::parse_error&) {  // then it is text as it stands
  } catch (const SceneError&) {         // too deep to be looked into
  }
  return value;
}

}  // namespace

std::string settings_text(const Overrides& changes) {
  std::string out;
  for (auto change = changes.begin(); change != changes.end(); ++change) {
    const bool replaced = std::any_of(std::next(change), changes.end(), [change](const auto& later) {
      return !later.second.empty() && change->first.starts_with(later.first + ".");
    });
    if (!replaced)
      out += fmt::format("{}{} = {}", out.empty() ? "" : ", ", change->first, text_of(change->second));
  }
  return out;
}

}  // namespace phalanx

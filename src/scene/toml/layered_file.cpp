// SPDX-License-Identifier: Apache-2.0
#include "scene/toml/layered_file.h"

#include <fmt/format.h>

#include <utility>

#include "phalanx/scene/data_paths.h"
#include "phalanx/scene/scene.h"
#include "scene/text_file.h"

namespace phalanx {
namespace {

namespace fs = std::filesystem;

/// Longest chain of bases; a longer one is circular.
constexpr int kMaxBases = 8;

std::string joined(const std::string& path, std::string_view key) {
  return path.empty() ? std::string(key) : fmt::format("{}.{}", path, key);
}

/// Inserts a value at a dotted path, with the tables that lead to it.
void insert_at(toml::table& root, const OverlaidValue& value) {
  toml::table parsed = parse_toml("v = " + value.value, value.place);
  toml::node* leaf = parsed.get("v");
  if (leaf == nullptr)
    throw SceneError(fmt::format("{}: {} is not a value; write one", value.place, value.value));
  toml::table* at = &root;
  std::size_t begin = 0;
  for (std::size_t dot = value.path.find('.'); dot != std::string::npos; dot = value.path.find('.', begin)) {
    const std::string part = value.path.substr(begin, dot - begin);
    if (!at->contains(part)) at->insert(part, toml::table{});
    at = at->get(part)->as_table();
    if (at == nullptr)
      throw SceneError(fmt::format("{}: {}: \"{}\" is stated as a value and as a table; keep one",
                                   value.place, value.path, part));
    begin = dot + 1;
  }
  leaf->visit([&](auto& node) { at->insert_or_assign(value.path.substr(begin), std::move(node)); });
}

/// Merges `top` over `below`: tables are merged, other values replaced.
void merge(toml::table& below, toml::table& top) {
  for (auto&& [key, value] : top) {
    toml::node* there = below.get(key.str());
    if (there != nullptr && there->is_table() && value.is_table()) {
      merge(*there->as_table(), *value.as_table());
    } else {
      value.visit([&](auto& node) { below.insert_or_assign(key.str(), std::move(node)); });
    }
  }
}

}  // namespace

/// Notes the parser's place of every value of a file.
void LayeredFile::note_places(const toml::table& table, const std::string& path, const std::string& origin,
                              Places& places) {
  for (const auto& [key, value] : table) {
    const std::string at = joined(path, key.str());
    places[at] = {{fmt::format("{}:{}", origin, value.source().begin.line), ""}, value.is_table()};
    if (const toml::table* below = value.as_table()) note_places(*below, at, origin, places);
  }
}

void LayeredFile::add_file(const std::string& name_or_path, const fs::path& folder,
                           const std::string& stated_at) {
  const std::string what = stated_at.empty() ? what_ : fmt::format("{}: {}", stated_at, what_);
  const auto file = find_data_file(what, name_or_path, fmt::format("assets/{}s", what_), ".toml", folder);
  files_.push_back(file);
  add_text(read_text_file(file.string(), what_), file.string(), file.parent_path(), 0);
}

void LayeredFile::add_text(const std::string& text, const std::string& origin, const fs::path& folder) {
  add_text(text, origin, folder, 0);
}

void LayeredFile::add_text(const std::string& text, const std::string& origin, const fs::path& folder,
                           int depth) {
  Layer layer;
  layer.tree = parse_toml(text, origin);
  note_places(layer.tree, "", origin, layer.places);
  TomlTable table(layer.tree, origin, "");
  if (table.has("base")) {
    const std::string base = table.text("base");
    if (depth == kMaxBases)
      table.fail("base", "the files name each other as base in a circle; remove one `base`");
    const auto file = find_data_file(layer.places["base"].place.place + ": base: " + what_, base,
                                     fmt::format("assets/{}s", what_), ".toml", folder);
    files_.push_back(file);
    add_text(read_text_file(file.string(), what_), file.string(), file.parent_path(), depth + 1);
    layer.tree.erase("base");
  }
  origin_ = origin;
  add(std::move(layer));
}

void LayeredFile::add_overlay(const std::vector<OverlaidValue>& values) {
  Layer layer;
  const std::string prefix = what_ + ".";
  for (const OverlaidValue& value : values) {
    insert_at(layer.tree, value);
    overlay_in_words_ += fmt::format(", {}: {}{} = {}", value.place, prefix, value.path, value.value);
    const ValuePlace place = {value.place, prefix};
    for (std::size_t dot = value.path.find('.'); dot != std::string::npos;
         dot = value.path.find('.', dot + 1))
      layer.places.emplace(value.path.substr(0, dot), Stated{place, true});
    layer.places[value.path] = {place, value.value == "{}"};
  }
  if (layer.tree.contains("base"))
    throw SceneError(fmt::format(
        "{}: {}base: is a key of a file, not of a scene; state the file that has this base as {}file",
        layer.places["base"].place.place, prefix, prefix));
  add(std::move(layer));
}

void LayeredFile::add(Layer layer) {
  if (layer.tree.contains("scale")) {
    auto scale = std::make_unique<Layer>();
    layer.tree.get("scale")->visit([&](auto& node) { scale->tree.insert("scale", std::move(node)); });
    scale->places = layer.places;
    scale_layers_.push_back(std::move(scale));
    layer.tree.erase("scale");
  }
  merge(merged_.tree, layer.tree);
  // A table's place is where it began; a value's place is where it was stated last.
  for (auto& [path, stated] : layer.places) {
    if (stated.table)
      merged_.places.emplace(path, std::move(stated));
    else
      merged_.places[path] = std::move(stated);
  }
}

PlaceOf LayeredFile::lookup(const Places& places) const {
  return [&places, origin = origin_](const std::string& path) -> ValuePlace {
    for (std::string at = path; !at.empty();) {
      if (const auto found = places.find(at); found != places.end()) return found->second.place;
      const std::size_t dot = at.rfind('.');
      at = dot == std::string::npos ? std::string() : at.substr(0, dot);
    }
    return {origin, ""};
  };
}

std::string LayeredFile::in_words() const {
  return overlay_in_words_.empty() ? origin_
                                   : fmt::format("{} (with {})", origin_, overlay_in_words_.substr(2));
}

TomlTable LayeredFile::root() const { return {merged_.tree, origin_, "", lookup(merged_.places)}; }

std::vector<TomlTable> LayeredFile::scales() const {
  std::vector<TomlTable> scales;
  for (const auto& layer : scale_layers_) {
    TomlTable table(layer->tree, origin_, "", lookup(layer->places));
    scales.push_back(table.table("scale"));
  }
  return scales;
}

}  // namespace phalanx

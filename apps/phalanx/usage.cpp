// SPDX-License-Identifier: Apache-2.0
#include "usage.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "phalanx/core/nearest_name.h"
#include "phalanx/scene/scene_keys.h"

namespace phalanx {
namespace {

/// @returns the innermost command that was parsed.
const CLI::App& innermost(const CLI::App& app) {
  const CLI::App* command = &app;
  while (!command->get_subcommands().empty()) command = command->get_subcommands().front();
  return *command;
}

std::string full_name(const CLI::App& command) {
  const CLI::App* parent = command.get_parent();
  return parent == nullptr ? command.get_name() : full_name(*parent) + " " + command.get_name();
}

std::vector<std::string> command_names(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::App* sub : visible_commands(command)) names.push_back(sub->get_name());
  return names;
}

std::vector<std::string> option_names(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  return names;
}

/// Suggests a name. A typed prefix of a name is preferred to a similar spelling; empty: no name is near.
std::string suggestion(const std::string& word, const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    if (name.starts_with(word)) return name;
  }
  return near_name(word, names);
}

/// Suggests an option, or a scene's key if the command takes --set; empty: none is near.
std::string meant_option(const CLI::App& command, const std::string& word) {
  const std::vector<std::string> options = option_names(command);
  std::string option = suggestion(word, options);
  if (std::find(options.begin(), options.end(), "--set") == options.end()) return option;
  const std::string bare = word.substr(std::min(word.find_first_not_of('-'), word.size()));
  const std::string key = near_name(bare, settable_keys());
  if (key.empty() || option.starts_with(word)) return option;
  const bool nearer = option.empty() || name_distance(bare, key) < name_distance(word, option);
  return nearer ? fmt::format("--set {}=VALUE", key) : option;
}

std::string question(const std::string& meant) {
  return meant.empty() ? "" : fmt::format("did you mean '{}'? ", meant);
}

bool is_number(const std::string& text) {
  double value = 0.0;
  return CLI::detail::lexical_cast(text, value);
}

/// Describes a wrong number, such as "200Hz", in words; empty: it is another mistake.
std::string number_mistake(const CLI::App& command, const CLI::ParseError& error) {
  const std::string what = error.what();
  const bool conversion = what.starts_with("Could not convert: ");
  if (!conversion && what.find(" not in range ") == std::string::npos) return "";
  for (const CLI::Option* option : command.get_options()) {
    if (what.find(option->get_name() + (conversion ? " = " : ": ")) == std::string::npos) continue;
    for (const std::string& value : option->results()) {
      if (!is_number(value))
        return fmt::format("{} {}: is not a number; write its digits alone, without a unit",
                           option->get_name(), value);
      if (conversion)
        return fmt::format("{} {}: is not a whole number; write one", option->get_name(), value);
    }
  }
  return "";
}

}  // namespace

std::vector<const CLI::App*> visible_commands(const CLI::App& command) {
  return command.get_subcommands([](const CLI::App* sub) { return !sub->get_group().empty(); });
}

std::vector<std::string> settable_keys() {
  std::vector<std::string> keys;
  for (const SceneKey& key : scene_keys()) {
    keys.push_back(key.path);
    if (const std::size_t at = keys.back().find("[]"); at != std::string::npos)
      keys.back().replace(at, 2, ".0");
  }
  return keys;
}

void refuse_empty_values(const CLI::App& command) {
  for (const CLI::Option* option : command.get_options()) {
    if (option->get_lnames().empty() || option->get_expected_min() == 0) continue;
    const auto& values = option->results();
    if (std::find(values.begin(), values.end(), "") != values.end()) {
      throw std::invalid_argument(
          fmt::format("{} \"\": the value is empty; give one or leave the option out", option->get_name()));
    }
  }
}

CLI::Validator positive() {
  return {[](const std::string& text) -> std::string {
            double value = 0.0;
            if (!CLI::detail::lexical_cast(text, value))
              return fmt::format("{}: is not a number; write its digits alone, without a unit", text);
            if (value > 0.0 && std::isfinite(value)) return {};
            return fmt::format("{}: must be a number above 0", text);
          },
          "> 0"};
}

std::string usage_message(const CLI::App& app, const CLI::ParseError& error) {
  const CLI::App& command = innermost(app);
  const std::string name = full_name(command);
  const auto subcommands = command_names(command);
  const auto unknown = app.remaining(true);
  if (!unknown.empty()) {
    const std::string& word = unknown.front();
    if (word.starts_with("-")) {
      const std::string bare = word.substr(0, word.find('='));
      return fmt::format("{}: unknown option '{}'; {}See {} --help", name, bare,
                         question(meant_option(command, bare)), name);
    }
    if (command.get_parent() == nullptr && word.ends_with(".toml"))
      return fmt::format("{0}: '{1}' is a file, not a command; if it is a scene, type {0} run {1}", name,
                         word);
    if (!subcommands.empty()) {
      return fmt::format("{}: unknown command '{}'; {}Known: {}", name, word,
                         question(suggestion(word, subcommands)), fmt::join(subcommands, ", "));
    }
    return fmt::format("{}: '{}' is one argument too many; see {} --help", name, word, name);
  }
  if (!subcommands.empty()) {
    return fmt::format("{}: say what to do: {}; see {} --help", name, fmt::join(subcommands, ", "), name);
  }
  const std::string mistake = number_mistake(command, error);
  return fmt::format("{}: {}; see {} --help", name, mistake.empty() ? error.what() : mistake, name);
}

}  // namespace phalanx

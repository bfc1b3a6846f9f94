// SPDX-License-Identifier: Apache-2.0
#include "usage.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <vector>

#include "phalanx/core/nearest_name.h"

namespace phalanx {
namespace {

/// The innermost command that the line got to.
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
  for (const CLI::App* sub : command.get_subcommands({})) names.push_back(sub->get_name());
  return names;
}

std::vector<std::string> option_names(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  return names;
}

/// A name that was not typed to its end beats one that is merely spelt alike.
std::string suggestion(const std::string& word, const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    if (name.starts_with(word)) return name;
  }
  return nearest_name(word, names);
}

}  // namespace

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

std::string usage_message(const CLI::App& app, const CLI::ParseError& error) {
  const CLI::App& command = innermost(app);
  const std::string name = full_name(command);
  const auto subcommands = command_names(command);
  const auto unknown = app.remaining(true);
  if (!unknown.empty()) {
    const std::string& word = unknown.front();
    if (word.starts_with("-")) {
      const std::string bare = word.substr(0, word.find('='));
      return fmt::format("{}: unknown option '{}'; did you mean '{}'? See {} --help", name, bare,
                         suggestion(bare, option_names(command)), name);
    }
    if (!subcommands.empty()) {
      return fmt::format("{}: unknown command '{}'; did you mean '{}'? Known: {}", name, word,
                         suggestion(word, subcommands), fmt::join(subcommands, ", "));
    }
    return fmt::format("{}: '{}' is one argument too many; see {} --help", name, word, name);
  }
  if (!subcommands.empty()) {
    return fmt::format("{}: say what to do: {}; see {} --help", name, fmt::join(subcommands, ", "), name);
  }
  return fmt::format("{}: {}; see {} --help", name, error.what(), name);
}

}  // namespace phalanx

// SPDX-License-Identifier: Apache-2.0
#include "completion.h"

#include <algorithm>

#include "phalanx/exercise/participant_skill.h"
#include "phalanx/scene/data_paths.h"
#include "phalanx/scene/scene.h"
#include "usage.h"

namespace phalanx {
namespace {

using Candidates = std::vector<Candidate>;

bool takes_value(const CLI::Option& option) { return option.get_items_expected_min() > 0; }

bool is_named(const CLI::Option& option, const std::string& name) {
  const auto& names = option.get_lnames();
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// @returns the subcommand of that name; nullptr: there is none.
const CLI::App* subcommand(const CLI::App& command, const std::string& name) {
  for (const CLI::App* sub : command.get_subcommands({}))
    if (sub->get_name() == name) return sub;
  return nullptr;
}

/// @returns the first line: a shell takes each line for a word
std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

Candidates options_of(const CLI::App& command) {
  Candidates all;
  for (const CLI::Option* option : command.get_options()) {
    if (option->get_group().empty()) continue;
    for (const std::string& name : option->get_lnames())
      all.push_back({"--" + name, first_line(option->get_description())});
  }
  return all;
}

Candidates commands_of(const CLI::App& command) {
  Candidates all;
  for (const CLI::App* sub : visible_commands(command))
    all.push_back({sub->get_name(), sub->get_description()});
  return all;
}

Candidates files_of(const std::string& folder, const std::string& extension = ".toml") {
  Candidates all;
  for (std::string& name : names_in_folder(data_folder() / folder, extension))
    all.push_back({std::move(name), ""});
  return all;
}

Candidates scenes() {
  Candidates all;
  for (const SceneInfo& scene : list_scenes()) all.push_back({scene.name, scene.description});
  return all;
}

Candidates skills() {
  Candidates all;
  for (const std::string_view name : participant_skill_names()) all.push_back({std::string(name), ""});
  return all;
}

Candidates settings() {
  Candidates all;
  for (const std::string& key : settable_keys()) all.push_back({key + "=", ""});
  return all;
}

/// Reads the choices of an option; CLI::IsMember describes them as "{a,b}".
Candidates choices(const CLI::Option& option) {
  Candidates all;
  const std::string type = option.get_type_name();
  const std::size_t begin = type.find('{');
  const std::size_t end = type.find('}', begin);
  if (begin == std::string::npos || end == std::string::npos) return all;
  for (std::string& choice : CLI::detail::split(type.substr(begin + 1, end - begin - 1), ','))
    all.push_back({std::move(choice), ""});
  return all;
}

Candidates values_of(const CLI::Option& option) {
  const std::string name = CLI::detail::to_lower(option.get_single_name());
  if (option.get_positional() && name == "scene") return scenes();
  if ((option.get_positional() && name == "exercise") || is_named(option, "exercise"))
    return files_of("assets/exercises");
  if (is_named(option, "demo")) return skills();
  if (option.get_positional() && name == "postures") return files_of("assets/postures", ".csv");
  if (is_named(option, "set")) return settings();
  if (is_named(option, "profile")) return files_of("assets/profiles");
  if (is_named(option, "template")) return files_of("assets/prescriptions");
  if (is_named(option, "mapping")) return files_of("assets/mappings");
  if (is_named(option, "hand")) return files_of("assets/hands");
  return choices(option);
}

/// Parser that follows a command line to the word at the cursor.
class Cursor {
 public:
  explicit Cursor(const CLI::App& program) : command_(&program) {}

  void pass(const std::string& word) {
    if (word == "=") return;
    if (value_of_ != nullptr) {
      value_of_ = nullptr;
    } else if (word.starts_with("-")) {
      const CLI::Option* option = command_->get_option_no_throw(word);
      if (option != nullptr && takes_value(*option)) value_of_ = option;
    } else if (const CLI::App* sub = subcommand(*command_, word)) {
      command_ = sub;
      arguments_ = 0;
    } else {
      ++arguments_;
    }
  }

  [[nodiscard]] Candidates offers(const std::string& word) const {
    if (value_of_ != nullptr) return values_of(*value_of_);
    if (word.starts_with("-"))
      return word.find('=') == std::string::npos ? options_of(*command_) : assigned(word);
    Candidates all = commands_of(*command_);
    if (const CLI::Option* argument = next_argument()) {
      const Candidates values = values_of(*argument);
      all.insert(all.end(), values.begin(), values.end());
    }
    return all;
  }

 private:
  /// Completes --option=value in one word.
  [[nodiscard]] Candidates assigned(const std::string& word) const {
    const std::string name = word.substr(0, word.find('='));
    const CLI::Option* option = command_->get_option_no_throw(name);
    if (option == nullptr || !takes_value(*option)) return {};
    Candidates all = values_of(*option);
    for (Candidate& one : all) one.word = name + "=" + one.word;
    return all;
  }

  [[nodiscard]] const CLI::Option* next_argument() const {
    int before = 0;
    for (const CLI::Option* option : command_->get_options()) {
      if (!option->get_positional()) continue;
      before += option->get_items_expected_max();
      if (arguments_ < before) return option;
    }
    return nullptr;
  }

  const CLI::App* command_;
  const CLI::Option* value_of_ = nullptr;  ///< option whose value comes next
  int arguments_ = 0;                      ///< number of the command's arguments so far
};

}  // namespace

std::vector<Candidate> completions(const CLI::App& program, const std::vector<std::string>& typed) {
  Cursor cursor(program);
  if (typed.empty()) return {};
  for (std::size_t i = 0; i + 1 < typed.size(); ++i) cursor.pass(typed[i]);
  const std::string word = typed.back() == "=" ? "" : typed.back();
  std::vector<Candidate> fitting = cursor.offers(word);
  std::erase_if(fitting, [&](const Candidate& one) { return !one.word.starts_with(word); });
  return fitting;
}

}  // namespace phalanx

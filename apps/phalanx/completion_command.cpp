// SPDX-License-Identifier: Apache-2.0
// phalanx completion bash|zsh: the scripts ask `phalanx completion words` for candidates, so that they match
// the program. They run only a program that is called phalanx, never a ./run in some folder.
#include <fmt/format.h>

#include <memory>
#include <string>
#include <vector>

#include "commands.h"
#include "completion.h"

namespace phalanx {
namespace {

constexpr const char* kBash = R"(# bash completion for phalanx, made by `phalanx completion bash`
_phalanx() {
  local program=${COMP_WORDS[0]/#\~/$HOME}
  mapfile -t COMPREPLY < <("$program" completion words -- "${COMP_WORDS[@]:1:COMP_CWORD}" 2>/dev/null)
  COMPREPLY=("${COMPREPLY[@]%%$'\t'*}")
  [[ ${COMPREPLY-} != *= ]] || compopt -o nospace
}
complete -o bashdefault -o default -F _phalanx phalanx
)";

constexpr const char* kZsh = R"(#compdef phalanx
# zsh completion for phalanx, made by `phalanx completion zsh`
_phalanx() {
  local -a offered behind
  local program=${words[1]/#\~/$HOME}
  offered=("${(@f)$("$program" completion words -- "${(@)words[2,CURRENT]}" 2>/dev/null)}")
  offered=("${(@)offered:#}")
  (( $#offered )) || { _default; return }
  [[ ${offered[1]%%$'\t'*} == *= ]] && behind=(-S '')
  offered=("${(@)offered//:/\\:}")
  offered=("${(@)offered/$'\t'/:}")
  _describe phalanx offered $behind
}
if [[ $funcstack[1] == _phalanx ]]; then _phalanx "$@"; else compdef _phalanx phalanx; fi
)";

int print_words(const CLI::App& program, const std::vector<std::string>& typed) {
  for (const Candidate& one : completions(program, typed)) fmt::print("{}\t{}\n", one.word, one.meaning);
  return kDone;
}

void add_shell(CLI::App& completion, const std::string& shell, const char* script, Job& job) {
  completion.add_subcommand(shell, fmt::format("Print the script for {}", shell))->callback([script, &job] {
    job = [script] {
      fmt::print("{}", script);
      return kDone;
    };
  });
}

}  // namespace

void add_completion_command(CLI::App& app, Job& job) {
  CLI::App* completion = app.add_subcommand("completion", "Make bash or zsh complete commands and options");
  completion->require_subcommand(1);
  completion->footer(
      "An installed phalanx has its scripts where both shells look. In a checkout, type\n"
      "  source <(build/release/bin/phalanx completion bash)");
  add_shell(*completion, "bash", kBash, job);
  add_shell(*completion, "zsh", kZsh, job);

  auto typed = std::make_shared<std::vector<std::string>>();
  CLI::App* words = completion->add_subcommand("words", "What may stand at the cursor")->group("");
  words->set_help_flag();
  words->add_option("WORD", *typed);
  words->callback([typed, &app, &job] { job = [typed, &app] { return print_words(app, *typed); }; });
}

}  // namespace phalanx

// SPDX-License-Identifier: Apache-2.0
// phalanx man: the manual page phalanx(1), made from the help of all commands when the program is installed.
#include <fmt/format.h>

#include <sstream>
#include <string>
#include <vector>

#include "commands.h"
#include "usage.h"

namespace phalanx {
namespace {

constexpr const char* kEnd = R"(.SH EXIT STATUS
.TP
.B 0
The work is done.
.TP
.B 1
The input was valid, but the work failed: for example a full disk, no answer from a device, a run that ended in a fault.
.TP
.B 2
Wrong usage or input; nothing was written.
.SH ENVIRONMENT
.TP
.B PHALANX_DATA_DIR
Folder with scenes and assets.
.TP
.B PHALANX_PATIENTS_DIR
Data folder of the patients, where
.B \-\-data
names none.
.TP
.B PHALANX_KEYS
File with the keys of patients, where
.B \-\-keys
names none.
.TP
.B PHALANX_PASSPHRASE
Passphrase of the file with the keys of patients.
.TP
.B PHALANX_PASSWORD
Password of the account that
.B \-\-as
names.
.TP
.B NO_COLOR
If it is not empty, a terminal gets plain text.
.SH FILES
.TP
.I out/
Recordings, reports of faults, calibrations and ranges, below the working directory.
.TP
.I /etc/default/phalanx\-station
Options of the service
.BR phalanx\-station .
.TP
.I /usr/share/phalanx
Scenes, hands, profiles, studies, the pages, and the link's reference in C.
.SH SAFETY
Phalanx is not a medical device.
A powered device on a hand needs an emergency stop in hardware that works without this program.
.SH SEE ALSO
The documents of the package
.BR phalanx\-doc :
.IR /usr/share/doc/phalanx/html/index.html .
)";

/// Escapes what troff would read as an instruction or print as another character.
std::string as_roff(const std::string& text) {
  std::string out;
  for (const char c : text) {
    const bool line_starts = out.empty() || out.back() == '\n';
    if (line_starts && (c == '.' || c == '\'')) out += "\\&";
    switch (c) {
      case '\\':
        out += "\\e";
        break;
      case '-':
        out += "\\-";
        break;
      case '\'':
        out += "\\(aq";
        break;
      case '`':
        out += "\\(ga";
        break;
      case '^':
        out += "\\(ha";
        break;
      case '~':
        out += "\\(ti";
        break;
      default:
        out += c;
    }
  }
  return out;
}

std::string quoted(const std::string& text) {
  std::string out = as_roff(text);
  for (std::size_t at = 0; (at = out.find('"', at)) != std::string::npos; at += 4)
    out.replace(at, 1, "\\(dq");
  return "\"" + out + "\"";
}

/// Writes a text with its own line breaks, such as an example in a footer.
void print_lines(const std::string& text) {
  std::istringstream lines(text);
  bool first = true;
  for (std::string line; std::getline(lines, line); first = false) {
    if (line.empty()) {
      fmt::print(".PP\n");
      first = true;
      continue;
    }
    if (!first) fmt::print(".br\n");
    fmt::print("{}\n", as_roff(line));
  }
}

void print_entry(const std::string& name, const std::string& arguments, const std::string& meaning) {
  fmt::print(".TP\n\\fB{}\\fR{}\n", as_roff(name), as_roff(arguments));
  meaning.empty() ? fmt::print("\\&\n") : print_lines(meaning);
}

void print_options(const CLI::App& command) {
  const CLI::Formatter as_help;
  for (const bool positional : {true, false})
    for (const CLI::Option* option : command.get_options()) {
      if (option->get_group().empty() || option->get_positional() != positional) continue;
      if (option == command.get_help_ptr() && command.get_parent() != nullptr) continue;
      print_entry(as_help.make_option_name(option, positional), as_help.make_option_opts(option),
                  option->get_description());
    }
}

/// Writes a section for the command, and after it one for each command below it.
void print_command(const CLI::App& command, const std::string& name) {
  const auto below = visible_commands(command);
  fmt::print(".SS {}\n{}.\n", quoted(name), as_roff(command.get_description()));
  if (below.empty()) {
    print_options(command);
  } else {
    for (const CLI::App* sub : below) print_entry(name + " " + sub->get_name(), "", sub->get_description());
  }
  if (const std::string footer = command.get_footer(); footer != command.get_parent()->get_footer()) {
    fmt::print(".PP\n");
    print_lines(footer);
  }
  for (const CLI::App* sub : below) print_command(*sub, name + " " + sub->get_name());
}

int print_manual(const CLI::App& program) {
  fmt::print(
      ".\\\" Made by `phalanx man`.\n.TH PHALANX 1 \"\" \"phalanx {}\" \"User Commands\"\n"
      ".ad l\n.SH NAME\nphalanx \\- haptic rendering for hand exoskeletons\n"
      ".SH SYNOPSIS\n.B phalanx\n.I COMMAND\n.RI [ OPTION ]...\n.SH DESCRIPTION\n{}\n"
      ".PP\n.B phalanx run\nstarts a station with a simulated device and prints the address of its page.\n"
      ".SH OPTIONS\n",
      PHALANX_VERSION, as_roff(program.get_description()));
  print_options(program);
  fmt::print(".SH COMMANDS\n");
  for (const CLI::App* command : visible_commands(program))
    print_command(*command, "phalanx " + command->get_name());
  fmt::print("{}", kEnd);
  return kDone;
}

}  // namespace

void add_manual_command(CLI::App& app, Job& job) {
  CLI::App* manual = app.add_subcommand("man", "Print the manual page")->group("");
  manual->callback([&app, &job] { job = [&app] { return print_manual(app); }; });
}

}  // namespace phalanx

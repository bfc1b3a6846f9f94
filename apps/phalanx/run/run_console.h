// SPDX-License-Identifier: Apache-2.0
// Messages of `phalanx run` and `phalanx exercise run` on their terminal.
#pragma once

#include <optional>
#include <string>

#include "terminal/emphasis.h"
#include "terminal/line_writer.h"

namespace phalanx {

/// Standard output and standard error, without waiting for their readers (LineWriter). If both are the same
/// terminal, pipe or file, lines keep their order.
class RunConsole {
 public:
  /// @param command  name of the command that writes, for standard error
  explicit RunConsole(std::string command = "phalanx run");

  void say(const std::string& line) noexcept { out_.line(line); }
  void say(const std::string& line, Emphasis emphasis) noexcept;
  /// Writes a line to standard error, with the command's name.
  void complain(const std::string& what, Emphasis emphasis = Emphasis::kError) noexcept;
  /// Writes a status line. @returns false if it was left out: LineWriter::status()
  [[nodiscard]] bool status(const std::string& line) noexcept { return out_.status(line); }

  /// @returns true if standard output is a terminal. Secrets are written to a terminal only.
  [[nodiscard]] bool is_terminal() const noexcept { return out_.is_terminal(); }
  [[nodiscard]] std::size_t width() const noexcept { return out_.width(); }  ///< LineWriter::width()

 private:
  const std::string command_;
  LineWriter out_;
  std::optional<LineWriter> err_;  ///< none if it is the same as out_
};

}  // namespace phalanx

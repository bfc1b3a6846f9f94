// SPDX-License-Identifier: Apache-2.0
// What `phalanx run` says on its terminal.
#pragma once

#include <optional>
#include <string>

#include "line_writer.h"

namespace phalanx {

/// Standard output and standard error, without ever waiting for them: LineWriter. Where both are the same
/// terminal, pipe or file, lines keep their order.
class RunConsole {
 public:
  RunConsole();

  void say(const std::string& line) noexcept { out_.line(line); }
  /// On standard error, with the command's name.
  void complain(const std::string& what) noexcept;
  /// @returns false if it was left out: LineWriter::status()
  [[nodiscard]] bool status(const std::string& line) noexcept { return out_.status(line); }

  /// Whether standard output is a terminal: what is secret is for one only.
  [[nodiscard]] bool is_terminal() const noexcept { return out_.is_terminal(); }
  [[nodiscard]] std::size_t width() const noexcept { return out_.width(); }  ///< LineWriter::width()

 private:
  LineWriter out_;
  std::optional<LineWriter> err_;  ///< none where it is the same as out_
};

}  // namespace phalanx

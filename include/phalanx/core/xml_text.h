// SPDX-License-Identifier: Apache-2.0
// Text in XML, SVG and HTML.
#pragma once

#include <string>
#include <string_view>

namespace phalanx {

/// @returns `text` as the content of an element or the value of an attribute in double quotes: &, <, > and "
/// as entities; control characters become spaces. Set-up only.
[[nodiscard]] inline std::string xml_escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
    }
  }
  return out;
}

}  // namespace phalanx

// SPDX-License-Identifier: Apache-2.0
// What every picture and page must be, whatever is in it.
#pragma once

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <fstream>
#include <set>
#include <string>
#include <vector>

namespace phalanx {

/// Empty if every element is closed by its own end tag, in order, every attribute is quoted, no & or < stands
/// bare, no id is there twice and what is filled with url(#id) has it; else what is wrong.
inline std::string flaw_of(const std::string& xml) {
  std::vector<std::string> open;
  std::set<std::string> ids, wanted;
  for (std::size_t i = 0; i < xml.size();) {
    const auto c = static_cast<unsigned char>(xml[i]);
    if (c < 0x20 && c != '\n') return "control character " + std::to_string(c);
    if (xml[i] == '&') {
      const std::size_t end = xml.find(';', i);
      const std::string entity = end == std::string::npos ? "" : xml.substr(i, end - i);
      if (entity != "&amp" && entity != "&lt" && entity != "&gt" && entity != "&quot")
        return "bare & at " + xml.substr(i, 20);
    }
    if (xml[i] != '<') {
      ++i;
      continue;
    }
    const std::size_t end = xml.find('>', i);
    if (end == std::string::npos) return "unfinished tag";
    const std::string tag = xml.substr(i + 1, end - i - 1);
    i = end + 1;
    if (tag.empty() || tag.find('<') != std::string::npos) return "bare < before " + tag.substr(0, 20);
    if (tag[0] == '?' || tag[0] == '!') continue;
    if (tag[0] == '/') {
      if (open.empty() || open.back() != tag.substr(1)) return "end tag " + tag;
      open.pop_back();
      continue;
    }
    if (std::isalpha(static_cast<unsigned char>(tag[0])) == 0) return "tag " + tag;
    if (std::count(tag.begin(), tag.end(), '"') != 2 * std::count(tag.begin(), tag.end(), '=') &&
        tag.find("content=") == std::string::npos)
      return "attributes of " + tag;
    if (const std::size_t at = tag.find(" id=\""); at != std::string::npos) {
      const std::string id = tag.substr(at + 5, tag.find('"', at + 5) - at - 5);
      if (!ids.insert(id).second) return "second id " + id;
    }
    if (const std::size_t at = tag.find("=\"url(#"); at != std::string::npos)
      wanted.insert(tag.substr(at + 7, tag.find(')', at) - at - 7));
    if (tag.back() != '/') open.push_back(tag.substr(0, tag.find(' ')));
  }
  for (const std::string& id : wanted) {
    if (ids.count(id) == 0) return "nothing has the id " + id;
  }
  return open.empty() ? "" : "no end of " + open.back();
}

inline std::size_t count_of(const std::string& text, const std::string& word) {
  std::size_t n = 0;
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++n;
  return n;
}

/// For looking at: written into the folder that PHALANX_KEEP_REPORTS names, if it names one.
inline void keep(const std::string& name, const std::string& text) {
  if (const char* folder = std::getenv("PHALANX_KEEP_REPORTS"))
    std::ofstream(std::string(folder) + "/" + name) << text;
}

/// Text that breaks what does not escape it.
inline const std::string kNasty = "a <b> & \"c\" \x01\t'd' ]]> --><script>";

}  // namespace phalanx

// SPDX-License-Identifier: Apache-2.0
// A small reader of well-formed XML: the elements with their attributes.
#pragma once

#include <algorithm>
#include <cctype>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

namespace phalanx::testing {

/// Element without its content.
struct XmlElement {
  std::string name = {};
  std::map<std::string, std::string> attributes = {};

  [[nodiscard]] bool has(const std::string& attribute) const { return attributes.contains(attribute); }
  [[nodiscard]] const std::string& at(const std::string& attribute) const { return attributes.at(attribute); }
};

/// @returns a text with the five entities of XML replaced. @throws std::runtime_error for another '&'
inline std::string unescaped(const std::string& text) {
  static const std::map<std::string, char> kEntities = {
      {"amp", '&'}, {"lt", '<'}, {"gt", '>'}, {"quot", '"'}, {"apos", '\''}};
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '&') {
      out.push_back(text[i]);
      continue;
    }
    const std::size_t end = text.find(';', i);
    const auto entity = kEntities.find(text.substr(i + 1, end - i - 1));
    if (end == std::string::npos || entity == kEntities.end())
      throw std::runtime_error("no entity: " + text.substr(i, 12));
    out.push_back(entity->second);
    i = end;
  }
  return out;
}

/// Reads the elements in the order of their begin. @throws std::runtime_error if the text is not well-formed: an
/// element that is not closed, an attribute without quotes, an attribute twice, an unknown entity
inline std::vector<XmlElement> xml_elements(const std::string& text) {
  std::vector<XmlElement> all;
  std::vector<std::string> open;
  std::size_t at = text.find("<html");
  while (at < text.size()) {
    const std::size_t begin = text.find('<', at);
    static_cast<void>(unescaped(open.empty() || open.back() == "style" ? "" : text.substr(at, begin - at)));
    if (begin == std::string::npos) break;
    const std::size_t end = text.find('>', begin);
    if (end == std::string::npos) throw std::runtime_error("an element does not end");
    std::string inside = text.substr(begin + 1, end - begin - 1);
    at = end + 1;
    if (inside.starts_with("/")) {
      if (open.empty() || open.back() != inside.substr(1))
        throw std::runtime_error("<" + inside + "> closes nothing");
      open.pop_back();
      continue;
    }
    const bool closed = inside.ends_with("/");
    if (closed) inside.pop_back();
    XmlElement element;
    std::size_t i = std::min(inside.find(' '), inside.size());
    element.name = inside.substr(0, i);
    while (i < inside.size()) {
      if (std::isspace(static_cast<unsigned char>(inside[i])) != 0) {
        ++i;
        continue;
      }
      const std::size_t equal = inside.find("=\"", i);
      const std::size_t quote = equal == std::string::npos ? equal : inside.find('"', equal + 2);
      if (quote == std::string::npos) throw std::runtime_error("no attribute: " + inside);
      if (!element.attributes
               .emplace(inside.substr(i, equal - i), unescaped(inside.substr(equal + 2, quote - equal - 2)))
               .second)
        throw std::runtime_error("an attribute twice: " + inside);
      i = quote + 1;
    }
    if (!closed) {
      if (element.name != "meta") open.push_back(element.name);
    }
    all.push_back(std::move(element));
  }
  if (!open.empty()) throw std::runtime_error("<" + open.back() + "> is not closed");
  return all;
}

/// @returns the text nodes of a well-formed document that are not only white space, without those of <style>
inline std::vector<std::string> xml_texts(const std::string& text) {
  std::vector<std::string> all;
  for (std::size_t at = text.find("<html"); at < text.size();) {
    const std::size_t end = text.find('>', at);
    const std::size_t next = std::min(text.find('<', end), text.size());
    const std::string node = text.substr(end + 1, next - end - 1);
    if (!text.substr(at).starts_with("<style") && node.find_first_not_of(" \n") != std::string::npos)
      all.push_back(unescaped(node));
    at = next;
  }
  return all;
}

}  // namespace phalanx::testing

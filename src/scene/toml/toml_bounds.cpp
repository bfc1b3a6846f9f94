// SPDX-License-Identifier: Apache-2.0
#include "scene/toml/toml_bounds.h"

#include <fmt/format.h>

#include <algorithm>

#include "phalanx/scene/scene.h"

namespace phalanx {
namespace {

constexpr std::size_t kLongestKey = 1000;  ///< with its dots and quotes [bytes]
constexpr int kMostBrackets = 16;          ///< nested brackets

/// Scanner of the text, without comments and strings.
class BoundsCheck {
 public:
  BoundsCheck(std::string_view text, const std::string& origin) : text_(text), origin_(origin) {}

  void run() {
    while (at_ < text_.size()) {
      const char c = text_[at_];
      if (c == '#') {
        at_ = std::min(text_.find('\n', at_), text_.size());
      } else if (c == '"' || c == '\'') {
        skip_string(c);
      } else {
        ++at_;
        take(c);
      }
    }
  }

 private:
  void take(char c) {
    switch (c) {
      case '\n':
        ++line_;
        header_ = false;
        value_ = false;
        return begin();
      case '[':
      case '{':
        header_ = header_ || (c == '[' && brackets_ == 0 && !value_ && is_blank_since_begin());
        if (++brackets_ > kMostBrackets)
          fail(fmt::format("brackets are nested more than {} deep; nest them less deep", kMostBrackets));
        return begin();
      case ']':
      case '}':
        if (header_) check_length();
        brackets_ = std::max(brackets_ - 1, 0);
        return begin();
      case '=':
        check_length();
        value_ = true;
        return begin();
      case ',':
        return begin();
      case '.':
        if (++dots_ >= kMostKeyParts)
          fail(fmt::format("a key of more than {} parts; shorten it", kMostKeyParts));
        return;
      default:
        return;
    }
  }

  /// Begins a possible key.
  void begin() {
    begin_ = at_;
    dots_ = 0;
  }

  [[nodiscard]] bool is_blank_since_begin() const {
    return text_.substr(begin_, at_ - 1 - begin_).find_first_not_of(" \t") == std::string_view::npos;
  }

  void check_length() const {
    if (at_ - 1 - begin_ <= kLongestKey) return;
    fail(fmt::format("a key of {} bytes; write at most {}", at_ - 1 - begin_, kLongestKey));
  }

  void skip_string(char quote) {
    const std::string three(3, quote);
    const bool is_long = text_.substr(at_).starts_with(three);
    at_ += is_long ? three.size() : 1;
    while (at_ < text_.size()) {
      const char c = text_[at_];
      if (c == '\n' && !is_long) return;  // not TOML: the parser stops here
      if (c == '\n') ++line_;
      const bool ends = c == quote && (!is_long || text_.substr(at_).starts_with(three));
      const bool escapes = c == '\\' && quote == '"' && !text_.substr(at_ + 1).starts_with('\n');
      at_ += ends && is_long ? three.size() : escapes ? 2 : 1;
      if (!ends) continue;
      // Up to two quotes before the last three are part of the string.
      for (int i = 0; is_long && i < 2 && at_ < text_.size() && text_[at_] == quote; ++i) ++at_;
      return;
    }
  }

  [[noreturn]] void fail(const std::string& problem) const {
    throw SceneError(fmt::format("{}:{}: {}", origin_, line_, problem));
  }

  std::string_view text_;
  const std::string& origin_;
  std::size_t at_ = 0;
  std::size_t begin_ = 0;  ///< begin of a possible key
  std::size_t dots_ = 0;   ///< dots in that key
  std::size_t line_ = 1;
  int brackets_ = 0;     ///< open brackets
  bool header_ = false;  ///< the line is a table's header
  bool value_ = false;   ///< a key of this line has ended
};

}  // namespace

void check_toml_bounds(std::string_view text, const std::string& origin) { BoundsCheck(text, origin).run(); }

}  // namespace phalanx

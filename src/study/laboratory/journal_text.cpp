// SPDX-License-Identifier: Apache-2.0
// The text of a journal, and the comparison of its header.
#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <map>
#include <new>
#include <stdexcept>
#include <utility>

#include "study/laboratory/journal.h"
#include "study/laboratory/study_json.h"

namespace phalanx {
namespace {

constexpr int kFormat = 1;
constexpr const char* kFormatKey = "phalanx_study_journal";

std::string line_of(const OrderedJson& json) {
  return json.dump(-1, ' ', false, OrderedJson::error_handler_t::replace) + "\n";
}

std::string header_line(const JournalHeader& header) {
  OrderedJson json{{kFormatKey, kFormat}, {"commit", header.commit}, {"inputs", header.inputs}};
  if (!header.libm.empty()) json["libm"] = header.libm;
  json["study"] = study_to_json(header.study);
  return line_of(json);
}

JournalHeader header_from(const std::string& line) {
  const OrderedJson json = parse_json(line);
  if (json.at(kFormatKey) != kFormat) throw std::out_of_range("it is of another format");
  return {.study = study_from_json(json.at("study")),
          .inputs = json.at("inputs"),
          .commit = json.at("commit"),
          .libm = json.value("libm", "")};
}

class Lines {
 public:
  Lines(std::string text, const std::filesystem::path& file) : text_(std::move(text)), file_(file) {}

  /// Reads the next complete line, without its end.
  bool next(std::string& line) {
    const std::size_t end = text_.find('\n', at_);
    if (end == std::string::npos) return false;
    line = text_.substr(at_, end - at_);
    at_ = end + 1;
    ++number_;
    return true;
  }
  [[noreturn]] void fail(const std::string& problem) const {
    throw std::invalid_argument(fmt::format("{}:{}: {}", file_.string(), std::max(number_, 1), problem));
  }

 private:
  std::string text_;
  const std::filesystem::path& file_;
  std::size_t at_ = 0;
  int number_ = 0;
};

void add_once(const PointResult& result, std::map<int, std::string>& seen, JournalContent& content,
              const Lines& lines) {
  if (result.index < 0 || result.index >= point_count(content.header.study))
    lines.fail(fmt::format("the study has no point {}; move the file away, or measure it again (--restart)",
                           result.index));
  const auto [known, is_new] = seen.emplace(result.index, result_to_json(result).dump());
  if (is_new) {
    content.points.push_back(result);
  } else if (known->second != result_to_json(result).dump()) {
    lines.fail(
        fmt::format("point {} stands there twice with different results; move the file away, or measure it "
                    "again (--restart)",
                    result.index));
  }
}

}  // namespace

std::string journal_name(int shard, int of) {
  return of == 1 ? "points.jsonl" : fmt::format("points.{}-of-{}.jsonl", shard, of);
}

std::string difference(const JournalHeader& journal, const JournalHeader& now) {
  if (study_to_json(journal.study) != study_to_json(now.study))
    return fmt::format("it is of another study (\"{}\"), or the study file has changed since",
                       journal.study.name);
  if (journal.inputs != now.inputs)
    return "the scene, or a device, patient, hand or mesh file that it uses, has changed since";
  if (journal.commit != now.commit)
    return fmt::format("it was made by another version of the program ({}, this is {})", journal.commit,
                       now.commit);
  if (!journal.libm.empty() && !now.libm.empty() && journal.libm != now.libm)
    return "it was measured on a machine whose sine, exponential or another mathematical function rounds "
           "differently";
  return "";
}

std::string result_line(const PointResult& result) { return line_of(result_to_json(result)); }

std::string journal_text(const JournalContent& content) {
  std::string text = header_line(content.header);
  for (const PointResult& result : content.points) text += result_line(result);
  return text;
}

JournalContent read_journal(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream)
    throw std::invalid_argument(fmt::format("{}: cannot be opened; check the path", file.string()));
  return parse_journal(std::string(std::istreambuf_iterator<char>(stream), {}), file);
}

JournalContent parse_journal(std::string text, const std::filesystem::path& file) {
  Lines lines(std::move(text), file);
  JournalContent content;
  std::string line;
  if (!lines.next(line))
    lines.fail("is no journal of a study; name another folder, or measure it again (--restart)");
  try {
    content.header = header_from(line);
  } catch (const std::bad_alloc&) {  // no error of the journal
    throw;
  } catch (const std::exception& error) {
    lines.fail(fmt::format(
        "is no journal of a study ({}); name another folder, or measure it again (--restart)", error.what()));
  }
  std::map<int, std::string> seen;
  while (lines.next(line)) {
    PointResult result;
    try {
      result = result_from_json(parse_json(line));
    } catch (const std::bad_alloc&) {
      throw;
    } catch (const std::exception& error) {
      lines.fail(
          fmt::format("is damaged ({}); remove this line, its point is then measured again", error.what()));
    }
    add_once(result, seen, content, lines);
  }
  return content;
}

}  // namespace phalanx

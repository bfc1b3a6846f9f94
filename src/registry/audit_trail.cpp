// SPDX-License-Identifier: Apache-2.0
#include "registry/audit_trail.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>

#include "phalanx/registry/registry_error.h"
#include "registry/crypto.h"
#include "registry/field_checks.h"

namespace phalanx::registry {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

const std::string kFirst(64, '0');  ///< `before` of the first line

struct ParsedLine {
  AuditEntry entry;
  std::string before;
  bool had_head = true;
};

std::optional<ParsedLine> parse_line(std::string_view text) {
  try {
    const json line = json::parse(text);
    ParsedLine out;
    out.entry = {.n = line.at("n").get<std::uint64_t>(),
                 .time = line.at("time").get<std::string>(),
                 .account = line.at("account").get<std::string>(),
                 .action = line.at("action").get<std::string>(),
                 .record = line.at("record").get<std::string>(),
                 .detail = line.value("detail", std::string())};
    out.before = line.at("before").get<std::string>();
    out.had_head = !line.contains("head");
    return out;
  } catch (const json::exception&) {
    return std::nullopt;
  }
}

std::vector<std::string_view> lines_of(std::string_view text) {
  std::vector<std::string_view> out;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    out.push_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return out;
}

std::string known_gap(std::uint64_t first, std::uint64_t last) {
  return fmt::format("lines {} to {} of the audit log are missing", first, last);
}

AuditCheck broken(AuditCheck check, std::uint64_t line, const std::string& text) {
  check.whole = false;
  check.first_broken = line;
  check.text = text;
  return check;
}

}  // namespace

/// All heads of a key file.
struct AuditTrail::Heads {
  std::map<std::string, AuditHead> of;

  static Heads read(const fs::path& file) {
    Heads out;
    const std::optional<std::string> text = read_private_file(file);
    if (!text) return out;
    try {
      const json whole = json::parse(*text);
      for (const auto& [id, head] : whole.at("registries").items())
        out.of[id] = {.folder = head.at("folder").get<std::string>(),
                      .lines = head.at("lines").get<std::uint64_t>(),
                      .hash = head.at("hash").get<std::string>(),
                      .line = head.at("line").get<std::string>(),
                      .accounts = head.at("accounts").get<std::uint64_t>()};
    } catch (const json::exception& error) {
      throw RegistryError(
          RegistryFault::kDamaged,
          fmt::format("{} is damaged ({}); put back its copy, or remove it: the audit log is then "
                      "checked without it",
                      file.string(), error.what()));
    }
    return out;
  }
  void write(const fs::path& file) const {
    json registries = json::object();
    for (const auto& [id, head] : of)
      registries[id] = {{"folder", head.folder},
                        {"lines", head.lines},
                        {"hash", head.hash},
                        {"line", head.line},
                        {"accounts", head.accounts}};
    replace_private_file(file, fmt::format("{}\n", json{{"format", 1}, {"registries", registries}}.dump(1)));
  }
};

AuditTrail::AuditTrail(fs::path folder, const fs::path& keys, std::string id)
    : folder_(std::move(folder)),
      log_(folder_ / "audit.jsonl"),
      heads_(fs::path(keys.string() + ".heads")),
      id_(std::move(id)),
      hash_(kFirst) {}

std::optional<AuditHead> AuditTrail::head() const {
  const Heads heads = Heads::read(heads_);
  const auto found = heads.of.find(id_);
  if (found == heads.of.end()) return std::nullopt;
  return found->second;
}

void AuditTrail::read_more(const std::optional<AuditHead>& head) {
  const std::uint64_t size = stamp_of(log_) ? stamp_of(log_)->bytes : 0;
  if (size < bytes_) {
    bytes_ = 0;
    lines_ = 0;
    hash_ = kFirst;
  }
  torn_ = false;
  if (size == bytes_) return;
  const std::string text = read_private_file(log_, bytes_).value_or("");
  std::size_t begin = 0;
  for (std::size_t end = text.find('\n'); end != std::string::npos; end = text.find('\n', begin)) {
    hash_ = sha256(std::string_view(text).substr(begin, end - begin));
    ++lines_;
    begin = end + 1;
  }
  bytes_ += begin;
  if (begin == text.size()) return;
  if (head &&
      lines_ + 1 == head->lines) {  // a kill interrupted the newest line; refresh() appends it as a whole
    cut_private_file(log_, bytes_);
  } else {
    torn_ = true;
  }
}

void AuditTrail::refresh() {
  const std::optional<AuditHead> head = this->head();
  read_more(head);
  as_head_says_ = !head || (head->lines == lines_ && (lines_ == 0 || head->hash == hash_) && !torn_);
  if (as_head_says_ || torn_ || !head || lines_ + 1 != head->lines) return;
  const std::optional<ParsedLine> line = parse_line(head->line);
  if (!line || line->before != hash_ || sha256(head->line) != head->hash) return;
  append_private_file(log_, fmt::format("{}\n", head->line));
  bytes_ += head->line.size() + 1;
  ++lines_;
  hash_ = head->hash;
  as_head_says_ = true;
}

void AuditTrail::append(double utc, const std::string& account, const std::string& action,
                        const std::string& record, const std::string& detail) {
  refresh();
  const FileLock lock(heads_.string() + ".lock");
  Heads heads = Heads::read(heads_);
  const bool is_head_lost = lines_ > 0 && !heads.of.contains(id_);
  AuditHead& head = heads.of[id_];
  const std::uint64_t n = (as_head_says_ ? lines_ : head.lines) + 1;
  json line = {{"n", n},           {"time", utc_text(utc)}, {"account", account},
               {"action", action}, {"record", record},      {"before", as_head_says_ ? hash_ : head.hash}};
  if (!detail.empty()) line["detail"] = detail;
  if (is_head_lost) line["head"] = "missing";  // for good: lines may have been cut before it
  head.folder = folder_.string();
  head.lines = n;
  head.line = line.dump(-1, ' ', true, json::error_handler_t::replace);
  head.hash = sha256(head.line);
  heads.write(heads_);
  append_private_file(log_, fmt::format("{}{}\n", torn_ ? "\n" : "", head.line));
}

AuditCheck AuditTrail::check() {
  refresh();
  AuditCheck out;
  const Heads heads = Heads::read(heads_);
  for (const auto& [id, head] : heads.of)
    if (id != id_ && head.folder == folder_.string() && head.lines > 0)
      return broken(
          out, 1,
          fmt::format("an earlier registry of {} with {} audit lines is missing; restore its backup. If it "
                      "was removed on purpose, remove its entry {} in {}",
                      folder_.string(), head.lines, id, heads_.string()));
  const auto head = heads.of.find(id_);
  const std::string text = read_private_file(log_).value_or("");
  std::uint64_t expected = 1;
  std::string before = kFirst;
  std::string gaps;
  for (const std::string_view each : lines_of(text)) {
    ++out.lines;
    const std::optional<ParsedLine> line = parse_line(each);
    if (!line) return broken(out, expected, fmt::format("line {} of {} is damaged", expected, log_.string()));
    const std::uint64_t n = line->entry.n;
    if (n > expected && line->entry.action == "restore" && line->entry.detail == known_gap(expected, n - 1)) {
      gaps += fmt::format("; {}: a backup that was older was restored", line->entry.detail);
    } else if (n != expected) {
      return broken(out, expected,
                    fmt::format("line {} of {} is missing: line {} follows", expected, log_.string(), n));
    } else if (line->before != before) {
      const std::uint64_t changed = std::max<std::uint64_t>(1, expected - 1);
      return broken(out, changed, fmt::format("line {} of {} was changed", changed, log_.string()));
    }
    if (!line->had_head && line->entry.action != "restore")
      return broken(
          out, n,
          fmt::format("before line {} the head beside the keys was missing ({}): lines that were cut "
                      "from the end of the log cannot be told",
                      n, heads_.string()));
    if (!line->had_head)
      gaps += fmt::format("; line {}: a backup was restored beside keys without a head", n);
    before = sha256(each);
    expected = n + 1;
  }
  if (head == heads.of.end()) {
    if (out.lines > 0)
      return broken(
          out, expected,
          fmt::format("{} lines are chained, but their head is missing in {}: lines that were cut from "
                      "the end cannot be told; put back the copy of that file, or restore a backup",
                      out.lines, heads_.string()));
    out.whole = true;
    out.text = "the audit log is empty";
    return out;
  }
  if (expected - 1 < head->second.lines)
    return broken(out, expected,
                  fmt::format("lines {} to {} of {} are missing; restore a backup", expected,
                              head->second.lines, log_.string()));
  if (expected - 1 > head->second.lines)
    return broken(
        out, head->second.lines + 1,
        fmt::format("line {} of {} was not written by this program", head->second.lines + 1, log_.string()));
  if (head->second.lines > 0 && before != head->second.hash)
    return broken(out, expected - 1, fmt::format("line {} of {} was changed", expected - 1, log_.string()));
  out.whole = true;
  out.text = fmt::format("{} lines are whole, and end as the head beside the keys says{}", out.lines, gaps);
  return out;
}

std::vector<AuditEntry> AuditTrail::newest(std::size_t count) const {
  const std::string text = read_private_file(log_).value_or("");
  const std::vector<std::string_view> lines = lines_of(text);
  std::vector<AuditEntry> out;
  for (std::size_t i = lines.size() > count ? lines.size() - count : 0; i < lines.size(); ++i)
    if (std::optional<ParsedLine> line = parse_line(lines[i])) out.push_back(std::move(line->entry));
  return out;
}

void AuditTrail::set_accounts(std::uint64_t count) {
  const FileLock lock(heads_.string() + ".lock");
  Heads heads = Heads::read(heads_);
  AuditHead& head = heads.of[id_];
  if (head.folder.empty()) head.folder = folder_.string();
  if (head.hash.empty()) head.hash = hash_;
  head.accounts = count;
  heads.write(heads_);
}

bool AuditTrail::take_over(const std::string& log) {
  const std::string own = read_private_file(log_).value_or("");
  if (log.size() <= own.size() || log.compare(0, own.size(), own) != 0) return false;
  replace_private_file(log_, log);
  bytes_ = 0;
  lines_ = 0;
  hash_ = kFirst;
  refresh();
  return true;
}

bool AuditTrail::begins_with(const std::string& log) const {
  return read_private_file(log_).value_or("").starts_with(log);
}

std::uint64_t AuditTrail::lines() {
  refresh();
  return lines_;
}

void AuditTrail::set_id(std::string id) { id_ = std::move(id); }

}  // namespace phalanx::registry

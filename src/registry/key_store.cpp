// SPDX-License-Identifier: Apache-2.0
#include "phalanx/registry/key_store.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>
#include <utility>

#include "phalanx/registry/registry_error.h"
#include "registry/crypto.h"
#include "registry/private_file.h"

namespace phalanx {

/// Content of the key file, with the keys in the clear.
struct KeyFileContent {
  bool has_passphrase = false;
  std::string salt = {};
  Argon2Cost cost = {};
  registry::Key secret = {};  ///< of the store itself; its seal also proves that the master key is right
  std::map<std::string, registry::Key> keys = {};
  std::set<std::string> erased = {};
};

namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using registry::Key;

constexpr int kKeyFileFormat = 1;

fs::path beside(const fs::path& file, const char* ending) { return file.string() + ending; }

Key to_key(const std::string& bytes) {
  Key key{};
  if (bytes.size() != key.size()) throw std::invalid_argument("a key has 32 bytes");
  std::transform(bytes.begin(), bytes.end(), key.begin(),
                 [](char c) { return static_cast<unsigned char>(c); });
  return key;
}
std::string to_bytes(const Key& key) { return {key.begin(), key.end()}; }

[[noreturn]] void fail_damaged(const fs::path& file, const std::string& what) {
  throw RegistryError(
      RegistryFault::kDamaged,
      fmt::format("{}: {}; put back a copy of the key file and of its master key", file.string(), what));
}

std::string unhex(const fs::path& file, const std::string& text) {
  std::optional<std::string> bytes = registry::from_hex(text);
  if (!bytes) fail_damaged(file, "a key is not in hexadecimal digits");
  return std::move(*bytes);
}

/// Checks a cost that a file states: a damaged one must not take all memory.
Argon2Cost checked_cost(const fs::path& file, const Argon2Cost& cost) {
  constexpr std::uint32_t kMostMemory = 4U << 20U;
  if (cost.passes < 1 || cost.passes > 1000 || cost.lanes < 1 || cost.lanes > 64 ||
      cost.memory_kib < 8 * cost.lanes || cost.memory_kib > kMostMemory)
    fail_damaged(file, "the cost of its passphrase is out of range");
  return cost;
}

void require_id(const std::string& id) {
  if (!is_record_id(id))
    throw std::invalid_argument(
        fmt::format("the record id \"{}\" is not 32 hexadecimal digits in lower case", id));
}

std::string key_context(const std::string& id) { return fmt::format("phalanx key {}", id); }

std::string written(const KeyFileContent& content, const Key& master) {
  json out = {
      {"format", kKeyFileFormat},
      {"master", content.has_passphrase ? "passphrase" : "file"},
      {"secret", registry::to_hex(registry::seal(master, "phalanx secret", to_bytes(content.secret)))},
      {"keys", json::object()},
      {"erased", content.erased}};
  if (content.has_passphrase) {
    out["salt"] = registry::to_hex(content.salt);
    out["passes"] = content.cost.passes;
    out["memory_kib"] = content.cost.memory_kib;
    out["lanes"] = content.cost.lanes;
  }
  for (const auto& [id, key] : content.keys)
    out["keys"][id] = registry::to_hex(registry::seal(master, key_context(id), to_bytes(key)));
  return fmt::format("{}\n", out.dump(1));
}

Key read_master(const fs::path& file) {
  const fs::path name = beside(file, ".master");
  const std::optional<std::string> text = registry::read_private_file(name);
  if (!text) fail_damaged(name, "the master key is missing");
  const std::optional<std::string> bytes = registry::from_hex(text->substr(0, text->find('\n')));
  if (!bytes || bytes->size() != Key{}.size()) fail_damaged(name, "it does not hold a key");
  return to_key(*bytes);
}

/// Reads what needs no master key. @returns the whole as JSON, and the content without secrets
std::pair<json, KeyFileContent> read_plain_part(const fs::path& file, const std::string& text) {
  std::pair<json, KeyFileContent> out;
  try {
    out.first = json::parse(text);
    const int format = out.first.at("format").get<int>();
    if (format > kKeyFileFormat)
      throw RegistryError(RegistryFault::kNewer,
                          fmt::format("{} has format {}; this program knows {}: install a newer one",
                                      file.string(), format, kKeyFileFormat));
    KeyFileContent& content = out.second;
    content.has_passphrase = out.first.at("master").get<std::string>() == "passphrase";
    if (content.has_passphrase) {
      content.salt = unhex(file, out.first.at("salt").get<std::string>());
      if (content.salt.size() < 8) fail_damaged(file, "its salt is too short");
      content.cost = checked_cost(file, {.passes = out.first.at("passes").get<std::uint32_t>(),
                                         .memory_kib = out.first.at("memory_kib").get<std::uint32_t>(),
                                         .lanes = out.first.at("lanes").get<std::uint32_t>()});
    }
    content.erased = out.first.at("erased").get<std::set<std::string>>();
  } catch (const json::exception& error) {
    fail_damaged(file, fmt::format("it is no key file ({})", error.what()));
  }
  return out;
}

/// Opens the sealed part. @returns false if the master key is another one
bool read_sealed_part(const fs::path& file, const json& whole, const Key& master, KeyFileContent& content) {
  const auto open = [&](const std::string& context, const std::string& text) {
    return registry::open_sealed(master, context, unhex(file, text));
  };
  try {
    const std::optional<std::string> secret = open("phalanx secret", whole.at("secret").get<std::string>());
    if (!secret) return false;
    content.secret = to_key(*secret);
    for (const auto& [id, sealed] : whole.at("keys").get<std::map<std::string, std::string>>()) {
      const std::optional<std::string> key = open(key_context(id), sealed);
      if (!key || !is_record_id(id)) fail_damaged(file, fmt::format("the key of record {} is damaged", id));
      content.keys[id] = to_key(*key);
    }
  } catch (const json::exception& error) {
    fail_damaged(file, fmt::format("it is no key file ({})", error.what()));
  } catch (const std::invalid_argument& error) {
    fail_damaged(file, error.what());
  }
  return true;
}

}  // namespace

struct KeyStore::State {
  fs::path file;
  Key master{};
  KeyFileContent content;
  std::optional<registry::FileStamp> stamp;
  std::mutex mutex;

  ~State() {
    registry::wipe(master);
    registry::wipe(content.secret);
    for (auto& [id, key] : content.keys) registry::wipe(key);
  }

  [[nodiscard]] registry::FileLock lock() const {
    registry::make_private_folder(file.has_parent_path() ? file.parent_path() : fs::path("."));
    return registry::FileLock(beside(file, ".lock"));
  }

  /// Reads the file if it changed. @param passphrase  of the first reading; null: the master key is known
  void refresh(const std::string* passphrase = nullptr) {
    const std::optional<registry::FileStamp> now = registry::stamp_of(file);
    if (passphrase == nullptr && now == stamp) return;
    const std::optional<std::string> text = registry::read_private_file(file);
    if (!text)
      throw RegistryError(RegistryFault::kUnknown,
                          fmt::format("there is no key file {}; name another with --keys, or "
                                      "put back its copy",
                                      file.string()));
    auto [whole, next] = read_plain_part(file, *text);
    Key next_master = master;
    if (!next.has_passphrase) {
      next_master = read_master(file);
    } else if (passphrase != nullptr) {
      if (passphrase->empty())
        throw RegistryError(RegistryFault::kDamaged,
                            fmt::format("{} needs a passphrase; set PHALANX_PASSPHRASE", file.string()));
      next_master = registry::passphrase_key(*passphrase, next.salt, next.cost);
    } else if (!content.has_passphrase || next.salt != content.salt) {
      throw RegistryError(
          RegistryFault::kDamaged,
          fmt::format("the passphrase of {} was changed by another program; start this one again",
                      file.string()));
    }
    if (!read_sealed_part(file, whole, next_master, next))
      throw RegistryError(
          RegistryFault::kDamaged,
          next.has_passphrase
              ? fmt::format("{}: the passphrase is wrong; set PHALANX_PASSPHRASE", file.string())
              : fmt::format("{} belongs to another master key than {}.master; put back its copy",
                            file.string(), file.string()));
    master = next_master;
    content = std::move(next);
    stamp = now;
  }

  /// Writes the key file. The replaced one is overwritten: it has keys that may be erased later.
  void write() {
    registry::replace_private_file(file, written(content, master), true);
    stamp = registry::stamp_of(file);
  }

  /// Derives or makes the master key for a passphrase, or none.
  void choose_master(const std::string& passphrase, const Argon2Cost& cost) {
    content.has_passphrase = !passphrase.empty();
    if (content.has_passphrase) {
      content.salt = registry::random_bytes(16);
      content.cost = checked_cost(file, cost);
      master = registry::passphrase_key(passphrase, content.salt, cost);
      return;
    }
    const fs::path name = beside(file, ".master");
    if (registry::stamp_of(
            name)) {  // of a program that was killed before it wrote the key file, or of a lost key file
      master = read_master(file);
      return;
    }
    master = registry::random_key();
    registry::replace_private_file(name, fmt::format("{}\n", registry::to_hex(to_bytes(master))));
  }
};

KeyStore KeyStore::open(const fs::path& file, const std::string& passphrase) {
  auto state = std::make_shared<State>();
  state->file = fs::absolute(file).lexically_normal();
  if (registry::stamp_of(beside(state->file, ".old"))) {  // of a program that was killed
    const registry::FileLock lock = state->lock();
    registry::finish_replacement(state->file);
  }
  state->refresh(&passphrase);
  return KeyStore(std::move(state));
}

KeyStore KeyStore::create(const fs::path& file, const std::string& passphrase, const Argon2Cost& cost) {
  auto state = std::make_shared<State>();
  state->file = fs::absolute(file).lexically_normal();
  const registry::FileLock lock = state->lock();
  if (registry::stamp_of(state->file))
    throw RegistryError(RegistryFault::kConflict,
                        fmt::format("{} exists already; open it", state->file.string()));
  state->choose_master(passphrase, cost);
  state->content.secret = registry::random_key();
  state->write();
  return KeyStore(std::move(state));
}

RecordingKey KeyStore::add(const std::string& id) {
  require_id(id);
  const std::lock_guard guard(state_->mutex);
  const registry::FileLock lock = state_->lock();
  state_->refresh();
  if (state_->content.keys.contains(id) || state_->content.erased.contains(id))
    throw RegistryError(
        RegistryFault::kConflict,
        fmt::format("record id {} exists already, or was erased; take another random one", id));
  const Key key = registry::random_key();
  state_->content.keys[id] = key;
  try {
    state_->write();
  } catch (...) {
    state_->content.keys.erase(id);
    throw;
  }
  return key;
}

std::optional<RecordingKey> KeyStore::find(const std::string& id) const {
  const std::lock_guard guard(state_->mutex);
  try {
    state_->refresh();
  } catch (const std::exception&) {
    return std::nullopt;
  }
  const auto found = state_->content.keys.find(id);
  if (found == state_->content.keys.end()) return std::nullopt;
  return found->second;
}

void KeyStore::check() const {
  const std::lock_guard guard(state_->mutex);
  state_->refresh();
}

void KeyStore::erase(const std::string& id) {
  require_id(id);
  const std::lock_guard guard(state_->mutex);
  const registry::FileLock lock = state_->lock();
  state_->refresh();
  KeyFileContent before = state_->content;
  const bool had_key = state_->content.keys.erase(id) > 0;
  const bool is_new = state_->content.erased.insert(id).second;
  try {
    if (had_key || is_new) state_->write();
  } catch (...) {
    state_->content = std::move(before);
    state_->stamp.reset();  // read it again: the file may be the new one
    throw;
  }
  for (auto& [name, key] : before.keys) registry::wipe(key);
}

bool KeyStore::erased(const std::string& id) const {
  const std::lock_guard guard(state_->mutex);
  state_->refresh();
  return state_->content.erased.contains(id);
}

std::vector<std::string> KeyStore::ids() const {
  const std::lock_guard guard(state_->mutex);
  state_->refresh();
  std::vector<std::string> out;
  for (const auto& [id, key] : state_->content.keys) out.push_back(id);
  return out;
}

std::vector<std::string> KeyStore::erased_ids() const {
  const std::lock_guard guard(state_->mutex);
  state_->refresh();
  return {state_->content.erased.begin(), state_->content.erased.end()};
}

void KeyStore::change_passphrase(const std::string& passphrase, const Argon2Cost& cost) {
  const std::lock_guard guard(state_->mutex);
  const registry::FileLock lock = state_->lock();
  state_->refresh();
  KeyFileContent before = state_->content;
  const Key master_before = state_->master;
  try {
    state_->choose_master(passphrase, cost);
    state_->write();
  } catch (...) {
    state_->content = std::move(before);
    state_->master = master_before;
    if (state_->stamp) state_->stamp->changed_ns = 0;  // read it again: the file may be the new one
    throw;
  }
  if (!passphrase.empty()) registry::erase_private_file(beside(state_->file, ".master"));
}

bool KeyStore::needs_passphrase(const fs::path& file) {
  const std::optional<std::string> text = registry::read_private_file(file);
  return text && read_plain_part(file, *text).second.has_passphrase;
}

std::string KeyStore::keyed_hash(const std::string& text) const {
  const std::lock_guard guard(state_->mutex);
  return registry::keyed_hash(registry::derived_key(state_->content.secret, "phalanx keyed hash"), text);
}

std::string KeyStore::seal(const std::string& context, const std::string& text) const {
  const std::lock_guard guard(state_->mutex);
  return registry::seal(state_->content.secret, context, text);
}

std::optional<std::string> KeyStore::open_sealed(const std::string& context,
                                                 const std::string& sealed) const {
  const std::lock_guard guard(state_->mutex);
  return registry::open_sealed(state_->content.secret, context, sealed);
}

FindRecordingKey KeyStore::finder() const {
  return [store = *this](const std::string& id) { return store.find(id); };
}

const fs::path& KeyStore::file() const noexcept { return state_->file; }

fs::path default_keys_file() {
  const auto variable = [](const char* name) -> std::string {
    const char* value = std::getenv(name);  // NOLINT(concurrency-mt-unsafe)
    return value == nullptr ? std::string() : std::string(value);
  };
  if (const std::string file = variable("PHALANX_KEYS"); !file.empty()) return file;
  if (const std::string folder = variable("XDG_CONFIG_HOME"); !folder.empty())
    return fs::path(folder) / "phalanx" / "keys";
  return fs::path(variable("HOME")) / ".config" / "phalanx" / "keys";
}

bool is_record_id(const std::string& id) noexcept {
  return id.size() == RecordingEncryption::kIdLength && std::all_of(id.begin(), id.end(), [](char c) {
           return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f');
         });
}

}  // namespace phalanx

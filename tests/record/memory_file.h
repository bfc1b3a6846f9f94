// SPDX-License-Identifier: Apache-2.0
// A file in memory that remembers what was written and synchronised when, and what a loss of power leaves of it.
#pragma once

#include <cstdint>
#include <functional>
#include <random>
#include <string>
#include <system_error>
#include <vector>

#include "record/mcap/mcap_file.h"

namespace phalanx::test {

class MemoryFile final : public mcap::WritableFile {
 public:
  struct Operation {
    enum Kind { kWrite, kTruncate, kSynchronise } kind = kWrite;
    std::uint64_t place = 0;  ///< of a write; the size of a truncation
    std::string bytes;
    double time = 0.0;  ///< [s]
  };

  /// @param now  the time, for Operation::time; may be empty
  explicit MemoryFile(std::function<double()> now = {}) : now_(std::move(now)) {}

  void write(std::uint64_t place, std::string_view bytes) override {
    refuse_if_full("write");
    note(Operation::kWrite, place, std::string(bytes));
    apply(content, operations.back(), 0, bytes.size());
  }
  void synchronise() override {
    refuse_if_full("synchronise");
    note(Operation::kSynchronise, 0, {});
  }
  void truncate(std::uint64_t size) override {
    note(Operation::kTruncate, size, {});
    content.resize(static_cast<std::size_t>(size));
  }

  /// What is on the disk if the power fails after operation `at`: all that was synchronised before, and of what was not an
  /// arbitrary part, in pages of 4 KiB.
  [[nodiscard]] std::string after_power_loss(std::size_t at, std::mt19937_64& random) const {
    std::size_t synchronised = 0;
    for (std::size_t i = 0; i <= at; ++i)
      if (operations[i].kind == Operation::kSynchronise) synchronised = i;
    std::string disk;
    for (std::size_t i = 0; i <= at; ++i) {
      const Operation& operation = operations[i];
      if (operation.kind == Operation::kTruncate) {
        if (i <= synchronised || random() % 2 == 0) disk.resize(static_cast<std::size_t>(operation.place));
        continue;
      }
      constexpr std::size_t kPage = 4096;
      for (std::size_t part = 0; part < operation.bytes.size(); part += kPage)
        if (i <= synchronised || random() % 2 == 0)
          apply(disk, operation, part, std::min(kPage, operation.bytes.size() - part));
    }
    return disk;
  }

  std::string content;
  std::vector<Operation> operations;
  int refuses = 0;              ///< error number that writes fail with; 0: none
  std::function<void()> delay;  ///< called before each write and each synchronisation; may be empty

 private:
  static void apply(std::string& to, const Operation& operation, std::size_t part, std::size_t length) {
    const auto place = static_cast<std::size_t>(operation.place) + part;
    if (to.size() < place + length) to.resize(place + length);
    to.replace(place, length, operation.bytes, part, length);
  }
  void note(Operation::Kind kind, std::uint64_t place, std::string bytes) {
    operations.push_back(
        {.kind = kind, .place = place, .bytes = std::move(bytes), .time = now_ ? now_() : 0.0});
  }
  void refuse_if_full(const char* what) const {
    if (delay) delay();
    if (refuses != 0) throw std::system_error(refuses, std::generic_category(), what);
  }

  std::function<double()> now_;
};

}  // namespace phalanx::test

// SPDX-License-Identifier: Apache-2.0
#include "encryption.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "record/mcap/encrypted_file.h"
#include "record/mcap/mcap_reader.h"
#include "stopwatch.h"

namespace phalanx::bench {
namespace {

/// A file that keeps what is written in memory that it has already.
class KeptInMemory final : public mcap::WritableFile {
 public:
  explicit KeptInMemory(std::size_t most) { bytes_.reserve(most); }
  void write(std::uint64_t place, std::string_view bytes) override {
    bytes_.resize(static_cast<std::size_t>(place));
    bytes_.append(bytes);
  }
  void synchronise() override {}
  void truncate(std::uint64_t size) override { bytes_.resize(static_cast<std::size_t>(size)); }
  [[nodiscard]] const std::string& bytes() const noexcept { return bytes_; }

 private:
  std::string bytes_;
};

double part_of(std::vector<double>& values, double part) {
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(part * static_cast<double>(values.size() - 1))];
}

}  // namespace

void report_encryption(const std::filesystem::path& recording, int rounds) {
  const mcap::ReadableFile file(recording);
  const mcap::Summary summary = mcap::read_summary(file);
  std::vector<std::string> writes;
  std::uint64_t place = 0;
  for (const mcap::ChunkEntry& chunk : summary.chunks) {
    file.read(place, chunk.place - place, writes.emplace_back());
    place = chunk.place;
  }
  file.read(place, file.size() - place, writes.emplace_back());
  const RecordingEncryption encryption{.id = std::string(RecordingEncryption::kIdLength, 'a'), .key = {}};
  std::vector<double> encrypting;
  std::vector<double> decrypting;
  std::uint64_t encrypted_bytes = 0;
  for (int round = 0; round < rounds; ++round) {
    KeptInMemory disk(static_cast<std::size_t>(2 * file.size()));
    mcap::EncryptedFile encrypted(disk, encryption);
    place = 0;
    for (const std::string& write : writes) {
      const Stopwatch watch;
      encrypted.write(place, write);
      encrypting.push_back(watch.us());
      place += write.size();
    }
    encrypted_bytes = disk.bytes().size();
    const mcap::ReadableFile decrypted(mcap::InMemory{disk.bytes()},
                                       [&](const std::string&) { return std::optional(encryption.key); });
    place = 0;
    std::string part;
    for (const std::string& write : writes) {
      const Stopwatch watch;
      decrypted.read(place, write.size(), part);
      decrypting.push_back(watch.us());
      place += write.size();
    }
  }
  const auto bytes = static_cast<double>(file.size());
  fmt::print(
      "\nencrypted: {} frames of {:.0f} bytes; encrypting one takes {:.1f} us (median; 99 %: {:.1f}), "
      "decrypting {:.1f} ({:.1f}); {:.3f} % more bytes\n",
      writes.size(), bytes / static_cast<double>(writes.size()), part_of(encrypting, 0.5),
      part_of(encrypting, 0.99), part_of(decrypting, 0.5), part_of(decrypting, 0.99),
      100.0 * (static_cast<double>(encrypted_bytes) / bytes - 1.0));
}

}  // namespace phalanx::bench

// SPDX-License-Identifier: Apache-2.0
#include "phalanx/registry/key_store.h"

#include <gmock/gmock.h>

#include "registry/crypto.h"
#include "registry/registry_files.h"

namespace phalanx {
namespace {

using ::testing::ElementsAre;
using testing::fault_of;
using ::testing::IsEmpty;
using testing::RegistryFiles;

const std::string kId = "0123456789abcdef0123456789abcdef";
const std::string kOther = "ffffffffffffffffffffffffffffffff";

TEST(RegistryCrypto, EqualsPublishedValues) {
  EXPECT_EQ(registry::sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  registry::Key
      key{};  // RFC 4231, case 1, with its key of 20 bytes padded with zeros: HMAC pads it in the same way
  std::fill_n(key.begin(), 20, static_cast<unsigned char>(0x0b));
  EXPECT_EQ(registry::keyed_hash(key, "Hi There"),
            "b0344c61d8db38535ca8afceaf0bf12b881dc200c9833da726e9376c2e32cff7");
}

TEST(RegistryCrypto, OpensWhatItSealedAndNothingElse) {
  const registry::Key key = registry::random_key();
  const std::string sealed = registry::seal(key, "place", "text");
  EXPECT_EQ(registry::open_sealed(key, "place", sealed), "text");
  EXPECT_EQ(registry::open_sealed(key, "place", registry::seal(key, "place", "")), "");
  EXPECT_EQ(registry::open_sealed(key, "another place", sealed), std::nullopt);
  EXPECT_EQ(registry::open_sealed(registry::random_key(), "place", sealed), std::nullopt);
  EXPECT_NE(registry::seal(key, "place", "text"), sealed) << "the nonce is random";
  for (std::size_t i = 0; i < sealed.size(); ++i) {
    std::string changed = sealed;
    changed[i] = static_cast<char>(changed[i] ^ 1);
    EXPECT_EQ(registry::open_sealed(key, "place", changed), std::nullopt) << "byte " << i;
    EXPECT_EQ(registry::open_sealed(key, "place", sealed.substr(0, i)), std::nullopt) << "length " << i;
  }
}

TEST(KeyStore, KeepsAKeyUntilItIsErased) {
  RegistryFiles files;
  RecordingKey key{};
  {
    KeyStore keys = files.keys();
    key = keys.add(kId);
    EXPECT_EQ(fault_of([&] { keys.add(kId); }), RegistryFault::kConflict);
    EXPECT_THROW(keys.add("P07"), std::invalid_argument);
    EXPECT_EQ(keys.find(kOther), std::nullopt);
  }
  KeyStore keys = KeyStore::open(files.keys_file());
  const FindRecordingKey find = keys.finder();
  EXPECT_EQ(find(kId), key);
  EXPECT_THAT(keys.ids(), ElementsAre(kId));
  keys.erase(kId);
  EXPECT_EQ(find(kId), std::nullopt);
  EXPECT_TRUE(keys.erased(kId));
  EXPECT_EQ(fault_of([&] { keys.add(kId); }), RegistryFault::kConflict) << "an erased id must not come back";
  EXPECT_THAT(KeyStore::open(files.keys_file()).ids(), IsEmpty());
  EXPECT_THAT(KeyStore::open(files.keys_file()).erased_ids(), ElementsAre(kId));
}

TEST(KeyStore, OverwritesTheOldFileWhenItErasesAKey) {
  RegistryFiles files;
  KeyStore keys = files.keys();
  keys.add(kId);
  const std::string old = testing::read_file(files.keys_file());
  std::filesystem::create_hard_link(files.keys_file(), files.path("second name of the old file"));
  keys.erase(kId);
  const std::string overwritten = testing::read_file(files.path("second name of the old file"));
  ASSERT_EQ(overwritten.size(), old.size());
  std::size_t same = 0;
  for (std::size_t i = 0; i < old.size(); ++i) same += old[i] == overwritten[i] ? 1U : 0U;
  EXPECT_LT(same, old.size() / 10) << "random bytes equal 1 in 256";
}

TEST(KeyStore, SeesWhatAnotherProgramDid) {
  RegistryFiles files;
  KeyStore first = files.keys();
  KeyStore second = KeyStore::open(files.keys_file());
  const RecordingKey key = first.add(kId);
  EXPECT_EQ(second.find(kId), key);
  second.add(kOther);
  second.erase(kId);
  EXPECT_EQ(first.find(kId), std::nullopt);
  EXPECT_THAT(first.ids(), ElementsAre(kOther));
}

TEST(KeyStore, HasFilesThatOthersCannotRead) {
  RegistryFiles files;
  KeyStore keys = files.keys();
  keys.add(kId);
  keys.erase(kId);
  EXPECT_THAT(testing::open_to_others(files.path("config")), IsEmpty());
}

TEST(KeyStore, IsUselessWithoutItsMasterKey) {
  RegistryFiles files;
  files.keys().add(kId);
  std::filesystem::rename(files.path("config/keys.master"), files.path("master"));
  EXPECT_EQ(fault_of([&] { static_cast<void>(KeyStore::open(files.keys_file())); }), RegistryFault::kDamaged);
  testing::write_bytes(files.path("config/keys.master"), std::string(64, 'a') + "\n");
  EXPECT_EQ(fault_of([&] { static_cast<void>(KeyStore::open(files.keys_file())); }), RegistryFault::kDamaged);
}

TEST(KeyStore, IsUselessWithoutItsPassphrase) {
  RegistryFiles files;
  const std::filesystem::path file = files.keys_file();
  const RecordingKey key = KeyStore::create(file, "a long passphrase", Argon2Cost::least()).add(kId);
  EXPECT_FALSE(std::filesystem::exists(files.path("config/keys.master")));
  EXPECT_EQ(fault_of([&] { static_cast<void>(KeyStore::open(file)); }), RegistryFault::kDamaged);
  EXPECT_EQ(fault_of([&] { static_cast<void>(KeyStore::open(file, "another")); }), RegistryFault::kDamaged);
  KeyStore keys = KeyStore::open(file, "a long passphrase");
  EXPECT_EQ(keys.find(kId), key);
  keys.change_passphrase("");
  EXPECT_EQ(KeyStore::open(file).find(kId), key);
  keys.change_passphrase("a new one", Argon2Cost::least());
  EXPECT_EQ(KeyStore::open(file, "a new one").find(kId), key);
  EXPECT_FALSE(std::filesystem::exists(files.path("config/keys.master")));
}

TEST(KeyStore, RefusesEveryDamagedFileInWords) {
  RegistryFiles files;
  files.keys().add(kId);
  const std::string whole = testing::read_file(files.keys_file());
  for (std::size_t length = 0; length < whole.size() - 3; length += 7) {
    testing::write_bytes(files.keys_file(), whole.substr(0, length));
    EXPECT_EQ(fault_of([&] { static_cast<void>(KeyStore::open(files.keys_file())); }),
              RegistryFault::kDamaged)
        << length;
  }
  std::string newer = whole;
  newer.replace(newer.find("\"format\": 1"), 11, "\"format\": 2");
  testing::write_bytes(files.keys_file(), newer);
  EXPECT_EQ(fault_of([&] { static_cast<void>(KeyStore::open(files.keys_file())); }), RegistryFault::kNewer);
  EXPECT_EQ(fault_of([&] { static_cast<void>(KeyStore::open(files.path("none"))); }),
            RegistryFault::kUnknown);
}

}  // namespace
}  // namespace phalanx

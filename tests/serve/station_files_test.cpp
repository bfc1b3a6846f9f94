// SPDX-License-Identifier: Apache-2.0
#include "serve/station_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <future>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "record/mcap/mcap_reader.h"
#include "record/mcap/mcap_writer.h"
#include "record/recording/topics.h"
#include "record/stored_recording.h"
#include "record/temporary_folder.h"

namespace phalanx {
namespace {

using test::test_encryption;
using test::test_keys;
using ::testing::AllOf;
using ::testing::HasSubstr;

class EncryptedFilesOfStation : public ::testing::Test {
 protected:
  static WebResponse asked(StationFiles& files, const std::string& path, const std::string& query,
                           const std::string& range, const std::string& session = "") {
    WebRequest request;
    request.session = session;
    request.method = "GET";
    request.path = path;
    request.query = query;
    request.range = range;
    request.client.may_operate = true;
    std::promise<WebResponse> response;
    files.request(request, [&](WebResponse given) { response.set_value(std::move(given)); });
    return response.get_future().get();
  }
  /// Keys for requests with a session alone.
  static RecordingAccess access(const WebRequest& request) {
    if (request.session == "none") return {.keys = {}, .refusal = "sign in first"};
    return {.keys = test_keys(), .refusal = {}};
  }
  WebResponse part(StationFiles& files, const std::string& query, const std::string& range) const {
    return asked(files, "/recordings/" + name_, query, range);
  }

  const testing::TemporaryFolder folder_;
  const std::string name_ = "2026-11-28T10-00-00Z.mcap.enc";
  const std::shared_ptr<StationFiles> with_ = std::make_shared<StationFiles>(folder_.path(), access);
  const std::shared_ptr<StationFiles> without_ = std::make_shared<StationFiles>(folder_.path());
};

TEST_F(EncryptedFilesOfStation, AreReadDecryptedWhileTheyAreWrittenAndAfterwards) {
  mcap::DiskFile disk(folder_ / name_);
  mcap::EncryptedFile encrypted(disk, test_encryption());
  mcap::McapWriter writer(encrypted, recording_schemas(), recording_channels(),
                          {{"phalanx", {{"version", "9"}}}});
  const auto write = [&](std::uint64_t second) {
    writer.add(static_cast<std::uint16_t>(Topic::kEvent), second * 1'000'000'000, "");
    writer.write_chunk();
  };
  write(5);
  write(6);
  const std::uint64_t until = writer.size();
  write(7);
  const WebResponse open = part(*with_, "until=" + std::to_string(until), "bytes=0-9999999");
  ASSERT_EQ(open.status, 206) << *open.body;
  const mcap::ReadableFile read(mcap::InMemory{*open.body});
  EXPECT_FALSE(read.encrypted());
  EXPECT_EQ(mcap::read_summary(read).chunks.size(), 2U);
  writer.finish();
  const WebResponse whole = part(*with_, "", "bytes=0-9999999");
  ASSERT_EQ(whole.status, 206);
  EXPECT_EQ(mcap::read_summary(mcap::ReadableFile(mcap::InMemory{*whole.body})).chunks.size(), 3U);
  EXPECT_EQ(whole.content_range,
            "bytes 0-" + std::to_string(whole.body->size() - 1) + "/" + std::to_string(whole.body->size()));
  EXPECT_EQ(*part(*with_, "", "bytes=100-149").body, whole.body->substr(100, 50));
}

TEST_F(EncryptedFilesOfStation, AreRefusedInWordsWithoutTheirKey) {
  {
    mcap::DiskFile disk(folder_ / name_);
    mcap::EncryptedFile encrypted(disk, test_encryption());
    mcap::McapWriter writer(encrypted, recording_schemas(), recording_channels(),
                            {{"phalanx", {{"version", "9"}}}});
    writer.add(static_cast<std::uint16_t>(Topic::kEvent), 5'000'000'000, "");
    writer.finish();
  }
  const WebResponse refused = part(*without_, "", "bytes=0-99");
  EXPECT_EQ(refused.status, 409);
  EXPECT_THAT(*refused.body, AllOf(HasSubstr("is encrypted"), HasSubstr(test_encryption().id)));
  const auto listed = [&](StationFiles& files) {
    return nlohmann::json::parse(*asked(files, "/recordings", "", "").body)["recordings"];
  };
  ASSERT_EQ(listed(*without_).size(), 1U);
  EXPECT_EQ(listed(*without_)[0]["opens"], false);
  EXPECT_EQ(listed(*without_)[0]["state"], "encrypted, no key");
  EXPECT_EQ(listed(*with_)[0]["opens"], true);
  EXPECT_EQ(listed(*with_)[0]["events"], 1);
  // The same object answers a request without keys after one with them.
  const auto other = nlohmann::json::parse(*asked(*with_, "/recordings", "", "", "none").body)["recordings"];
  EXPECT_EQ(other[0]["state"], "encrypted, no key") << "nothing of what was read with the key";
  EXPECT_EQ(other[0]["events"], 0);
  const WebResponse locked = asked(*with_, "/recordings/" + name_, "", "bytes=0-99", "none");
  EXPECT_EQ(locked.status, 409);
  EXPECT_THAT(*locked.body, HasSubstr("sign in first"));
}

}  // namespace
}  // namespace phalanx

// SPDX-License-Identifier: Apache-2.0
// HTTP requests of pages: a stop, the geometry, an upload. See docs/cockpit.md.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <future>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "phalanx/geometry.pb.h"
#include "phalanx/mesh/import_cache.h"
#include "record/mcap/mcap_reader.h"
#include "record/mcap/mcap_writer.h"
#include "record/recording/topics.h"
#include "serve/cockpit_fixture.h"

namespace phalanx {
namespace {

using namespace test;
using ::testing::HasSubstr;
using ::testing::Not;
using CockpitHttp = CockpitTest;

TEST_F(CockpitHttp, AStopMayAlsoBeAPost) {
  Page page(port(), "", "Anna");
  EXPECT_EQ(status_of(post("/stop", "")), 200);
  EXPECT_TRUE(session_->held_stopped());
  EXPECT_EQ(page.notice("stopped").who(), "a page (127.0.0.1)");
  EXPECT_EQ(status_of(post("/stop", "", "X-Phalanx-Page: " + page.welcome.secret() + "\r\n")), 200);
  EXPECT_EQ(page.notice("stopped").who(), "page 1 (127.0.0.1), Anna");
  EXPECT_EQ(status_of(ask(port(), get("/stop"))), 405) << "a link cannot stop";
  EXPECT_EQ(status_of(post("/resume", "")), 404);
  EXPECT_TRUE(session_->held_stopped());
}

TEST_F(CockpitHttp, AMarkerIsToldAndLoggedUnlessAViewerSendsIt) {
  Page page(port());
  EXPECT_EQ(status_of(post("/marker", "stimulus 3\n")), 200);
  const wire::Notice notice = page.notice("marker");
  EXPECT_EQ(notice.who(), "127.0.0.1");
  EXPECT_THAT(notice.text(), HasSubstr("stimulus 3"));
  EXPECT_EQ(status_of(post("/marker", "")), 400);
  EXPECT_EQ(status_of(post("/marker", std::string(Cockpit::kMarkerLimit + 1, 'a'))), 413);
  EXPECT_EQ(status_of(ask(port(), get("/marker"))), 405);
  serve("operators-own-token", "viewers-own-token");
  EXPECT_EQ(status_of(post("/marker?token=viewers-own-token", "stimulus 4")) / 100, 4);
  EXPECT_EQ(status_of(post("/marker?token=operators-own-token", "stimulus 4")), 200);
}

TEST_F(CockpitHttp, TheReportOfTheNewestFaultIsReadByWhoMayOperate) {
  EXPECT_EQ(status_of(ask(port(), get("/report"))), 404);  // no fault
  const std::filesystem::path report = folder_ / "report.json";
  std::ofstream(report) << R"({"fault": "sensor_jump"})";
  cockpit_->fault_reported(report.string(), 12.5);
  const std::string answer = ask(port(), get("/report"));
  EXPECT_EQ(status_of(answer), 200);
  EXPECT_EQ(body_of(answer), R"({"fault": "sensor_jump"})");
  EXPECT_THAT(field_of(answer, "Content-Type"), HasSubstr("application/json"));
  EXPECT_EQ(status_of(post("/report", "")), 405);
  std::filesystem::remove(report);
  EXPECT_EQ(status_of(ask(port(), get("/report"))), 500);
  serve("operators-own-token", "viewers-own-token");
  const auto asked_as = [&](const std::string& token) {
    const std::string cookie = "Cookie: phalanx-" + std::to_string(port()) + "=" + token + "\r\n";
    return status_of(ask(port(), get("/report", cookie)));
  };
  EXPECT_EQ(asked_as("viewers-own-token"), 403);
  EXPECT_NE(asked_as("operators-own-token"), 403);
}

TEST_F(CockpitHttp, ARecordingThatIsBeingWrittenIsReadAsItWas) {
  std::filesystem::create_directory(folder_ / "recordings");
  const std::filesystem::path file = folder_ / "recordings/2026-11-28T10-00-00Z.mcap";
  mcap::DiskFile disk(file);
  mcap::McapWriter writer(disk, recording_schemas(), recording_channels(), {{"phalanx", {{"version", "9"}}}});
  const auto write = [&](std::uint64_t second) {
    writer.add(static_cast<std::uint16_t>(Topic::kEvent), second * 1'000'000'000, "");
    writer.write_chunk();
  };
  write(5);
  write(6);
  const std::uint64_t until = writer.size();
  write(7);
  const auto part = [&](const std::string& query, const std::string& range) {
    return ask(port(),
               get("/recordings/2026-11-28T10-00-00Z.mcap?" + query, "Range: bytes=" + range + "\r\n"));
  };
  const std::string query = "until=" + std::to_string(until);
  const std::string bytes = body_of(part(query, "0-9999999"));
  const mcap::ReadableFile read(mcap::InMemory{bytes});
  EXPECT_EQ(field_of(part(query, "0-9"), "Content-Range"), "bytes 0-9/" + std::to_string(bytes.size()));
  ASSERT_TRUE(mcap::has_end(read));
  EXPECT_EQ(mcap::read_summary(read).chunks.size(), 2U);
  mcap::McapReader reader(read);
  mcap::Message message;
  std::uint64_t last = 0;
  while (reader.next(message)) last = message.time;
  EXPECT_EQ(last, 6'000'000'000U);
  for (const std::uint64_t from : {until - 5, until, until + 5}) {  // over the place where the end begins
    const std::string range = std::to_string(from) + "-" + std::to_string(from + 9);
    EXPECT_EQ(body_of(part(query, range)), bytes.substr(from, 10)) << range;
  }
  EXPECT_EQ(status_of(part(query, "9999999-10000000")), 416);
  EXPECT_EQ(status_of(part("until=", "0-9")), 400);
  EXPECT_EQ(status_of(part("until=-1", "0-9")), 400);
  EXPECT_EQ(status_of(part("since=3", "0-9")), 400);
  EXPECT_EQ(status_of(part("until=9999999", "0-9")), 409);
}

TEST_F(CockpitHttp, RecordingsAreListedAndReadInPartsByWhoMayOperate) {
  std::filesystem::create_directory(folder_ / "recordings");
  const std::filesystem::path file = folder_ / "recordings/2026-11-27T14-03-11Z.mcap";
  {
    mcap::DiskFile disk(file);
    mcap::McapWriter writer(disk, recording_schemas(), recording_channels(),
                            {{"phalanx", {{"version", "9"}}}});
    writer.add(static_cast<std::uint16_t>(Topic::kEvent), 5'000'000'000, "");
    writer.add(static_cast<std::uint16_t>(Topic::kEvent), 7'500'000'000, "");
    writer.finish();
  }
  std::ofstream(folder_ / "recordings/cut.mcap") << read_file(file).substr(0, 200);
  std::ofstream(folder_ / "secret.mcap") << "outside";
  const auto all = nlohmann::json::parse(body_of(ask(port(), get("/recordings"))))["recordings"];
  ASSERT_EQ(all.size(), 2U);
  const auto& whole = all[0]["name"] == "cut.mcap" ? all[1] : all[0];
  EXPECT_EQ(whole["name"], "2026-11-27T14-03-11Z.mcap");
  EXPECT_EQ(whole["state"], "whole");
  EXPECT_EQ(whole["opens"], true);
  EXPECT_EQ(all[all[0]["name"] == "cut.mcap" ? 0 : 1]["opens"], false);
  EXPECT_EQ(whole["begin"], 5.0);
  EXPECT_EQ(whole["seconds"], 2.5);
  EXPECT_EQ(whole["events"], 2);
  const std::string bytes = read_file(file);
  const std::string path = "/recordings/2026-11-27T14-03-11Z.mcap";
  const auto part = [&](const std::string& range) {
    return ask(port(), get(path, "Range: " + range + "\r\n"));
  };
  EXPECT_EQ(status_of(part("bytes=10-29")), 206);
  EXPECT_EQ(body_of(part("bytes=10-29")), bytes.substr(10, 20));
  EXPECT_EQ(field_of(part("bytes=10-29"), "Content-Range"), "bytes 10-29/" + std::to_string(bytes.size()));
  EXPECT_EQ(body_of(part("bytes=10-999999")), bytes.substr(10));
  EXPECT_EQ(status_of(part("bytes=999999-1000000")), 416);
  for (const char* bad : {"", "bytes=9-", "bytes=-5", "bytes=9-3", "bytes=1-2,5-6", "bytes=0-16777216",
                          "lines=1-2", "bytes=99999999999999999999-1"})
    EXPECT_EQ(status_of(part(bad)), 400) << bad;
  EXPECT_EQ(status_of(ask(port(), get("/recordings/none.mcap", "Range: bytes=0-9\r\n"))), 404);
  EXPECT_EQ(status_of(ask(port(), get("/recordings/../secret.mcap", "Range: bytes=0-3\r\n"))) / 100, 4);
  EXPECT_EQ(status_of(ask(port(), get("/recordings/%2e%2e/secret.mcap", "Range: bytes=0-3\r\n"))) / 100, 4);
  EXPECT_EQ(status_of(post("/recordings", "")) / 100, 4);
  serve("operators-own-token", "viewers-own-token");
  const auto asked_as = [&](const std::string& token, const std::string& path_asked) {
    const std::string cookie = "Cookie: phalanx-" + std::to_string(port()) + "=" + token + "\r\n";
    return status_of(ask(port(), get(path_asked, cookie + "Range: bytes=0-9\r\n")));
  };
  EXPECT_EQ(asked_as("viewers-own-token", "/recordings"), 403);
  EXPECT_EQ(asked_as("viewers-own-token", path), 403);
  EXPECT_EQ(asked_as("operators-own-token", "/recordings"), 200);
  EXPECT_EQ(asked_as("operators-own-token", path), 206);
}

TEST_F(CockpitHttp, TheGeometryIsFetchedByItsRevision) {
  Page page(port());
  const std::string answer = ask(port(), get("/geometry/1"));
  ASSERT_EQ(status_of(answer), 200);
  wire::Geometry geometry;
  ASSERT_TRUE(geometry.ParseFromString(body_of(answer)));
  EXPECT_EQ(geometry.revision(), 1U);
  EXPECT_GT(geometry.object().position_size(), 0);
  for (const std::string wrong : {"2", "", "1x", "../1", "-1", "01", "99999999999999999999"})
    EXPECT_EQ(status_of(ask(port(), get("/geometry/" + wrong))) / 100, 4) << wrong;
  wire::ToHost scene;
  scene.mutable_scene()->set_name("pinch_ball");
  EXPECT_TRUE(page.ask(scene).ok());
  page.until([](const wire::State& s) { return s.geometry() == 2; });
  ASSERT_TRUE(geometry.ParseFromString(body_of(ask(port(), get("/geometry/2")))));
  EXPECT_EQ(geometry.revision(), 2U) << "not the cached one";
}

TEST_F(CockpitHttp, AViewerMayNotUploadEvenWithTheOperatorsSecret) {
  const Page page(port());
  WebRequest request;
  request.method = "POST";
  request.path = "/mesh";
  request.page_secret = page.welcome.secret();
  request.client.may_operate = false;
  std::promise<int> status;
  std::size_t limit_of_viewer = 1;
  std::size_t limit_of_operator = 0;
  server_->post([&] {
    limit_of_viewer = cockpit_->body_limit(request);
    WebRequest operators = request;
    operators.client.may_operate = true;
    limit_of_operator = cockpit_->body_limit(operators);
    cockpit_->requested(request, [&](const WebResponse& answer) { status.set_value(answer.status); });
  });
  EXPECT_EQ(status.get_future().get(), 403);
  EXPECT_EQ(limit_of_viewer, 0U);
  EXPECT_EQ(limit_of_operator, Cockpit::kUploadLimit);
}

TEST_F(CockpitHttp, TheOperatorUploadsAMeshAndUsesIt) {
  Page page(port());
  Page other(port());
  const std::string mesh = "v 0 0 0\nv 60 0 0\nv 0 60 0\nv 0 0 60\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";
  const std::string mine = "X-Phalanx-Page: " + page.welcome.secret() + "\r\n";
  const std::string theirs = "X-Phalanx-Page: " + other.welcome.secret() + "\r\n";
  // Refused by the head: the body of a client that may not upload is not read.
  EXPECT_EQ(status_of(post("/mesh?name=a.obj&unit=mm", mesh)), 413);
  EXPECT_EQ(status_of(post("/mesh?name=a.obj&unit=mm", mesh, theirs)), 413);
  EXPECT_EQ(status_of(post("/mesh?name=a.obj&unit=mile", mesh, mine)), 400);
  const auto bad = nlohmann::json::parse(body_of(post("/mesh?name=b.obj", "not a mesh", mine)));
  EXPECT_FALSE(bad["ok"].get<bool>());
  const auto good =
      nlohmann::json::parse(body_of(post("/mesh?token=geheim&name=../a.obj&unit=mm", mesh, mine)));
  ASSERT_TRUE(good["ok"].get<bool>()) << good.dump();
  const wire::Notice told = other.notice("upload");
  EXPECT_THAT(log_text(), Not(HasSubstr("geheim")));
  EXPECT_EQ(told.who(), "page 1 (127.0.0.1)");
  wire::ToHost set;
  const auto lay = [&](const std::string& key, const std::string& value) {
    auto& setting = *set.mutable_set()->add_setting();
    setting.set_key(key);
    setting.set_value(value);
  };
  lay("objects.0", "{kind = \"file\", file = \"" + good["file"].get<std::string>() +
                       "\", size_mm = 0, unit = \"mm\", position_mm = [0, 400, 0]}");
  const wire::Reply reply = page.ask(set);
  EXPECT_TRUE(reply.ok()) << reply.error();
  EXPECT_EQ(session_->imports()->misses(), 0U) << "the upload's import is used";
  EXPECT_EQ(session_->imports()->hits(), 1U);
  EXPECT_FALSE(page.set("objects.0.file", "/etc/passwd").ok());
}

TEST_F(CockpitHttp, MayEndWhileChangesWaitWhichAreAnsweredAfterItsEnd) {
  Page page(port());
  owner_.reset();  // nothing is answered
  for (std::uint32_t request : {101U, 102U}) {
    wire::ToHost scene;
    scene.mutable_scene()->set_name("pinch_ball");
    scene.set_request(request);
    page.send(scene);
  }
  EXPECT_TRUE(page.ask(to_take()).ok()) << "the requests before it have been passed on";
  server_.reset();
  EXPECT_EQ(page.client().receive_until_closed().code(), 1001);
  cockpit_.reset();
  // Answers come in order: once this one has come, those to the destroyed cockpit have come too.
  int answers = 0;
  session_->load_scene("pinch_ball", [&answers](const ChangeOutcome&) { ++answers; });
  while (answers == 0) {
    session_->poll();
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  EXPECT_EQ(session_->info()->scene, "pinch_ball");
}

TEST_F(CockpitHttp, AStopIsAppliedWhenAllConnectionsAreInUse) {
  std::vector<std::unique_ptr<Page>> pages;
  for (std::size_t i = 0; i < WebServerSettings{}.connections; ++i)
    pages.push_back(std::make_unique<Page>(port()));
  EXPECT_EQ(status_of(PageClient(port()).handshake()), 503);
  EXPECT_EQ(status_of(post("/stop", "")), 200);
  EXPECT_TRUE(session_->held_stopped());
}

/// File with a lease: a program that opens it for writing waits until this object is destroyed (45
/// s at most).
class HeldFile {
 public:
  explicit HeldFile(const std::filesystem::path& file) {
    std::ofstream(file) << "held";
    descriptor_ = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
    opened = ::eventfd(0, EFD_CLOEXEC);
    std::signal(SIGIO, [](int) { static_cast<void>(::eventfd_write(opened, 1)); });
    held_ = ::fcntl(descriptor_, F_SETLEASE, F_RDLCK) == 0;
  }
  ~HeldFile() {
    ::close(descriptor_);
    std::signal(SIGIO, SIG_DFL);
    ::close(opened);
  }
  HeldFile(const HeldFile&) = delete;
  HeldFile& operator=(const HeldFile&) = delete;

  [[nodiscard]] bool is_held() const { return held_; }
  /// @returns true once a program waits
  [[nodiscard]] static bool is_waited_for() {
    pollfd begun{.fd = opened, .events = POLLIN, .revents = 0};
    int count = 0;
    while ((count = ::poll(&begun, 1, 300'000)) < 0 && errno == EINTR) {
    }
    return count == 1;
  }

 private:
  static inline int opened = -1;
  int descriptor_ = -1;
  bool held_ = false;
};

TEST_F(CockpitHttp, AnUploadThatIsStuckDoesNotDelayTheEnd) {
  Page page(port());
  std::string mesh = "v 0 0 0\nv 60 0 0\nv 0 60 0\nv 0 0 60\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";
  const std::string mine = "X-Phalanx-Page: " + page.welcome.secret() + "\r\n";
  const auto good = nlohmann::json::parse(body_of(post("/mesh?name=a.obj&unit=mm", mesh, mine)));
  ASSERT_TRUE(good["ok"].get<bool>()) << good.dump();
  page.notice("upload");
  const std::filesystem::path folder = std::filesystem::path(good["file"].get<std::string>()).parent_path();
  constexpr int kOlder = 60;  // more than are kept
  for (int i = 0; i < kOlder; ++i)
    std::ofstream(folder / ("old-" + std::string(14, '0') + std::to_string(10 + i) + ".obj")) << "older";
  // The next upload cannot open its temporary file until the lease ends.
  const std::filesystem::path file = good["file"].get<std::string>();
  std::filesystem::remove(file);
  auto lease = std::make_unique<HeldFile>(file.string() + ".partial");
  if (!lease->is_held()) GTEST_SKIP() << "no leases on this file system";
  RawClient line(port());
  line.send("POST /mesh?name=a.obj&unit=mm HTTP/1.1\r\nHost: 127.0.0.1\r\nOrigin: http://127.0.0.1\r\n" +
            mine + "Content-Length: " + std::to_string(mesh.size()) + "\r\n\r\n" + mesh);
  page.notice("upload");
  ASSERT_TRUE(HeldFile::is_waited_for()) << "no file is opened";
  EXPECT_EQ(status_of(post("/mesh?name=c.obj&unit=mm", mesh, mine)), 429) << "one at a time";
  owner_.reset();
  server_.reset();
  cockpit_.reset();  // hangs if it waits
  EXPECT_FALSE(std::filesystem::exists(file));
  lease.reset();
  for (int i = 0; i < 10'000 && !std::filesystem::exists(file); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  EXPECT_EQ(std::filesystem::file_size(file), mesh.size()) << "it was still being written";
  std::this_thread::sleep_for(std::chrono::milliseconds(1));  // of the held clock: the upload has ended then
  int older = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    older += entry.path().filename().string().starts_with("old-") ? 1 : 0;
  EXPECT_EQ(older, kOlder) << "abandoned work removes nothing";
}

}  // namespace
}  // namespace phalanx

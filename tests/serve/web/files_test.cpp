// SPDX-License-Identifier: Apache-2.0
// Responses to requests for files.
#include <gmock/gmock.h>
#include <zlib.h>

#include "serve/web/web_fixture.h"

namespace phalanx {
namespace {

using testing::HasSubstr;
using testing::Not;

class WebFiles : public WebTest {};

std::string unpacked(const std::string& bytes) {
  z_stream stream{};
  EXPECT_EQ(inflateInit2(&stream, MAX_WBITS + 16), Z_OK);
  std::string in = bytes;
  std::string out(1 << 20, '\0');
  stream.next_in = reinterpret_cast<Bytef*>(in.data());
  stream.avail_in = static_cast<uInt>(in.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  EXPECT_EQ(inflate(&stream, Z_FINISH), Z_STREAM_END);
  out.resize(stream.total_out);
  inflateEnd(&stream);
  return out;
}

TEST_F(WebFiles, TheIndexIsServedAtTheRootAndAlwaysRevalidated) {
  start();
  const std::string answer = ask(get("/"));
  EXPECT_EQ(status_of(answer), 200);
  EXPECT_EQ(field_of(answer, "Content-Type"), "text/html; charset=utf-8");
  EXPECT_EQ(field_of(answer, "Cache-Control"), "no-cache");
  EXPECT_EQ(body_of(answer), "<!doctype html><title>hand</title>\n");
}

TEST_F(WebFiles, ThePatientsScreenHasAnAddressWithoutAnEnding) {
  start();
  EXPECT_EQ(status_of(ask(get("/patient"))), 404);  // this front-end has none
  server_.reset();
  write("site/patient.html", "<!doctype html><title>exercise</title>\n");
  start();
  const std::string answer = ask(get("/patient"));
  EXPECT_EQ(status_of(answer), 200);
  EXPECT_EQ(field_of(answer, "Content-Type"), "text/html; charset=utf-8");
  EXPECT_EQ(body_of(answer), body_of(ask(get("/patient.html"))));
  EXPECT_EQ(status_of(ask(get("/patient/"))), 404);
}

TEST_F(WebFiles, HashedAssetsMayBeCached) {
  start();
  const std::string answer = ask(get("/assets/app-1a2b.js"));
  EXPECT_EQ(status_of(answer), 200);
  EXPECT_EQ(field_of(answer, "Content-Type"), "text/javascript; charset=utf-8");
  EXPECT_THAT(field_of(answer, "Cache-Control"), HasSubstr("immutable"));
  EXPECT_EQ(field_of(answer, "Content-Encoding"), "");
  EXPECT_EQ(body_of(answer), script());
}

TEST_F(WebFiles, FilesAreCompressedForClientsThatAcceptGzip) {
  start();
  const std::string packed = ask(get("/assets/app-1a2b.js", "Accept-Encoding: br, gzip;q=0.5\r\n"));
  EXPECT_EQ(field_of(packed, "Content-Encoding"), "gzip");
  EXPECT_EQ(field_of(packed, "Vary"), "Accept-Encoding");
  EXPECT_EQ(unpacked(body_of(packed)), script());
  const std::string plain = ask(get("/assets/app-1a2b.js", "Accept-Encoding: gzip;q=0\r\n"));
  EXPECT_EQ(field_of(plain, "Content-Encoding"), "");
  EXPECT_EQ(body_of(plain), script());
}

TEST_F(WebFiles, AFileThatTheBrowserHasIsNotSentAgain) {
  start();
  const std::string tag = field_of(ask(get("/mark.svg")), "ETag");
  ASSERT_FALSE(tag.empty());
  const std::string again = ask(get("/mark.svg", "If-None-Match: " + tag + "\r\n"));
  EXPECT_EQ(status_of(again), 304);
  EXPECT_EQ(body_of(again), "");
}

TEST_F(WebFiles, HeadGetsTheLengthAndNoBody) {
  start();
  RawClient client(port());
  client.send(
      "HEAD /mark.svg HTTP/1.1\r\nHost: localhost\r\n\r\nGET /mark.svg HTTP/1.1\r\nHost: localhost\r\n\r\n");
  const std::string head = client.receive_response(false);
  EXPECT_EQ(status_of(head), 200);
  EXPECT_EQ(field_of(head, "Content-Length"), "6");
  EXPECT_EQ(body_of(client.receive_response()), "<svg/>") << "the next response follows at once";
}

TEST_F(WebFiles, EveryResponseHasTheSecurityFields) {
  start();
  for (const std::string& request :
       {get("/"), get("/none"), get("/%00"), std::string("nonsense\r\n\r\n"),
        std::string("GET / HTTP/1.1\r\nHost: evil.example\r\nConnection: close\r\n\r\n"),
        get("/", "Upgrade: h2c\r\n")}) {
    const std::string answer = ask(request);
    EXPECT_EQ(field_of(answer, "X-Content-Type-Options"), "nosniff") << request;
    EXPECT_EQ(field_of(answer, "Referrer-Policy"), "no-referrer") << request;
    EXPECT_THAT(field_of(answer, "Content-Security-Policy"), HasSubstr("default-src 'self'")) << request;
    EXPECT_THAT(field_of(answer, "Content-Security-Policy"), HasSubstr("frame-ancestors 'none'")) << request;
    // Scripts, styles and workers use default-src: files of the site only, nothing inline.
    for (const char* looser : {"unsafe-", "script-src", "style-src", "worker-src", "child-src"})
      EXPECT_THAT(field_of(answer, "Content-Security-Policy"), Not(HasSubstr(looser))) << request;
  }
}

TEST_F(WebFiles, NoPathLeadsOutOfTheFolder) {
  std::filesystem::create_symlink(folder_ / "secret.txt", folder_ / "site/link.txt");
  start();
  const std::vector<std::string> paths{"/../secret.txt",
                                       "/assets/../../secret.txt",
                                       "/%2e%2e/secret.txt",
                                       "/%2E%2E%2Fsecret.txt",
                                       "/..%2fsecret.txt",
                                       "/..%5csecret.txt",
                                       "/..\\secret.txt",
                                       "/%252e%252e/secret.txt",
                                       "//secret.txt",
                                       "//etc/passwd",
                                       "/assets//app-1a2b.js",
                                       "/./index.html",
                                       "/index.html%00.js",
                                       "/%00",
                                       "/index.html/..",
                                       "/.hidden",
                                       "/link.txt",
                                       "/%c0%ae%c0%ae/secret.txt",
                                       "/%",
                                       "/%2",
                                       "/%zz",
                                       "/assets",
                                       "/assets/",
                                       (folder_ / "secret.txt").string(),
                                       "secret.txt",
                                       "http://127.0.0.1/index.html",
                                       "*",
                                       "/" + std::string(1900, 'a'),
                                       "/" + std::string(3000, 'a'),
                                       "/" + std::string(100000, 'a')};
  for (const std::string& path : paths) {
    const std::string answer = ask(get(path));
    const int status = status_of(answer);
    EXPECT_TRUE(status == 400 || status == 404 || status == 414) << path << ": " << status;
    EXPECT_THAT(answer, Not(HasSubstr("secret"))) << path;
    EXPECT_FALSE(body_of(answer).empty()) << path;
  }
  expect_alive();
}

TEST_F(WebFiles, ASiteThatIsNotBuiltIsReported) {
  settings_.site = folder_ / "nowhere";
  start();
  const std::string answer = ask(get("/"));
  EXPECT_EQ(status_of(answer), 503);
  EXPECT_EQ(body_of(answer), "the front-end is not built\n");
  EXPECT_EQ(status_of(ask(get("/index.html"))), 404);
}

TEST_F(WebFiles, FilesCanOnlyBeRead) {
  start();
  const std::string fields = "Host: 127.0.0.1\r\nOrigin: http://127.0.0.1\r\nConnection: close\r\n";
  const std::string answer = ask("POST / HTTP/1.1\r\n" + fields + "Content-Length: 2\r\n\r\nhi");
  EXPECT_EQ(status_of(answer), 405);
  EXPECT_EQ(field_of(answer, "Allow"), "GET, HEAD");
  EXPECT_EQ(status_of(ask(get("/", "Content-Length: 2\r\n") + "hi")), 413);
}

}  // namespace
}  // namespace phalanx

// SPDX-License-Identifier: Apache-2.0
// HTTP and WebSocket server on a thread of its own. It knows nothing of hands: a WebApplication handles the
// requests and the messages of pages. src/serve/web/server_context.h describes its inside.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace phalanx {

/// Number of a connected page, from 1 on; never used twice in a process.
using PageId = std::uint32_t;
/// Bytes of a message or a body, encoded once and shared by all that send them.
using Bytes = std::shared_ptr<const std::string>;

/// The other end of a connection.
struct ClientInfo {
  std::string address;       ///< IP address: "127.0.0.1"
  bool may_operate = false;  ///< false: it has the viewers' token
};

struct WebRequest {
  std::string method;       ///< GET, HEAD or POST
  std::string path;         ///< decoded, without the query; begins with '/'
  std::string query;        ///< after '?', not decoded, without the token
  std::string page_secret;  ///< value of the field X-Phalanx-Page; empty if there is none
  std::string range;        ///< value of the field Range; empty if there is none
  std::string body;
  ClientInfo client;
  std::string session = {};  ///< value of the field X-Phalanx-Session; empty if there is none
};

struct WebResponse {
  int status = 200;
  std::string type = "text/plain; charset=utf-8";
  Bytes body;
  bool immutable = false;          ///< the content at this path never changes: browsers may keep it
  std::string content_range = {};  ///< value of the field Content-Range, with status 206 or 416; empty: none
};

/// Application behind a WebServer. The server calls all functions on its thread. They must return soon and
/// must not throw.
class WebApplication {
 public:
  WebApplication() = default;
  WebApplication(const WebApplication&) = delete;
  WebApplication& operator=(const WebApplication&) = delete;
  virtual ~WebApplication() = default;

  /// A page has connected.
  virtual void joined(PageId page, const ClientInfo& client) = 0;
  /// A page has left. Called once for each page that joined, whatever the reason, soon after disconnect() and
  /// before stop() returns. Never called from within another call.
  virtual void left(PageId page) = 0;
  /// A page has sent a binary message of at most WebServerSettings::message_limit bytes.
  virtual void received(PageId page, std::string_view message) = 0;
  /// A page has sent a message over its rate limit and will be disconnected. The messages of the same burst
  /// are still reported here, so that the application can find the one that must not be lost.
  virtual void received_over_limit(PageId /*page*/, std::string_view /*message*/) {}
  /// A frame is due. Called WebServerSettings::frame_rate_hz times a second while a page is connected.
  virtual void frame() = 0;

  /// A client has sent a request that names no file of the site.
  /// @param respond  sends the response; any thread, also later. Only the first call counts. If all copies
  /// are destroyed without a call, the response is 500
  virtual void requested(const WebRequest& request, std::function<void(WebResponse)> respond) = 0;
  /// Called before the body of such a request is read. @returns how long the body may be [bytes]; 0: no body
  [[nodiscard]] virtual std::size_t body_limit(const WebRequest& head) = 0;
};

/// Error of the settings: a port that is taken, an address that does not exist, a certificate that cannot be
/// read. The message says what to do.
class WebServerError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct WebServerSettings {
  std::string address = "127.0.0.1";  ///< to listen on; all but loopback addresses need TLS and tokens
  std::uint16_t port = 8480;          ///< 0: any free one
  bool next_free_port = true;         ///< if the port is taken, try the next 20
  std::filesystem::path site;         ///< folder of the built front-end; read once, into memory
  std::string site_missing;           ///< text at / if that folder does not exist (with status 503)

  std::filesystem::path certificate;  ///< PEM, with its chain; with `key`: TLS 1.2 without CBC, or 1.3
  std::filesystem::path key;          ///< PEM; only its owner may read or write it (mode 0600)
  std::string operator_token;         ///< empty: all clients may connect and operate (loopback only)
  std::string viewer_token;           ///< accepts clients that may only view

  double frame_rate_hz = 60.0;
  std::size_t message_limit = 64 * 1024;      ///< of a WebSocket message from a page [bytes]
  std::size_t messages_per_second = 200;      ///< of a page, its pings included; above, it is disconnected
  std::size_t queue_limit = 256;              ///< messages that wait for a page; above, it is disconnected
  std::size_t queue_bytes = 4 * 1024 * 1024;  ///< the same in bytes; one message alone may be longer
  /// Connections at once that have sent an accepted request; further ones are refused (503). Viewers leave
  /// the last eighth to clients that may operate. These leave the last sixteenth to their own WebSockets. A
  /// POST without a body needs none of them: it is always accepted, and its connection is closed afterwards.
  std::size_t connections = 64;
  /// Connections at once that have not sent an accepted request; a new one closes the oldest.
  std::size_t pending_connections = 32;
  std::size_t pending_per_address = 8;  ///< the same of one remote address; without effect on loopback
  double pending_timeout = 3.0;         ///< from the connection to the first accepted request [s]
  std::size_t header_limit = 8 * 1024;  ///< of a request [bytes]
  double request_timeout = 10.0;        ///< for the head of a request [s]
  /// Time without data after which a page is disconnected; it is pinged after half of it. Also the time that
  /// a page has to take a message. A body has this time and in addition its length divided by 16 kB/s [s].
  double idle_timeout = 20.0;
};

/// Web server with one thread: SCHED_OTHER with nice 5, below the loop's priority, all signals blocked.
///
/// It checks each request in this order, and refuses it with a status and a sentence:
///   - Pending connections: above `pending_connections` the oldest is closed, without a response.
///   - Framing: 400, and the connection is closed, if Host, Origin, Content-Length, Transfer-Encoding
///     or the key or version of a WebSocket occurs more than once. Transfer-Encoding must be
///     "chunked", in HTTP/1.1.
///   - Host: 421 unless it names localhost, a loopback address or the connection's own address, with any
///     port (an SSH tunnel has another). If other machines can reach the server, it may also name this
///     machine or one of its addresses. This check stops DNS rebinding.
///   - Form: 405 unless the method is GET, HEAD or POST. 414 if the address is longer than 2048
///     bytes. 400 if it could be read in two ways ("..", "//", an encoded '/'). 431 if the head is
///     longer than `header_limit`.
///   - Token, if there is one: 403 unless the query (?token=...) or the cookie has it. The query sets
///     the cookie (HttpOnly, SameSite=Strict, with TLS also Secure) and redirects to the address without
///     the token. A WebSocket or a POST may have it in the query without a redirect. Tokens are compared
///     in constant time.
///   - Connections: 503 if all `connections` are in use.
///   - Origin, of WebSockets and POST: 403 unless it is "http(s)://" + Host.
///   - Upgrade: 400 unless it is to a WebSocket with a key of 16 bytes in base64. It may have any path.
///   - Files: only those of the list that was read at the start, by their exact path.
///   - Body: 413 if the path is a file, or the body is longer than the application allows. 503 if two
///     bodies above 64 KiB are being read.
///
/// Every response has X-Content-Type-Options, Referrer-Policy: no-referrer, and a Content-Security-Policy
/// of 'self' with frame-ancestors 'none' (pictures also from data: and blob:). Files are also held in gzip
/// format. Browsers may keep those in assets/ and ask again for all others.
///
/// Messages of pages are binary. A page that sends text is disconnected.
class WebServer {
 public:
  static constexpr std::size_t kNewestKinds = 2;  ///< of send_newest()

  /// Binds the port and reads the site. port() is known afterwards.
  /// @param application  outlives the server
  /// @throws WebServerError if the settings cannot be used
  WebServer(WebServerSettings settings, WebApplication& application);
  WebServer(const WebServer&) = delete;
  WebServer& operator=(const WebServer&) = delete;
  ~WebServer();  ///< stop()

  void start();
  /// Closes all pages and ends the thread, within about a second. Does not wait longer for pages that do not
  /// answer. May be called twice, but not on the server's thread. A stopped server cannot start again.
  void stop() noexcept;

  [[nodiscard]] std::uint16_t port() const noexcept;
  [[nodiscard]] bool tls() const noexcept;
  /// @returns "http://127.0.0.1:8480/" without a token; the loopback address if the server listens on all
  [[nodiscard]] std::string url() const;

  /// Runs work on the server's thread, soon. Drops it after stop(). Any thread but a real-time one:
  /// locks and allocates.
  void post(std::function<void()> work);

  // ---- on the server's thread only: from within a function of the application, or in post()
  /// Sends a message to a page, in order. If the page's queue is full, drops the queue and disconnects the
  /// page. Ignores an unknown page.
  void send(PageId page, Bytes message);
  /// Sends a message of which only the newest of its kind matters: it replaces one of this kind that still waits. It is
  /// sent after all messages of send().
  /// @param kind  below kNewestKinds
  /// @returns true if it replaced one, which will never be sent
  bool send_newest(PageId page, Bytes message, std::size_t kind = 0);
  /// Disconnects a page: sends what waits, then the reason (its first 123 bytes). Aborts the connection if
  /// the page has not taken these in within 2 s. Ignores all that it sends from now on.
  void disconnect(PageId page, const std::string& reason);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace phalanx

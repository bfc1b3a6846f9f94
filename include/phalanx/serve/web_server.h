// SPDX-License-Identifier: Apache-2.0
// HTTP and WebSocket on one thread of its own. Knows nothing of hands: what is said over it is a
// WebApplication's.
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

/// A connected page, by a number that is never used twice in a process; counts from 1.
using PageId = std::uint32_t;
/// Encoded once, shared by all who get it.
using Bytes = std::shared_ptr<const std::string>;

/// Who is at the other end.
struct Visitor {
  std::string address;       ///< "127.0.0.1"
  bool may_operate = false;  ///< false: came with the viewers' token
};

struct WebRequest {
  std::string method;       ///< GET, HEAD or POST
  std::string path;         ///< decoded, without the query; begins with '/'
  std::string query;        ///< behind '?', as it came but for the token
  std::string page_secret;  ///< of the header X-Phalanx-Page; empty: none
  std::string body;
  Visitor visitor;
};

struct WebAnswer {
  int status = 200;
  std::string type = "text/plain; charset=utf-8";
  Bytes body;
  bool immutable = false;  ///< what stands at this path never changes: browsers may keep it
};

/// What the pages of a server talk to. All functions are called on the server's thread, must return soon and
/// must not throw.
class WebApplication {
 public:
  WebApplication() = default;
  WebApplication(const WebApplication&) = delete;
  WebApplication& operator=(const WebApplication&) = delete;
  virtual ~WebApplication() = default;

  virtual void joined(PageId page, const Visitor& visitor) = 0;
  /// Once for each that joined, however it went: also soon after show_out(), and before stop() returns. In a
  /// turn of its own, never from within another call.
  virtual void left(PageId page) = 0;
  /// A whole binary message of at most WebServerSettings::message_limit bytes.
  virtual void received(PageId page, std::string_view message) = 0;
  /// A message of a page that has said more in a second than it may, and those behind it that have come
  /// already: it is about to be shown out. For the one word that must never be lost.
  virtual void received_too_much(PageId /*page*/, std::string_view /*last*/) {}
  /// Of the settings' frame_rate_hz, as long as at least one page is connected.
  virtual void frame() = 0;

  /// A request that is none for a file of the site. `answer` may be called later, from any thread, once; what
  /// follows is ignored, and if all copies of it go uncalled, the answer is 500.
  virtual void requested(const WebRequest& request, std::function<void(WebAnswer)> answer) = 0;
  /// How long the body of such a request may be, asked before any of it is read [bytes]; 0: it may have none.
  [[nodiscard]] virtual std::size_t body_limit(const WebRequest& head) = 0;
};

/// A port that is taken, an address that is none, a certificate that does not open: says what to do.
class WebServerError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct WebServerSettings {
  std::string address = "127.0.0.1";  ///< to listen on; any other than a loopback one needs TLS and tokens
  std::uint16_t port = 8480;          ///< 0: any that is free
  bool next_free_port = true;         ///< if it is taken, up to 20 above are tried
  std::filesystem::path site;         ///< folder of the built front-end; read once, into memory
  std::string site_missing;           ///< what to show at / if it is not there (with 503)

  std::filesystem::path certificate;  ///< PEM, with its chain; with key: TLS, 1.2 at least, without CBC
  std::filesystem::path key;          ///< PEM; only its owner may read or write it (mode 0600)
  std::string operator_token;         ///< empty: everybody who gets through is let in (loopback only)
  std::string viewer_token;  ///< lets in those who may only look; both: 16 letters, digits, '-', '_' or more

  double frame_rate_hz = 60.0;
  std::size_t message_limit = 64 * 1024;      ///< of a WebSocket message from a page [bytes]
  std::size_t messages_per_second = 200;      ///< of one page, with its pings; more, and it is shown out
  std::size_t queue_limit = 256;              ///< messages waiting for one page; more, and it is shown out
  std::size_t queue_bytes = 4 * 1024 * 1024;  ///< the same in bytes; one alone may be longer
  /// At once, that have asked for something with a right Host and token; others are refused (503). Viewers
  /// leave the last eighth to visitors who may operate, and these the last sixteenth to their own WebSockets.
  /// A POST without a body needs no place: it is always heard, and its connection then closed.
  std::size_t connections = 64;
  std::size_t unproven_connections = 32;  ///< that have not; a new one takes the place of the oldest
  std::size_t unproven_per_address =
      8;                                ///< of one remote address; does not count where we listen on loopback
  double proof_timeout = 3.0;           ///< to ask for something so, from the connection on [s]
  std::size_t header_limit = 8 * 1024;  ///< of a request [bytes]
  double request_timeout = 10.0;        ///< to say a request, its body aside [s]
  /// A page from which nothing comes for so long is gone (it is pinged halfway), and so is one that takes
  /// longer to take a message. A body, of a request or an answer, has this and its length / (16 kB/s) [s].
  double idle_timeout = 20.0;
};

/// One thread, SCHED_OTHER with nice 5 (the loop comes first), all signals blocked. Doors in this order, each
/// with its own refusal in plain words (but for the first):
///   - more than `unproven_connections` that have asked for nothing yet: the oldest is closed;
///   - framing: Host, Origin, Content-Length, Transfer-Encoding and the WebSocket's key and version at most
///     once, a Transfer-Encoding only of "chunked" and in HTTP/1.1: else 400, and the connection ends;
///   - Host: localhost, a loopback address or the address of the connection, any port (an SSH tunnel has
///     another); where other machines reach the server, also this machine's names and addresses: else 421,
///     which stops DNS rebinding;
///   - form: GET, HEAD or POST (405), an address of at most 2048 bytes (414) that can be read in one way only
///     (400: no "..", no "//", no encoded '/', ...), a head of at most header_limit (431);
///   - token, where there is one: in the query (?token=...) of the first request, which sets a cookie
///     (HttpOnly, SameSite=Strict, with TLS also Secure) and goes on to the same address without it; a
///     WebSocket or a POST may bring it so itself; compared in constant time; else 403;
///   - no place among the `connections`: 503;
///   - Origin, for WebSockets and POST: "http(s)://" + Host, exactly; else 403;
///   - a WebSocket may be asked for at any path; another upgrade, or a key that is not 16 bytes in base64:
///     400;
///   - files: an exact path out of the list read at the start, so that no path leads out of the folder;
///   - a body: only for what is no file, and no longer than the application allows (413); more than 64 KiB
///     of at most two at once (503).
/// Every answer carries X-Content-Type-Options, Referrer-Policy: no-referrer, frame-ancestors 'none' and a
/// Content-Security-Policy of 'self' (pictures also from data: and blob:). Files are held gzipped, too, for
/// whoever accepts that; those in assets/ are immutable, others are asked for anew each time.
/// Pages speak binary messages: whoever sends text is shown out.
class WebServer {
 public:
  /// Binds, so that port() is known, and reads the site. @throws WebServerError
  /// @param application  outlives the server
  WebServer(WebServerSettings settings, WebApplication& application);
  WebServer(const WebServer&) = delete;
  WebServer& operator=(const WebServer&) = delete;
  ~WebServer();  ///< stop()

  void start();
  /// Says goodbye to all pages, and returns when the thread has ended: in about a second, whatever they do.
  /// May be called twice; not on the server's thread. It cannot be started again.
  void stop() noexcept;

  [[nodiscard]] std::uint16_t port() const noexcept;
  [[nodiscard]] bool tls() const noexcept;
  /// "http://127.0.0.1:8480/", without a token; by the loopback address if it listens on all.
  [[nodiscard]] std::string url() const;

  /// Runs `work` on the server's thread, soon. From any thread but a real-time one (it locks and allocates);
  /// after stop() it is dropped.
  void post(std::function<void()> work);

  // On the server's thread only, from within the application's functions or post().
  /// In order, each once; a page whose queue is full is shown out, and what waited is dropped. Unknown pages
  /// are ignored.
  void send(PageId page, Bytes message);
  /// Replaces one that still waits (latest wins): a page whose line is slow skips. Goes behind all that
  /// send() has given.
  /// @returns whether it has replaced one, which the page will never get
  bool send_newest(PageId page, Bytes message);
  /// What waits is still sent, then the reason (123 bytes of it); a page that does not take that in within 2
  /// s is cut off. Nothing is taken from it any more.
  void show_out(PageId page, const std::string& reason);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace phalanx

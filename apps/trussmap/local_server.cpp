// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "local_server.hpp"

#include "command_line.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <exception>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <random>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/strand.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <fmt/format.h>

namespace trussmap::app {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
using asio::ip::tcp;
using Request = http::request<http::string_body>;
using Response = http::response<http::string_body>;
using namespace std::chrono_literals;

constexpr std::uint32_t kMostHeader = 16 * 1024;
constexpr std::uint64_t kMostBody = std::uint64_t{64} * 1024;
constexpr int kMostConnections = 64;        // of those that have shown the token
constexpr std::size_t kMostUnproven = 256;  // of others: the oldest goes first
constexpr auto kUnproven = 5s;              // that one of these lasts
constexpr auto kSilence = 60s;
constexpr auto kLook = 50ms;  // for events
constexpr auto kHeartbeat = 10s;
constexpr auto kRetry = 100ms;

/// 128 bits that nobody can foresee.
std::string secret() {
  std::random_device random;
  std::string text;
  for (int k = 0; k < 4; ++k) text += fmt::format("{:08x}", random());
  return text;
}

/// In the same time wherever they differ.
bool same(std::string_view a, std::string_view b) {
  unsigned differ = a.size() == b.size() ? 0U : 1U;
  for (std::size_t k = 0; k < std::min(a.size(), b.size()); ++k) {
    differ |= static_cast<unsigned char>(a[k]) ^ static_cast<unsigned char>(b[k]);
  }
  return differ == 0;
}

std::string_view text_of(const beast::string_view& text) {
  return {text.data(), text.size()};
}

}  // namespace

struct LocalServer::Listener {
  explicit Listener(std::uint16_t port) : acceptor(context), again(context) {
    const tcp::endpoint here(asio::ip::address_v4::loopback(), port);
    acceptor.open(here.protocol());
    acceptor.set_option(tcp::acceptor::reuse_address(true));
    acceptor.bind(here);
    acceptor.listen();
    host = fmt::format("127.0.0.1:{}", acceptor.local_endpoint().port());
    other_host = fmt::format("localhost:{}", acceptor.local_endpoint().port());
  }

  [[nodiscard]] bool is_here(std::string_view name) const {
    return name == host || name == other_host;
  }

  /// Whether the request is one of our own page, or of whoever was given the address.
  [[nodiscard]] bool is_allowed(const Request& request) const {
    const std::string_view origin = text_of(request[http::field::origin]);
    const std::string_view site = text_of(request["Sec-Fetch-Site"]);
    const std::string_view target = text_of(request.target());
    const bool ours =
        origin.empty() || (origin.starts_with("http://") && is_here(origin.substr(7)));
    const bool near = site.empty() || site == "same-origin" || site == "none";
    return is_here(text_of(request[http::field::host])) && ours && near &&
           target.size() > token.size() + 1 && target.front() == '/' &&
           same(target.substr(1, token.size()), token) && target[token.size() + 1] == '/';
  }

  [[nodiscard]] static bool is_json(const Request& request) {
    return text_of(request[http::field::content_type]).starts_with("application/json");
  }

  [[nodiscard]] std::string path_of(const Request& request) const {
    std::string_view path = text_of(request.target()).substr(token.size() + 2);
    return std::string(path.substr(0, path.find('?')));
  }

  [[nodiscard]] static Response response(const Request& request, const LocalReply& reply) {
    Response result{http::int_to_status(reply.status), request.version()};
    result.set(http::field::content_type, reply.type);
    result.set(http::field::cache_control, "no-store");
    result.set("X-Content-Type-Options", "nosniff");
    result.set("Referrer-Policy", "no-referrer");
    result.set("Cross-Origin-Resource-Policy", "same-origin");
    result.set("X-Frame-Options", "DENY");
    result.set("Content-Security-Policy",
               reply.policy.empty() ? "default-src 'none'" : reply.policy);
    if (!reply.file.empty()) {
      result.set(http::field::content_disposition,
                 fmt::format("attachment; filename=\"{}\"", reply.file));
    }
    result.keep_alive(request.keep_alive());
    result.body() = reply.body;
    result.prepare_payload();
    return result;
  }

  [[nodiscard]] LocalReply reply_to(const Request& request) const {
    const bool post = request.method() == http::verb::post;
    if (!post && request.method() != http::verb::get) return {405, "text/plain", "GET or POST\n"};
    if (post && !is_json(request)) return {415, "text/plain", "expected application/json\n"};
    try {
      return answer({post, path_of(request), request.body()});
    } catch (const std::exception& error) {
      return {500, "text/plain", fmt::format("{}\n", error.what())};
    }
  }

  void accept();

  /// One more connection that has not shown the token; `close` ends it. Too many end the oldest.
  std::uint64_t begin(std::function<void()> close) {
    std::function<void()> oldest;
    std::uint64_t number = 0;
    {
      const std::scoped_lock lock(mutex);
      number = next++;
      unproven.emplace(number, std::move(close));
      if (unproven.size() > kMostUnproven) {
        oldest = std::move(unproven.begin()->second);
        unproven.erase(unproven.begin());
      }
    }
    if (oldest) oldest();
    return number;
  }

  /// It is over, or has shown the token.
  void forget(std::uint64_t number) {
    const std::scoped_lock lock(mutex);
    unproven.erase(number);
  }

  asio::io_context context;
  tcp::acceptor acceptor;
  asio::steady_timer again;
  std::string host;
  std::string other_host;
  std::string token = secret();
  std::atomic<int> proven = 0;  ///< connections that have shown the token
  std::mutex mutex;             // of `unproven`
  std::map<std::uint64_t, std::function<void()>> unproven;  ///< in order of their arrival
  std::uint64_t next = 0;
  std::function<LocalReply(const LocalRequest&)> answer;
  std::function<std::string()> event;
};

namespace {

/// One connection: a request, its answer, the next; or events until it breaks. One that breaks,
/// says nothing for long, does not show the token soon or is no HTTP is closed, and that is all.
class Connection : public std::enable_shared_from_this<Connection> {
 public:
  Connection(tcp::socket socket, LocalServer::Listener& listener)
      : stream_(std::move(socket)),
        timer_(stream_.get_executor()),
        listener_(listener),
        ends_(std::chrono::steady_clock::now() + kUnproven) {}
  ~Connection() {
    if (proven_) {
      --listener_.proven;
    } else {
      listener_.forget(number_);
    }
  }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  void begin() {
    number_ = listener_.begin([connection = weak_from_this()] {
      const std::shared_ptr<Connection> self = connection.lock();
      if (!self) return;
      asio::post(self->stream_.get_executor(), [self] {
        beast::error_code ignored;
        self->stream_.socket().close(ignored);
      });
    });
    asio::post(stream_.get_executor(), [self = shared_from_this()] { self->read(); });
  }

 private:
  /// Who has not shown the token gets a few seconds in all, however many bytes it sends.
  void limit_time() {
    if (proven_) {
      stream_.expires_after(kSilence);
    } else {
      stream_.expires_at(ends_);
    }
  }

  void read() {
    parser_.emplace();
    parser_->header_limit(kMostHeader);
    parser_->body_limit(kMostBody);
    limit_time();
    http::async_read(stream_, buffer_, *parser_,
                     [self = shared_from_this()](const beast::error_code& error, std::size_t) {
                       if (!error) self->answer(self->parser_->release());
                     });
  }

  /// False: too many have shown it.
  bool prove() {
    if (proven_) return true;
    if (++listener_.proven > kMostConnections) {
      --listener_.proven;
      return false;
    }
    proven_ = true;
    listener_.forget(number_);
    return true;
  }

  void answer(const Request& request) {
    const bool allowed = listener_.is_allowed(request) && prove();
    if (allowed && request.method() == http::verb::get && listener_.path_of(request) == "events") {
      return begin_events(request);
    }
    const LocalReply refused{403, "text/plain", "not from here\n"};
    response_ = listener_.response(request, allowed ? listener_.reply_to(request) : refused);
    limit_time();
    http::async_write(stream_, response_,
                      [self = shared_from_this()](const beast::error_code& error, std::size_t) {
                        if (error) return;
                        if (!self->response_.need_eof()) return self->read();
                        beast::error_code ignored;
                        self->stream_.socket().shutdown(tcp::socket::shutdown_send, ignored);
                      });
  }

  void begin_events(const Request& request) {
    head_ = {http::status::ok, request.version()};
    head_.set(http::field::content_type, "text/event-stream");
    head_.set(http::field::cache_control, "no-store");
    head_.set("X-Content-Type-Options", "nosniff");
    head_.chunked(true);
    serializer_.emplace(head_);
    stream_.expires_after(kSilence);
    http::async_write_header(
        stream_, *serializer_,
        [self = shared_from_this()](const beast::error_code& error, std::size_t) {
          if (!error) self->look();
        });
  }

  /// Sends what goes on where that has changed, or where nothing was said for long.
  void look() {
    std::string now = listener_.event();
    const auto time = std::chrono::steady_clock::now();
    if (now == last_ && time - said_ < kHeartbeat) return wait();
    event_ = fmt::format("data: {}\n\n", now);
    last_ = std::move(now);
    said_ = time;
    stream_.expires_after(kSilence);
    asio::async_write(stream_, http::make_chunk(asio::buffer(event_)),
                      [self = shared_from_this()](const beast::error_code& error, std::size_t) {
                        if (!error) self->wait();
                      });
  }

  void wait() {
    timer_.expires_after(kLook);
    timer_.async_wait([self = shared_from_this()](const beast::error_code& error) {
      if (!error) self->look();
    });
  }

  beast::tcp_stream stream_;
  asio::steady_timer timer_;
  LocalServer::Listener& listener_;
  std::chrono::steady_clock::time_point ends_;  // while it has not shown the token
  std::uint64_t number_ = 0;
  bool proven_ = false;
  beast::flat_buffer buffer_;
  std::optional<http::request_parser<http::string_body>> parser_;
  Response response_;
  http::response<http::empty_body> head_;
  std::optional<http::response_serializer<http::empty_body>> serializer_;
  std::string event_;
  std::string last_;
  std::chrono::steady_clock::time_point said_;
};

}  // namespace

void LocalServer::Listener::accept() {
  acceptor.async_accept(asio::make_strand(context),
                        [this](const beast::error_code& error, tcp::socket socket) {
                          if (error) {  // out of file descriptors: some become free
                            again.expires_after(kRetry);
                            return again.async_wait([this](const beast::error_code&) { accept(); });
                          }
                          std::make_shared<Connection>(std::move(socket), *this)->begin();
                          accept();
                        });
}

LocalServer::LocalServer(std::uint16_t port) {
  try {
    listener_ = std::make_unique<Listener>(port);
  } catch (const boost::system::system_error& error) {
    throw UsageError(
        fmt::format("port {} of 127.0.0.1 cannot be served: {}; expected a free port, or "
                    "none for any",
                    port, error.code().message()));
  }
}

LocalServer::~LocalServer() = default;

std::string LocalServer::address() const {
  return fmt::format("http://{}/{}/", listener_->host, listener_->token);
}

void LocalServer::run(const std::function<LocalReply(const LocalRequest&)>& answer,
                      const std::function<std::string()>& event) {
  constexpr int kThreads = 4;  // one that computes does not keep the others waiting
  listener_->answer = answer;
  listener_->event = event;
  listener_->accept();
  std::vector<std::thread> threads;
  for (int k = 1; k < kThreads; ++k) threads.emplace_back([this] { listener_->context.run(); });
  listener_->context.run();
  for (std::thread& one : threads) one.join();
}

}  // namespace trussmap::app

// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "local_server.hpp"

#include "command_line.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <exception>
#include <random>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include <boost/asio/awaitable.hpp>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/strand.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <fmt/format.h>

namespace trussmap::app {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
using asio::use_awaitable;
using asio::ip::tcp;
using Request = http::request<http::string_body>;
using Response = http::response<http::string_body>;
using namespace std::chrono_literals;

constexpr std::uint32_t kMostHeader = 16 * 1024;
constexpr std::uint64_t kMostBody = std::uint64_t{64} * 1024;
constexpr int kMostConnections = 64;
constexpr auto kSilence = 60s;
constexpr auto kLook = 50ms;  // for events
constexpr auto kHeartbeat = 10s;

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
  explicit Listener(std::uint16_t port) : acceptor(context) {
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

  asio::awaitable<void> send_events(beast::tcp_stream& stream, const Request& request) {
    http::response<http::empty_body> head{http::status::ok, request.version()};
    head.set(http::field::content_type, "text/event-stream");
    head.set(http::field::cache_control, "no-store");
    head.set("X-Content-Type-Options", "nosniff");
    head.chunked(true);
    http::response_serializer<http::empty_body> serializer{head};
    stream.expires_after(kSilence);
    co_await http::async_write_header(stream, serializer, use_awaitable);
    asio::steady_timer timer(co_await asio::this_coro::executor);
    std::string last;
    auto said = std::chrono::steady_clock::now() - 1h;
    while (true) {
      std::string now = event();
      const auto time = std::chrono::steady_clock::now();
      if (now != last || time - said > kHeartbeat) {
        const std::string text = fmt::format("data: {}\n\n", now);
        stream.expires_after(kSilence);
        co_await asio::async_write(stream, http::make_chunk(asio::buffer(text)), use_awaitable);
        last = std::move(now);
        said = time;
      }
      timer.expires_after(kLook);
      co_await timer.async_wait(use_awaitable);
    }
  }

  asio::awaitable<void> serve(tcp::socket socket) {
    beast::tcp_stream stream(std::move(socket));
    beast::flat_buffer buffer;
    while (true) {
      http::request_parser<http::string_body> parser;
      parser.header_limit(kMostHeader);
      parser.body_limit(kMostBody);
      stream.expires_after(kSilence);
      co_await http::async_read(stream, buffer, parser, use_awaitable);
      const Request request = parser.release();
      const bool allowed = is_allowed(request);
      if (allowed && request.method() == http::verb::get && path_of(request) == "events") {
        co_await send_events(stream, request);
      }
      const LocalReply refused{403, "text/plain", "not from here\n"};
      const Response reply = response(request, allowed ? reply_to(request) : refused);
      stream.expires_after(kSilence);
      co_await http::async_write(stream, reply, use_awaitable);
      if (reply.need_eof()) break;
    }
    beast::error_code ignored;
    stream.socket().shutdown(tcp::socket::shutdown_send, ignored);
  }

  /// A connection that breaks, says nothing or is no HTTP is closed, and that is all.
  asio::awaitable<void> connection(tcp::socket socket) {
    ++connections;
    try {
      co_await serve(std::move(socket));
    } catch (const std::exception&) {
    }
    --connections;
  }

  asio::awaitable<void> accept() {
    while (true) {
      beast::error_code error;
      tcp::socket socket = co_await acceptor.async_accept(
          asio::make_strand(context), asio::redirect_error(use_awaitable, error));
      if (error) {  // out of file descriptors: some become free
        asio::steady_timer timer(context, 100ms);
        co_await timer.async_wait(use_awaitable);
        continue;
      }
      if (connections >= kMostConnections) continue;  // and so it is closed
      const auto executor = socket.get_executor();
      asio::co_spawn(executor, connection(std::move(socket)), asio::detached);
    }
  }

  asio::io_context context;
  tcp::acceptor acceptor;
  std::string host;
  std::string other_host;
  std::string token = secret();
  std::atomic<int> connections = 0;
  std::function<LocalReply(const LocalRequest&)> answer;
  std::function<std::string()> event;
};

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
  asio::co_spawn(listener_->context, listener_->accept(), asio::detached);
  std::vector<std::thread> threads;
  for (int k = 1; k < kThreads; ++k) threads.emplace_back([this] { listener_->context.run(); });
  listener_->context.run();
  for (std::thread& one : threads) one.join();
}

}  // namespace trussmap::app

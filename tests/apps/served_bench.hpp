// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// trussmap serve as a child, and requests to it as anybody could send them: bytes over a socket.
#pragma once

#include "child_process.hpp"
#include "command_path.hpp"

#include <arpa/inet.h>
#include <array>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <netinet/in.h>
#include <poll.h>
#include <stdexcept>
#include <string>
#include <sys/socket.h>
#include <thread>
#include <unistd.h>
#include <vector>

#include <nlohmann/json.hpp>

namespace trussmap::testing {

struct HttpAnswer {
  int status = 0;  ///< 0: none, the connection was closed
  std::string head;
  std::string body;
};

/// Sends bytes to a port of this machine and reads until the other side closes, or half a second
/// passes in silence after something came.
inline HttpAnswer sent_to(std::uint16_t port, const std::string& bytes) {
  const int socket = ::socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in place{};
  place.sin_family = AF_INET;
  place.sin_port = htons(port);
  place.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (::connect(socket, reinterpret_cast<sockaddr*>(&place), sizeof(place)) != 0) {
    ::close(socket);
    throw std::runtime_error("nobody listens at port " + std::to_string(port));
  }
  const bool sent = ::send(socket, bytes.data(), bytes.size(), MSG_NOSIGNAL) >= 0;
  std::string text;
  std::array<char, 65536> buffer{};
  pollfd ready{socket, POLLIN, 0};
  const auto whole = [&text] {
    const std::size_t end = text.find("\r\n\r\n");
    const std::size_t length = text.find("Content-Length: ");
    return end != std::string::npos && length < end &&
           text.size() >= end + 4 + std::stoul(text.substr(length + 16));
  };
  while (sent && !whole() && ::poll(&ready, 1, text.empty() ? 20'000 : 2'000) > 0) {
    const ssize_t count = ::recv(socket, buffer.data(), buffer.size(), 0);
    if (count <= 0) break;
    text.append(buffer.data(), static_cast<std::size_t>(count));
  }
  ::close(socket);
  HttpAnswer answer;
  if (text.rfind("HTTP/1.1 ", 0) != 0) return answer;
  answer.status = std::stoi(text.substr(9, 3));
  const std::size_t end = text.find("\r\n\r\n");
  answer.head = text.substr(0, end);
  answer.body = end == std::string::npos ? "" : text.substr(end + 4);
  return answer;
}

class ServedBench {
 public:
  /// `arguments`: words of the command line after "serve".
  explicit ServedBench(const std::vector<std::string>& arguments) {
    std::array<int, 2> out{};
    if (::pipe(out.data()) != 0) throw std::runtime_error("no pipe");
    child_ = std::make_unique<ChildProcess>([&] {
      ::dup2(out[1], 1);
      ::close(out[0]);
      std::vector<std::string> words{command_path(), "serve", "--no-browser"};
      words.insert(words.end(), arguments.begin(), arguments.end());
      std::vector<char*> pointers;
      for (std::string& word : words) pointers.push_back(word.data());
      pointers.push_back(nullptr);
      ::execv(pointers.front(), pointers.data());
    });
    ::close(out[1]);
    address_ = first_line(out[0]);
    ::close(out[0]);
    const std::string start = "http://127.0.0.1:";
    if (address_.rfind(start, 0) != 0) throw std::runtime_error("no address: " + address_);
    const std::size_t slash = address_.find('/', start.size());
    port_ =
        static_cast<std::uint16_t>(std::stoi(address_.substr(start.size(), slash - start.size())));
    path_ = address_.substr(slash);
  }

  [[nodiscard]] const std::string& address() const { return address_; }
  [[nodiscard]] std::uint16_t port() const { return port_; }
  [[nodiscard]] const std::string& path() const { return path_; }  ///< with the token: "/6b1f/"
  [[nodiscard]] std::string host() const { return "127.0.0.1:" + std::to_string(port_); }

  void kill() const { child_->kill(); }

  [[nodiscard]] HttpAnswer get(const std::string& name) const {
    return sent_to(port_, "GET " + path_ + name + " HTTP/1.1\r\nHost: " + host() + "\r\n\r\n");
  }
  [[nodiscard]] HttpAnswer post(const std::string& name, const std::string& body) const {
    return sent_to(port_, "POST " + path_ + name + " HTTP/1.1\r\nHost: " + host() +
                              "\r\nContent-Type: application/json\r\nContent-Length: " +
                              std::to_string(body.size()) + "\r\n\r\n" + body);
  }
  [[nodiscard]] nlohmann::json status() const { return nlohmann::json::parse(get("status").body); }
  [[nodiscard]] nlohmann::json state() const { return nlohmann::json::parse(get("state").body); }

  /// Until no step is under way; its status.
  [[nodiscard]] nlohmann::json settled() const {
    for (int k = 0; k < 15000; ++k) {
      nlohmann::json now = status();
      if (!now.at("busy").get<bool>()) return now;
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    throw std::runtime_error("the step does not end");
  }

 private:
  static std::string first_line(int file) {
    std::string line;
    char one = 0;
    while (::read(file, &one, 1) == 1 && one != '\n') line += one;
    return line;
  }

  std::unique_ptr<ChildProcess> child_;
  std::string address_;
  std::string path_;
  std::uint16_t port_ = 0;
};

}  // namespace trussmap::testing

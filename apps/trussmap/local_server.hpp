// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A server for a page of this machine's own user: HTTP on 127.0.0.1 alone (Boost.Beast).
//
//   GET /TOKEN/PATH   answered where the token is right, the host is this one, and no page from
//                     elsewhere asks (Host, Origin, Sec-Fetch-Site); else 403, and not a word more
//   GET /TOKEN/events what goes on, as server-sent events: one whenever it changes
//
// Whatever is sent, it goes on: headers of at most 16 KiB, bodies of at most 64 KiB, connections of
// at most a minute's silence and not more than 64 of them.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

namespace trussmap::app {

struct LocalRequest {
  bool post = false;  ///< else GET
  std::string path;   ///< after the token, without "?...": "state"
  std::string body;   ///< JSON, of a POST
};

struct LocalReply {
  unsigned status = 200;
  std::string type = "application/json";
  std::string body = {};
  std::string file = {};    ///< saved under this name
  std::string policy = {};  ///< content security policy; empty: nothing may run
};

class LocalServer {
 public:
  /// Port 0: any that is free. Throws UsageError where the port is taken.
  explicit LocalServer(std::uint16_t port);
  ~LocalServer();
  LocalServer(const LocalServer&) = delete;
  LocalServer& operator=(const LocalServer&) = delete;

  /// With its secret: "http://127.0.0.1:40123/6b1f.../".
  [[nodiscard]] std::string address() const;

  /// Until the program ends. `answer` is called by several threads at once; what it throws becomes
  /// an answer of status 500. `event`: what goes on, cheap to ask.
  void run(const std::function<LocalReply(const LocalRequest&)>& answer,
           const std::function<std::string()>& event);

  /// For the implementation's own use.
  struct Listener;

 private:
  std::unique_ptr<Listener> listener_;
};

}  // namespace trussmap::app

#pragma once

// The server of the page and of the stream of messages: HTTP and WebSocket on a thread of its own.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "viewer/listen_address.h"
#include "viewer/live_map.h"
#include "viewer/protocol.h"

namespace ldso {

struct ServerOptions {
  ListenAddress address;
  std::string token;                ///< Needed for page and stream; empty: none is.
  std::size_t most_connections = 48;  ///< Beyond these new ones are refused.
  std::size_t most_viewers = 16;    ///< Of the connections, those that receive the stream.
  int request_seconds = 10;         ///< Within which a request has to come in and its answer to be taken.
  int silent_seconds = 30;          ///< After which a page that answers no ping is given up.
};

class Server {
 public:
  /// Called on the server's thread, some thirty times a second: brings the map up to date. `viewers`: pages that are
  /// connected.
  using Tick = std::function<void(LiveMap& map, std::size_t viewers)>;
  /// Called on the server's thread.
  using CommandHandler = std::function<void(protocol::Command)>;

  /// Begins to serve. `map` is the server's until the server is gone. Throws Error if it cannot listen.
  Server(const ServerOptions& options, LiveMap& map, Tick tick, CommandHandler on_command);
  /// Closes all connections.
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  /// Calls it on the server's thread, between two ticks, and waits for that.
  void call(const std::function<void(LiveMap& map)>& function);

  std::uint16_t port() const;
  /// For a browser, with the token.
  std::string url() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace ldso

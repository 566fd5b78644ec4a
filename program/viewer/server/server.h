#pragma once

// The server of the page and of the stream of messages: HTTP and WebSocket on a thread of its own.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "viewer/map/live_map.h"
#include "viewer/map/protocol.h"
#include "viewer/server/server_options.h"

namespace ldso {

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

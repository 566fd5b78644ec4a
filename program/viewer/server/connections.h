#pragma once

// What the connections of a server share. All of it belongs to the server's thread.

#include <utility>  // Before Boost.Beast, which forgets it under GCC 12.

#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/message.hpp>
#include <cstddef>
#include <functional>
#include <memory>
#include <set>

#include "viewer/map/live_map.h"
#include "viewer/server/request_policy.h"
#include "viewer/server/server.h"

namespace ldso {

/// One page that receives the stream.
class StreamConnection {
 public:
  virtual ~StreamConnection() = default;
  /// Sends what the page has not got yet, unless it is still at the last.
  virtual void pump() = 0;
  virtual void close() = 0;
};

struct ServerContext {
  ServerOptions options;
  RequestPolicy policy;
  LiveMap& map;
  Server::CommandHandler on_command;
  std::size_t connections = 0;
  std::set<std::shared_ptr<StreamConnection>> streams = {};
};

/// Counts a connection for as long as it lives.
class ConnectionCount {
 public:
  explicit ConnectionCount(ServerContext& context) : context_(&context) { ++context_->connections; }
  ConnectionCount(ConnectionCount&& other) noexcept : context_(std::exchange(other.context_, nullptr)) {}
  ConnectionCount& operator=(ConnectionCount&&) = delete;
  ~ConnectionCount() {
    if (context_ != nullptr) --context_->connections;
  }

 private:
  ServerContext* context_;
};

using HttpRequest = boost::beast::http::request<boost::beast::http::empty_body>;

/// Answers requests for files, hands those for the stream on.
void serve_http(ServerContext& context, boost::asio::ip::tcp::socket socket);

/// Goes on as a stream with a connection whose request has been checked.
void serve_stream(ServerContext& context, boost::beast::tcp_stream stream, HttpRequest request, ConnectionCount count);

}  // namespace ldso

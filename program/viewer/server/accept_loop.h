#pragma once

// Listens at an address and accepts one connection after the other, whatever becomes of those before.

#include <utility>  // Before Boost.Beast, which forgets it under GCC 12.

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <cstdint>
#include <functional>

#include "viewer/server/listen_address.h"

namespace ldso {

class AcceptLoop {
 public:
  /// Called with each connection. It may throw: out of io.run(), after which the next connection is accepted as well.
  using Serve = std::function<void(boost::asio::ip::tcp::socket)>;

  /// Begins to accept. Throws Error if it cannot listen there.
  AcceptLoop(boost::asio::io_context& io, const ListenAddress& address, Serve serve);

  void stop() { acceptor_.close(); }
  std::uint16_t port() const { return port_; }

 private:
  void accept();
  void on_accept(const boost::system::error_code& error, boost::asio::ip::tcp::socket socket);

  Serve serve_;
  boost::asio::ip::tcp::acceptor acceptor_;
  boost::asio::steady_timer pause_;
  std::uint16_t port_ = 0;
};

}  // namespace ldso

#include "viewer/server/accept_loop.h"

#include <chrono>
#include <string>

#include "ldso/error.h"

namespace ldso {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using ErrorCode = boost::system::error_code;

/// Pause after accepting failed, for instance for want of file descriptors.
constexpr std::chrono::milliseconds kAcceptPause(200);

/// Nothing if it cannot be listened there.
ErrorCode try_listen(tcp::acceptor& acceptor, const tcp::endpoint& endpoint) {
  ErrorCode error;
  acceptor.open(endpoint.protocol(), error);
  if (!error) acceptor.set_option(asio::socket_base::reuse_address(true), error);
  if (!error) acceptor.bind(endpoint, error);
  if (!error) acceptor.listen(asio::socket_base::max_listen_connections, error);
  if (error) {
    ErrorCode ignored;
    acceptor.close(ignored);
  }
  return error;
}

void listen(tcp::acceptor& acceptor, const ListenAddress& address) {
  ErrorCode error;
  const auto ip = asio::ip::make_address(address.host, error);
  if (error) {
    throw Error("viewer: " + address.host, "it is no IP address", "give one, e.g. --view=0.0.0.0:8421");
  }
  error = try_listen(acceptor, {ip, address.port});
  if (error == boost::system::errc::address_in_use && !address.is_port_given) error = try_listen(acceptor, {ip, 0});
  if (error) {
    throw Error("viewer: " + address.host + ":" + std::to_string(address.port),
                "it cannot be listened there (" + error.message() + ")", "give another --view=ADDRESS:PORT");
  }
}

}  // namespace

AcceptLoop::AcceptLoop(asio::io_context& io, const ListenAddress& address, Serve serve)
    : serve_(std::move(serve)), acceptor_(io), pause_(io) {
  listen(acceptor_, address);
  port_ = acceptor_.local_endpoint().port();
  accept();
}

void AcceptLoop::accept() {
  acceptor_.async_accept([this](ErrorCode error, tcp::socket socket) { on_accept(error, std::move(socket)); });
}

void AcceptLoop::on_accept(const ErrorCode& error, tcp::socket socket) {
  if (error == asio::error::operation_aborted || !acceptor_.is_open()) return;
  if (error) {
    pause_.expires_after(kAcceptPause);
    pause_.async_wait([this](ErrorCode aborted) {
      if (!aborted) accept();
    });
    return;
  }
  accept();  // Before it is served: what that throws must not end the accepting.
  serve_(std::move(socket));
}

}  // namespace ldso

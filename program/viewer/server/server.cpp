#include "viewer/server/server.h"

#include <utility>  // Before Boost.Beast, which forgets it under GCC 12.

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <future>
#include <thread>

#include "ldso/error.h"
#include "viewer/server/connections.h"

namespace ldso {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using ErrorCode = boost::system::error_code;

constexpr std::chrono::milliseconds kTickInterval(33);
/// Pause after accepting failed, for instance for want of file descriptors.
constexpr std::chrono::milliseconds kAcceptPause(200);
/// For what is still to be sent when the server ends.
constexpr std::chrono::milliseconds kLastWords(150);

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

struct Server::Impl {
  Impl(const ServerOptions& options, LiveMap& map, Tick on_tick, CommandHandler on_command)
      : context{options, {options.address.is_loopback(), options.token}, map, std::move(on_command)},
        tick(std::move(on_tick)) {
    listen(acceptor, options.address);
    port = acceptor.local_endpoint().port();
    accept();
    schedule(std::chrono::milliseconds(0));
    thread = std::jthread([this] { work(); });
  }

  ~Impl() {
    asio::post(io, [this] { shut_down(); });
    thread.join();
    context.streams.clear();  // While there still is what their sockets live in.
  }

  /// What one connection throws must not end the others.
  void work() {
    while (true) {
      try {
        io.run();
        return;
      } catch (const std::exception&) {
        continue;
      }
    }
  }

  void shut_down() {
    acceptor.close();
    bring_up_to_date();  // One last time, so that pages hear how it ended.
    for (const auto& stream : std::set(context.streams)) stream->close();
    timer.expires_after(kLastWords);
    timer.async_wait([this](ErrorCode) { io.stop(); });
  }

  void bring_up_to_date() {
    tick(context.map, context.streams.size());
    for (const auto& stream : context.streams) stream->pump();
  }

  void accept() {
    acceptor.async_accept([this](ErrorCode error, tcp::socket socket) {
      if (error == asio::error::operation_aborted || !acceptor.is_open()) return;
      if (error) {
        pause.expires_after(kAcceptPause);
        pause.async_wait([this](ErrorCode aborted) {
          if (!aborted) accept();
        });
        return;
      }
      serve_http(context, std::move(socket));
      accept();
    });
  }

  void schedule(std::chrono::milliseconds wait) {
    timer.expires_after(wait);
    timer.async_wait([this](ErrorCode aborted) {
      if (aborted) return;
      schedule(kTickInterval);
      bring_up_to_date();
    });
  }

  ServerContext context;  // Outlives the connections, which the context of the sockets destroys.
  Tick tick;
  asio::io_context io{1};
  tcp::acceptor acceptor{io};
  asio::steady_timer timer{io}, pause{io};
  std::uint16_t port = 0;
  std::jthread thread;
};

Server::Server(const ServerOptions& options, LiveMap& map, Tick tick, CommandHandler on_command)
    : impl_(std::make_unique<Impl>(options, map, std::move(tick), std::move(on_command))) {}

Server::~Server() = default;

void Server::call(const std::function<void(LiveMap&)>& function) {
  std::packaged_task<void()> task([&] { function(impl_->context.map); });
  std::future<void> done = task.get_future();
  asio::post(impl_->io, [&task] { task(); });
  done.get();
}

std::uint16_t Server::port() const { return impl_->port; }

std::string Server::url() const {
  return viewer_url(impl_->context.options.address.host, impl_->port, impl_->context.options.token);
}

}  // namespace ldso

#include "viewer/server/server.h"

#include <utility>  // Before Boost.Beast, which forgets it under GCC 12.

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <future>
#include <thread>

#include "viewer/server/accept_loop.h"
#include "viewer/server/connections.h"

namespace ldso {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using ErrorCode = boost::system::error_code;

constexpr std::chrono::milliseconds kTickInterval(33);
/// For what is still to be sent when the server ends.
constexpr std::chrono::milliseconds kLastWords(150);

}  // namespace

struct Server::Impl {
  Impl(const ServerOptions& options, LiveMap& map, Tick on_tick, CommandHandler on_command)
      : context{options, {options.address.is_loopback(), options.token}, map, std::move(on_command)},
        tick(std::move(on_tick)),
        connections(io, options.address, [this](tcp::socket socket) { serve_http(context, std::move(socket)); }) {
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
    connections.stop();
    bring_up_to_date();  // One last time, so that pages hear how it ended.
    for (const auto& stream : std::set(context.streams)) stream->close();
    timer.expires_after(kLastWords);
    timer.async_wait([this](ErrorCode) { io.stop(); });
  }

  void bring_up_to_date() {
    tick(context.map, context.streams.size());
    for (const auto& stream : context.streams) stream->pump();
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
  AcceptLoop connections;
  asio::steady_timer timer{io};
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

std::uint16_t Server::port() const { return impl_->connections.port(); }

std::string Server::url() const {
  return viewer_url(impl_->context.options.address.host, impl_->connections.port(), impl_->context.options.token);
}

}  // namespace ldso

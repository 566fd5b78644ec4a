#include "server_connection.h"

#include <fcntl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <utility>  // Before Boost.Beast, which forgets it under GCC 12.

#include <array>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>

#include "fuzz_target.h"
#include "viewer/server/connections.h"

namespace ldso::fuzz {
namespace {

namespace asio = boost::asio;

/// Moves what the server has written into `answer`; false if there was nothing.
bool drain(int end, std::string& answer) {
  std::array<char, 65536> part;
  const ssize_t count = read(end, part.data(), part.size());
  if (count <= 0) return false;
  answer.append(part.data(), static_cast<std::size_t>(count));
  return true;
}

/// Sends as much as the socket takes.
void feed(int end, std::string_view& rest) {
  const ssize_t count = rest.empty() ? 0 : send(end, rest.data(), rest.size(), MSG_NOSIGNAL);
  if (count < 0) rest = {};
  if (count > 0) rest.remove_prefix(static_cast<std::size_t>(count));
  if (rest.empty()) shutdown(end, SHUT_WR);
}

}  // namespace

Conversation converse(std::string_view sent, const std::string& token) {
  std::array<int, 2> ends{};
  expect(socketpair(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK, 0, ends.data()) == 0, "there is a pair of sockets");
  Conversation conversation;
  LiveMap map;
  map.start({});
  const ServerOptions options;
  ServerContext context{options, {true, token}, map, [&](protocol::Command) { ++conversation.commands; }};
  {
    asio::io_context io{1};
    asio::ip::tcp::socket socket(io);
    socket.assign(asio::ip::tcp::v4(), ends[1]);
    serve_http(context, std::move(socket));
    for (bool busy = true; busy;) {
      feed(ends[0], sent);
      busy = io.poll() > 0;
      busy = drain(ends[0], conversation.answer) || busy || !sent.empty();
    }
    context.streams.clear();
    conversation.is_over = io.stopped();
  }
  close(ends[0]);
  return conversation;
}

}  // namespace ldso::fuzz

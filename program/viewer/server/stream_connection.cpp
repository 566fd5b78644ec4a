#include <boost/asio/buffer.hpp>
#include <boost/beast/core/bind_handler.hpp>
#include <boost/beast/core/buffers_to_string.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <chrono>
#include <optional>
#include <vector>

#include "viewer/server/connections.h"

namespace ldso {
namespace {

namespace beast = boost::beast;
namespace websocket = beast::websocket;
using ErrorCode = boost::system::error_code;

/// Of the map in one go: the newest view follows it at once, so that a slow line shows life while the map comes in.
constexpr std::size_t kMostBytes = 1 << 20;
/// A page has nothing longer to say.
constexpr std::size_t kMostIncomingBytes = 64;

class Stream final : public StreamConnection, public std::enable_shared_from_this<Stream> {
 public:
  Stream(ServerContext& context, beast::tcp_stream stream, ConnectionCount count)
      : context_(context), count_(std::move(count)), socket_(std::move(stream)) {}

  void accept(HttpRequest request) {
    websocket::stream_base::timeout limits{};
    limits.handshake_timeout = std::chrono::seconds(context_.options.request_seconds);
    limits.idle_timeout = std::chrono::seconds(context_.options.silent_seconds);
    limits.keep_alive_pings = true;
    socket_.set_option(limits);
    socket_.read_message_max(kMostIncomingBytes);
    socket_.binary(true);
    socket_.auto_fragment(false);
    request_ = std::move(request);
    socket_.async_accept(request_, beast::bind_front_handler(&Stream::on_accept, shared_from_this()));
  }

  void pump() override {
    if (is_writing_ || is_closing_) return;
    sent_ = context_.map.next(cursor_, kMostBytes);
    if (sent_.empty()) return;
    std::vector<boost::asio::const_buffer> buffers;
    for (const SharedBytes& message : sent_) buffers.emplace_back(message->data(), message->size());
    is_writing_ = true;
    socket_.async_write(buffers, beast::bind_front_handler(&Stream::on_write, shared_from_this()));
  }

  void close() override {
    if (is_closing_) return;
    is_closing_ = true;
    socket_.async_close(websocket::close_code::going_away, [self = shared_from_this()](ErrorCode) {});
  }

 private:
  void on_accept(ErrorCode error) {
    if (error || is_closing_) return;
    context_.streams.insert(shared_from_this());
    read();
    pump();
  }

  void read() { socket_.async_read(incoming_, beast::bind_front_handler(&Stream::on_read, shared_from_this())); }

  void on_read(ErrorCode error, std::size_t) {
    if (error) return leave();
    const auto data = incoming_.data();
    const auto command = protocol::decode_command({static_cast<const std::uint8_t*>(data.data()), data.size()});
    incoming_.consume(incoming_.size());
    if (!command) {
      leave();
      return close();
    }
    context_.on_command(*command);
    read();
  }

  void on_write(ErrorCode error, std::size_t) {
    is_writing_ = false;
    sent_.clear();
    if (error) return leave();
    pump();
  }

  void leave() { context_.streams.erase(shared_from_this()); }

  ServerContext& context_;
  ConnectionCount count_;
  websocket::stream<beast::tcp_stream> socket_;
  HttpRequest request_;
  beast::flat_buffer incoming_{kMostIncomingBytes};
  MapCursor cursor_;
  std::vector<SharedBytes> sent_;  ///< What is being written.
  bool is_writing_ = false;
  bool is_closing_ = false;
};

}  // namespace

void serve_stream(ServerContext& context, beast::tcp_stream stream, HttpRequest request, ConnectionCount count) {
  std::make_shared<Stream>(context, std::move(stream), std::move(count))->accept(std::move(request));
}

}  // namespace ldso

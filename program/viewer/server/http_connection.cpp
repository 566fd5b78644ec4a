#include <boost/beast/core/bind_handler.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/http/string_body.hpp>
#include <boost/beast/http/write.hpp>
#include <boost/beast/websocket/rfc6455.hpp>
#include <chrono>
#include <optional>
#include <string>

#include "viewer/server/connections.h"
#include "viewer/server/web_assets.h"

namespace ldso {
namespace {

namespace beast = boost::beast;
namespace http = beast::http;
using ErrorCode = boost::system::error_code;
using Response = http::response<http::string_body>;

constexpr std::size_t kMostHeaderBytes = 8192;
constexpr std::string_view kStreamPath = "/stream";

std::string_view view(beast::string_view text) { return {text.data(), text.size()}; }

/// What keeps other sites out of the page, and the page from asking other hosts for anything.
void set_security(Response& response, const std::string& host) {
  response.set(
      "Content-Security-Policy",
      "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob: data:; connect-src 'self'" +
          (host.empty() ? "" : " ws://" + host) + "; base-uri 'none'; form-action 'none'; frame-ancestors 'none'");
  response.set("X-Content-Type-Options", "nosniff");
  response.set("Referrer-Policy", "no-referrer");
  response.set("Cross-Origin-Resource-Policy", "same-origin");
  response.set("Cross-Origin-Opener-Policy", "same-origin");
  response.set(http::field::cache_control, "no-store");
}

Response make_response(http::status status, std::string_view type, std::string_view text) {
  Response response(status, 11);
  response.set(http::field::server, "ldso");
  response.set(http::field::content_type, beast::string_view(type.data(), type.size()));
  response.body() = text;
  return response;
}

Response make_refusal(http::status status, std::string_view why) {
  return make_response(status, "text/plain; charset=utf-8", std::string(why) + "\n");
}

std::string_view text_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::kWrongHost:
      return "this address is not served under that name";
    case Verdict::kWrongOrigin:
      return "pages of other sites are not answered";
    default:
      return "the token is missing or wrong: use the whole address that ldso printed";
  }
}

/// One connection, from request to request.
class HttpConnection : public std::enable_shared_from_this<HttpConnection> {
 public:
  HttpConnection(ServerContext& context, boost::asio::ip::tcp::socket socket)
      : context_(context), count_(context), stream_(std::move(socket)) {}

  void start() {
    if (context_.connections > context_.options.most_connections) {
      must_close_ = true;
      send(make_refusal(http::status::service_unavailable, "there are too many connections"));
      return;
    }
    read();
  }

 private:
  void expire() { stream_.expires_after(std::chrono::seconds(context_.options.request_seconds)); }

  void read() {
    parser_.emplace();
    parser_->header_limit(kMostHeaderBytes);
    parser_->body_limit(0);
    expire();
    http::async_read(stream_, buffer_, *parser_,
                     beast::bind_front_handler(&HttpConnection::on_read, shared_from_this()));
  }

  void on_read(ErrorCode error, std::size_t) {
    if (error == http::error::end_of_stream) return close();
    if (error == http::error::header_limit) {
      must_close_ = true;
      return send(make_refusal(http::status::request_header_fields_too_large, "the request is too long"));
    }
    if (error == http::error::body_limit) {
      must_close_ = true;
      return send(make_refusal(http::status::payload_too_large, "requests have no body here"));
    }
    if (error.category() == make_error_code(http::error::bad_target).category() &&
        error != http::error::partial_message) {
      must_close_ = true;
      return send(make_refusal(http::status::bad_request, "this is no HTTP request"));
    }
    if (error) return;  // Timed out or gone.
    handle(parser_->release());
  }

  void handle(HttpRequest request) {
    must_close_ = must_close_ || !request.keep_alive();
    is_head_ = request.method() == http::verb::head;
    host_ = std::string(view(request[http::field::host]));
    const std::string target(view(request.target()));
    const bool is_stream = path_of(target) == kStreamPath;
    const WebAsset* asset = find_web_asset(path_of(target));
    const std::string origin(view(request[http::field::origin]));
    const Verdict verdict =
        judge(context_.policy, {target, host_, origin}, is_stream || (asset != nullptr && asset->is_page));
    if (verdict != Verdict::kAllowed) return send(make_refusal(http::status::forbidden, text_of(verdict)));
    if (is_stream) return upgrade(std::move(request));
    if (request.method() != http::verb::get && !is_head_) {
      Response refusal = make_refusal(http::status::method_not_allowed, "only GET and HEAD are answered");
      refusal.set(http::field::allow, "GET, HEAD");
      return send(std::move(refusal));
    }
    if (asset == nullptr) return send(make_refusal(http::status::not_found, "there is no such page"));
    send(make_response(http::status::ok, asset->type, asset->content));
  }

  void upgrade(HttpRequest request) {
    if (!beast::websocket::is_upgrade(request)) {
      return send(make_refusal(http::status::upgrade_required, "this address is for WebSockets"));
    }
    if (context_.streams.size() >= context_.options.most_viewers) {
      return send(make_refusal(http::status::service_unavailable, "there are too many viewers"));
    }
    stream_.expires_never();  // The stream has time limits of its own.
    serve_stream(context_, std::move(stream_), std::move(request), std::move(count_));
  }

  void send(Response response) {
    set_security(response, is_loopback_host(host_) || !context_.policy.loopback_only ? safe_host() : "");
    response.keep_alive(!must_close_);
    response.prepare_payload();
    if (is_head_) response.body().clear();
    response_ = std::move(response);
    expire();
    http::async_write(stream_, response_, beast::bind_front_handler(&HttpConnection::on_write, shared_from_this()));
  }

  /// The host as it may stand in a header of ours.
  std::string safe_host() const {
    const bool is_safe =
        host_.find_first_not_of("0123456789abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ.:-[]") ==
        std::string::npos;
    return is_safe ? host_ : "";
  }

  void on_write(ErrorCode error, std::size_t) {
    if (error) return;
    if (must_close_) return close();
    read();
  }

  void close() {
    ErrorCode ignored;
    stream_.socket().shutdown(boost::asio::ip::tcp::socket::shutdown_send, ignored);
  }

  ServerContext& context_;
  ConnectionCount count_;
  beast::tcp_stream stream_;
  beast::flat_buffer buffer_{2 * kMostHeaderBytes};
  std::optional<http::request_parser<http::empty_body>> parser_;
  Response response_;
  std::string host_;
  bool is_head_ = false;
  bool must_close_ = false;
};

}  // namespace

void serve_http(ServerContext& context, boost::asio::ip::tcp::socket socket) {
  std::make_shared<HttpConnection>(context, std::move(socket))->start();
}

}  // namespace ldso

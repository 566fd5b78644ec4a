#include "viewer/server/listen_address.h"

#include <charconv>

#include "ldso/error.h"

namespace ldso {
namespace {

std::uint16_t parse_port(const std::string& digits, const std::string& text) {
  unsigned port = 0;
  const char* end = digits.data() + digits.size();
  const auto [stop, error] = std::from_chars(digits.data(), end, port);
  if (error != std::errc() || stop != end || port > 65535) {
    throw Error(text, "'" + digits + "' is no port", "write ADDRESS:PORT, e.g. 127.0.0.1:8421");
  }
  return static_cast<std::uint16_t>(port);
}

bool is_ipv6(const std::string& host) { return host.find(':') != std::string::npos; }

}  // namespace

bool ListenAddress::is_loopback() const { return host == "::1" || host.rfind("127.", 0) == 0; }

ListenAddress parse_listen_address(const std::string& text) {
  ListenAddress address;
  std::string host = text, port;
  const std::size_t bracket = text.find(']');
  if (!text.empty() && text[0] == '[') {
    if (bracket == std::string::npos) throw Error(text, "its bracket is not closed", "write [ADDRESS]:PORT");
    host = text.substr(1, bracket - 1);
    if (bracket + 1 < text.size()) {
      if (text[bracket + 1] != ':') throw Error(text, "it is no address", "write [ADDRESS]:PORT");
      port = text.substr(bracket + 2);
    }
  } else if (const std::size_t colon = text.rfind(':'); colon != std::string::npos && colon == text.find(':')) {
    host = text.substr(0, colon);
    port = text.substr(colon + 1);
    if (port.empty()) throw Error(text, "the port is missing after ':'", "write ADDRESS:PORT");
  }
  if (!port.empty()) {
    address.port = parse_port(port, text);
    address.is_port_given = true;
  }
  if (host == "localhost") host = "127.0.0.1";
  if (!host.empty()) address.host = host;
  return address;
}

std::string viewer_url(const std::string& host, std::uint16_t port, const std::string& token) {
  std::string name = host;
  if (host == "0.0.0.0") name = "127.0.0.1";
  if (host == "::") name = "::1";
  if (is_ipv6(name)) name = "[" + name + "]";
  return "http://" + name + ":" + std::to_string(port) + "/" + (token.empty() ? "" : "?token=" + token);
}

}  // namespace ldso

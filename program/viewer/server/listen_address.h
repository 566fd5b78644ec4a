#pragma once

// Where a viewer listens: as written on the command line, and as an address for a browser.

#include <cstdint>
#include <string>

namespace ldso {

inline constexpr std::uint16_t kDefaultViewerPort = 8421;

struct ListenAddress {
  std::string host = "127.0.0.1";  ///< An IP address.
  std::uint16_t port = kDefaultViewerPort;
  bool is_port_given = false;  ///< Otherwise a free one is taken if that is in use.

  bool is_loopback() const;
};

/// "ADDRESS:PORT", "ADDRESS", ":PORT" or ""; IPv6 as [::1]:8000. Throws Error if it is none of these.
ListenAddress parse_listen_address(const std::string& text);

/// What a user puts into the browser. An address that means all interfaces becomes the loopback one.
std::string viewer_url(const std::string& host, std::uint16_t port, const std::string& token);

}  // namespace ldso

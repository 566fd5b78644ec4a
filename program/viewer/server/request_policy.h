#pragma once

// Which requests a viewer answers. Pages of other sites, which a browser would let talk to any local server, are told
// apart by Host (a name of theirs that resolves to this machine: DNS rebinding) and Origin.

#include <string>
#include <string_view>

namespace ldso {

struct RequestPolicy {
  /// Whether only names of the loopback interface are taken for this host.
  bool loopback_only = true;
  /// That a request for the page or the stream must carry; empty: none.
  std::string token;
};

/// What of a request decides.
struct RequestFacts {
  std::string_view target;  ///< Path with query.
  std::string_view host;    ///< Empty if there was none.
  std::string_view origin;  ///< Empty if there was none.
};

enum class Verdict { kAllowed, kWrongHost, kWrongOrigin, kWrongToken };

/// `needs_token`: whether what is asked for is the run's and not only the page's code.
Verdict judge(const RequestPolicy& policy, const RequestFacts& facts, bool needs_token);

/// The path of a target without its query.
std::string_view path_of(std::string_view target);

/// Whether a Host header ("name", "name:port", "[::1]:port") names the loopback interface.
bool is_loopback_host(std::string_view host);

}  // namespace ldso

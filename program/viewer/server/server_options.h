#pragma once

// How a viewer serves its page, and to whom.

#include <cstddef>
#include <string>

#include "viewer/server/listen_address.h"

namespace ldso {

struct ServerOptions {
  ListenAddress address;
  std::string token;                  ///< Needed for page and stream; empty: none is.
  std::size_t most_connections = 48;  ///< Beyond these new ones are refused.
  std::size_t most_viewers = 16;      ///< Of the connections, those that receive the stream.
  int request_seconds = 10;           ///< Within which a request has to come in and its answer to be taken.
  int silent_seconds = 30;            ///< After which a page that answers no ping is given up.
};

/// For "ADDRESS:PORT" (see parse_listen_address): other addresses than those of this machine alone get a token. Throws
/// Error.
ServerOptions make_server_options(const std::string& address);

}  // namespace ldso

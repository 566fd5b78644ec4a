#include "viewer/server/server_options.h"

#include "viewer/server/random_id.h"

namespace ldso {

ServerOptions make_server_options(const std::string& address) {
  ServerOptions options;
  options.address = parse_listen_address(address);
  if (!options.address.is_loopback()) options.token = make_token();
  return options;
}

}  // namespace ldso

#include "ldso/error.h"
#include "viewer/server/server.h"

// The server of a program that was built without its viewer: there is none, and it says so.

namespace ldso {

struct Server::Impl {};

Server::Server(const ServerOptions&, LiveMap&, Tick, CommandHandler) {
  throw Error("viewer", "this ldso was built without it",
              "install libboost-dev, nodejs and npm, and build again (cmake says what was missing)");
}
Server::~Server() = default;
void Server::call(const std::function<void(LiveMap&)>&) {}
std::uint16_t Server::port() const { return 0; }
std::string Server::url() const { return {}; }

}  // namespace ldso

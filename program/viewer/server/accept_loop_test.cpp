#include "viewer/server/accept_loop.h"

#include <gtest/gtest.h>

#include <chrono>
#include <stdexcept>

#include "viewer/server/test_client.h"

namespace ldso {
namespace {

TEST(AcceptLoop, AConnectionThatCannotBeServedDoesNotEndTheAccepting) {
  boost::asio::io_context io;
  ListenAddress address;
  address.port = 0;
  int accepted = 0;
  AcceptLoop loop(io, address, [&](boost::asio::ip::tcp::socket) {
    if (++accepted == 1) throw std::runtime_error("no memory");
  });
  const TestClient first(loop.port()), second(loop.port());
  EXPECT_THROW(io.run_for(std::chrono::seconds(20)), std::runtime_error);
  while (accepted < 2 && io.run_one_for(std::chrono::seconds(20)) > 0) continue;
  EXPECT_EQ(accepted, 2);
}

}  // namespace
}  // namespace ldso

#include "viewer/server/listen_address.h"

#include <gtest/gtest.h>

#include "ldso/error.h"
#include "viewer/server/random_id.h"

namespace ldso {
namespace {

TEST(ListenAddress, IsReadAsWritten) {
  const ListenAddress plain = parse_listen_address("");
  EXPECT_EQ(plain.host, "127.0.0.1");
  EXPECT_EQ(plain.port, kDefaultViewerPort);
  EXPECT_FALSE(plain.is_port_given);
  const ListenAddress port = parse_listen_address(":9000");
  EXPECT_EQ(port.host, "127.0.0.1");
  EXPECT_EQ(port.port, 9000);
  EXPECT_TRUE(port.is_port_given);
  const ListenAddress all = parse_listen_address("0.0.0.0");
  EXPECT_EQ(all.host, "0.0.0.0");
  EXPECT_FALSE(all.is_loopback());
  const ListenAddress six = parse_listen_address("[::1]:80");
  EXPECT_EQ(six.host, "::1");
  EXPECT_EQ(six.port, 80);
  EXPECT_TRUE(six.is_loopback());
  EXPECT_EQ(parse_listen_address("fe80::1").host, "fe80::1");
  EXPECT_TRUE(parse_listen_address("localhost:1").is_loopback());
}

TEST(ListenAddress, NonsenseIsAnError) {
  for (const char* text : {"127.0.0.1:", ":x", ":70000", ":-1", "[::1", "[::1]80"}) {
    EXPECT_THROW(parse_listen_address(text), Error) << text;
  }
}

TEST(ListenAddress, AsAnAddressForABrowser) {
  EXPECT_EQ(viewer_url("127.0.0.1", 8421, ""), "http://127.0.0.1:8421/");
  EXPECT_EQ(viewer_url("0.0.0.0", 1, "ab"), "http://127.0.0.1:1/?token=ab");
  EXPECT_EQ(viewer_url("::1", 1, ""), "http://[::1]:1/");
}

TEST(ListenAddress, TokensDiffer) {
  const std::string token = make_token();
  EXPECT_EQ(token.size(), 32u);
  EXPECT_EQ(token.find_first_not_of("0123456789abcdef"), std::string::npos);
  EXPECT_NE(token, make_token());
}

}  // namespace
}  // namespace ldso

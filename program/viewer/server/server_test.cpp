#include "viewer/server/server.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <vector>

#include "ldso/error.h"
#include "viewer/server/test_client.h"

namespace ldso {
namespace {

/// A server with a map that has begun.
class ServerTest : public testing::Test {
 protected:
  void start(ServerOptions options = {}) {
    options.address.is_port_given = true;
    options.address.port = 0;
    map_.start({});
    server_ = std::make_unique<Server>(
        options, map_,
        [this](LiveMap&, std::size_t viewers) { viewers_.store(viewers), ++ticks_, ticks_.notify_all(); },
        [this](protocol::Command command) {
          last_command_.store(static_cast<int>(command)), last_command_.notify_all();
        });
  }
  TestClient client() const { return TestClient(server_->port()); }
  std::string get(const std::string& target) const { return client().get(target); }
  /// That the server still answers, and its thread still works.
  void expect_alive() {
    EXPECT_EQ(status_of(get("/")), 200);
    const int before = ticks_.load();
    ticks_.wait(before);
  }
  void wait_for_viewers(std::size_t count) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    while (viewers_.load() != count && std::chrono::steady_clock::now() < end) ticks_.wait(ticks_.load());
    EXPECT_EQ(viewers_.load(), count);
  }

  LiveMap map_;
  std::atomic<std::size_t> viewers_{0};
  std::atomic<int> ticks_{0}, last_command_{0};
  std::unique_ptr<Server> server_;
};

TEST_F(ServerTest, ServesThePageAndNothingElse) {
  start();
  const std::string page = get("/");
  EXPECT_EQ(status_of(page), 200);
  EXPECT_NE(page.find("<!doctype html>"), std::string::npos);
  EXPECT_NE(page.find("Content-Security-Policy: default-src 'none'"), std::string::npos);
  EXPECT_NE(page.find("X-Content-Type-Options: nosniff"), std::string::npos);
  EXPECT_EQ(status_of(get("/app.js")), 200);
  EXPECT_EQ(status_of(get("/style.css?x=1")), 200);
  for (const char* target : {"/nothing", "/../../etc/passwd", "/..%2f..%2fetc%2fpasswd", "/app.js/..", "//",
                             "/./app.js", "/app.js%00", "/stream/", "*"}) {
    EXPECT_EQ(status_of(get(target)), 404) << target;
  }
}

TEST_F(ServerTest, AnswersGetAndHeadOnly) {
  start();
  TestClient head = client();
  head.send("HEAD / HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n");
  const std::string answer = head.receive();
  EXPECT_EQ(status_of(answer), 200);
  EXPECT_EQ(answer.find("<html"), std::string::npos);
  TestClient post = client();
  post.send("DELETE / HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n");
  EXPECT_EQ(status_of(post.receive()), 405);
  TestClient body = client();
  body.send("POST / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 100000\r\n\r\n" + std::string(1000, 'x'));
  EXPECT_EQ(status_of(body.receive()), 413);
  EXPECT_EQ(status_of(get("/stream")), 426);
  expect_alive();
}

TEST_F(ServerTest, KeepsAConnectionForSeveralRequests) {
  start();
  TestClient one = client();
  for (int i = 0; i < 3; ++i) {
    one.send("GET /icon.svg HTTP/1.1\r\nHost: localhost\r\n\r\n");
    EXPECT_EQ(status_of(one.receive("</svg>")), 200);
  }
}

TEST_F(ServerTest, MalformedRequestsAreRefused) {
  start();
  for (const std::string& request :
       {std::string("nonsense\r\n\r\n"), std::string("GET / HTTP/9.9\r\n\r\n"), std::string(300, '\0') + "\r\n\r\n",
        std::string("GET  HTTP/1.1\r\n\r\n"), std::string("GET / HTTP/1.1\r\nbroken header\r\n\r\n"),
        std::string("\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03", 11) + std::string(200, '\xff')}) {
    TestClient attacker = client();
    attacker.send(request);
    const std::string answer = attacker.receive();
    EXPECT_TRUE(status_of(answer) == 400 || (answer.empty() && attacker.is_closed(0))) << request << "->" << answer;
  }
  TestClient long_header = client();
  long_header.send("GET / HTTP/1.1\r\nHost: localhost\r\nX: " + std::string(100000, 'x') + "\r\n\r\n");
  const std::string answer = long_header.receive();
  EXPECT_TRUE(status_of(answer) == 431 || answer.empty()) << answer;
  expect_alive();
}

TEST_F(ServerTest, OtherHostsAndOriginsAreRefused) {
  start();
  EXPECT_EQ(status_of(client().get("/", "evil.example")), 403);
  EXPECT_EQ(status_of(client().get("/app.js", "evil.example")), 403);
  EXPECT_EQ(status_of(client().upgrade("/stream", "evil.example")), 403);
  EXPECT_EQ(status_of(client().upgrade("/stream", "127.0.0.1", "Origin: http://evil.example\r\n")), 403);
  EXPECT_EQ(status_of(client().upgrade("/stream", "127.0.0.1", "Origin: null\r\n")), 403);
  EXPECT_EQ(status_of(client().upgrade("/stream", "127.0.0.1", "Origin: http://127.0.0.1\r\n")), 101);
  TestClient without_host = client();
  without_host.send("GET / HTTP/1.0\r\n\r\n");
  EXPECT_EQ(status_of(without_host.receive()), 0 + 403);
}

TEST_F(ServerTest, TokenOpensPageAndStream) {
  ServerOptions options;
  options.token = "c0ffee";
  start(options);
  EXPECT_NE(server_->url().find("/?token=c0ffee"), std::string::npos);
  EXPECT_EQ(status_of(get("/")), 403);
  EXPECT_EQ(status_of(get("/?token=c0ffef")), 403);
  EXPECT_EQ(status_of(get("/?token=c0ffee")), 200);
  EXPECT_EQ(status_of(client().upgrade("/stream")), 403);
  EXPECT_EQ(status_of(client().upgrade("/stream?token=c0ffe")), 403);
  EXPECT_EQ(status_of(client().upgrade("/stream?token=c0ffee")), 101);
}

TEST_F(ServerTest, StreamBeginsWithAHelloAndTakesCommands) {
  start();
  TestClient page = client();
  const std::string head = page.upgrade();
  EXPECT_EQ(status_of(head), 101);
  const std::string rest = head.substr(head.find("\r\n\r\n") + 4);
  const std::string hello = rest.find("LDSO") != std::string::npos ? rest : rest + page.receive("LDSO");
  EXPECT_NE(hello.find("LDSO"), std::string::npos);
  page.send_frame("\x01");
  last_command_.wait(0);
  EXPECT_EQ(last_command_.load(), static_cast<int>(protocol::Command::kPause));
  wait_for_viewers(1);
}

TEST_F(ServerTest, StreamsThatMisbehaveAreClosed) {
  // One that answers no goodbye is closed after this long: well within the patience below.
  ServerOptions options;
  options.request_seconds = 4;
  start(options);
  std::vector<std::string> attacks = {
      std::string("\x82\xff\x7f\xff\xff\xff\xff\xff\xff\xff\0\0\0\0", 14),   // 2^63 bytes announced
      std::string("\x82\xfe\xff\xff\0\0\0\0", 8) + std::string(65535, 'x'),  // 64 kB
      std::string("\x82\x01\x01", 3),                                        // not masked
      std::string("\xf2\x81\0\0\0\0\x01", 7),                                // reserved bits
      std::string("\x8b\x80\0\0\0\0", 6),                                    // reserved code
      std::string("\x89\xfe\x01\x00\0\0\0\0", 8) + std::string(256, 'x'),    // a long ping
      std::string("\x82\x81\0\0\0\0\x63", 7),                                // no command
      std::string("\x82\x80\0\0\0\0", 6),                                    // empty
      std::string("\x81\x82\0\0\0\0\xc3\x28", 8),                            // text that is no UTF-8
      std::string(2000, '\xaa'),
  };
  for (const std::string& attack : attacks) {
    TestClient attacker = client();
    ASSERT_EQ(status_of(attacker.upgrade()), 101);
    attacker.send(attack);
    EXPECT_TRUE(attacker.is_closed(10000)) << "attack of " << attack.size() << " bytes";
  }
  wait_for_viewers(0);
  expect_alive();
}

TEST_F(ServerTest, BrokenUpgradesAreRefused) {
  start();
  TestClient no_key = client();
  no_key.send(
      "GET /stream HTTP/1.1\r\nHost: localhost\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n"
      "Sec-WebSocket-Version: 13\r\n\r\n");
  EXPECT_NE(status_of(no_key.receive("\r\n\r\n")), 101);
  TestClient old_version = client();
  old_version.send(
      "GET /stream HTTP/1.1\r\nHost: localhost\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n"
      "Sec-WebSocket-Version: 1\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n");
  EXPECT_NE(status_of(old_version.receive("\r\n\r\n")), 101);
  expect_alive();
}

TEST_F(ServerTest, FiftyConnectionsAreHeldOrRefused) {
  ServerOptions options;
  options.most_connections = 20;
  options.request_seconds = 2;
  start(options);
  std::vector<TestClient> crowd;
  for (int i = 0; i < 50; ++i) crowd.push_back(client());
  for (TestClient& one : crowd) one.send("GET / HTTP/1.1\r\nHost: loc");  // and not a byte more
  int refused = 0;
  for (std::size_t i = 20; i < crowd.size(); ++i) refused += status_of(crowd[i].receive()) == 503 ? 1 : 0;
  EXPECT_EQ(refused, 30);
  // Those that were let in have had their time.
  for (std::size_t i = 0; i < 20; ++i) EXPECT_TRUE(crowd[i].is_closed(10000));
  expect_alive();
}

TEST_F(ServerTest, ViewersBeyondTheMostAreRefused) {
  ServerOptions options;
  options.most_viewers = 2;
  start(options);
  TestClient first = client(), second = client(), third = client();
  EXPECT_EQ(status_of(first.upgrade()), 101);
  EXPECT_EQ(status_of(second.upgrade()), 101);
  wait_for_viewers(2);
  EXPECT_EQ(status_of(third.upgrade()), 503);
}

TEST_F(ServerTest, AViewerThatReadsNothingHoldsUpNobody) {
  start();
  TestClient stuck = client();
  ASSERT_EQ(status_of(stuck.upgrade()), 101);
  wait_for_viewers(1);
  server_->call([](LiveMap& map) {
    for (int i = 0; i < 64; ++i) map.add_message(Bytes(1 << 20, 7));  // more than any socket takes
  });
  const int before = ticks_.load();
  while (ticks_.load() < before + 5) ticks_.wait(ticks_.load());
  TestClient reader = client();
  const std::string head = reader.upgrade();
  ASSERT_EQ(status_of(head), 101);
  std::size_t received = head.size();
  while (received < 64u << 20) {
    const std::string part = reader.receive("\x07", 5000);
    if (part.empty()) break;
    received += part.size();
  }
  EXPECT_GE(received, 64u << 20);
}

TEST_F(ServerTest, TakesAnotherPortIfTheDefaultIsTaken) {
  start();
  ServerOptions options;
  options.address.port = server_->port();
  LiveMap map;
  const auto nothing = [](LiveMap&, std::size_t) {};
  {
    const Server other(options, map, nothing, [](protocol::Command) {});
    EXPECT_NE(other.port(), server_->port());
  }
  options.address.is_port_given = true;
  EXPECT_THROW(Server(options, map, nothing, [](protocol::Command) {}), Error);
  options.address.host = "not an address";
  EXPECT_THROW(Server(options, map, nothing, [](protocol::Command) {}), Error);
}

TEST_F(ServerTest, EndsWithConnectionsOpen) {
  start();
  TestClient idle = client(), half = client(), page = client();
  half.send("GET / HT");
  ASSERT_EQ(status_of(page.upgrade()), 101);
  server_.reset();
  EXPECT_TRUE(idle.is_closed(5000));
  EXPECT_TRUE(half.is_closed(5000));
  EXPECT_TRUE(page.is_closed(5000));
}

}  // namespace
}  // namespace ldso

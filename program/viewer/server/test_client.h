#pragma once

// A client as bare as an attacker's, for the tests of the server: a socket, and what is written to it.

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdint>
#include <string>
#include <utility>

#include "util/bytes.h"

namespace ldso {

class TestClient {
 public:
  explicit TestClient(std::uint16_t port) : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    EXPECT_EQ(::connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof(address)), 0);
  }
  ~TestClient() {
    if (socket_ >= 0) ::close(socket_);
  }
  TestClient(TestClient&& other) noexcept : socket_(std::exchange(other.socket_, -1)) {}
  TestClient& operator=(TestClient&&) = delete;

  void send(const std::string& text) {
    std::size_t sent = 0;
    while (sent < text.size()) {
      const ssize_t n = ::send(socket_, text.data() + sent, text.size() - sent, MSG_NOSIGNAL);
      if (n <= 0) return;  // The server may have closed already.
      sent += static_cast<std::size_t>(n);
    }
  }

  /// What comes until `end` is in it, the server closes, or nothing comes for so long.
  std::string receive(const std::string& end = "", int milliseconds = 3000) {
    std::string text;
    char buffer[65536];
    while (end.empty() || text.find(end) == std::string::npos) {
      pollfd poll{socket_, POLLIN, 0};
      if (::poll(&poll, 1, milliseconds) <= 0) break;
      const ssize_t n = ::recv(socket_, buffer, sizeof(buffer), 0);
      if (n <= 0) {
        is_closed_ = true;
        break;
      }
      text.append(buffer, static_cast<std::size_t>(n));
    }
    return text;
  }
  /// Whether the server has closed the connection, or does within so long.
  bool is_closed(int milliseconds = 3000) {
    if (!is_closed_) receive("", milliseconds);
    return is_closed_;
  }

  /// A request that asks for the connection to be closed, and its whole answer.
  std::string get(const std::string& target, const std::string& host = "127.0.0.1", const std::string& more = "") {
    send("GET " + target + " HTTP/1.1\r\nHost: " + host + "\r\nConnection: close\r\n" + more + "\r\n");
    return receive();
  }

  /// Asks for the stream; the head of the answer.
  std::string upgrade(const std::string& target = "/stream", const std::string& host = "127.0.0.1",
                      const std::string& more = "") {
    send("GET " + target + " HTTP/1.1\r\nHost: " + host +
         "\r\nConnection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
         "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n" +
         more + "\r\n");
    return receive("\r\n\r\n");
  }

  /// One frame as browsers send them, masked (with zeros).
  void send_frame(const std::string& payload, unsigned char first_byte = 0x82) {
    std::string frame(1, static_cast<char>(first_byte));
    frame += static_cast<char>(0x80 | payload.size());
    frame += std::string(4, '\0') + payload;
    send(frame);
  }

 private:
  int socket_;
  bool is_closed_ = false;
};

inline int status_of(const std::string& answer) {
  return answer.compare(0, 9, "HTTP/1.1 ") == 0 ? std::stoi(answer.substr(9, 3)) : 0;
}

}  // namespace ldso

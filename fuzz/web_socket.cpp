// What a page may send over its stream, after a good handshake.

#include "fuzz_target.h"
#include "server_connection.h"

LDSO_FUZZ_TARGET(web_socket) {
  using namespace ldso;
  std::string sent =
      "GET /stream HTTP/1.1\r\nHost: localhost\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n"
      "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n";
  const fuzz::Conversation conversation = fuzz::converse(sent.append(input), "");
  fuzz::expect(conversation.answer.starts_with("HTTP/1.1 101 "), "the handshake is answered");
  fuzz::expect(static_cast<std::size_t>(conversation.commands) * 7 <= input.size(), "a command takes a frame");
}

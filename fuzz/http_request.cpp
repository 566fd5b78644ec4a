// What anybody may send to the viewer's port. The first line is the server's token.

#include "fuzz_target.h"
#include "server_connection.h"

LDSO_FUZZ_TARGET(http_request) {
  using namespace ldso;
  const auto [token, request] = fuzz::split_line(input);
  const fuzz::Conversation conversation = fuzz::converse(request, std::string(token));
  const std::string& answer = conversation.answer;
  fuzz::expect(answer.empty() || answer.starts_with("HTTP/1.1 "), "every answer is one of HTTP");
  const bool is_stream = answer.find("HTTP/1.1 101 ") != std::string::npos;
  fuzz::expect(is_stream || conversation.commands == 0, "only a page's stream commands");
  if (!token.empty() && request.find(token) == std::string_view::npos)
    fuzz::expect(!is_stream && answer.find("<!doctype html>") == std::string::npos, "nothing without the token");
}

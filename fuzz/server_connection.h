#pragma once

// A connection of the viewer's server without a network: its other end is ours.

#include <string>
#include <string_view>

namespace ldso::fuzz {

/// What the server answers to `sent`, after which the other side says no more, and how many commands it took.
struct Conversation {
  std::string answer;
  int commands = 0;
  bool is_over = false;  ///< Whether the server has let go of the connection.
};

/// `token`: that the server wants.
Conversation converse(std::string_view sent, const std::string& token);

}  // namespace ldso::fuzz

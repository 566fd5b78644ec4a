#pragma once

#include <stdexcept>
#include <string>

namespace ldso {

/// Bad input or bad use. The message names the file, line or frame and says what to do about it.
class Error : public std::runtime_error {
 public:
  explicit Error(const std::string& message) : std::runtime_error(message) {}
  /// "context: problem; remedy"
  Error(const std::string& context, const std::string& problem, const std::string& remedy)
      : std::runtime_error(context + ": " + problem + (remedy.empty() ? "" : "; " + remedy)) {}
};

}  // namespace ldso

#pragma once

#include <memory>
#include <stdexcept>
#include <string>

namespace ldso {

/// Bad input or bad use. The message names the file, line or frame and says what to do about it.
class Error : public std::runtime_error {
 public:
  explicit Error(const std::string& message)
      : std::runtime_error(message), parts_(std::make_shared<const Parts>(Parts{"", message, ""})) {}
  /// "context: problem; remedy"
  Error(const std::string& context, const std::string& problem, const std::string& remedy)
      : std::runtime_error(context + ": " + problem + (remedy.empty() ? "" : "; " + remedy)),
        parts_(std::make_shared<const Parts>(Parts{context, problem, remedy})) {}

  /// Where it is: a file, with ":7" behind it if it is about its line 7; "frame 7"; the name of a setting. Empty if the
  /// message does not say.
  const std::string& context() const { return parts_->context; }
  const std::string& problem() const { return parts_->problem; }
  /// What to do about it; may be empty.
  const std::string& remedy() const { return parts_->remedy; }

 private:
  struct Parts {
    std::string context, problem, remedy;
  };
  std::shared_ptr<const Parts> parts_;  ///< Copying an exception must not throw.
};

}  // namespace ldso

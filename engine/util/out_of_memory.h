#pragma once

#include <exception>
#include <memory>
#include <new>
#include <string>

namespace ldso {

/// Memory that could not be had. It is no fault of the input, and so no ldso::Error: nothing is skipped or refused
/// because of it.
class OutOfMemory : public std::bad_alloc {
 public:
  /// "out of memory while <doing>; what to do about it"
  explicit OutOfMemory(const std::string& doing)
      : message_(std::make_shared<const std::string>(
            "out of memory while " + doing +
            "; close other programs, take a machine with more memory, or give less: smaller images, fewer frames")) {}
  const char* what() const noexcept override { return message_->c_str(); }

 private:
  std::shared_ptr<const std::string> message_;  ///< Exceptions are copied, which must not throw.
};

/// What an exception says. One of the standard library for want of memory says nothing of use: then what was being done
/// ("reading frame 7"), and what to do about it.
inline std::string problem_of(const std::exception& error, const std::string& doing) {
  const bool is_plain =
      dynamic_cast<const std::bad_alloc*>(&error) != nullptr && dynamic_cast<const OutOfMemory*>(&error) == nullptr;
  return is_plain ? OutOfMemory(doing).what() : error.what();
}

}  // namespace ldso

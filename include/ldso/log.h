#pragma once

#include <functional>
#include <string>

namespace ldso {

enum class LogLevel { kInfo, kWarning };

/// Where the library says what a user should know; it prints nothing by itself. Called from any thread.
using LogSink = std::function<void(LogLevel, const std::string&)>;

}  // namespace ldso

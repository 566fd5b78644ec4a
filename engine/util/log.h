#pragma once

#include "ldso/log.h"

namespace ldso {

inline void log_to(const LogSink& sink, LogLevel level, const std::string& message) {
  if (sink) sink(level, message);
}

}  // namespace ldso

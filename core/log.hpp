// Whole lines to stderr. Libraries return statistics and do not print; tools set the level.
#pragma once

#include <string>

namespace binpick {

enum class LogLevel { kDebug, kInfo, kWarning, kError, kOff };
void set_log_level(LogLevel level);
void log_line(LogLevel level, const std::string& text);

}  // namespace binpick

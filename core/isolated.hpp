// Work that may crash, in a process of its own: a foreign reader that dies on a damaged file takes nobody with it.
#pragma once

#include <functional>
#include <optional>
#include <string>

namespace binpick {

/// Runs `body` in a child of this process and returns the bytes it produced; nothing when the child crashed, used more
/// than `cpu_seconds` of processor time, or let an exception out. What it prints is dropped.
std::optional<std::string> run_isolated(const std::function<std::string()>& body, unsigned cpu_seconds);

}  // namespace binpick

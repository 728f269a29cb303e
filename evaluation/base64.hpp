// Bytes as text (RFC 4648, with padding): pictures and lists of numbers inside a page.
#pragma once

#include <string>

namespace binpick {

std::string base64(const std::string& bytes);

}  // namespace binpick

// Messages quote what they met; a quoted line end or terminal code must not leave the line that an error has.
#pragma once

#include <algorithm>
#include <string>

namespace binpick {

/// Line ends, zero bytes and what else is a control character.
inline bool is_control(char c) { return static_cast<unsigned char>(c) < 32 || c == 127; }

/// The text with a '?' for every control character.
inline std::string one_line(std::string text) {
  std::replace_if(text.begin(), text.end(), is_control, '?');
  return text;
}

}  // namespace binpick

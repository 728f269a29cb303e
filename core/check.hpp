// BP_CHECK: a broken invariant is our own bug. Always on, whatever NDEBUG says; only the campaign runner catches it.
#pragma once

#include <sstream>
#include <stdexcept>
#include <string>

namespace binpick {

class InvariantError : public std::logic_error {
 public:
  using std::logic_error::logic_error;
};

namespace detail {
[[noreturn]] inline void fail_check(const char* file, int line, const char* condition, const std::string& values) {
  std::ostringstream text;
  text << file << ":" << line << ": broken invariant: " << condition;
  if (!values.empty()) text << " (" << values << ")";
  throw InvariantError(text.str());
}
}  // namespace detail

}  // namespace binpick

/// BP_CHECK(condition) or BP_CHECK(condition, a << " against " << b).
#define BP_CHECK(condition, ...)                                                            \
  do {                                                                                      \
    if (!(condition)) {                                                                     \
      std::ostringstream bp_values;                                                         \
      __VA_OPT__(bp_values << __VA_ARGS__;)                                                 \
      ::binpick::detail::fail_check(__FILE__, __LINE__, #condition, bp_values.str());       \
    }                                                                                       \
  } while (false)

// "5 mm" -> 0.005: numbers with a unit, converted to SI at the edge of the program.
#pragma once

#include <string>
#include <string_view>

#include "core/config.hpp"

namespace binpick {

/// Parses "0.4", "5 mm", "12 deg", "250 ms". A bare number is SI. Throws SpecError when the text is not a finite number
/// in the C locale or the unit does not measure `unit`.
double parse_quantity(std::string_view text, Unit unit);

/// The shortest text that reads back to the same double.
std::string format_double(double value);

}  // namespace binpick

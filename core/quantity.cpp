#include "core/quantity.hpp"

#include <charconv>
#include <cmath>
#include <numbers>
#include <string>

#include "core/error.hpp"

namespace binpick {
namespace {

struct UnitName {
  const char* name;
  Unit unit;
  double factor;
};

constexpr double kDegree = std::numbers::pi / 180;

constexpr UnitName kUnits[] = {
    {"m", Unit::kLength, 1},
    {"cm", Unit::kLength, 1e-2},
    {"mm", Unit::kLength, 1e-3},
    {"um", Unit::kLength, 1e-6},
    {"inch", Unit::kLength, 0.0254},
    {"rad", Unit::kAngle, 1},
    {"deg", Unit::kAngle, kDegree},
    {"s", Unit::kTime, 1},
    {"ms", Unit::kTime, 1e-3},
    {"kg", Unit::kMass, 1},
    {"g", Unit::kMass, 1e-3},
    {"kg/m^3", Unit::kDensity, 1},
    {"g/cm^3", Unit::kDensity, 1e3},
    {"m/s", Unit::kSpeed, 1},
    {"mm/s", Unit::kSpeed, 1e-3},
    {"rad/s", Unit::kAngularSpeed, 1},
    {"deg/s", Unit::kAngularSpeed, kDegree},
    {"m/s^2", Unit::kAcceleration, 1},
    {"Pa", Unit::kPressure, 1},
    {"kPa", Unit::kPressure, 1e3},
    {"bar", Unit::kPressure, 1e5},
    {"mbar", Unit::kPressure, 1e2},
    {"N", Unit::kForce, 1},
    {"N/m", Unit::kStiffness, 1},
    {"N/mm", Unit::kStiffness, 1e3},
};

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

std::string names_of(Unit unit) {
  std::string names;
  for (const UnitName& u : kUnits)
    if (u.unit == unit) names += (names.empty() ? "" : ", ") + std::string(u.name);
  return names.empty() ? "none" : names;
}

}  // namespace

double parse_quantity(std::string_view text, Unit unit) {
  const std::string_view body = trimmed(text);
  double value = 0;
  const char* begin = body.data();
  if (!body.empty() && body.front() == '+') ++begin;
  const auto [end, error] = std::from_chars(begin, body.data() + body.size(), value);
  const std::string shown = "'" + std::string(body) + "'";
  if (error != std::errc() || !std::isfinite(value)) throw SpecError(shown + " is not a finite number");
  const std::string_view suffix = trimmed(body.substr(static_cast<std::size_t>(end - body.data())));
  if (suffix.empty()) return value;
  for (const UnitName& u : kUnits)
    if (suffix == u.name && u.unit == unit) return value * u.factor;
  throw SpecError(shown + ": unit '" + std::string(suffix) + "' does not fit here (allowed: " + names_of(unit) + ")");
}

std::string format_double(double value) {
  char buffer[40];
  const auto result = std::to_chars(buffer, buffer + sizeof buffer, value);
  return std::string(buffer, result.ptr);
}

}  // namespace binpick

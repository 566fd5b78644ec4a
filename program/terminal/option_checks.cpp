#include "terminal/option_checks.h"

#include <cmath>
#include <cstddef>
#include <string>

#include "io/text/text_file.h"

namespace ldso {
namespace {

bool is_above_zero(const std::string& text) {
  double value = 0;
  return parse_number(text, value) && std::isfinite(value) && value > 0;
}

/// Checks return what is wrong, or nothing.
std::string check_positive(const std::string& text) {
  return is_above_zero(text) ? "" : "'" + text + "' is not a number above 0";
}

std::string check_from_zero(const std::string& text) {
  double value = 0;
  const bool good = parse_number(text, value) && std::isfinite(value) && value >= 0;
  return good ? "" : "'" + text + "' is not a number of 0 or more";
}

std::string read_frame_rate(std::string& text) {
  const std::size_t stroke = text.find('/');
  const std::string above = text.substr(0, stroke);
  const std::string below = stroke == std::string::npos ? "1" : text.substr(stroke + 1);
  if (!is_above_zero(above) || !is_above_zero(below))
    return "'" + text + "' is no frame rate: images a second are expected, `30`, `29.97` or `30000/1001`";
  if (stroke == std::string::npos) return "";
  double images = 0, seconds = 1;
  parse_number(above, images);
  parse_number(below, seconds);
  std::ostringstream number = number_stream();
  number << images / seconds;
  text = number.str();
  return "";
}

}  // namespace

CLI::Validator positive_number() { return {check_positive, "POSITIVE", "POSITIVE"}; }

CLI::Validator number_from_zero() { return {check_from_zero, "NONNEGATIVE", "NONNEGATIVE"}; }

CLI::Validator frame_rate() { return {read_frame_rate, "RATE", "RATE"}; }

}  // namespace ldso

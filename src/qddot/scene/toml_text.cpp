#include <cctype>

#include <fmt/format.h>

#include "qddot/scene/invalid_input.hpp"
#include "qddot/scene/text_file.hpp"
#include "qddot/scene/toml_table.hpp"

namespace qddot {
namespace {

// toml++ nests a table for each part of a dotted key and destroys them recursively: a key of a
// hundred thousand parts would exhaust the stack. So a line's dots are bounded before it is parsed.
// Dots that cannot part keys do not count: the first in a number, and all but the first in a row.
void refuse_deep_keys(const std::string& text, const std::string& path) {
  constexpr int most = 50;
  const auto digit_at = [&](std::size_t i) {
    return i < text.size() && text[i] >= '0' && text[i] <= '9';
  };
  int line = 1, dots = 0;
  bool word_has_dot = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const unsigned char c = text[i];
    if (c == '\n') {
      ++line;
      dots = 0;
    }
    if (c != '.') {
      word_has_dot = word_has_dot && (std::isalnum(c) || c == '_' || c == '-' || c == '+');
      continue;
    }
    const bool decimal = !word_has_dot && digit_at(i - 1) && digit_at(i + 1);
    const bool repeated = i > 0 && text[i - 1] == '.';
    word_has_dot = true;
    dots += !decimal && !repeated;
    if (dots > most)
      throw InvalidInput(
          fmt::format("{}:{}: the line has too many dots; allowed are {} beside those of numbers",
                      path, line, most));
  }
}

}  // namespace

toml::table parse_toml(const std::string& text, const std::string& path) {
  refuse_deep_keys(text, path);
  try {
    return toml::parse(text);
  } catch (const toml::parse_error& error) {
    const auto& place = error.source().begin;
    throw InvalidInput(fmt::format("{}:{}:{}: this is not TOML: {}", path, place.line, place.column,
                                   shown(error.description(), 200)));
  }
}

}  // namespace qddot

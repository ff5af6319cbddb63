#include "experiments/kit/written_table.hpp"

#include <charconv>
#include <fstream>
#include <iterator>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "qddot/scene/invalid_input.hpp"

namespace qddot::inline kit {
namespace {

// The rows of a text by RFC 4180: quoted fields may hold commas, line ends and doubled quotes.
std::vector<std::vector<std::string>> rows_of(const std::string& text) {
  std::vector<std::vector<std::string>> rows;
  std::vector<std::string> row;
  std::string field;
  bool is_quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '"' && is_quoted && i + 1 < text.size() && text[i + 1] == '"') {
      field += text[++i];
    } else if (c == '"') {
      is_quoted = !is_quoted;
    } else if (is_quoted || (c != ',' && c != '\n')) {
      field += c;
    } else {
      row.push_back(std::exchange(field, {}));
      if (c == '\n') rows.push_back(std::exchange(row, {}));
    }
  }
  if (!field.empty() || !row.empty()) {  // the last line is without its end
    row.push_back(field);
    rows.push_back(row);
  }
  return rows;
}

}  // namespace

WrittenTable::WrittenTable(const std::string& path, const std::vector<std::string>& needed)
    : path_(path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw InvalidInput(fmt::format("{}: it cannot be read", path));
  rows_ = rows_of({std::istreambuf_iterator<char>(file), {}});
  if (rows_.empty()) throw InvalidInput(fmt::format("{}: it is empty", path));
  for (std::size_t i = 0; i < rows_[0].size(); ++i) columns_[rows_[0][i]] = i;
  for (const std::string& name : needed) {
    if (columns_.contains(name)) continue;
    throw InvalidInput(fmt::format("{}: the column {} is missing", path, name));
  }
  const std::size_t width = rows_[0].size();
  rows_.erase(rows_.begin());
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    if (rows_[i].size() == width) continue;
    throw InvalidInput(fmt::format("{}: row {} has {} fields, and the header {}", path, i + 1,
                                   rows_[i].size(), width));
  }
}

const std::string& WrittenTable::text(std::size_t row, const std::string& column) const {
  return rows_[row][columns_.at(column)];
}

double WrittenTable::number(std::size_t row, const std::string& column) const {
  const std::string& field = text(row, column);
  if (field.empty()) return std::numeric_limits<double>::quiet_NaN();
  double value = 0;
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
  if (error == std::errc() && end == field.data() + field.size()) return value;
  throw InvalidInput(
      fmt::format("{}: row {}: {} is '{}', which is no number", path_, row + 1, column, field));
}

}  // namespace qddot::inline kit

#include "experiments/kit/csv.hpp"

#include <charconv>
#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <sstream>

#include <fmt/compile.h>
#include <nlohmann/json.hpp>

#include "qddot/scene/invalid_input.hpp"

namespace qddot::inline kit {

Csv::Csv(const std::vector<std::string>& header) {
  for (const auto& name : header) field(name);
  end_row();
}

void Csv::field(double value) {
  separate();
  if (std::isfinite(value))
    fmt::format_to(std::back_inserter(text_), FMT_COMPILE("{:.17g}"), value);
}

void Csv::field(std::string_view text) {
  separate();
  if (text.find_first_of(",\"\r\n") == text.npos) {
    text_.append(text.data(), text.data() + text.size());
    return;
  }
  text_.push_back('"');
  for (const char c : text) {
    if (c == '"') text_.push_back('"');
    text_.push_back(c);
  }
  text_.push_back('"');
}

void Csv::end_row() {
  text_.push_back('\n');
  row_is_empty_ = true;
}

std::vector<std::string> columns_in(const std::string& names) {
  std::istringstream words(names);
  return {std::istream_iterator<std::string>(words), {}};
}

std::string sidecar_of(const std::string& path) {
  return (path.ends_with(".csv") ? path.substr(0, path.size() - 4) : path) + ".json";
}

std::string text_of_sidecar(const nlohmann::json& origin) {
  // A path in a command line may hold bytes that are no UTF-8.
  return origin.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

CsvFile::CsvFile(const std::string& path, const std::vector<std::string>& header)
    : Csv(header), file_(path, std::string(text()), sidecar_of(path)), sidecar_(sidecar_of(path)) {}

void CsvFile::complete(const nlohmann::json& origin) {
  flush();
  sidecar_.write(text_of_sidecar(origin));
  file_.complete();
  sidecar_.complete();
}

void CsvFile::commit() {
  file_.commit();
  sidecar_.commit();
}

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

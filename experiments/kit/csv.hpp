#pragma once

#include <concepts>
#include <functional>
#include <initializer_list>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json_fwd.hpp>

#include "experiments/kit/whole_file.hpp"

namespace qddot::inline kit {

// A table in CSV (RFC 4180), with lines ended by a line feed and one header row. Numbers have 17
// significant digits, enough to read back the same double; fields of numbers that are not finite
// are empty.
class Csv {
 public:
  explicit Csv(const std::vector<std::string>& header);
  // A table of rows without a header, for the rows() of another table.
  Csv() = default;

  // Appends one row, a field for each argument: numbers, or text that is quoted where it must be.
  template <class... Fields>
  void row(const Fields&... fields) {
    (field(fields), ...);
    end_row();
  }
  void field(double value);
  template <std::integral Integer>
  void field(Integer value) {
    separate();
    const fmt::format_int digits(value);
    text_.append(digits.data(), digits.data() + digits.size());
  }
  void field(std::string_view text);
  void end_row();
  // Appends rows that another table of the same columns wrote, without its header.
  void rows(std::string_view text) { text_.append(text.data(), text.data() + text.size()); }

  std::string_view text() const { return {text_.data(), text_.size()}; }
  void clear() { text_.clear(); }

 private:
  void separate() {
    if (!row_is_empty_) text_.push_back(',');
    row_is_empty_ = false;
  }

  fmt::memory_buffer text_;
  bool row_is_empty_ = true;
};

// The names in a text such as "method h error".
std::vector<std::string> columns_in(const std::string& names);

// The sidecar X.json of a table X.csv.
std::string sidecar_of(const std::string& path);

// The text of a sidecar that records how a result was made (see provenance.hpp).
std::string text_of_sidecar(const nlohmann::json& origin);

// A Csv that goes to a file X.csv as it grows, and appears there on commit(), together with its
// sidecar X.json. Throws InvalidInput at once if either place cannot be written.
class CsvFile : public Csv {
 public:
  CsvFile(const std::string& path, const std::vector<std::string>& header);

  const std::string& path() const { return file_.path(); }
  // Writes the rows to the file once they exceed a megabyte.
  void flush_if_large() {
    if (text().size() > (1 << 20)) flush();
  }
  // Writes the rest of table and sidecar. `origin`: how the table was made (see provenance.hpp).
  void complete(const nlohmann::json& origin);
  // Gives both files their names. The disk holds all of them already.
  void commit();
  void commit(const nlohmann::json& origin) {
    complete(origin);
    commit();
  }

 private:
  void flush() {
    file_.write(text());
    clear();
  }

  WholeFile file_, sidecar_;
};

// The columns of a table, each with its name and its value. A row is made from one `Source`.
template <class Source>
class Columns {
 public:
  struct Column {
    // value: a member of Source, or a function of one; it gives a number or text.
    template <class Value>
    Column(std::string_view its_name, Value value)
        : name(its_name), write([value = std::move(value)](Csv& csv, const Source& source) {
            csv.field(std::invoke(value, source));
          }) {}

    std::string name;
    std::function<void(Csv&, const Source&)> write;
  };

  Columns(std::initializer_list<Column> columns) : columns_(columns) {}
  Columns& operator+=(const Columns& more) {
    columns_.insert(columns_.end(), more.columns_.begin(), more.columns_.end());
    return *this;
  }

  std::vector<std::string> header() const {
    std::vector<std::string> names;
    for (const Column& column : columns_) names.push_back(column.name);
    return names;
  }
  void write_row(Csv& csv, const Source& source) const {
    for (const Column& column : columns_) column.write(csv, source);
    csv.end_row();
  }

 private:
  std::vector<Column> columns_;
};

// A table that a program wrote (see csv.hpp), read back: a header row, then rows of equal length.
class WrittenTable {
 public:
  // Throws InvalidInput if the file cannot be read, a row has more or fewer fields than the header,
  // or a column of `needed` is missing. The sentence names the file and the problem.
  WrittenTable(const std::string& path, const std::vector<std::string>& needed);

  std::size_t size() const { return rows_.size(); }
  // A field, by its row and its column's name, which must be one of `needed`.
  const std::string& text(std::size_t row, const std::string& column) const;
  // The field as a number, NaN if it is empty. Throws InvalidInput if it is anything else.
  double number(std::size_t row, const std::string& column) const;

 private:
  std::string path_;
  std::map<std::string, std::size_t> columns_;
  std::vector<std::vector<std::string>> rows_;
};

}  // namespace qddot::inline kit

#pragma once

#include <functional>
#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "experiments/kit/csv.hpp"

namespace qddot::inline kit {

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

}  // namespace qddot::inline kit

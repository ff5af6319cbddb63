#pragma once

#include <map>
#include <string>
#include <vector>

namespace qddot::command {

// A table that a program wrote (see csv.hpp), read back: a header row, then rows of as many fields.
class WrittenTable {
 public:
  // Throws InvalidInput, in a sentence that names the file and what is wrong, where it cannot be
  // read, a row has more or fewer fields than the header, or a column of `needed` is missing.
  WrittenTable(const std::string& path, const std::vector<std::string>& needed);

  std::size_t size() const { return rows_.size(); }
  // A field, by its row and its column's name, which must be one of `needed`.
  const std::string& text(std::size_t row, const std::string& column) const;
  // The same as a number, which is none where the field is empty. Throws InvalidInput where it is
  // something else.
  double number(std::size_t row, const std::string& column) const;

 private:
  std::string path_;
  std::map<std::string, std::size_t> columns_;
  std::vector<std::vector<std::string>> rows_;
};

}  // namespace qddot::command

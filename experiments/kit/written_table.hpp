#pragma once

#include <map>
#include <string>
#include <vector>

namespace qddot::inline kit {

// A table that a program wrote (see csv.hpp), read back: a header row, then rows of equal length.
class WrittenTable {
 public:
  // Throws InvalidInput if the file cannot be read, if a row has more or fewer fields than the
  // header, or if a column of `needed` is missing. The sentence names the file and the problem.
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

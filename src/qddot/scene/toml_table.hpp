#pragma once

#include <array>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>
#include <toml++/toml.h>

namespace qddot {

// The allowed numbers of a key, and their name in messages.
struct Range {
  bool (*holds)(double);
  std::string_view words;
};
inline constexpr Range any_number{[](double) { return true; }, "finite numbers"};
inline constexpr Range not_negative{[](double x) { return x >= 0; }, "finite numbers from 0"};
inline constexpr Range positive{[](double x) { return x > 0; }, "finite numbers above 0"};

// The finite number that a node holds, if it holds one; an integer serves as a number.
std::optional<double> finite_number(const toml::node& node);

// A table of a TOML file and its place there. Wrong content is refused: InvalidInput names file,
// line, entry, key, value and what is allowed. Integers serve as numbers.
class TomlTable {
 public:
  // `table` and `file` must outlive this; `entry` is empty for the file's top level.
  TomlTable(const toml::table& table, const std::string& file, std::string entry = "")
      : table_(table), file_(file), entry_(std::move(entry)) {}

  bool has(std::string_view key) const { return table_.contains(key); }
  // All keys of the table; and a check that refuses all keys but these.
  std::vector<std::string> keys() const;
  void allow_keys(std::initializer_list<std::string_view> keys) const;

  // The number at `key`, in the range; or `standard` if the key is missing.
  double number(std::string_view key, const Range& range = any_number) const;
  double number_or(double standard, std::string_view key, const Range& range = any_number) const {
    return has(key) ? number(key, range) : standard;
  }
  // `size` finite numbers; the rest of the three are zero.
  Eigen::Vector3d vector(std::string_view key, int size) const;
  Eigen::Vector3d vector_or_zero(std::string_view key, int size) const {
    return has(key) ? vector(key, size) : Eigen::Vector3d::Zero();
  }
  // Any number of finite numbers, and of such vectors; one at least.
  std::vector<double> numbers(std::string_view key) const;
  std::vector<Eigen::Vector3d> vectors(std::string_view key, int size) const;
  // An integer in [low, high].
  int integer(std::string_view key, int low, int high) const;
  // Some of `count` nodes, by their indices; one at least.
  std::vector<std::size_t> nodes(std::string_view key, std::size_t count) const;
  // Two of `count` nodes, by their indices.
  std::array<std::size_t, 2> node_pair(std::string_view key, std::size_t count) const;
  // The boolean at `key`, false if the key is missing; whether there is a string; the string; the
  // table.
  bool flag_or_false(std::string_view key) const;
  bool is_text(std::string_view key) const;
  std::string text(std::string_view key) const;
  TomlTable table(std::string_view key) const;
  // The tables of an array of tables; none if the key is missing.
  std::vector<TomlTable> tables(std::string_view key) const;

  // Refuses the value at `key`, or that there is none. `allowed` completes "allowed are".
  [[noreturn]] void refuse(std::string_view key, std::string_view allowed) const;
  // Throws InvalidInput: `what`, after the file, line and name of `key`.
  [[noreturn]] void fail(std::string_view key, std::string_view what) const;
  // "file:line: entry" of this table, "file" of the top level.
  std::string place() const;

 private:
  std::string name_of(std::string_view key) const;

  const toml::table& table_;
  const std::string& file_;
  std::string entry_;
};

// Parses the TOML text of the file `path`. Throws InvalidInput with file, line and column if it is
// not TOML, or if its keys are nested deeper than the parser bears.
toml::table parse_toml(const std::string& text, const std::string& path);

}  // namespace qddot

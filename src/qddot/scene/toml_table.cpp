#include "qddot/scene/toml_table.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include <fmt/format.h>

#include "qddot/scene/invalid_input.hpp"
#include "qddot/scene/text_file.hpp"

namespace qddot {
namespace {

// A float always has a point, an exponent or letters in TOML.
std::string written(double number) {
  const std::string digits = fmt::format("{}", number);
  return digits.find_first_not_of("-0123456789") == digits.npos ? digits + ".0" : digits;
}

std::string written(const toml::node& node) {
  if (node.is_table()) return "a table";
  if (const auto* number = node.as_floating_point()) return written(number->get());
  if (const auto* array = node.as_array()) {
    std::vector<std::string> entries;
    for (const toml::node& entry : *array) entries.push_back(written(entry));
    return fmt::format("[{}]", fmt::join(entries, ", "));
  }
  std::ostringstream out;
  node.visit([&](const auto& value) { out << value; });
  return out.str();
}

// An array of so many finite numbers as a vector.
std::optional<Eigen::Vector3d> vector_in(const toml::array* array, int size) {
  if (!array || array->size() != static_cast<std::size_t>(size)) return {};
  Eigen::Vector3d x = Eigen::Vector3d::Zero();
  for (int k = 0; k < size; ++k) {
    const auto value = finite_number((*array)[static_cast<std::size_t>(k)]);
    if (!value) return {};
    x[k] = *value;
  }
  return x;
}

}  // namespace

std::optional<double> finite_number(const toml::node& node) {
  if (const auto* integer = node.as_integer()) return static_cast<double>(integer->get());
  const auto* number = node.as_floating_point();
  return number && std::isfinite(number->get()) ? std::optional(number->get()) : std::nullopt;
}

std::vector<std::string> TomlTable::keys() const {
  std::vector<std::string> all;
  for (const auto& [key, value] : table_) all.emplace_back(key.str());
  return all;
}

void TomlTable::allow_keys(std::initializer_list<std::string_view> keys) const {
  for (const auto& [key, value] : table_) {
    if (std::find(keys.begin(), keys.end(), key.str()) == keys.end())
      fail(key, fmt::format("it is an unknown key; allowed are {}", fmt::join(keys, ", ")));
  }
}

double TomlTable::number(std::string_view key, const Range& range) const {
  const toml::node* node = table_.get(key);
  const auto value = node ? finite_number(*node) : std::nullopt;
  if (!value || !range.holds(*value)) refuse(key, range.words);
  return *value;
}

Eigen::Vector3d TomlTable::vector(std::string_view key, int size) const {
  const auto x = vector_in(table_[key].as_array(), size);
  if (!x) refuse(key, fmt::format("arrays of {} finite number{}", size, size == 1 ? "" : "s"));
  return *x;
}

std::vector<double> TomlTable::numbers(std::string_view key) const {
  std::vector<double> all;
  if (const toml::array* array = table_[key].as_array()) {
    for (const toml::node& entry : *array) {
      const auto value = finite_number(entry);
      if (!value) refuse(key, "arrays of finite numbers");
      all.push_back(*value);
    }
  }
  if (all.empty()) refuse(key, "arrays of finite numbers");
  return all;
}

std::vector<Eigen::Vector3d> TomlTable::vectors(std::string_view key, int size) const {
  std::vector<Eigen::Vector3d> all;
  const std::string allowed =
      fmt::format("arrays of arrays of {} finite number{}", size, size == 1 ? "" : "s");
  if (const toml::array* array = table_[key].as_array()) {
    for (const toml::node& entry : *array) {
      const auto x = vector_in(entry.as_array(), size);
      if (!x) refuse(key, allowed);
      all.push_back(*x);
    }
  }
  if (all.empty()) refuse(key, allowed);
  return all;
}

int TomlTable::integer(std::string_view key, int low, int high) const {
  const auto* value = table_[key].as_integer();
  if (!value || value->get() < low || value->get() > high)
    refuse(key, low == high ? fmt::format("no integers but {}", low)
                            : fmt::format("integers from {} to {}", low, high));
  return static_cast<int>(value->get());
}

std::vector<std::size_t> TomlTable::nodes(std::string_view key, std::size_t count) const {
  const toml::array* array = table_[key].as_array();
  if (!array || array->empty() || !array->is_homogeneous<std::int64_t>())
    refuse(key, fmt::format("arrays of nodes from 0 to {}", count - 1));
  std::vector<std::size_t> all;
  for (const toml::node& entry : *array) {
    const std::int64_t node = entry.as_integer()->get();
    if (node < 0 || static_cast<std::size_t>(node) >= count)
      fail(key, fmt::format("{} is not a node; allowed are 0 to {}", node, count - 1));
    all.push_back(static_cast<std::size_t>(node));
  }
  return all;
}

std::array<std::size_t, 2> TomlTable::node_pair(std::string_view key, std::size_t count) const {
  const toml::array* array = table_[key].as_array();
  if (!array || array->size() != 2 || !array->is_homogeneous<std::int64_t>())
    refuse(key, fmt::format("pairs of nodes from 0 to {}", count - 1));
  const std::vector<std::size_t> pair = nodes(key, count);
  return {pair[0], pair[1]};
}

bool TomlTable::flag_or_false(std::string_view key) const {
  if (!has(key)) return false;
  const auto* flag = table_[key].as_boolean();
  if (!flag) refuse(key, "true and false");
  return flag->get();
}

bool TomlTable::is_text(std::string_view key) const { return table_[key].is_string(); }

std::string TomlTable::text(std::string_view key) const {
  const auto* text = table_[key].as_string();
  if (!text) refuse(key, "quoted texts");
  return text->get();
}

TomlTable TomlTable::table(std::string_view key) const {
  const auto* table = table_[key].as_table();
  if (!table) refuse(key, fmt::format("tables, written [{}]", key));
  return {*table, file_, name_of(key)};
}

std::vector<TomlTable> TomlTable::tables(std::string_view key) const {
  if (!has(key)) return {};
  const toml::array* array = table_[key].as_array();
  if (!array || !(array->empty() || array->is_array_of_tables()))
    refuse(key, fmt::format("arrays of tables, written [[{}]]", name_of(key)));
  std::vector<TomlTable> all;
  all.reserve(array->size());
  for (const toml::node& node : *array)
    all.emplace_back(*node.as_table(), file_, fmt::format("{}[{}]", name_of(key), all.size()));
  return all;
}

void TomlTable::refuse(std::string_view key, std::string_view allowed) const {
  const toml::node* node = table_.get(key);
  const std::string what = node ? shown(written(*node)) + " is not allowed" : "it is missing";
  fail(key, fmt::format("{}; allowed are {}", what, allowed));
}

void TomlTable::fail(std::string_view key, std::string_view what) const {
  const toml::node* node = table_.get(key);
  throw InvalidInput(fmt::format("{}:{}: {}: {}", file_,
                                 (node ? *node : table_).source().begin.line, name_of(key), what));
}

std::string TomlTable::place() const {
  if (entry_.empty()) return file_;
  return fmt::format("{}:{}: {}", file_, table_.source().begin.line, entry_);
}

std::string TomlTable::name_of(std::string_view key) const {
  return entry_.empty() ? shown(key) : fmt::format("{}.{}", entry_, shown(key));
}

}  // namespace qddot

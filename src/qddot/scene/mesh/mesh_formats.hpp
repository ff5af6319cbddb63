#pragma once

#include <charconv>
#include <optional>
#include <string>
#include <string_view>

#include "qddot/scene/mesh/mesh.hpp"

namespace qddot::mesh {

// Whether a backslash at a line's end joins the next line to it.
enum class Backslash { is_a_character, continues_lines };

// The words of a mesh file, and the line of the last one. Lines end with LF, CR LF or CR alone; a
// '#' ends its line's words.
class Words {
 public:
  // Both must outlive this.
  Words(std::string_view text, const std::string& file,
        Backslash backslash = Backslash::is_a_character)
      : text_(text), file_(file), backslash_(backslash) {}

  // The next word of this line; empty at the line's end.
  std::string_view in_line();
  // The next word of this or a later line; empty at the file's end.
  std::string_view next();
  // Steps to the start of the next line; false where there is none.
  bool next_line();

  // All that is left of this line.
  std::string_view rest_of_line();

  int line() const { return line_; }
  // The place of the next character, and a step to another place behind it.
  std::size_t at() const { return at_; }
  void go_to(std::size_t at) { at_ = at; }

  // Throws InvalidInput: `value`, met in `line`, is not one of those `allowed`.
  [[noreturn]] void refuse(std::string_view field, std::string_view value, std::string_view allowed,
                           int line) const;
  [[noreturn]] void refuse(std::string_view field, std::string_view value,
                           std::string_view allowed) const {
    refuse(field, value, allowed, line_);
  }
  // The finite number that `word` gives; else it is refused.
  double number(std::string_view field, std::string_view word) const;

 private:
  void pass_line();  // to its end
  bool pass_line_end();
  bool is_continued() const;

  std::string_view text_;
  const std::string& file_;
  Backslash backslash_;
  std::size_t at_ = 0;
  int line_ = 1;
};

// The number that is all of `word`, with or without a sign.
template <class Number>
std::optional<Number> number_in(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  Number value{};
  const char* last = word.data() + word.size();
  const auto [end, error] = std::from_chars(word.data(), last, value);
  return error == std::errc() && end == last ? std::optional(value) : std::nullopt;
}

// The real number that is all of `word`. Its exponent may follow e or, as Fortran writes it, d.
std::optional<double> real_in(std::string_view word);

// Read one format each. Edges and vertices of groups come as the file has them: repeated, in either
// direction, unsorted.
Mesh read_obj(std::string_view text, const std::string& file);
Mesh read_medit(std::string_view text, const std::string& file);
Mesh read_gmsh(std::string_view text, const std::string& file);
Mesh read_ply(std::string_view text, const std::string& file);
Mesh read_stl(std::string_view text, const std::string& file);

}  // namespace qddot::mesh

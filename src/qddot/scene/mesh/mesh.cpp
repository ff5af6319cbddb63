#include "qddot/scene/mesh/mesh.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include <fmt/format.h>

#include "qddot/model/grouped.hpp"
#include "qddot/scene/invalid_input.hpp"
#include "qddot/scene/mesh/mesh_formats.hpp"
#include "qddot/scene/mesh/weld.hpp"

namespace qddot::mesh {
namespace {

using Reader = Mesh (*)(std::string_view text, const std::string& file);

// Nullptr if the ending is that of no mesh.
Reader reader_of(const std::filesystem::path& file) {
  std::string ending = file.extension().string();
  for (char& c : ending) {
    if (c >= 'A' && c <= 'Z') c += 'a' - 'A';
  }
  if (ending == ".obj") return read_obj;
  if (ending == ".mesh") return read_medit;
  if (ending == ".msh") return read_gmsh;
  if (ending == ".ply") return read_ply;
  if (ending == ".stl") return read_stl;
  return nullptr;
}

Reader reader_for(const std::filesystem::path& file) {
  if (const Reader reader = reader_of(file)) return reader;
  throw InvalidInput(fmt::format(
      "{}: the ending \"{}\" is not allowed; allowed are .obj, .mesh, .msh, .ply and .stl",
      file.string(), file.extension().string()));
}

// Lines end with a line feed, a carriage return, or both, as each system writes them.
bool is_line_end(char c) { return c == '\n' || c == '\r'; }

bool is_blank(char c) { return static_cast<unsigned char>(c) <= ' ' && !is_line_end(c); }

// Calls see(elements) with those of each group that share their first number, sorted, in the order
// of these numbers. The first numbers are below `vertices`. In linear time if groups are small.
template <class Element, class See>
void for_sorted_groups(const std::vector<Element>& elements, std::size_t vertices, const See& see) {
  const Grouped by_first(static_cast<int>(vertices), static_cast<int>(elements.size()), [&](int e) {
    return static_cast<int>(elements[static_cast<std::size_t>(e)][0]);
  });
  std::vector<Element> group;
  for (int first = 0; first < by_first.groups(); ++first) {
    group.clear();
    for (const int e : by_first[first]) group.push_back(elements[static_cast<std::size_t>(e)]);
    std::sort(group.begin(), group.end());
    see(group);
  }
}

void keep_distinct(std::vector<std::array<std::size_t, 2>>& edges, std::size_t vertices) {
  for (auto& [i, j] : edges) {
    if (i > j) std::swap(i, j);
  }
  // A face may name a corner twice in a row; that is no edge.
  std::erase_if(edges, [](const auto& edge) { return edge[0] == edge[1]; });
  std::vector<std::array<std::size_t, 2>> distinct;
  distinct.reserve(edges.size());
  for_sorted_groups(edges, vertices, [&](const auto& group) {
    std::unique_copy(group.begin(), group.end(), std::back_inserter(distinct));
  });
  edges = std::move(distinct);
}

void keep_distinct(std::vector<std::size_t>& vertices) {
  std::ranges::sort(vertices);
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
}

using Face = std::array<std::size_t, 3>;

Face sorted(Face face) {
  std::sort(face.begin(), face.end());
  return face;
}

// Appends the triangles that belong to one tetrahedron only.
void add_boundary(Mesh& mesh) {
  std::vector<std::pair<Face, Face>> sides;  // sorted, and as seen from outside
  for (const auto& [a, b, c, d] : mesh.tetrahedra) {
    for (const Face& side : {Face{a, c, b}, Face{a, b, d}, Face{a, d, c}, Face{b, c, d}})
      sides.emplace_back(sorted(side), side);
  }
  std::stable_sort(sides.begin(), sides.end(),
                   [](const auto& x, const auto& y) { return x.first < y.first; });
  for (auto first = sides.begin(); first != sides.end();) {
    const auto last = std::find_if(first, sides.end(),
                                   [&](const auto& side) { return side.first != first->first; });
    if (last - first == 1) mesh.faces.push_back(first->second);
    first = last;
  }
}

// Leaves out faces that name a corner twice, and all but the first of the same three corners.
void keep_distinct_faces(std::vector<Face>& faces, std::size_t vertices) {
  std::erase_if(faces, [](const Face& f) { return f[0] == f[1] || f[1] == f[2] || f[2] == f[0]; });
  std::vector<std::array<std::size_t, 4>> corners;  // sorted, and the number of the face
  corners.reserve(faces.size());
  for (const Face& face : faces) {
    const auto [low, middle, high] = sorted(face);
    corners.push_back({low, middle, high, corners.size()});
  }
  std::vector<bool> is_repeated(faces.size(), false);
  for_sorted_groups(corners, vertices, [&](const auto& group) {
    for (std::size_t k = 1; k < group.size(); ++k) {
      const auto &one = group[k - 1], &next = group[k];
      is_repeated[next[3]] = std::equal(one.begin(), one.begin() + 3, next.begin());
    }
  });
  std::size_t kept = 0;
  for (std::size_t i = 0; i < faces.size(); ++i) {
    if (!is_repeated[i]) faces[kept++] = faces[i];
  }
  faces.resize(kept);
}

}  // namespace

bool Words::is_continued() const {
  return backslash_ == Backslash::continues_lines && text_[at_] == '\\' && at_ + 1 < text_.size() &&
         is_line_end(text_[at_ + 1]);
}

std::string_view Words::in_line() {
  for (; at_ < text_.size(); ++at_) {
    if (is_blank(text_[at_])) continue;
    if (!is_continued()) break;
    ++at_;
    pass_line_end();
    --at_;
  }
  if (at_ < text_.size() && text_[at_] == '#') pass_line();
  const std::size_t start = at_;
  while (at_ < text_.size() && !is_line_end(text_[at_]) && !is_blank(text_[at_]) && !is_continued())
    ++at_;
  return text_.substr(start, at_ - start);
}

std::string_view Words::next() {
  std::string_view word = in_line();
  while (word.empty() && next_line()) word = in_line();
  return word;
}

void Words::pass_line() {
  while (at_ < text_.size() && !is_line_end(text_[at_])) ++at_;
}

bool Words::next_line() {
  pass_line();
  return pass_line_end();
}

bool Words::pass_line_end() {
  if (at_ == text_.size()) return false;
  at_ += text_.substr(at_, 2) == "\r\n" ? 2 : 1;
  ++line_;
  return true;
}

void Words::refuse(std::string_view field, std::string_view value, std::string_view allowed,
                   int line) const {
  const std::string what =
      value.empty() ? "ends too early" : fmt::format("{} is not allowed", shown(value));
  throw InvalidInput(fmt::format("{}:{}: {}: {}; allowed {}", file_, line, field, what, allowed));
}

std::string_view Words::rest_of_line() {
  const std::size_t start = at_;
  pass_line();
  return text_.substr(start, at_ - start);
}

std::optional<double> real_in(std::string_view word) {
  if (const auto value = number_in<double>(word)) return value;
  const std::size_t exponent = word.find_first_of("dD");
  if (exponent == word.npos) return {};
  std::string with_e(word);
  with_e[exponent] = 'e';
  return number_in<double>(with_e);
}

double Words::number(std::string_view field, std::string_view word) const {
  const auto value = real_in(word);
  if (!value || !std::isfinite(*value)) refuse(field, word, "are finite numbers");
  return *value;
}

bool is_mesh_file(const std::filesystem::path& file) { return reader_of(file) != nullptr; }

void Mesh::leave_out(std::string_view section) {
  const std::string warning = fmt::format("the section {} is left out", shown(section));
  if (std::ranges::find(warnings, warning) == warnings.end()) warnings.push_back(warning);
}

Mesh read_mesh(const std::filesystem::path& file, const TextSource& read, double weld_within) {
  reader_for(file);  // a file with an unknown ending is not opened
  return parse_mesh(read(file.string()), file, weld_within);
}

Mesh parse_mesh(const std::string& text, const std::filesystem::path& file, double weld_within) {
  const std::string name = file.string();
  // Some editors begin a text in UTF-8 with this mark.
  constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
  std::string_view content = text;
  if (content.starts_with(byte_order_mark)) content.remove_prefix(byte_order_mark.size());
  Mesh mesh = reader_for(file)(content, name);
  if (mesh.vertices.empty())
    throw InvalidInput(fmt::format("{}: it has no vertices; allowed are meshes with some", name));
  if (weld_within >= 0) weld(welded(mesh.vertices, weld_within), mesh);
  for (Group& group : mesh.groups) keep_distinct(group.vertices);
  keep_distinct(mesh.edges, mesh.vertices.size());
  add_boundary(mesh);
  keep_distinct_faces(mesh.faces, mesh.vertices.size());
  return mesh;
}

std::vector<std::array<std::size_t, 2>> opposite_vertices(const Mesh& mesh) {
  std::vector<std::array<std::size_t, 3>> sides;  // the two ends of an edge, the corner opposite
  sides.reserve(3 * mesh.triangles.size());
  for (const auto& [a, b, c] : mesh.triangles) {
    for (const auto& [i, j, k] : {std::array{a, b, c}, std::array{b, c, a}, std::array{c, a, b}})
      sides.push_back({std::min(i, j), std::max(i, j), k});
  }
  std::vector<std::array<std::size_t, 2>> pairs;
  for_sorted_groups(sides, mesh.vertices.size(), [&](auto& group) {
    // A triangle may be given twice, as for two groups.
    group.erase(std::unique(group.begin(), group.end()), group.end());
    for (auto first = group.begin(); first != group.end();) {
      const auto last = std::find_if(first, group.end(),
                                     [&](const auto& side) { return side[1] != (*first)[1]; });
      if (last - first == 2) pairs.push_back({first[0][2], first[1][2]});
      first = last;
    }
  });
  return pairs;
}

}  // namespace qddot::mesh

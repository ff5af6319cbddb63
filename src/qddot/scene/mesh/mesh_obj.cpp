#include <algorithm>
#include <iterator>

#include <fmt/format.h>

#include "qddot/scene/mesh/mesh_elements.hpp"
#include "qddot/scene/mesh/mesh_formats.hpp"

namespace qddot::mesh {
namespace {

// The vertex that a corner a, a/b, a//c or a/b/c names, of the `count` vertices read so far.
std::size_t corner_in(std::string_view word, const Words& words, std::size_t count) {
  const std::size_t slash = std::min(word.find('/'), word.size());
  const auto index = number_in<std::int64_t>(word.substr(0, slash));
  const auto n = static_cast<std::int64_t>(count);
  const bool is_corner = word.find_first_not_of("/-0123456789", slash) == word.npos;
  if (n == 0) words.refuse("face", word, "are faces after the vertices that they name");
  if (!is_corner || !index || *index == 0 || *index > n || *index < -n)
    words.refuse("face", word,
                 fmt::format("are a, a/b, a//c and a/b/c with a vertex a from 1 to {0}, or from -1 "
                             "back to -{0}",
                             n));
  return static_cast<std::size_t>(*index > 0 ? *index - 1 : n + *index);
}

// `corners`: memory for them, as there are many lines.
void add_line(Words& words, bool closed, std::vector<std::size_t>& corners, Mesh& mesh) {
  corners.clear();
  for (auto word = words.in_line(); !word.empty(); word = words.in_line())
    corners.push_back(corner_in(word, words, mesh.vertices.size()));
  if (corners.size() < (closed ? 3 : 2))
    words.refuse("face", "", "are three corners or more for f, two or more for l");

  if (closed) return add_face(corners, mesh);
  for (std::size_t i = 1; i < corners.size(); ++i) {
    mesh.edges.push_back({corners[i - 1], corners[i]});
    mesh.cells.add(1, mesh.edges.back());
  }
}

void add_vertex(Words& words, Mesh& mesh) {
  auto& vertex = mesh.vertices.emplace_back();
  for (double& x : vertex) x = words.number("vertex", words.in_line());
  // A weight or a colour may follow.
  for (auto word = words.in_line(); !word.empty(); word = words.in_line())
    words.number("vertex", word);
}

// Kinds of lines that say nothing of vertices and edges: texture, normals, groups, materials.
bool is_silent_line(std::string_view kind) {
  constexpr std::string_view kinds[] = {"vt",     "vn",         "vp",        "g",        "o",
                                        "s",      "mg",         "p",         "mtllib",   "usemtl",
                                        "maplib", "usemap",     "bevel",     "c_interp", "d_interp",
                                        "lod",    "shadow_obj", "trace_obj", "ctech",    "stech"};
  return std::ranges::find(kinds, kind) != std::end(kinds);
}

bool is_keyword(std::string_view kind) {
  return std::ranges::all_of(kind,
                             [](char c) {
                               return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                                      c == '_' || (c >= '0' && c <= '9');
                             }) &&
         !(kind[0] >= '0' && kind[0] <= '9');
}

// Makes room for what the lines that begin with v and f will add if all faces are triangles.
void reserve(std::string_view text, Mesh& mesh) {
  constexpr std::size_t shortest_face = 7;  // f 1 2 3
  std::size_t vertices = 0, faces = 0;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size() - 1);
    vertices += text.starts_with("v ");
    faces += text.starts_with("f ") && end >= shortest_face;
    text.remove_prefix(end + 1);
  }
  mesh.vertices.reserve(vertices);
  mesh.triangles.reserve(faces);
  mesh.faces.reserve(faces);
  mesh.edges.reserve(3 * faces);
  mesh.cells.reserve(faces, 3 * faces);
}

}  // namespace

Mesh read_obj(std::string_view text, const std::string& file) {
  Mesh mesh;
  reserve(text, mesh);
  Words words(text, file, Backslash::continues_lines);
  // Lines that are not read: free-form curves and surfaces, and what others added to the format.
  int left_out = 0, first_line = 0;
  std::string first;
  std::vector<std::size_t> corners;
  do {
    const std::string_view kind = words.in_line();
    if (kind == "v") {
      add_vertex(words, mesh);
    } else if (kind == "f" || kind == "fo" || kind == "l") {
      add_line(words, kind != "l", corners, mesh);
    } else if (!kind.empty() && !is_silent_line(kind)) {
      if (!is_keyword(kind))
        words.refuse("line", kind, "are lines that begin with a keyword, such as v, f or l");
      if (left_out++ > 0) continue;
      first_line = words.line();
      first = kind;
    }
  } while (words.next_line());
  if (left_out > 0)
    mesh.warnings.push_back(
        fmt::format("{} {} left out; only vertices (v), faces (f) and lines (l) are read; the "
                    "first is line {}, {}",
                    left_out, left_out == 1 ? "line is" : "lines are", first_line, shown(first)));
  return mesh;
}

}  // namespace qddot::mesh

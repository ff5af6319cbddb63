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
  if (!is_corner || !index || *index == 0 || *index > n || *index < -n)
    words.refuse("face", word,
                 fmt::format("are a, a/b, a//c and a/b/c with a vertex a from 1 to {0}, or from -1 "
                             "back to -{0}",
                             n));
  return static_cast<std::size_t>(*index > 0 ? *index - 1 : n + *index);
}

void add_face(Words& words, bool closed, Mesh& mesh) {
  std::vector<std::size_t> corners;
  for (auto word = words.in_line(); !word.empty(); word = words.in_line())
    corners.push_back(corner_in(word, words, mesh.vertices.size()));
  if (corners.size() < (closed ? 3 : 2))
    words.refuse("face", "", "are three corners or more for f, two or more for l");

  for (std::size_t i = 1; i < corners.size(); ++i)
    mesh.edges.push_back({corners[i - 1], corners[i]});
  if (!closed) return;
  mesh.edges.push_back({corners.back(), corners.front()});
  add_polygon(corners, mesh);
  if (corners.size() == 3) mesh.triangles.push_back({corners[0], corners[1], corners[2]});
}

}  // namespace

Mesh read_obj(const std::string& text, const std::string& file) {
  Mesh mesh;
  Words words(text, file);
  do {
    const std::string_view kind = words.in_line();
    if (kind == "v") {
      auto& vertex = mesh.vertices.emplace_back();
      for (double& x : vertex) x = words.number("vertex", words.in_line());
    } else if (kind == "f" || kind == "l") {
      add_face(words, kind == "f", mesh);
    }
  } while (words.next_line());
  return mesh;
}

}  // namespace qddot::mesh

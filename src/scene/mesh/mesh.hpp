#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "qddot/scene/text_file.hpp"

namespace qddot::mesh {

// Vertices, distinct edges, triangles and faces of a surface or volume mesh. Vertices without an
// edge are kept.
struct Mesh {
  std::vector<Eigen::Vector3d> vertices;              // [m] as in the file
  std::vector<std::array<std::size_t, 2>> edges;      // each once, smaller index first, sorted
  std::vector<std::array<std::size_t, 3>> triangles;  // as in the file; no larger polygon is cut up
  std::vector<std::array<std::size_t, 4>> tetrahedra;  // as in the file
  // What can be seen of it, each triangle once: triangles and larger polygons, cut up, and the
  // triangles that one tetrahedron alone has, which face outwards where it has a positive volume.
  std::vector<std::array<std::size_t, 3>> faces;
};

// Reads a Wavefront .obj (polygonal faces of the forms a, a/b, a//c, a/b/c and lines, negative
// indices counted back from the last vertex), a MEDIT .mesh or a Gmsh .msh of version 2.2 or 4.1
// (both ASCII; every element's edges), chosen by the file name's ending. Throws InvalidInput naming
// the file, line, value and what is allowed.
Mesh read_mesh(const std::filesystem::path& file, const TextSource& read = read_text);

// The same of a text in memory, as if `file` held it.
Mesh parse_mesh(const std::string& text, const std::filesystem::path& file);

// For each edge that exactly two triangles share, the two vertices opposite to it: the ends of a
// spring that resists bending about that edge. Ordered by the shared edges.
std::vector<std::array<std::size_t, 2>> opposite_vertices(const Mesh& mesh);

}  // namespace qddot::mesh

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
  // The visible triangles, each once: triangles, larger polygons cut up, and triangles that belong
  // to one tetrahedron only. Triangles of the last kind face outwards if the tetrahedron has a
  // positive volume.
  std::vector<std::array<std::size_t, 3>> faces;
};

// Reads a mesh; the file name's ending chooses the format. A Wavefront .obj may have lines and
// polygonal faces of the forms a, a/b, a//c, a/b/c; negative indices count back from the last
// vertex. A MEDIT .mesh, or a Gmsh .msh of version 2.2 or 4.1 (both ASCII), gives every element's
// edges. Throws InvalidInput with the file, line, value and what is allowed.
Mesh read_mesh(const std::filesystem::path& file, const TextSource& read = read_text);

// The same for a text in memory, as if `file` held it.
Mesh parse_mesh(const std::string& text, const std::filesystem::path& file);

// The two vertices opposite to each edge that exactly two triangles share, ordered by these edges.
// A spring between them resists bending about the edge.
std::vector<std::array<std::size_t, 2>> opposite_vertices(const Mesh& mesh);

}  // namespace qddot::mesh

#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <string_view>
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
  // Sentences, without the name of the file, about parts of it that are not read and may matter.
  std::vector<std::string> warnings{};

  // Warns once of a section that is not read, and that nobody knows to mean nothing.
  void leave_out(std::string_view section);
};

// Whether the file's ending is that of a mesh.
bool is_mesh_file(const std::filesystem::path& file);

// Reads a mesh; the file name's ending, in either case, chooses the format. A Wavefront .obj may
// have lines and polygonal faces of the forms a, a/b, a//c, a/b/c; negative indices count back from
// the last vertex, and a backslash continues a line. A MEDIT .mesh, or a Gmsh .msh of version 2,
// 2.1, 2.2 or 4.1 (both ASCII), gives the edges between every element's corners, also of elements
// of order 2 and 3. Numbers may have exponents with e or d. Vertices within the distance
// `weld_within` [unit of the file] of each other are welded (see weld.hpp), none if it is negative.
// Throws InvalidInput with the file, line, value and what is allowed.
Mesh read_mesh(const std::filesystem::path& file, const TextSource& read = read_text,
               double weld_within = -1);

// The same for a text in memory, as if `file` held it.
Mesh parse_mesh(const std::string& text, const std::filesystem::path& file,
                double weld_within = -1);

// The two vertices opposite to each edge that exactly two triangles share, ordered by these edges.
// A spring between them resists bending about the edge.
std::vector<std::array<std::size_t, 2>> opposite_vertices(const Mesh& mesh);

}  // namespace qddot::mesh

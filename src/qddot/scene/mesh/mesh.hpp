#pragma once

#include <algorithm>
#include <array>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "qddot/scene/text_file.hpp"

namespace qddot::mesh {

// The elements of a mesh one after the other: lines of two corners, polygons, and solids of 4, 5, 6
// or 8 corners (see mesh_elements.hpp for their order).
class Cells {
 public:
  // Makes room for so many elements, and corners in all.
  void reserve(std::size_t elements, std::size_t corners) {
    corners_.reserve(corners);
    ends_.reserve(elements);
    dimensions_.reserve(elements);
  }
  void add(int dimension, std::span<const std::size_t> corners) {
    corners_.insert(corners_.end(), corners.begin(), corners.end());
    ends_.push_back(corners_.size());
    dimensions_.push_back(static_cast<unsigned char>(dimension));
  }

  std::size_t size() const { return ends_.size(); }
  int dimension(std::size_t e) const { return dimensions_[e]; }
  // The vertices of element e.
  std::span<const std::size_t> corners(std::size_t e) const {
    const std::size_t first = e == 0 ? 0 : ends_[e - 1];
    return std::span(corners_).subspan(first, ends_[e] - first);
  }
  // The largest dimension of an element; 0 if there is none.
  int highest_dimension() const {
    return dimensions_.empty() ? 0 : *std::ranges::max_element(dimensions_);
  }
  // The corners of all elements, to be renumbered.
  std::vector<std::size_t>& all_corners() { return corners_; }

 private:
  std::vector<std::size_t> corners_, ends_;
  std::vector<unsigned char> dimensions_;
};

// The vertices of all elements with a mark: a physical group of Gmsh, or a reference of MEDIT.
struct Group {
  int dimension;  // of its elements
  int tag;
  std::string name;                   // empty if it has none
  std::vector<std::size_t> vertices;  // each once, ascending
};

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
  Cells cells{};  // as in the file; points are left out
  std::vector<Group> groups{};
  // Sentences, without the name of the file, about parts of it that are not read and may matter.
  std::vector<std::string> warnings{};

  // Warns once of a section that is not read, and that nobody knows to mean nothing.
  void leave_out(std::string_view section);
};

// Whether the file's ending is that of a mesh.
bool is_mesh_file(const std::filesystem::path& file);

// Reads a mesh; the file name's ending, in either case, chooses the format. A Wavefront .obj may
// have lines and polygonal faces of the forms a, a/b, a//c, a/b/c; negative indices count back from
// the last vertex, and a backslash continues a line. A MEDIT .mesh (ASCII), or a Gmsh .msh of
// version 2, 2.1, 2.2 or 4.1 (ASCII or binary), gives the edges between every element's corners,
// also of elements of order 2 and 3. A .ply (ASCII or binary) has faces and edges. A .stl (ASCII or
// binary) has triangles, whose equal corners are one vertex. Numbers of texts may have exponents
// with e or d. Vertices within the distance `weld_within` [unit of the file] of each other are
// welded (see weld.hpp), none if it is negative. Throws InvalidInput with the file, line or byte,
// value and what is allowed.
Mesh read_mesh(const std::filesystem::path& file, const TextSource& read = read_text,
               double weld_within = -1);

// The same for a text in memory, as if `file` held it.
Mesh parse_mesh(const std::string& text, const std::filesystem::path& file,
                double weld_within = -1);

// The two vertices opposite to each edge that exactly two triangles share, ordered by these edges.
// A spring between them resists bending about the edge.
std::vector<std::array<std::size_t, 2>> opposite_vertices(const Mesh& mesh);

}  // namespace qddot::mesh

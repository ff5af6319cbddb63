#include <algorithm>
#include <iterator>

#include <fmt/format.h>

#include "qddot/scene/mesh/mesh_elements.hpp"
#include "qddot/scene/mesh/mesh_formats.hpp"
#include "qddot/scene/mesh/mesh_groups.hpp"

namespace qddot::mesh {
namespace {

// Sections that say nothing of vertices and edges: marks, normals, geometry and partitions.
bool is_silent_keyword(std::string_view section) {
  constexpr std::string_view sections[] = {"Corners",
                                           "Ridges",
                                           "Normals",
                                           "Tangents",
                                           "NormalAtVertices",
                                           "NormalAtTriangleVertices",
                                           "NormalAtQuadrilateralVertices",
                                           "TangentAtVertices",
                                           "TangentAtEdges",
                                           "TangentAtEdgeVertices",
                                           "AngleOfCornerBound",
                                           "BoundingBox",
                                           "Geometry",
                                           "Identifier"};
  return section.starts_with("Required") || section.starts_with("SubDomain") ||
         section.find("OnGeometric") != section.npos ||
         std::ranges::find(sections, section) != std::end(sections);
}

class MeditReader {
 public:
  MeditReader(std::string_view text, const std::string& file) : words_(text, file) {}

  Mesh read() {
    if (const auto word = words_.next(); word != "MeshVersionFormatted")
      words_.refuse("first word", word, "is MeshVersionFormatted");
    whole("MeshVersionFormatted", 0, 9);
    // A section without edges is skipped up to the next keyword. Any other section ends after its
    // count: a further number is one too many.
    bool passes_over = false;
    std::string_view section = "MeshVersionFormatted";
    for (auto word = words_.next(); !word.empty() && word != "End"; word = words_.next()) {
      if (real_in(word)) {
        if (!passes_over)
          words_.refuse(section, word, "is no more than its count says: next comes a keyword");
        continue;
      }
      section = word;
      passes_over = !read_section(word);
    }
    // Elements may come before the vertices, so their indices can be checked only now.
    if (largest_ > mesh_.vertices.size())
      words_.refuse("element", std::to_string(largest_),
                    fmt::format("are the vertices 1 to {}", mesh_.vertices.size()), largest_line_);
    mesh_.groups = groups_.all();
    return std::move(mesh_);
  }

 private:
  // Reads the section with that keyword; false if it is not one of those read.
  bool read_section(std::string_view keyword) {
    const ListedElement listed =
        listed_element(keyword, &Element::medit_section, &CurvedElement::medit_section);
    if (keyword != "Dimension" && keyword != "Vertices" && !listed.element) {
      const bool is_text = !seen_.empty() && seen_.back() == "Identifier";
      if (!is_text && !is_silent_keyword(keyword)) mesh_.leave_out(keyword);
      if (keyword == "Identifier") seen_.push_back(keyword);
      return false;
    }
    if (std::ranges::find(seen_, keyword) != seen_.end())
      words_.refuse("section", keyword, "is each section once");
    seen_.push_back(keyword);
    if (keyword == "Dimension") {
      if (!mesh_.vertices.empty())
        words_.refuse("section", keyword, "is Dimension before Vertices");
      dimension_ = whole(keyword, 2, 3);
    } else if (keyword == "Vertices") {
      read_vertices();
    } else {
      read_elements(keyword, listed);
    }
    return true;
  }

  std::size_t whole(std::string_view field, std::size_t low, std::size_t high) {
    const auto word = words_.next();
    const auto value = number_in<std::size_t>(word);
    if (!value || *value < low || *value > high)
      words_.refuse(field, word, fmt::format("are whole numbers from {} to {}", low, high));
    return *value;
  }
  // The number of entries in a section. Nothing is reserved for them before they are seen.
  std::size_t count(std::string_view field) { return whole(field, 0, 1'000'000'000); }
  // Puts an element, of the vertices named last, into the group of the reference that follows. Zero
  // marks none.
  void read_reference(std::string_view field, int dimension,
                      std::span<const std::size_t> vertices) {
    const double reference = words_.number(field, words_.next());
    const int tag = static_cast<int>(std::clamp(reference, -2e9, 2e9));
    if (tag != 0) groups_.add(dimension, tag, vertices);
  }

  void read_vertices() {
    constexpr std::string_view field = "Vertices";
    for (std::size_t left = count(field); left > 0; --left) {
      Eigen::Vector3d x = Eigen::Vector3d::Zero();
      for (std::size_t k = 0; k < dimension_; ++k) x[k] = words_.number(field, words_.next());
      const std::size_t own = mesh_.vertices.size();
      read_reference(field, 0, {&own, 1});
      mesh_.vertices.push_back(x);
    }
  }

  void read_elements(std::string_view field, const ListedElement& listed) {
    std::array<std::size_t, most_corners> corners;
    for (std::size_t left = count(field); left > 0; --left) {
      for (std::size_t k = 0; k < listed.nodes; ++k) {
        const std::size_t node = corner(field);
        if (k < listed.element->corners) corners[k] = node;
      }
      read_reference(field, listed.element->dimension,
                     std::span(corners).first(listed.element->corners));
      add_element(*listed.element, corners, mesh_);
    }
  }

  std::size_t corner(std::string_view field) {
    const std::size_t index = whole(field, 1, 1'000'000'000);
    if (index > largest_) {
      largest_ = index;
      largest_line_ = words_.line();
    }
    return index - 1;
  }

  Words words_;
  Mesh mesh_;
  GroupCollection groups_;
  std::size_t dimension_ = 3;
  std::vector<std::string_view> seen_;  // sections
  std::size_t largest_ = 0;             // the largest index, counted from 1
  int largest_line_ = 0;
};

}  // namespace

Mesh read_medit(std::string_view text, const std::string& file) {
  return MeditReader(text, file).read();
}

}  // namespace qddot::mesh

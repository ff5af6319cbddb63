// The MSH formats 2, 2.1, 2.2 and 4.1 of Gmsh, ASCII: sections $Name ... $EndName, nodes before the
// elements that name them by their tags.
#include <algorithm>
#include <cstdint>
#include <iterator>
#include <limits>
#include <unordered_map>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "qddot/scene/mesh/mesh_elements.hpp"
#include "qddot/scene/mesh/mesh_formats.hpp"

namespace qddot::mesh {
namespace {

using Tag = std::uint64_t;

std::string element_types() {
  std::vector<std::string> types;
  for (const Element& element : elements)
    types.push_back(fmt::format("{} ({})", element.gmsh_type, element.name));
  return fmt::format("are {}, and those of order 2 and 3", fmt::join(types, ", "));
}

// Sections that say nothing of nodes and elements: names, entities, fields and partitions.
bool is_silent_section(std::string_view section) {
  constexpr std::string_view sections[] = {
      "$PhysicalNames", "$Entities",        "$PartitionedEntities", "$NodeData",
      "$ElementData",   "$ElementNodeData", "$GhostElements",       "$InterpolationScheme",
      "$Comments",      "$Parametrizations"};
  return std::ranges::find(sections, section) != std::end(sections);
}

class GmshReader {
 public:
  GmshReader(std::string_view text, const std::string& file) : words_(text, file) {}

  Mesh read() {
    expect("$MeshFormat", words_.next());
    read_format();
    for (auto section = words_.next(); !section.empty(); section = words_.next()) {
      if (!section.starts_with('$'))
        words_.refuse("section", section, "are names that start with $");
      if (section == "$Nodes")
        has_blocks_ ? read_node_blocks() : read_node_list(section);
      else if (section == "$ParametricNodes" && !has_blocks_)
        read_node_list(section);
      else if (section == "$Elements")
        has_blocks_ ? read_element_blocks() : read_element_list();
      else if (section == "$MeshFormat")
        words_.refuse("section", section, "is one $MeshFormat, first in the file");
      else
        pass_over(section);
    }
    return std::move(mesh_);
  }

 private:
  template <class Integer>
  Integer whole(std::string_view field, Integer low = std::numeric_limits<Integer>::min(),
                Integer high = std::numeric_limits<Integer>::max()) {
    const auto word = words_.next();
    const auto value = number_in<Integer>(word);
    if (!value || *value < low || *value > high)
      words_.refuse(field, word, fmt::format("are whole numbers from {} to {}", low, high));
    return *value;
  }
  // The number of entries that follow. Nothing is reserved for them before they are seen.
  std::size_t count(std::string_view field) { return whole<std::size_t>(field, 0, 1'000'000'000); }
  Tag tag(std::string_view field) { return whole<Tag>(field); }

  void expect(std::string_view wanted, std::string_view word) {
    if (word != wanted) words_.refuse("section", word, fmt::format("is {}", wanted));
  }

  void read_format() {
    const auto version = words_.next();
    const auto number = number_in<double>(version);
    if (number != 2 && number != 2.1 && number != 2.2 && number != 4.1)
      words_.refuse("version of the format", version, "are 2, 2.1, 2.2 and 4.1");
    has_blocks_ = number == 4.1;
    const auto type = words_.next();
    if (type != "0") words_.refuse("file type", type, "is 0, which is ASCII");
    count("data size");
    expect("$EndMeshFormat", words_.next());
  }

  static std::string end_of(std::string_view section) {
    return fmt::format("$End{}", section.substr(1));
  }

  void pass_over(std::string_view section) {
    if (section == "$Periodic")
      mesh_.warnings.push_back("the section $Periodic is left out: nodes that it links stay apart");
    else if (!is_silent_section(section))
      mesh_.leave_out(section);
    const std::string end = end_of(section);
    const int line = words_.line();
    while (words_.in_line() != end) {
      if (!words_.next_line())
        words_.refuse("section", section, fmt::format("are sections that end with {}", shown(end)),
                      line);
    }
  }

  void read_node_list(std::string_view section) {
    for (std::size_t left = count("number of nodes"); left > 0; --left) {
      add_node(tag("node tag"));
      if (section != "$ParametricNodes") continue;
      // The dimension and the tag of its entity, and its parameters there.
      for (auto word = words_.in_line(); !word.empty(); word = words_.in_line())
        words_.number("parameter of a node", word);
    }
    expect(end_of(section), words_.next());
  }

  void read_node_blocks() {
    const BlockHeader header = read_block_header("node");
    std::vector<Tag> tags;
    TagRange range;
    for (std::size_t block = 0; block < header.blocks; ++block) {
      const int dimension = whole<int>("dimension of the entity", 0, 3);
      whole<int>("tag of the entity");
      const bool parametric = whole<int>("parametric", 0, 1) == 1;
      tags.clear();
      for (std::size_t left = count("number of nodes"); left > 0; --left)
        tags.push_back(tag("node tag"));
      for (const Tag node : tags) {
        range.take(node);
        add_node(node);
        for (int k = 0; parametric && k < dimension; ++k)
          words_.number("parameter of a node", words_.next());
      }
    }
    expect("$EndNodes", words_.next());
    check("node", header, range);
  }

  void add_node(Tag node) {
    Eigen::Vector3d x;
    for (double& coordinate : x) coordinate = words_.number("node", words_.next());
    if (!vertex_of_.emplace(node, mesh_.vertices.size()).second)
      words_.refuse("node tag", std::to_string(node), "are tags that no other node has");
    mesh_.vertices.push_back(x);
  }

  void read_element_list() {
    for (std::size_t left = count("number of elements"); left > 0; --left) {
      tag("element tag");
      const ListedElement listed = element_of_type();
      for (std::size_t tags = count("number of tags"); tags > 0; --tags)
        whole<std::int64_t>("tag of the element");
      read_corners(listed);
    }
    expect("$EndElements", words_.next());
  }

  void read_element_blocks() {
    const BlockHeader header = read_block_header("element");
    TagRange range;
    for (std::size_t block = 0; block < header.blocks; ++block) {
      const int dimension = whole<int>("dimension of the entity", 0, 3);
      whole<int>("tag of the entity");
      const ListedElement listed = element_of_type();
      if (listed.element->dimension != dimension)
        words_.refuse("element type",
                      fmt::format("{} ({})", listed.gmsh_type, listed.element->name),
                      fmt::format("are those of the entity's dimension, {}", dimension));
      for (std::size_t left = count("number of elements"); left > 0; --left) {
        range.take(tag("element tag"));
        read_corners(listed);
      }
    }
    expect("$EndElements", words_.next());
    check("element", header, range);
  }

  // The header of a section of blocks.
  struct BlockHeader {
    std::size_t blocks, entries;
    Tag least, largest;
    int line;
  };
  struct TagRange {
    std::size_t count = 0;
    Tag least = std::numeric_limits<Tag>::max(), largest = 0;

    void take(Tag tag) {
      ++count;
      least = std::min(least, tag);
      largest = std::max(largest, tag);
    }
  };

  BlockHeader read_block_header(std::string_view what) {
    const std::size_t blocks = count("number of blocks");
    const std::size_t entries = count(fmt::format("number of {}s", what));
    const Tag least = tag(fmt::format("least {} tag", what));
    return {blocks, entries, least, tag(fmt::format("largest {} tag", what)), words_.line()};
  }

  // Checks that the blocks hold what their header says.
  void check(std::string_view what, const BlockHeader& header, const TagRange& range) {
    const auto compare = [&](const std::string& field, std::uint64_t said, std::uint64_t is) {
      if (said != is)
        words_.refuse(field, std::to_string(said), fmt::format("is {}, as in the blocks", is),
                      header.line);
    };
    compare(fmt::format("number of {}s", what), header.entries, range.count);
    if (range.count == 0) return;  // without entries, any tags are allowed
    compare(fmt::format("least {} tag", what), header.least, range.least);
    compare(fmt::format("largest {} tag", what), header.largest, range.largest);
  }

  ListedElement element_of_type() {
    const auto word = words_.next();
    const auto type = number_in<int>(word);
    const ListedElement listed =
        type ? listed_element(*type, &Element::gmsh_type, &CurvedElement::gmsh_type)
             : ListedElement{};
    if (!listed.element) words_.refuse("element type", word, element_types());
    return listed;
  }

  void read_corners(const ListedElement& listed) {
    const Element& element = *listed.element;
    std::array<std::size_t, most_corners> corners;
    for (std::size_t k = 0; k < listed.nodes; ++k) {
      const Tag node = tag(element.name);
      const auto vertex = vertex_of_.find(node);
      if (vertex == vertex_of_.end())
        words_.refuse(element.name, std::to_string(node),
                      "are the tags of nodes in a section $Nodes that comes before");
      if (k < element.corners) corners[k] = vertex->second;
    }
    add_element(element, corners, mesh_);
  }

  Words words_;
  Mesh mesh_;
  bool has_blocks_ = false;                         // as in version 4.1
  std::unordered_map<Tag, std::size_t> vertex_of_;  // by the node's tag
};

}  // namespace

Mesh read_gmsh(std::string_view text, const std::string& file) {
  return GmshReader(text, file).read();
}

}  // namespace qddot::mesh

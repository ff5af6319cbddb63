// The MSH formats 2, 2.1, 2.2 and 4.1 of Gmsh, ASCII and binary: sections $Name ... $EndName, nodes
// before the elements that name them by their tags. In binary files, names and the counts of
// version 2 are ASCII, and all other numbers of nodes, elements and entities are bytes.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <unordered_map>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "qddot/scene/mesh/mesh_bytes.hpp"
#include "qddot/scene/mesh/mesh_elements.hpp"
#include "qddot/scene/mesh/mesh_formats.hpp"
#include "qddot/scene/mesh/mesh_groups.hpp"

namespace qddot::mesh {
namespace {

using Tag = std::uint64_t;

std::string element_types() {
  std::vector<std::string> types;
  for (const Element& element : elements)
    types.push_back(fmt::format("{} ({})", element.gmsh_type, element.name));
  return fmt::format("are {}, and those of order 2 and 3", fmt::join(types, ", "));
}

// Sections that say nothing of nodes, elements and groups: fields and partitions.
bool is_silent_section(std::string_view section) {
  constexpr std::string_view sections[] = {
      "$PartitionedEntities", "$NodeData", "$ElementData",     "$ElementNodeData", "$GhostElements",
      "$InterpolationScheme", "$Comments", "$Parametrizations"};
  return std::ranges::find(sections, section) != std::end(sections);
}

class GmshReader {
 public:
  GmshReader(std::string_view text, const std::string& file)
      : text_(text), words_(text, file), bytes_(text, file) {}

  Mesh read() {
    expect("$MeshFormat", words_.next());
    read_format();
    for (auto section = words_.next(); !section.empty(); section = words_.next()) {
      if (!section.starts_with('$')) refuse("section", section, "are names that start with $");
      if (section == "$Nodes")
        has_blocks_ ? read_node_blocks() : read_node_list(section);
      else if (section == "$ParametricNodes" && !has_blocks_)
        read_node_list(section);
      else if (section == "$Elements")
        has_blocks_ ? read_element_blocks() : read_element_list();
      else if (section == "$PhysicalNames")
        read_group_names();
      else if (section == "$Entities" && has_blocks_)
        read_entities();
      else if (section == "$MeshFormat")
        refuse("section", section, "is one $MeshFormat, first in the file");
      else
        pass_over(section);
    }
    mesh_.groups = groups_.all();
    return std::move(mesh_);
  }

 private:
  // The place of a binary file is the byte, and the line of any other one.
  [[noreturn]] void refuse(std::string_view field, std::string_view value,
                           std::string_view allowed) {
    if (!is_binary_) words_.refuse(field, value, allowed);
    if (!in_bytes_) bytes_.at = words_.at();
    bytes_.refuse(field, value, allowed);
  }

  // Steps from a line of text to the bytes behind it, and back.
  void enter_bytes() {
    if (!is_binary_) return;
    words_.next_line();
    bytes_.at = words_.at();
    in_bytes_ = true;
  }
  void leave_bytes() {
    if (in_bytes_) words_.go_to(bytes_.at);
    in_bytes_ = false;
  }

  template <class Integer>
  Integer whole(std::string_view field, Integer low = std::numeric_limits<Integer>::min(),
                Integer high = std::numeric_limits<Integer>::max()) {
    if (in_bytes_) return whole_in_bytes(field, low, high);
    const auto word = words_.next();
    const auto value = number_in<Integer>(word);
    if (!value || *value < low || *value > high) refuse(field, word, whole_numbers(low, high));
    return *value;
  }
  // Version 4.1 has eight bytes for tags of nodes and elements, and for counts.
  template <class Integer>
  Integer whole_in_bytes(std::string_view field, Integer low, Integer high) {
    const auto in_range = [&](auto value) {
      if (std::cmp_less(value, low) || std::cmp_greater(value, high))
        refuse(field, std::to_string(value), whole_numbers(low, high));
      return static_cast<Integer>(value);
    };
    if (sizeof(Integer) == 8 && has_blocks_) return in_range(bytes_.take<std::uint64_t>(field));
    return in_range(bytes_.take<std::int32_t>(field));
  }
  template <class Integer>
  static std::string whole_numbers(Integer low, Integer high) {
    return fmt::format("are whole numbers from {} to {}", low, high);
  }
  double real(std::string_view field) {
    if (!in_bytes_) {
      const auto word = words_.next();
      const auto value = real_in(word);
      if (!value || !std::isfinite(*value)) refuse(field, word, "are finite numbers");
      return *value;
    }
    const auto value = bytes_.take<double>(field);
    if (!std::isfinite(value)) refuse(field, fmt::format("{}", value), "are finite numbers");
    return value;
  }
  // The number of entries that follow. Nothing is reserved for them before they are seen.
  std::size_t count(std::string_view field) { return whole<std::size_t>(field, 0, 1'000'000'000); }
  Tag tag(std::string_view field) { return whole<Tag>(field); }

  void expect(std::string_view wanted, std::string_view word) {
    if (word != wanted) refuse("section", word, fmt::format("is {}", wanted));
  }

  void read_format() {
    const auto version = words_.next();
    const auto number = number_in<double>(version);
    if (number != 2 && number != 2.1 && number != 2.2 && number != 4.1)
      words_.refuse("version of the format", version, "are 2, 2.1, 2.2 and 4.1");
    has_blocks_ = number == 4.1;
    const auto type = words_.next();
    if (type != "0" && type != "1")
      words_.refuse("file type", type, "are 0, which is ASCII, and 1, which is binary");
    is_binary_ = type == "1";
    if (const std::size_t size = count("data size"); is_binary_ && size != 8)
      words_.refuse("data size", std::to_string(size), "is 8 in a binary file");
    read_byte_order();
    expect_end("$MeshFormat");
  }

  // A binary file has the integer 1 here.
  void read_byte_order() {
    if (!is_binary_) return;
    enter_bytes();
    const auto one = bytes_.take<std::int32_t>("the number one");
    constexpr std::int32_t swapped = 0x01000000;
    if (one == swapped)
      bytes_.order = std::endian::big;
    else if (one != 1)
      refuse("the number one", std::to_string(one), "is 1, in either order of its bytes");
  }

  void expect_end(std::string_view section) {
    leave_bytes();
    expect(end_of(section), words_.next());
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
    if (is_binary_) {
      const std::size_t at = text_.find("\n" + end, words_.at());
      if (at == text_.npos)
        refuse("section", section, fmt::format("are sections that end with {}", shown(end)));
      words_.go_to(at + 1 + end.size());
      return;
    }
    const int line = words_.line();
    while (words_.in_line() != end) {
      if (!words_.next_line())
        words_.refuse("section", section, fmt::format("are sections that end with {}", shown(end)),
                      line);
    }
  }

  void read_group_names() {
    for (std::size_t left = count("number of names"); left > 0; --left) {
      const int dimension = whole<int>("dimension of the group", 0, 3);
      const int tag = group_tag();
      std::string_view name = words_.rest_of_line();
      const std::size_t first = name.find('"'), last = name.rfind('"');
      if (first == last) refuse("name of the group", name, "are names between quotation marks");
      groups_.name(dimension, tag, std::string(name.substr(first + 1, last - first - 1)));
    }
    expect_end("$PhysicalNames");
  }
  // Negative where elements are turned over.
  int group_tag() {
    constexpr int most = std::numeric_limits<int>::max();
    return std::abs(whole<int>("tag of the group", -most, most));
  }

  // The groups of each entity, and in passing the entity's place and boundary.
  void read_entities() {
    enter_bytes();
    std::array<std::size_t, 4> counts;
    for (std::size_t& one : counts) one = count("number of entities");
    for (int dimension = 0; dimension < 4; ++dimension) {
      for (std::size_t left = counts[std::size_t(dimension)]; left > 0; --left) {
        auto& groups = groups_of_entity_[{dimension, whole<int>("tag of the entity")}];
        for (int k = 0; k < (dimension == 0 ? 3 : 6); ++k) real("box of the entity");
        for (std::size_t more = count("number of groups"); more > 0; --more)
          groups.push_back(group_tag());
        if (dimension == 0) continue;
        for (std::size_t more = count("number of bounds"); more > 0; --more)
          whole<int>("tag of a bound");
      }
    }
    expect_end("$Entities");
  }

  void read_node_list(std::string_view section) {
    const std::size_t nodes = count("number of nodes");
    enter_bytes();
    for (std::size_t left = nodes; left > 0; --left) {
      add_node(tag("node tag"));
      if (section == "$ParametricNodes") pass_over_parameters();
    }
    expect_end(section);
  }

  // The dimension and the tag of a node's entity, and its parameters there.
  void pass_over_parameters() {
    if (in_bytes_) {
      const int dimension = whole<int>("dimension of the entity", 0, 3);
      whole<int>("tag of the entity");
      for (int k = 0; k < dimension; ++k) bytes_.take<double>("parameter of a node");
      return;
    }
    for (auto word = words_.in_line(); !word.empty(); word = words_.in_line())
      words_.number("parameter of a node", word);
  }

  void read_node_blocks() {
    enter_bytes();
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
        for (int k = 0; parametric && k < dimension; ++k) real("parameter of a node");
      }
    }
    expect_end("$Nodes");
    check("node", header, range);
  }

  void add_node(Tag node) {
    Eigen::Vector3d x;
    for (double& coordinate : x) coordinate = real("node");
    if (!vertex_of_.emplace(node, mesh_.vertices.size()).second)
      refuse("node tag", std::to_string(node), "are tags that no other node has");
    mesh_.vertices.push_back(x);
  }

  void read_element_list() {
    const std::size_t number = count("number of elements");
    enter_bytes();
    for (std::size_t left = number; left > 0;) {
      // In bytes, elements alike share their header; in text, the tag of each comes first.
      if (!in_bytes_) tag("element tag");
      const ListedElement listed = element_of_type();
      const std::size_t alike =
          in_bytes_ ? whole<std::size_t>("number of elements alike", 1, left) : 1;
      const std::size_t tags = count("number of tags");
      for (std::size_t k = 0; k < alike; ++k, --left) {
        if (in_bytes_) tag("element tag");
        int group = 0;  // the first of its tags, zero if it is in none
        for (std::size_t t = 0; t < tags; ++t) {
          const auto own = whole<std::int64_t>("tag of the element");
          if (t == 0)
            group = static_cast<int>(std::clamp<std::int64_t>(own, -2'000'000'000, 2'000'000'000));
        }
        group = std::abs(group);
        read_corners(listed, std::span(&group, group == 0 ? 0 : 1));
      }
    }
    expect_end("$Elements");
  }

  void read_element_blocks() {
    enter_bytes();
    const BlockHeader header = read_block_header("element");
    TagRange range;
    for (std::size_t block = 0; block < header.blocks; ++block) {
      const int dimension = whole<int>("dimension of the entity", 0, 3);
      const auto groups = groups_of_entity_.find({dimension, whole<int>("tag of the entity")});
      const ListedElement listed = element_of_type();
      if (listed.element->dimension != dimension)
        refuse("element type", fmt::format("{} ({})", listed.gmsh_type, listed.element->name),
               fmt::format("are those of the entity's dimension, {}", dimension));
      for (std::size_t left = count("number of elements"); left > 0; --left) {
        range.take(tag("element tag"));
        read_corners(listed,
                     groups == groups_of_entity_.end() ? std::span<const int>() : groups->second);
      }
    }
    expect_end("$Elements");
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
        refuse_header(field, std::to_string(said), fmt::format("is {}, as in the blocks", is),
                      header);
    };
    compare(fmt::format("number of {}s", what), header.entries, range.count);
    if (range.count == 0) return;  // without entries, any tags are allowed
    compare(fmt::format("least {} tag", what), header.least, range.least);
    compare(fmt::format("largest {} tag", what), header.largest, range.largest);
  }

  void refuse_header(std::string_view field, std::string_view value, std::string_view allowed,
                     const BlockHeader& header) {
    if (is_binary_) refuse(field, value, allowed);
    words_.refuse(field, value, allowed, header.line);
  }

  ListedElement element_of_type() {
    std::string word;
    std::optional<int> type;
    if (in_bytes_) {
      type = bytes_.take<std::int32_t>("element type");
      word = std::to_string(*type);
    } else {
      word = words_.next();
      type = number_in<int>(word);
    }
    const ListedElement listed =
        type ? listed_element(*type, &Element::gmsh_type, &CurvedElement::gmsh_type)
             : ListedElement{};
    if (!listed.element) refuse("element type", word, element_types());
    return listed;
  }

  // Reads the nodes of an element, which is in those groups of its dimension.
  void read_corners(const ListedElement& listed, std::span<const int> groups) {
    const Element& element = *listed.element;
    std::array<std::size_t, most_corners> corners;
    for (std::size_t k = 0; k < listed.nodes; ++k) {
      const Tag node = tag(element.name);
      const auto vertex = vertex_of_.find(node);
      if (vertex == vertex_of_.end())
        refuse(element.name, std::to_string(node),
               "are the tags of nodes in a section $Nodes that comes before");
      if (k < element.corners) corners[k] = vertex->second;
    }
    add_element(element, corners, mesh_);
    for (const int group : groups)
      groups_.add(element.dimension, group, std::span(corners).first(element.corners));
  }

  std::string_view text_;
  Words words_;
  Bytes bytes_;
  Mesh mesh_;
  GroupCollection groups_;
  std::map<std::pair<int, int>, std::vector<int>> groups_of_entity_;  // by its dimension and tag
  bool has_blocks_ = false;                                           // as in version 4.1
  bool is_binary_ = false, in_bytes_ = false;  // whether the file is, and whether it reads them
  std::unordered_map<Tag, std::size_t> vertex_of_;  // by the node's tag
};

}  // namespace

Mesh read_gmsh(std::string_view text, const std::string& file) {
  return GmshReader(text, file).read();
}

}  // namespace qddot::mesh

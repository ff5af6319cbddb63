#include "experiments/kit/node_table.hpp"

#include <array>

#include <fmt/format.h>

namespace qddot::inline kit {

std::vector<std::string> node_header(int dimension, std::vector<std::string> header) {
  constexpr std::array<const char*, 3> axes = {"x", "y", "z"};
  header.emplace_back("node");
  for (int d = 0; d < dimension; ++d) header.emplace_back(axes[d]);
  for (int d = 0; d < dimension; ++d) header.emplace_back(fmt::format("v{}", axes[d]));
  return header;
}

void write_node(Csv& csv, std::size_t index, const Node& node, int dimension) {
  csv.field(index);
  for (int d = 0; d < dimension; ++d) csv.field(node.position[d]);
  for (int d = 0; d < dimension; ++d) csv.field(node.velocity[d]);
  csv.end_row();
}

}  // namespace qddot::inline kit

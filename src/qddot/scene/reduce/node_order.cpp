#include "qddot/scene/reduce/node_order.hpp"

#include <cmath>
#include <numeric>
#include <utility>

#include "qddot/scene/reduce/part_neighbours.hpp"

namespace qddot::reduce {
namespace {

// Measured: positions of fewer nodes stay in the second cache, wherever they lie.
constexpr std::size_t fewest = 20'000;

bool is_between_free(const DrawnPart& drawn, int e) {
  const auto [a, b] = drawn.springs.ends(e);
  return a < static_cast<int>(drawn.free) && b < static_cast<int>(drawn.free);
}

// The mean |number(a) - number(b)| over all springs between free nodes a and b.
template <class Number>
double mean_distance(const DrawnPart& drawn, const Number& number) {
  double sum = 0, count = 0;
  for (int e = 0; e < drawn.springs.size(); ++e) {
    if (!is_between_free(drawn, e)) continue;
    const auto [a, b] = drawn.springs.ends(e);
    sum += std::abs(number(a) - number(b));
    ++count;
  }
  return count > 0 ? sum / count : 0;
}

// The free nodes breadth-first, from one at an end: the last of a first search.
std::vector<int> breadth_first(const DrawnPart& drawn) {
  const Neighbours neighbours(drawn);
  std::vector<int> order = neighbours.along_springs(neighbours.along_springs().back());
  std::erase_if(order, [&](int node) { return node >= static_cast<int>(drawn.free); });
  return order;
}

}  // namespace

void gather_scattered_nodes(DrawnPart& drawn) {
  if (drawn.free < fewest) return;
  // The rows of a plane have the square root of its nodes, and in space a plane has more.
  constexpr double rows = 4, much = 2;
  const double as_drawn = mean_distance(drawn, [](int node) { return node; });
  if (as_drawn <= rows * std::sqrt(static_cast<double>(drawn.free))) return;
  const std::vector<int> order = breadth_first(drawn);
  std::vector<int> number(drawn.nodes.size());
  std::iota(number.begin(), number.end(), 0);
  for (std::size_t i = 0; i < order.size(); ++i)
    number[static_cast<std::size_t>(order[i])] = static_cast<int>(i);
  const auto number_of = [&](int node) { return number[static_cast<std::size_t>(node)]; };
  if (much * mean_distance(drawn, number_of) >= as_drawn) return;
  std::vector<std::size_t> nodes = drawn.nodes;
  for (std::size_t i = 0; i < order.size(); ++i)
    nodes[i] = drawn.nodes[static_cast<std::size_t>(order[i])];
  drawn.nodes = std::move(nodes);
  drawn.springs.renumber(number_of);
}

}  // namespace qddot::reduce

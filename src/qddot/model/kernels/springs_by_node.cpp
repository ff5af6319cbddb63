#include "qddot/model/kernels/springs_by_node.hpp"

#include <algorithm>
#include <map>

#include "qddot/model/kernels/roots.hpp"

namespace qddot::kernels {

template <int D>
SpringsByNode<D>::SpringsByNode(const Network& network, const Layout<D>& layout, const Vec& weight)
    : weight_(weight) {
  const int nodes = static_cast<int>(layout.nodes());
  // If a node has fewer unknowns, slices begin at other axes than the first.
  const bool are_full = nodes > 0 && weight.size() == D * Index{nodes};
  has_same_weights_ = are_full && weight.tail(weight.size() - D) == weight.head(weight.size() - D);
  if (has_same_weights_) {
    for (std::size_t i = 0; i < slice_weight_.size(); ++i) {
      slice_weight_[i] = weight[static_cast<Index>(i % D)];
    }
  }
  std::map<std::array<double, D>, int> points;
  std::vector<int> anchored_to;  // the point of each anchor
  for (const auto& anchor : network.anchors) {
    std::array<double, D> x;
    std::copy_n(anchor.point.data(), D, x.begin());
    const auto [point, is_new] = points.try_emplace(x, std::ssize(points_));
    if (is_new) points_.push_back(x);
    anchored_to.push_back(nodes + point->second);
  }
  // Images are ordered by mirror, then by source, so that the image of a grid is a grid.
  std::map<std::pair<std::array<double, D>, int>, int> images;
  const auto image_of = [&](int node, const Eigen::Vector3d& mirror) -> int& {
    std::array<double, D> signs;
    std::copy_n(mirror.data(), D, signs.begin());
    return images[{signs, node}];
  };
  for (const auto& link : network.image_links) {
    image_of(link.i, link.mirror) = image_of(link.j, link.mirror) = 0;
  }
  for (auto& [image, point] : images) {
    point = nodes + static_cast<int>(points_.size() + images_.size());
    images_.push_back({image.second, image.first});
  }
  // The spring pulls x_i towards S x_j and x_j towards S x_i, with S the mirror.
  std::vector<std::array<int, 2>> image_ends;
  for (const auto& link : network.image_links) {
    image_ends.push_back({image_of(link.j, link.mirror), image_of(link.i, link.mirror)});
  }
  const auto for_each_end = [&](const auto& see) {
    for (const auto& link : network.links)
      see(link.i, link.j, link.law), see(link.j, link.i, link.law);
    for (std::size_t e = 0; e < anchored_to.size(); ++e) {
      see(network.anchors[e].i, anchored_to[e], network.anchors[e].law);
    }
    for (std::size_t e = 0; e < image_ends.size(); ++e) {
      const auto& link = network.image_links[e];
      see(link.i, image_ends[e][0], link.law), see(link.j, image_ends[e][1], link.law);
    }
  };
  slices_ = slice_neighbours(neighbours_of(nodes, for_each_end),
                             static_cast<int>(points_.size() + images_.size()));
  if (D > 1) rings_ = rings_of(slices_);
  gathered_points_.reserve(slices_.gathers.size());
  for (const int place : slices_.gathers) gathered_points_.push_back(point_stride<D> * place);
  ring_table_ = rings_.table();
  kernels_ = spring_kernels(D, can_be_estimated(slices_) ? roots() : Roots::processor);

  std::vector<int> place(nodes);
  for (int row = 0; row < slices_.rows(); ++row) {
    unknowns_.insert(unknowns_.end(), D, -1);
    const int node = slices_.node[row];
    if (node < 0) {  // each at a place of its own, so that no distance is zero
      unknowns_[D * row] = -2 - row;
      continue;
    }
    place[node] = row;
    for (int a = 0; a < layout.count(node); ++a) {
      unknowns_[D * row + layout.axis(node, a)] = layout.first(node) + a;
    }
  }
  for (Image& image : images_) image.source = place[image.source];
  for (int row = 0; row < slices_.rows(); row += slice_rows) {
    Order order = Order::by_slice;
    for (int e = 0; e < D * slice_rows; ++e) {
      const int* own = unknowns(row + e / D);
      if (own[0] != unknowns(row)[0] + e / D * D) order = std::max(order, Order::by_row);
      if (own[0] < 0 || own[e % D] != own[0] + e % D) order = Order::none;
    }
    order_.push_back(order);
  }
}

template <int D>
SpringTable SpringsByNode<D>::table() const {
  return {.slices = slices_.slices.data(),
          .shifts = slices_.shifts.data(),
          .gathers = gathered_points_.data(),
          .rings = rings_.rings.empty() ? nullptr : &ring_table_,
          .slot_laws = slices_.slot_laws.data(),
          .laws = slices_.laws.data(),
          .law_vectors = slices_.law_vectors,
          .unknowns = unknowns_.data(),
          .orders = order_.data(),
          .gathered = slices_.gathered.data()};
}

template <int D>
void SpringsByNode<D>::sum_forces(const VecView& q, MutableVec f) const {
  const SpringTable springs = table();
  for_slices(q, [&](const Positions& positions, int from, int end) {
    thread_local Vec memory;
    if (memory.size() < rings_.numbers) memory.resize(rings_.numbers);
    kernels_->force(springs, positions, memory.data(), offset(), f.data(), from, end);
  });
}

template <int D>
double SpringsByNode<D>::half_sum_energies(const VecView& q) const {
  double sums[slice_rows] = {};
  kernels_->energy(table(), placed(q), sums, 0, slices_.count());
  double total = 0;
  for (const double sum : sums) total += sum;
  return total / 2;
}

template <int D>
void SpringsByNode<D>::sum_mean_forces(const VecView& a, const VecView& b, MutableVec f) const {
  kernels_->mean_force(table(), placed(a, 0), placed(b, 1), offset(), f.data(), 0, slices_.count());
}

template <int D>
Positions SpringsByNode<D>::placed(const VecView& q, int which) const {
  const Positions positions = memory(which);
  kernels_->place(table(), q.data(), positions, 0, slices_.count());
  place_extras(positions);
  return positions;
}

template <int D>
Positions SpringsByNode<D>::memory(int which) const {
  const Index stride = (slices_.places + slice_rows - 1) / slice_rows * slice_rows;
  thread_local std::array<Vec, 2> memories;
  Vec& numbers = memories[static_cast<std::size_t>(which)];
  const Index size = stride * (D > 1 ? D + point_stride<D> : D);
  if (numbers.size() < size) numbers.resize(size);
  return {numbers.data(), stride, D > 1 ? numbers.data() + stride * D : numbers.data()};
}

template <int D>
void SpringsByNode<D>::place_extras(const Positions& positions) const {
  const auto coordinate = [&](int a, int place) -> double& {
    return positions.coordinates[a * positions.stride + place];
  };
  int at = slices_.rows();
  for (const auto& point : points_) {
    for (int a = 0; a < D; ++a) coordinate(a, at) = point[a];
    ++at;
  }
  for (const auto& [source, signs] : images_) {
    for (int a = 0; a < D; ++a) coordinate(a, at) = signs[a] * coordinate(a, source);
    ++at;
  }
  if (D == 1) return;
  for (int place = slices_.rows(); place < at; ++place) {
    double* point = positions.points + point_stride<D> * Index{place};
    for (int a = 0; a < D; ++a) point[a] = coordinate(a, place);
  }
}

template class SpringsByNode<1>;
template class SpringsByNode<2>;
template class SpringsByNode<3>;

}  // namespace qddot::kernels

#include "qddot/model/kernels/springs_by_node.hpp"

#include <algorithm>
#include <map>

namespace qddot::kernels {

template <int D>
SpringsByNode<D>::Positions::Positions(int places) : stride_((places + lanes - 1) / lanes * lanes) {
  thread_local Vec memory;
  const Index size = stride_ * (D > 1 ? D + point_stride<D> : D);
  if (memory.size() < size) memory.resize(size);
  coordinates_ = memory.data();
  points_ = D > 1 ? coordinates_ + stride_ * D : coordinates_;
}

template <int D>
SpringsByNode<D>::SpringsByNode(const Network& network, const Layout<D>& layout) {
  const int nodes = static_cast<int>(layout.nodes());
  std::vector<std::vector<Neighbour>> neighbours(nodes);
  for (const auto& link : network.links) {
    neighbours[link.i].push_back({link.j, link.law});
    neighbours[link.j].push_back({link.i, link.law});
  }
  std::map<std::array<double, D>, int> points;
  for (const auto& anchor : network.anchors) {
    std::array<double, D> x;
    std::copy_n(anchor.point.data(), D, x.begin());
    const auto [point, is_new] = points.try_emplace(x, std::ssize(points_));
    if (is_new) points_.push_back(x);
    neighbours[anchor.i].push_back({nodes + point->second, anchor.law});
  }
  // In the order of mirrors and sources, so that the image of a grid is one.
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
  // With S the mirror, it pulls x_i towards S x_j and x_j towards S x_i.
  for (const auto& link : network.image_links) {
    neighbours[link.i].push_back({image_of(link.j, link.mirror), link.law});
    neighbours[link.j].push_back({image_of(link.i, link.mirror), link.law});
  }
  slices_ = slice_neighbours(neighbours, static_cast<int>(points_.size() + images_.size()));

  std::vector<int> place(nodes);
  for (int row = 0; row < slices_.rows(); ++row) {
    Unknowns& unknowns = unknowns_.emplace_back();
    unknowns.fill(-1);
    const int node = slices_.node[row];
    if (node < 0) continue;
    place[node] = row;
    for (int a = 0; a < layout.count(node); ++a) {
      unknowns[layout.axis(node, a)] = layout.first(node) + a;
    }
  }
  for (Image& image : images_) image.source = place[image.source];
  for (int row = 0; row < slices_.rows(); row += lanes) {
    Order order = Order::by_slice;
    for (int e = 0; e < D * lanes; ++e) {
      const Unknowns& own = unknowns_[row + e / D];
      if (own[0] != unknowns_[row][0] + e / D * D) order = std::max(order, Order::by_row);
      if (own[0] < 0 || own[e % D] != own[0] + e % D) order = Order::none;
    }
    order_.push_back(order);
  }
}

template <int D>
void SpringsByNode<D>::place(const Vec& q, int slice, const Positions& positions) const {
  const int row = slice * lanes;
  if (order_[slice] == Order::by_slice) {
    Lanes x[D];
    deinterleave<D>(q.data() + unknowns_[row][0], x);
    for (int a = 0; a < D; ++a) store(positions.coordinate(a, row), x[a]);
  } else if (order_[slice] == Order::by_row) {
    for (int t = 0; t < lanes; ++t) {
      const double* x = q.data() + unknowns_[row + t][0];
      for (int a = 0; a < D; ++a) *positions.coordinate(a, row + t) = x[a];
    }
  } else {
    for (int t = 0; t < lanes; ++t) {
      for (int a = 0; a < D; ++a) {
        const int unknown = unknowns_[row + t][a];
        *positions.coordinate(a, row + t) = unknown >= 0 ? q[unknown] : 0;
      }
    }
  }
  if (slices_.gathered[slice]) {
    for (int t = 0; t < lanes; ++t) copy_point(row + t, positions);
  }
}

template <int D>
void SpringsByNode<D>::place_extras(const Positions& positions) const {
  int at = slices_.rows();
  for (const auto& point : points_) {
    for (int a = 0; a < D; ++a) *positions.coordinate(a, at) = point[a];
    copy_point(at++, positions);
  }
  for (const auto& [source, signs] : images_) {
    for (int a = 0; a < D; ++a) {
      *positions.coordinate(a, at) = signs[a] * *positions.coordinate(a, source);
    }
    copy_point(at++, positions);
  }
}

template <int D>
void SpringsByNode<D>::copy_point(int place, const Positions& positions) {
  if constexpr (D > 1) {
    double* point = positions.points() + point_stride<D> * Index{place};
    for (int a = 0; a < D; ++a) point[a] = *positions.coordinate(a, place);
  }
}

template class SpringsByNode<1>;
template class SpringsByNode<2>;
template class SpringsByNode<3>;

}  // namespace qddot::kernels

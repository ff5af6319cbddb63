#include "src/model/force_kernel.hpp"

#include <algorithm>
#include <map>
#include <omp.h>

#include "src/model/lanes.hpp"

namespace qddot {
namespace {

// Fewer slots than these are done before a second thread has begun.
constexpr std::size_t slots_worth_threads = 5000;

// tau/l of one slot's springs, whose squared lengths are l2; 0 where l = 0, as in spring.hpp.
template <int law_vectors>
[[gnu::always_inline]] inline Lanes tension_by_length(Lanes l2, const double* law) {
  const Lanes stiffness = load(law);
  if constexpr (law_vectors == 1) {
    return stiffness;
  } else {
    const Lanes l = square_root(l2), s = l - load(law + lanes);
    Lanes tension = s * stiffness;
    if constexpr (law_vectors == 3) tension = s * (stiffness + load(law + 2 * lanes) * (s * s));
    const Lanes ratio = tension / l;
    return l > 0 ? ratio : Lanes{};
  }
}

}  // namespace

// The positions at hand, coordinate by coordinate and, of those that are gathered, point by point.
// They are this thread's until its next force.
template <int D>
class ForceKernel<D>::Places {
 public:
  explicit Places(int count) : stride_((count + lanes - 1) / lanes * lanes) {
    thread_local Vec memory;
    const Index size = Index{stride_} * (D + (D > 1 ? point_stride<D> : 0));
    if (memory.size() < size) memory.resize(size);
    coordinates_ = memory.data();
    points_ = D > 1 ? coordinates_ + Index{stride_} * D : coordinates_;
  }

  double* coordinate(int a, int place) const { return coordinates_ + Index{stride_} * a + place; }
  double* points() const { return points_; }

  void make_point(int place) const {
    if constexpr (D > 1) {
      for (int a = 0; a < D; ++a)
        points_[point_stride<D> * Index{place} + a] = *coordinate(a, place);
    }
  }

 private:
  int stride_;
  double *coordinates_, *points_;
};

template <int D>
ForceKernel<D>::ForceKernel(const Network& network, const Layout<D>& layout) {
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
    const auto [found, is_new] = points.try_emplace(x, static_cast<int>(points_.size()));
    if (is_new) points_.push_back(x);
    neighbours[anchor.i].push_back({nodes + found->second, anchor.law});
  }
  // With S = diag(signs) the spring pulls i towards S x_j and j towards S x_i.
  std::map<std::pair<std::array<double, D>, int>, int> images;
  const auto image_of = [&](int node, const Eigen::Vector3d& mirror) {
    std::array<double, D> signs;
    std::copy_n(mirror.data(), D, signs.begin());
    return &images[{signs, node}];
  };
  for (const auto& link : network.image_links) {
    image_of(link.i, link.mirror);
    image_of(link.j, link.mirror);
  }
  // In the order of their sources, so that those of a grid are a grid.
  for (auto& [image, number] : images) {
    number = nodes + static_cast<int>(points_.size() + images_.size());
    images_.push_back({image.second, image.first});
  }
  for (const auto& link : network.image_links) {
    neighbours[link.i].push_back({*image_of(link.j, link.mirror), link.law});
    neighbours[link.j].push_back({*image_of(link.i, link.mirror), link.law});
  }
  slices_ = slice_neighbours(neighbours, static_cast<int>(points_.size() + images_.size()));

  std::vector<int> place(nodes);
  for (int row = 0; row < slices_.rows(); ++row) {
    Unknowns& unknowns = unknowns_.emplace_back();
    unknowns.fill(-1);
    const int node = slices_.node[row];
    if (node < 0) continue;
    place[node] = row;
    for (int a = 0; a < layout.count(node); ++a)
      unknowns[layout.axis(node, a)] = layout.first(node) + a;
  }
  for (Image& image : images_) image.source = place[image.source];
  for (int row = 0; row < slices_.rows(); row += lanes) {
    const int first = unknowns_[row][0];
    bool follow = true;
    for (int e = 0; e < D * lanes; ++e) follow &= unknowns_[row + e / D][e % D] == first + e;
    first_unknown_.push_back(first >= 0 && follow ? first : -1);
  }
}

template <int D>
void ForceKernel<D>::place(const Vec& q, int slice, Places& places) const {
  const int row = slice * lanes;
  if (first_unknown_[slice] >= 0) {
    Lanes x[D];
    deinterleave<D>(q.data() + first_unknown_[slice], x);
    for (int a = 0; a < D; ++a) store(places.coordinate(a, row), x[a]);
  } else {
    for (int t = 0; t < lanes; ++t) {
      for (int a = 0; a < D; ++a) {
        const int unknown = unknowns_[row + t][a];
        *places.coordinate(a, row + t) = unknown >= 0 ? q[unknown] : 0;
      }
    }
  }
  if (slices_.gathered[slice]) {
    for (int t = 0; t < lanes; ++t) places.make_point(row + t);
  }
}

template <int D>
void ForceKernel<D>::place_extras(Places& places) const {
  int at = slices_.rows();
  for (const auto& point : points_) {
    for (int a = 0; a < D; ++a) *places.coordinate(a, at) = point[a];
    places.make_point(at++);
  }
  for (const auto& [source, signs] : images_) {
    for (int a = 0; a < D; ++a) {
      *places.coordinate(a, at) = signs[a] * *places.coordinate(a, source);
    }
    places.make_point(at++);
  }
}

template <int D>
template <int law_vectors>
void ForceKernel<D>::sum(const Places& places, int slice, const Vec& offset, Vec& f) const {
  const int row = slice * lanes;
  Lanes x[D], d[D], total[D] = {};
  for (int a = 0; a < D; ++a) x[a] = load(places.coordinate(a, row));
  const auto begin = slices_.slices[slice], end = slices_.slices[slice + 1];
  const double* law = slices_.laws.data() + begin.law;
  const auto add = [&] {
    Lanes l2 = d[0] * d[0];
    for (int a = 1; a < D; ++a) l2 += d[a] * d[a];
    const Lanes ratio = tension_by_length<law_vectors>(l2, law);
    for (int a = 0; a < D; ++a) total[a] += ratio * d[a];
    law += law_vectors * lanes;
  };
  for (int s = begin.shift; s < end.shift; ++s) {
    const int shifted = row + slices_.shifts[s];
    for (int a = 0; a < D; ++a) d[a] = load(places.coordinate(a, shifted)) - x[a];
    add();
  }
  for (int s = begin.gather; s < end.gather; s += lanes) {
    gather<D>(places.points(), slices_.gathers.data() + s, d);
    for (int a = 0; a < D; ++a) d[a] -= x[a];
    add();
  }
  if (first_unknown_[slice] >= 0) {
    interleave<D>(total, offset.data() + first_unknown_[slice], f.data() + first_unknown_[slice]);
    return;
  }
  for (int t = 0; t < lanes; ++t) {
    for (int a = 0; a < D; ++a) {
      const int unknown = unknowns_[row + t][a];
      if (unknown >= 0) f[unknown] = offset[unknown] + total[a][t];
    }
  }
}

template <int D>
template <int law_vectors>
void ForceKernel<D>::run(const Vec& q, const Vec& offset, Vec& f) const {
  Places places(slices_.places);
  const int count = slices_.count();
  const std::size_t slots = slices_.shifts.size() + slices_.gathers.size() / lanes;
  if (slots < slots_worth_threads || omp_in_parallel() || omp_get_max_threads() == 1) {
    for (int s = 0; s < count; ++s) place(q, s, places);
    place_extras(places);
    for (int s = 0; s < count; ++s) sum<law_vectors>(places, s, offset, f);
    return;
  }
#pragma omp parallel
  {
#pragma omp for schedule(static)
    for (int s = 0; s < count; ++s) place(q, s, places);
#pragma omp single
    place_extras(places);
#pragma omp for schedule(static)
    for (int s = 0; s < count; ++s) sum<law_vectors>(places, s, offset, f);
  }
}

template <int D>
void ForceKernel<D>::force(const Vec& q, const Vec& offset, Vec& f) const {
  switch (slices_.law_vectors) {
    case 1:
      return run<1>(q, offset, f);
    case 2:
      return run<2>(q, offset, f);
    default:
      return run<3>(q, offset, f);
  }
}

template class ForceKernel<1>;
template class ForceKernel<2>;
template class ForceKernel<3>;

}  // namespace qddot

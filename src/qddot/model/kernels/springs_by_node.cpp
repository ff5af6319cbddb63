#include "qddot/model/kernels/springs_by_node.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "qddot/model/kernels/roots.hpp"

namespace qddot::kernels {
namespace {

// Measured: all vectors of a step of so many parts stand in a cache of 2 MB. Those of more parts do
// not, and then so many are done at once.
constexpr int parts_in_cache = 24, parts_at_once = 4;

}  // namespace

template <int D>
SpringsByNode<D>::SpringsByNode(const Network& network, const CompactLinks& links,
                                const Layout<D>& layout, const Vec& weight,
                                const DrivenNetwork<D>& driven)
    : weight_(weight), driven_(driven) {
  const int nodes = static_cast<int>(layout.nodes());
  // If a node has fewer unknowns, slices begin at other axes than the first.
  const bool are_full = nodes > 0 && weight.size() == D * Index{nodes};
  has_same_weights_ = are_full && weight.tail(weight.size() - D) == weight.head(weight.size() - D);
  if (has_same_weights_) {
    for (std::size_t i = 0; i < slice_weight_.size(); ++i) {
      slice_weight_[i] = weight[static_cast<Index>(i % D)];
    }
  }
  std::map<std::pair<std::array<double, D>, int>, int> points;
  std::vector<int> anchored_to;  // the point of each anchor
  for (const auto& anchor : network.anchors) {
    std::array<double, D> x;
    std::copy_n(anchor.point.data(), D, x.begin());
    const auto [point, is_new] = points.try_emplace({x, anchor.curve}, std::ssize(points_));
    if (is_new) {
      points_.push_back(x);
      point_curves_.push_back(anchor.curve);
    }
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
    images_.push_back({point, image.second, image.first});
  }
  // The spring pulls x_i towards S x_j and x_j towards S x_i, with S the mirror.
  std::vector<std::array<int, 2>> image_ends;
  for (const auto& link : network.image_links) {
    image_ends.push_back({image_of(link.j, link.mirror), image_of(link.i, link.mirror)});
  }
  const auto for_each_end = [&](const auto& see) {
    links.for_each([&](int i, int j, const PlainLaw& law) { see(i, j, law), see(j, i, law); });
    for (std::size_t e = 0; e < anchored_to.size(); ++e) {
      see(network.anchors[e].i, anchored_to[e], network.anchors[e].law.plain());
    }
    for (std::size_t e = 0; e < image_ends.size(); ++e) {
      const auto& link = network.image_links[e];
      see(link.i, image_ends[e][0], link.law.plain());
      see(link.j, image_ends[e][1], link.law.plain());
    }
  };
  const Neighbours neighbours = neighbours_of(nodes, for_each_end);
  for (const PlainLaw& law : neighbours.laws.values()) {
    if (law.damping > 0 && law.rest_length == 0) dashpots_are_directed_ = false;
  }
  slices_ = slice_neighbours(neighbours, static_cast<int>(points_.size() + images_.size()));
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
  for (Image& image : images_) {
    image.place += slices_.rows() - nodes;
    image.source = place[image.source];
  }
  for (int row = 0; row < slices_.rows(); row += slice_rows) {
    Order order = Order::by_slice;
    for (int e = 0; e < D * slice_rows; ++e) {
      const int* own = unknowns(row + e / D);
      if (own[0] != unknowns(row)[0] + e / D * D) order = std::max(order, Order::by_row);
      if (own[0] < 0 || own[e % D] != own[0] + e % D) order = Order::none;
    }
    slice_unknowns_.push_back({order, unknowns(row)[0]});
  }
  divide_into_parts();
}

template <int D>
void SpringsByNode<D>::divide_into_parts() {
  std::ranges::sort(images_, {}, &Image::source);
  const int first_extra = slices_.rows(), points = static_cast<int>(points_.size());
  std::vector<int> sources(images_.size());
  for (const Image& image : images_) {
    sources[static_cast<std::size_t>(image.place - first_extra - points)] = image.source;
  }
  parts_ = parts_of(slices_, [&](int place) {
    const int image = place - first_extra - points;
    return image < 0 ? -1 : sources[static_cast<std::size_t>(image)];
  });
  int unknown = 0;
  for (const auto& [begin, end, first_read, read_end] : parts_.parts) {
    const auto image = std::ranges::lower_bound(images_, begin * slice_rows, {}, &Image::source);
    first_image_.push_back(static_cast<int>(image - images_.begin()));
    first_unknown_.push_back(unknown);
    for (int e = D * begin * slice_rows; e < D * end * slice_rows; ++e)
      unknown += unknowns_[e] >= 0;
  }
  first_image_.push_back(static_cast<int>(images_.size()));
  first_unknown_.push_back(unknown);
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
          .slice_unknowns = slice_unknowns_.data(),
          .gathered = slices_.gathered.data()};
}

template <int D>
DashpotTable SpringsByNode<D>::dashpot_table() const {
  return {.slots = slices_.slot_dashpots.data(),
          .jobs = rings_.job_dashpots.data(),
          .first_number = rings_.numbers,
          .are_directed = dashpots_are_directed_};
}

template <int D>
bool SpringsByNode<D>::uses_threads() const {
  const Index slots = std::ssize(slices_.shifts) + std::ssize(slices_.gathers) / slice_rows;
  return slots >= slots_worth_threads && !omp_in_parallel() && omp_get_max_threads() > 1;
}

template <int D>
template <class Damping>
double SpringsByNode<D>::sum_forces(const At& at, MutableVec f, BesideForce* beside,
                                    const Damping& damped) const {
  const VecView& q = at.q;
  const Offset weight = offset(at);
  const SpringTable springs = table();
  const Positions positions = memory();
  [[maybe_unused]] DashpotTable dashpots{};
  [[maybe_unused]] Positions velocities{};
  [[maybe_unused]] Offset none{};
  if constexpr (Damping::exists) {
    dashpots = dashpot_table();
    velocities = memory(1);
    none = no_offset(damped.friction);
    place_velocities_of_points(velocities, at);
  }
  const int count = parts_.count();
  thread_local Vec of_parts;
  if (of_parts.size() < count) of_parts.resize(count);
  double* const sums = of_parts.data();
  place_points(positions, at);

  const auto place = [&](int from, int end) {
    if (from == end) return;
    if (beside) beside->before(first_unknown_[from], first_unknown_[end]);
    kernels_->place(springs, q.data(), positions, parts_.parts[from].begin,
                    parts_.parts[end - 1].end);
    place_images(positions, from, end);
    if constexpr (Damping::exists) {
      kernels_->place(springs, at.v.data(), velocities, parts_.parts[from].begin,
                      parts_.parts[end - 1].end);
      place_images(velocities, from, end);
    }
  };
  // Sums parts [from, end). Of these, [placed, places_end) still have to be placed.
  const auto sum = [&](int from, int end, int placed, int places_end) {
    thread_local Vec memory;
    const Index numbers = Damping::exists ? 2 * rings_.numbers : rings_.numbers;
    if (memory.size() < numbers) memory.resize(numbers);
    [[maybe_unused]] bool met_no_length = false;
    const int at_once = end - from <= parts_in_cache ? parts_in_cache : parts_at_once;
    for (int first = from; first < end; first += at_once) {
      const int last = std::min(first + at_once, end) - 1;
      const int read_end = std::min(parts_.parts[last].read_end, places_end);
      if (placed < read_end) place(std::exchange(placed, read_end), read_end);
      const int begin = parts_.parts[first].begin, slices_end = parts_.parts[last].end;
      if constexpr (Damping::exists) {
        kernels_->damped_force(springs, dashpots, positions, velocities, memory.data(),
                               first > from, met_no_length, weight, f.data(), none,
                               damped.friction.data(), begin, slices_end);
      } else {
        kernels_->force(springs, positions, memory.data(), first > from, weight, f.data(), begin,
                        slices_end);
      }
      for (int p = first; beside && p <= last; ++p) {
        sums[p] = beside->after(first_unknown_[p], first_unknown_[p + 1]);
      }
    }
  };
  if (!uses_threads()) {
    sum(0, count, 0, count);
  } else {
#pragma omp parallel
    {
      const Index thread = omp_get_thread_num(), threads = omp_get_num_threads();
      const int from = static_cast<int>(count * thread / threads),
                end = static_cast<int>(count * (thread + 1) / threads);
      // Places that other threads read are made before all sums.
      const int head = from == 0 ? 0 : std::clamp(parts_.parts[from - 1].read_end, from, end);
      const int tail = end == count ? end : std::clamp(parts_.parts[end].first_read, head, end);
      place(from, head);
      place(tail, end);
#pragma omp barrier
      sum(from, end, head, tail);
    }
  }
  if (!beside) return 0;
  double total = 0;
  for (int p = 0; p < count; ++p) total += sums[p];
  return total;
}

template <int D>
double SpringsByNode<D>::half_sum_energies(const At& at) const {
  double sums[slice_rows] = {};
  kernels_->energy(table(), placed(at), sums, 0, slices_.count());
  double total = 0;
  for (const double sum : sums) total += sum;
  return total / 2;
}

template <int D>
void SpringsByNode<D>::sum_mean_forces(const At& a, const At& b, MutableVec f) const {
  kernels_->mean_force(table(), placed(a, 0), placed(b, 1), offset(a), f.data(), 0,
                       slices_.count());
}

template <int D>
Offset SpringsByNode<D>::offset(const At& at) const {
  if (!driven_.has_loads())
    return {weight_.data(), has_same_weights_ ? slice_weight_.data() : nullptr};
  thread_local Vec weight;
  weight = weight_;
  driven_.add_loads(at, weight);
  return {weight.data(), nullptr};
}

template <int D>
Offset SpringsByNode<D>::no_offset(MutableVec numbers) const {
  static constexpr std::array<double, D * slice_rows> of_slice{};
  for (std::size_t slice = 0; slice < slice_unknowns_.size(); ++slice) {
    if (slice_unknowns_[slice].order == Order::by_slice) continue;
    const int first = static_cast<int>(slice) * D * slice_rows;
    for (int e = first; e < first + D * slice_rows; ++e) {
      if (unknowns_[e] >= 0) numbers[unknowns_[e]] = 0;
    }
  }
  return {numbers.data(), of_slice.data()};
}

template <int D>
void SpringsByNode<D>::multiply_stiffness(const At& at, const VecView& x, MutableVec y) const {
  const Positions moved = placed_beside(x);
  kernels_->stiffness_product(table(), placed(at, 0), moved, no_offset(y), y.data(), 0,
                              slices_.count());
}

template <int D>
void SpringsByNode<D>::sum_friction(const At& at, MutableVec friction) const {
  const Positions velocities = placed_beside(at.v);
  place_velocities_of_points(velocities, at);
  kernels_->friction(table(), dashpot_table(), placed(at, 0), velocities, no_offset(friction),
                     friction.data(), 0, slices_.count());
}

template <int D>
double SpringsByNode<D>::sum_damped_forces(const At& at, MutableVec f, MutableVec friction,
                                           BesideForce* beside) const {
  return sum_forces(at, f, beside, Damped{friction});
}

template <int D>
Positions SpringsByNode<D>::placed_beside(const VecView& x) const {
  const Positions moved = placed(x, 1);
  place_resting_points(moved);
  return moved;
}

template <int D>
void SpringsByNode<D>::place_resting_points(const Positions& velocities) const {
  const int first = slices_.rows(), points = static_cast<int>(points_.size());
  for (int place = first; place < first + points; ++place) place_extra(velocities, place, {});
}

template <int D>
void SpringsByNode<D>::place_velocities_of_points(const Positions& velocities, const At& at) const {
  place_resting_points(velocities);
  move_points(velocities, driven_.rates(at));
}

template <int D>
void SpringsByNode<D>::sum_stiffness_rows(const At& at, MutableVec sums) const {
  kernels_->stiffness_row_sums(table(), placed(at), no_offset(sums), sums.data(), 0,
                               slices_.count());
}

template <int D>
Positions SpringsByNode<D>::placed(const At& at, int which) const {
  const Positions positions = memory(which);
  place_points(positions, at);
  kernels_->place(table(), at.q.data(), positions, 0, slices_.count());
  place_images(positions, 0, parts_.count());
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
void SpringsByNode<D>::place_points(const Positions& positions, const At& at) const {
  int place = slices_.rows();
  for (const auto& point : points_) place_extra(positions, place++, point);
  move_points(positions, driven_.values(at));
}

template <int D>
void SpringsByNode<D>::move_points(const Positions& positions,
                                   const std::vector<Eigen::Matrix<double, D, 1>>& by) const {
  for (std::size_t i = 0; i < point_curves_.size() && !by.empty(); ++i) {
    if (point_curves_[i] < 0) continue;
    const int place = slices_.rows() + static_cast<int>(i);
    std::array<double, D> x;
    for (int a = 0; a < D; ++a) {
      x[a] = positions.coordinates[a * positions.stride + place] + by[point_curves_[i]][a];
    }
    place_extra(positions, place, x);
  }
}

template <int D>
void SpringsByNode<D>::place_images(const Positions& positions, int from, int end) const {
  for (int i = first_image_[from]; i < first_image_[end]; ++i) {
    const auto& [place, source, signs] = images_[i];
    std::array<double, D> x;
    for (int a = 0; a < D; ++a) {
      x[a] = signs[a] * positions.coordinates[a * positions.stride + source];
    }
    place_extra(positions, place, x);
  }
}

template <int D>
void SpringsByNode<D>::place_extra(const Positions& positions, int place,
                                   const std::array<double, D>& x) const {
  for (int a = 0; a < D; ++a) positions.coordinates[a * positions.stride + place] = x[a];
  if (D == 1) return;
  std::copy(x.begin(), x.end(), positions.points + point_stride<D> * Index{place});
}

template class SpringsByNode<1>;
template class SpringsByNode<2>;
template class SpringsByNode<3>;

}  // namespace qddot::kernels

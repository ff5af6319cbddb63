#include "qddot/model/kernels/neighbour_slices.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>
#include <optional>

#include "qddot/model/kernels/slot_plan.hpp"

namespace qddot::kernels {
namespace {

// The measured cost of a gathering slot, in slots of one shift.
constexpr double cost_of_gather = 1.6;
constexpr int window = sorted_rows;

// Sorts neighbours, equal ones in the order they had. Most nodes have few, which are moved one by
// one without any memory.
void sort_by_place(std::vector<Neighbour>& row) {
  constexpr std::size_t few = 64;
  if (row.size() > few) {
    std::ranges::stable_sort(row, {}, &Neighbour::point);
    return;
  }
  for (auto next = row.begin(); next != row.end(); ++next) {
    const auto place =
        std::ranges::upper_bound(row.begin(), next, next->point, {}, &Neighbour::point);
    std::rotate(place, next, next + 1);
  }
}

// One number of each of a slot's laws.
using LawVector = std::array<double, slice_rows>;

class Slicer {
 public:
  Slicer(const Neighbours& neighbours, int extras, const std::vector<int>& order)
      : neighbours_(neighbours), place_(neighbours.nodes() + extras) {
    const int nodes = neighbours.nodes();
    const int rows = (nodes + slice_rows - 1) / slice_rows * slice_rows;
    result_.node = order;
    result_.node.resize(rows, -1);
    result_.places = rows + extras;
    result_.gathered.resize((result_.places + slice_rows - 1) / slice_rows);
    for (int row = 0; row < nodes; ++row) place_[order[row]] = row;
    std::iota(place_.begin() + nodes, place_.end(), rows);
    for (const PlainLaw& law : neighbours.laws.values()) {
      if (law.quartic > 0) result_.law_vectors = 3;
      if (law.rest_length > 0) result_.law_vectors = std::max(result_.law_vectors, 2);
      has_dashpots_ = has_dashpots_ || law.damping > 0;
    }
  }

  // The slices, or nothing if they will not cost less than `limit`.
  std::optional<NeighbourSlices> slice(double limit) {
    auto ends_left = static_cast<double>(neighbours_.ends.size());
    SlotPlan plan;
    for (int row = 0; row < result_.rows(); row += slice_rows) {
      begin_slice();
      take_rows(row);
      if (!plan.serves(row, result_.places, rows_)) plan.make(row, result_.places, rows_);
      for (const SlotPlan::Slot& slot : plan.slots()) take(row, slot);
      for (const auto& own : rows_) ends_left -= static_cast<double>(own.size());
      // The other rows need at least as many slots as if each were full and had one shift.
      if (cost(result_) + ends_left / slice_rows >= limit) return {};
    }
    begin_slice();
    result_.laws = Eigen::Map<const Vec>(laws_.values().data()->data(),
                                         slice_rows * std::ssize(laws_.values()));
    return std::move(result_);
  }

  // In slots of one shift.
  static double cost(const NeighbourSlices& slices) {
    return static_cast<double>(slices.shifts.size()) +
           cost_of_gather * static_cast<double>(slices.gathers.size()) / slice_rows;
  }

 private:
  void begin_slice() {
    result_.slices.push_back(
        {static_cast<int>(result_.shifts.size()), static_cast<int>(result_.gathers.size())});
  }

  void take_rows(int first) {
    for (int t = 0; t < slice_rows; ++t) {
      rows_[t].clear();
      const int node = result_.node[first + t];
      if (node < 0) continue;
      rows_[t].assign(neighbours_.ends.begin() + neighbours_.first[node],
                      neighbours_.ends.begin() + neighbours_.first[node + 1]);
      for (Neighbour& neighbour : rows_[t]) neighbour.point = place_[neighbour.point];
      sort_by_place(rows_[t]);
    }
  }

  void take(int first, const SlotPlan::Slot& slot) {
    if (slot.is_shift) {
      result_.shifts.push_back(slot.shift);
    } else {
      for (int t = 0; t < slice_rows; ++t) {
        const int place = first + slot.place[t];
        result_.gathers.push_back(place);
        result_.gathered[place / slice_rows] = true;
      }
    }
    static constexpr PlainLaw none;
    std::array<const PlainLaw*, slice_rows> laws;
    for (int t = 0; t < slice_rows; ++t) {
      const int e = slot.neighbour[t];
      laws[t] = e < 0 ? &none : &neighbours_.laws[rows_[t][e].law];
    }
    const auto place_of = [&](double PlainLaw::*number) {
      LawVector numbers;
      for (int t = 0; t < slice_rows; ++t) numbers[t] = laws[t]->*number;
      return slice_rows * laws_.number(numbers);
    };
    const auto place = [&](int vector, double PlainLaw::*number) {
      return vector < result_.law_vectors ? place_of(number) : 0;
    };
    if (has_dashpots_) result_.slot_dashpots.push_back(place_of(&PlainLaw::damping));
    result_.slot_laws.push_back({place(0, &PlainLaw::stiffness), place(1, &PlainLaw::rest_length),
                                 place(2, &PlainLaw::quartic)});
  }

  const Neighbours& neighbours_;
  bool has_dashpots_ = false;
  std::vector<int> place_;  // of each point
  RepeatedValues<LawVector> laws_;
  RowNeighbours rows_;
  NeighbourSlices result_;
};

}  // namespace

NeighbourSlices slice_neighbours(const Neighbours& neighbours, int extras) {
  std::vector<int> order(neighbours.nodes());
  std::iota(order.begin(), order.end(), 0);
  constexpr double any = std::numeric_limits<double>::infinity();
  NeighbourSlices as_given = *Slicer(neighbours, extras, order).slice(any);
  if (as_given.gathers.empty()) return as_given;
  for (std::size_t begin = 0; begin < order.size(); begin += window) {
    const std::size_t end = std::min(begin + window, order.size());
    std::stable_sort(order.begin() + begin, order.begin() + end,
                     [&](int a, int b) { return neighbours.count(a) > neighbours.count(b); });
  }
  auto sorted = Slicer(neighbours, extras, order).slice(Slicer::cost(as_given));
  return sorted ? std::move(*sorted) : std::move(as_given);
}

}  // namespace qddot::kernels

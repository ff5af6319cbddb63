#include "qddot/model/kernels/neighbour_slices.hpp"

#include <algorithm>
#include <array>
#include <numeric>

namespace qddot::kernels {
namespace {

// The measured cost of a gathering slot, in slots of one shift.
constexpr double cost_of_gather = 1.6;
// Rows are sorted within windows of this size; across more, positions are far apart in memory.
constexpr int window = 256;

using Rows = std::array<std::vector<Neighbour>, slice_rows>;  // by places
using Laws = std::array<SpringLaw, slice_rows>;

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

class Slicer {
 public:
  Slicer(const std::vector<std::vector<Neighbour>>& neighbours, int extras,
         const std::vector<int>& order)
      : neighbours_(neighbours), place_(neighbours.size() + extras) {
    const int nodes = static_cast<int>(neighbours.size());
    const int rows = (nodes + slice_rows - 1) / slice_rows * slice_rows;
    result_.node = order;
    result_.node.resize(rows, -1);
    result_.places = rows + extras;
    result_.gathered.resize((result_.places + slice_rows - 1) / slice_rows);
    for (int row = 0; row < nodes; ++row) place_[order[row]] = row;
    std::iota(place_.begin() + nodes, place_.end(), rows);
    for (const auto& own : neighbours) {
      for (const Neighbour& neighbour : own) {
        if (neighbour.law.quartic > 0) result_.law_vectors = 3;
        if (neighbour.law.rest_length > 0) result_.law_vectors = std::max(result_.law_vectors, 2);
      }
    }
  }

  NeighbourSlices slice() {
    for (int row = 0; row < result_.rows(); row += slice_rows) {
      begin_slice();
      take_rows(row);
      take_shifts(row, rows_);
      take_gathers(row, rows_);
    }
    begin_slice();
    result_.laws = Eigen::Map<const Vec>(laws_.data(), std::ssize(laws_));
    return std::move(result_);
  }

 private:
  // A slot of one shift is worth it if it serves at least this many rows.
  static constexpr int enough_rows = slice_rows / 2;

  void begin_slice() {
    result_.slices.push_back({static_cast<int>(result_.shifts.size()),
                              static_cast<int>(result_.gathers.size()), std::ssize(laws_)});
  }

  void take_rows(int first) {
    for (int t = 0; t < slice_rows; ++t) {
      rows_[t].clear();
      if (result_.node[first + t] < 0) continue;
      rows_[t] = neighbours_[result_.node[first + t]];
      for (Neighbour& neighbour : rows_[t]) neighbour.point = place_[neighbour.point];
      sort_by_place(rows_[t]);
    }
  }

  // Slots of one shift, as long as enough rows have a neighbour there.
  void take_shifts(int first, Rows& rows) {
    bool found = true;
    while (found) {
      found = false;
      shifts_.clear();
      for (int t = 0; t < slice_rows; ++t) {
        for (std::size_t e = 0; e < rows[t].size(); ++e) {
          if (e > 0 && rows[t][e].point == rows[t][e - 1].point) continue;
          shifts_.push_back(rows[t][e].point - first - t);
        }
      }
      std::ranges::sort(shifts_);
      for (auto next = shifts_.begin(); next != shifts_.end();) {
        const int shift = *next;
        const auto end = std::upper_bound(next, shifts_.end(), shift);
        const bool is_within = first + shift >= 0 && first + shift + slice_rows <= result_.places;
        if (end - next >= enough_rows && is_within) {
          take_shift(first, shift, rows);
          found = true;
        }
        next = end;
      }
    }
  }

  void take_shift(int first, int shift, Rows& rows) {
    result_.shifts.push_back(shift);
    Laws laws{};
    for (int t = 0; t < slice_rows; ++t) {
      const auto found = std::ranges::find(rows[t], first + t + shift, &Neighbour::point);
      if (found == rows[t].end()) continue;
      laws[t] = found->law;
      rows[t].erase(found);
    }
    append(laws);
  }

  // A row without a spring gets another row's neighbour. A spring to itself has length zero, which
  // takes the slower way.
  void take_gathers(int first, const Rows& rows) {
    std::size_t most = 0;
    for (const auto& row : rows) most = std::max(most, row.size());
    for (std::size_t e = 0; e < most; ++e) {
      int longest = 0;
      while (e >= rows[longest].size()) ++longest;
      const int other = rows[longest][e].point;
      Laws laws{};
      for (int t = 0; t < slice_rows; ++t) {
        const bool has_one = e < rows[t].size();
        const int place = has_one ? rows[t][e].point : other != first + t ? other : first + longest;
        if (has_one) laws[t] = rows[t][e].law;
        result_.gathers.push_back(place);
        result_.gathered[place / slice_rows] = true;
      }
      append(laws);
    }
  }

  void append(const Laws& laws) {
    for (const SpringLaw& law : laws) laws_.push_back(law.stiffness);
    if (result_.law_vectors > 1) {
      for (const SpringLaw& law : laws) laws_.push_back(law.rest_length);
    }
    if (result_.law_vectors > 2) {
      for (const SpringLaw& law : laws) laws_.push_back(law.quartic);
    }
  }

  const std::vector<std::vector<Neighbour>>& neighbours_;
  std::vector<int> place_;  // of each point
  std::vector<double> laws_;
  Rows rows_;
  std::vector<int> shifts_;
  NeighbourSlices result_;
};

double cost(const NeighbourSlices& slices) {
  return static_cast<double>(slices.shifts.size()) +
         cost_of_gather * static_cast<double>(slices.gathers.size()) / slice_rows;
}

}  // namespace

NeighbourSlices slice_neighbours(const std::vector<std::vector<Neighbour>>& neighbours,
                                 int extras) {
  std::vector<int> order(neighbours.size());
  std::iota(order.begin(), order.end(), 0);
  NeighbourSlices as_given = Slicer(neighbours, extras, order).slice();
  if (as_given.gathers.empty()) return as_given;
  for (std::size_t begin = 0; begin < order.size(); begin += window) {
    const std::size_t end = std::min(begin + window, order.size());
    std::stable_sort(order.begin() + begin, order.begin() + end,
                     [&](int a, int b) { return neighbours[a].size() > neighbours[b].size(); });
  }
  NeighbourSlices sorted = Slicer(neighbours, extras, order).slice();
  return cost(sorted) < cost(as_given) ? std::move(sorted) : std::move(as_given);
}

}  // namespace qddot::kernels

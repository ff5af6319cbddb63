#include "qddot/model/kernels/slot_plan.hpp"

#include <algorithm>

namespace qddot::kernels {
namespace {

// A slot of one shift is worth it if it serves at least this many rows.
constexpr int enough_rows = slice_rows / 2;

// Whether all rows of a slice have places at this shift.
bool is_within(int first, int shift, int places) {
  return first + shift >= 0 && first + shift + slice_rows <= places;
}

}  // namespace

bool SlotPlan::serves(int first, int places, const RowNeighbours& rows) const {
  if (!is_general_ || !is_within(first, least_shift_, places) ||
      !is_within(first, largest_shift_, places)) {
    return false;
  }
  auto at = around_.begin();
  for (const auto& row : rows) {
    if (around_.end() - at <= std::ssize(row) || *at++ != std::ssize(row)) return false;
    for (const Neighbour& neighbour : row) {
      if (*at++ != neighbour.point - first) return false;
    }
  }
  return at == around_.end();
}

void SlotPlan::make(int first, int places, const RowNeighbours& rows) {
  slots_.clear();
  around_.clear();
  is_general_ = true;
  least_shift_ = largest_shift_ = 0;
  for (int t = 0; t < slice_rows; ++t) {
    around_.push_back(static_cast<int>(rows[t].size()));
    left_[t].clear();
    for (const Neighbour& neighbour : rows[t]) {
      left_[t].push_back({neighbour.point - first, static_cast<int>(left_[t].size())});
      around_.push_back(neighbour.point - first);
    }
  }
  while (take_shifts(first, places)) {
  }
  take_gathers();
}

// Takes the slots of one shift for which enough rows have a neighbour; false if there were none.
bool SlotPlan::take_shifts(int first, int places) {
  bool found = false;
  shifts_.clear();
  for (int t = 0; t < slice_rows; ++t) {
    for (std::size_t e = 0; e < left_[t].size(); ++e) {
      if (e > 0 && left_[t][e].place == left_[t][e - 1].place) continue;
      shifts_.push_back(left_[t][e].place - t);
    }
  }
  std::ranges::sort(shifts_);
  for (auto next = shifts_.begin(); next != shifts_.end();) {
    const int shift = *next;
    const auto end = std::upper_bound(next, shifts_.end(), shift);
    const bool is_enough = end - next >= enough_rows;
    next = end;
    if (!is_enough) continue;
    if (is_within(first, shift, places)) {
      take_shift(shift);
      found = true;
    } else {
      is_general_ = false;
    }
  }
  return found;
}

void SlotPlan::take_shift(int shift) {
  Slot& slot = slots_.emplace_back();
  slot.is_shift = true;
  slot.shift = shift;
  least_shift_ = std::min(least_shift_, shift);
  largest_shift_ = std::max(largest_shift_, shift);
  for (int t = 0; t < slice_rows; ++t) {
    slot.place[t] = t + shift;
    const auto found = std::ranges::find(left_[t], t + shift, &Left::place);
    slot.neighbour[t] = found == left_[t].end() ? -1 : found->neighbour;
    if (found != left_[t].end()) left_[t].erase(found);
  }
}

// A row without a spring gets another row's neighbour. A spring to itself has length zero, which
// takes the slower way.
void SlotPlan::take_gathers() {
  std::size_t most = 0;
  for (const auto& row : left_) most = std::max(most, row.size());
  for (std::size_t e = 0; e < most; ++e) {
    int longest = 0;
    while (e >= left_[longest].size()) ++longest;
    const int other = left_[longest][e].place;
    Slot& slot = slots_.emplace_back();
    for (int t = 0; t < slice_rows; ++t) {
      const bool has_one = e < left_[t].size();
      slot.place[t] = has_one ? left_[t][e].place : other != t ? other : longest;
      slot.neighbour[t] = has_one ? left_[t][e].neighbour : -1;
    }
  }
}

}  // namespace qddot::kernels

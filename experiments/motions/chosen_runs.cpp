#include "experiments/motions/chosen_runs.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include <fmt/format.h>

namespace qddot::motions {
namespace {

// The chosen runs in order; each point once, with all reasons to show it.
class Choice {
 public:
  void add(const Point* point, const std::string& why) {
    if (!point) return;
    const auto known = std::ranges::find(runs_, point, &ChosenRun::point);
    if (known == runs_.end()) {
      runs_.push_back({point, why});
    } else if (!why.empty()) {
      known->why += (known->why.empty() ? "" : ", ") + why;
    }
  }
  std::vector<ChosenRun> take() { return std::move(runs_); }

 private:
  std::vector<ChosenRun> runs_;
};

bool is_shown(const Point& point) { return point.outcome != Outcome::over_budget; }
bool is_good(const Point& point) { return point.outcome == Outcome::reached_end; }

// "1e-4", as pictures write it.
std::string in_words(double accuracy) { return fmt::format("1e{:.0f}", std::log10(accuracy)); }

// Adds the fastest runs of `which`; those that are the fastest of all are there already.
void add_fastest(Choice& choice, const std::vector<FrontRow>& front, const Point* FrontRow::*which,
                 const std::string& whose) {
  for (auto first = front.begin(); first != front.end();) {
    const Point* point = (*first).*which;
    const auto next =
        std::find_if(first, front.end(), [&](const FrontRow& row) { return row.*which != point; });
    const bool is_named = which != &FrontRow::fastest && point == first->fastest;
    if (point && !is_named) {
      const double coarse = first->accuracy, fine = std::prev(next)->accuracy;
      const std::string words = coarse == fine
                                    ? "at " + in_words(coarse)
                                    : "from " + in_words(coarse) + " to " + in_words(fine);
      choice.add(point, fmt::format("fastest{} {}", whose, words));
    }
    first = next;
  }
}

}  // namespace

std::vector<ChosenRun> chosen_runs(const std::vector<Point>& points,
                                   const std::vector<FrontRow>& front) {
  Choice choice;
  add_fastest(choice, front, &FrontRow::fastest, "");
  add_fastest(choice, front, &FrontRow::fastest_sundials, " of SUNDIALS");
  add_fastest(choice, front, &FrontRow::fastest_hand_written, " of the hand-written");
  for (auto first = points.begin(); first != points.end();) {
    const auto last = std::find_if(
        first, points.end(), [&](const Point& point) { return point.method != first->method; });
    const auto good = std::find_if(first, last, is_good);
    if (good != last) choice.add(&*good, "coarsest run");
    const auto bad = std::find_if(
        first, last, [](const Point& point) { return is_shown(point) && !is_good(point); });
    if (bad != last) choice.add(&*bad, std::string(name(bad->outcome)));
    first = last;
  }
  for (const Point& point : points) {
    if (is_shown(point)) choice.add(&point, "");
  }
  return choice.take();
}

}  // namespace qddot::motions

#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "qddot/scene/scene.hpp"

namespace qddot::reduce {

// Springs chosen from a list, with ends numbered anew. Laws are read from the list, which must
// outlive this: a million nodes have no room for a second one.
class PartSprings {
 public:
  struct One {
    std::array<int, 2> nodes;
    const SpringLaw& law;
    Holds holds;
    bool stiff;
  };

  PartSprings() = default;
  // Spring e is `all[chosen[e]]` between the nodes ends[e].
  PartSprings(const std::vector<Spring>& all, std::vector<int> chosen,
              std::vector<std::array<int, 2>> ends)
      : all_(&all), chosen_(std::move(chosen)), ends_(std::move(ends)) {}

  // Gives the ends other numbers: number(node) for each.
  template <class Number>
  void renumber(const Number& number) {
    for (auto& [a, b] : ends_) {
      a = number(a);
      b = number(b);
    }
  }

  int size() const { return static_cast<int>(ends_.size()); }
  const std::array<int, 2>& ends(int e) const { return ends_[static_cast<std::size_t>(e)]; }
  const SpringLaw& law(int e) const { return drawn(e).law; }
  // The number of spring e in the list.
  int number(int e) const { return chosen_[static_cast<std::size_t>(e)]; }
  // Whether one of them may break, go slack, or has a cubic term.
  bool have_general() const {
    return std::ranges::any_of(
        chosen_, [&](int e) { return (*all_)[static_cast<std::size_t>(e)].law.is_general(); });
  }
  // Whether one of them is a rod.
  bool have_rods() const {
    return std::ranges::any_of(
        chosen_, [&](int e) { return (*all_)[static_cast<std::size_t>(e)].law.rigid; });
  }
  // Begins to load a law that is read some time later. Springs are read out of order by mirrors,
  // and most of the time would go into waiting for memory.
  void prefetch(int e) const { __builtin_prefetch(&drawn(e).law); }
  One operator[](int e) const {
    const Spring& spring = drawn(e);
    return {ends(e), spring.law, spring.holds, spring.stiff};
  }

 private:
  const Spring& drawn(int e) const {
    return (*all_)[static_cast<std::size_t>(chosen_[static_cast<std::size_t>(e)])];
  }

  const std::vector<Spring>* all_ = nullptr;
  std::vector<int> chosen_;
  std::vector<std::array<int, 2>> ends_;
};

}  // namespace qddot::reduce

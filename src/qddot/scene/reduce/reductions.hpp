#pragma once

#include <array>
#include <bitset>
#include <initializer_list>
#include <string>
#include <string_view>

namespace qddot {

// Reductions of a scene that do not change its motion; the last two not by more than asked for.
enum class Reduction {
  pins,                // pinned nodes are no unknowns
  duplicates,          // springs between the same nodes are one, springs of no stiffness none
  massless,            // springs in series through massless nodes are one
  free_flight,         // nodes on no spring move in closed form
  parts,               // each part is integrated by itself
  dimension,           // a motion in a plane or on a line has two coordinates or one
  mirror,              // one half is enough of a motion that is its own mirror image
  constant_stiffness,  // K is the same everywhere, and is factorised once
  falling,             // a part to which nothing is pinned falls in closed form
  rods,                // stiff springs are rods; only of answers to an accuracy (solve_with_rods)
  linear,              // small motions are sums of modes; likewise (solve_linear)
};

// The names of the reductions, in the order of Reduction.
inline constexpr std::array<std::string_view, 11> reduction_names = {
    "pins",   "duplicates",         "massless", "free_flight", "parts", "dimension",
    "mirror", "constant_stiffness", "falling",  "rods",        "linear"};

constexpr std::string_view name(Reduction reduction) {
  return reduction_names[static_cast<std::size_t>(reduction)];
}

// A set of reductions; by default all of them.
class Reductions {
 public:
  // The chosen reductions alone.
  static Reductions only(std::initializer_list<Reduction> chosen) {
    Reductions few;
    few.left_out_.set();
    for (const Reduction reduction : chosen) few.left_out_.reset(index(reduction));
    return few;
  }
  // The reductions that keep every direction in which the free nodes may move. They are for statics
  // and small motions, which also ask about directions that the motion itself never takes.
  static Reductions all_directions() { return only({Reduction::pins, Reduction::duplicates}); }
  bool has(Reduction reduction) const { return !left_out_[index(reduction)]; }
  Reductions without(Reduction reduction) const {
    Reductions rest = *this;
    rest.left_out_.set(index(reduction));
    return rest;
  }

 private:
  static std::size_t index(Reduction reduction) { return static_cast<std::size_t>(reduction); }

  std::bitset<reduction_names.size()> left_out_;
};

// The effect of a reduction on a scene, and why it is exact: one sentence or two.
struct Finding {
  Reduction reduction;
  std::string what;
};

}  // namespace qddot

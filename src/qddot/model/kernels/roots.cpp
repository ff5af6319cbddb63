#include "qddot/model/kernels/roots.hpp"

#include <array>
#include <chrono>
#include <cstdlib>
#include <limits>
#include <string>

#include "qddot/model/kernels/level.hpp"

namespace qddot::kernels {
namespace {

constexpr std::array<std::string_view, kinds_of_roots> root_names = {"processor", "estimated_root",
                                                                     "estimated"};

// A row of nodes with springs to the next six. It is as small as the clock allows, because a
// process that steps a small scene for a moment has to win its time back.
class Sample {
 public:
  Sample() {
    slices_ =
        slice_neighbours(neighbours_of(nodes,
                                       [](const auto& see) {
                                         for (int i = 0; i < nodes; ++i) {
                                           for (int j = std::max(0, i - reach);
                                                j < std::min(nodes, i + reach + 1); ++j) {
                                             if (j != i)
                                               see(i, j, {.stiffness = 100, .rest_length = 0.9});
                                           }
                                         }
                                       }),
                         0);
    for (int& place : slices_.gathers) place *= point_stride<3>;
    for (int i = 0; i < 3 * slices_.rows(); ++i) unknowns_.push_back(i);
    for (int slice = 0; slice < slices_.count(); ++slice) {
      slice_unknowns_.push_back({Order::by_slice, 3 * slice * slice_rows});
    }
    q_ = Vec::LinSpaced(std::ssize(unknowns_), 0, 100);
    x_ = Vec::Zero(std::ssize(unknowns_) + 4 * slices_.rows());
    offset_ = f_ = Vec::Zero(std::ssize(unknowns_));
  }

  // The time of some evaluations of the forces [s].
  double time(const SpringKernels& kernels) {
    using Clock = std::chrono::steady_clock;
    const SpringTable springs{.slices = slices_.slices.data(),
                              .shifts = slices_.shifts.data(),
                              .gathers = slices_.gathers.data(),
                              .rings = nullptr,
                              .slot_laws = slices_.slot_laws.data(),
                              .laws = slices_.laws.data(),
                              .law_vectors = slices_.law_vectors,
                              .unknowns = unknowns_.data(),
                              .slice_unknowns = slice_unknowns_.data(),
                              .gathered = slices_.gathered.data()};
    const Positions positions{x_.data(), slices_.rows(), x_.data() + 3 * slices_.rows()};
    const auto start = Clock::now();
    kernels.place(springs, q_.data(), positions, 0, slices_.count());
    for (int i = 0; i < evaluations; ++i)
      kernels.force(springs, positions, nullptr, false, {offset_.data(), nullptr}, f_.data(), 0,
                    slices_.count());
    return std::chrono::duration<double>(Clock::now() - start).count();
  }

 private:
  static constexpr int nodes = 4 * slice_rows, reach = 6, evaluations = 2;

  NeighbourSlices slices_;
  std::vector<int> unknowns_;
  std::vector<SliceUnknowns> slice_unknowns_;
  Vec q_, x_, offset_, f_;
};

// The fastest kind of roots. The kinds are timed in turn and the least time of each counts, since
// other work of the processor lengthens some passes.
Roots fastest() {
  // The least ratio of times that counts as faster; smaller gains may be other programs' work.
  constexpr double worth = 0.85;
  constexpr int turns = 30;  // of one or two microseconds each
  if (!spring_kernels(3, Roots::estimated_root)) return Roots::processor;
  Sample sample;
  std::array<double, kinds_of_roots> least;
  least.fill(std::numeric_limits<double>::infinity());
  for (int turn = 0; turn < turns; ++turn) {
    for (int i = 0; i < kinds_of_roots; ++i) {
      const SpringKernels* kernels = spring_kernels(3, static_cast<Roots>(i));
      if (kernels) least[i] = std::min(least[i], sample.time(*kernels));
    }
  }
  const auto found = std::ranges::min_element(least);
  if (*found > worth * least[static_cast<int>(Roots::processor)]) return Roots::processor;
  return static_cast<Roots>(found - least.begin());
}

Roots chosen_roots() {
  const char* wanted = std::getenv("QDDOT_ROOTS");
  if (!wanted) return fastest();
  const auto found = std::ranges::find(root_names, wanted);
  const auto roots = static_cast<Roots>(found - root_names.begin());
  if (found != root_names.end() && spring_kernels(3, roots)) return roots;
  std::string allowed;
  for (int i = 0; i < kinds_of_roots; ++i) {
    if (!spring_kernels(3, static_cast<Roots>(i))) continue;
    allowed += (allowed.empty() ? "" : ", ") + std::string(root_names[i]);
  }
  throw NoSuchKernels("QDDOT_ROOTS=" + std::string(wanted) +
                      ": this processor has no such roots; allowed are " + allowed);
}

// Stiffnesses between 1/extreme and extreme can be estimated: with lengths in [2^-128, 2^128), the
// tension is 0 or in [2^-800, 2^800].
constexpr double extreme = 0x1p200;

bool is_moderate(double stiffness) {
  return stiffness == 0 || (stiffness >= 1 / extreme && stiffness <= extreme);
}

}  // namespace

Roots roots() {
  static const Roots roots = chosen_roots();
  return roots;
}

std::span<const std::string_view> names_of_roots() { return root_names; }

bool can_be_estimated(const NeighbourSlices& slices) {
  if (slices.law_vectors == 1) return true;
  for (const SlotLaw& law : slices.slot_laws) {
    for (int t = 0; t < slice_rows; ++t) {
      const double* numbers = slices.laws.data() + t;
      const double stiffness = numbers[law.stiffness], rest_length = numbers[law.rest_length],
                   quartic = slices.law_vectors > 2 ? numbers[law.quartic] : 0;
      // A rest length without stiffness gives a tension of minus zero.
      const bool is_spring = stiffness > 0 || quartic > 0 || rest_length == 0;
      if (!is_spring || !is_moderate(stiffness) || !is_moderate(quartic) || rest_length > extreme) {
        return false;
      }
    }
  }
  return true;
}

}  // namespace qddot::kernels

#include "qddot/measure/advice/own_frequencies.hpp"

#include <algorithm>
#include <cmath>

#include "qddot/integrators/registry.hpp"
#include "qddot/model/machine_epsilon.hpp"

namespace qddot::inline measure {
namespace {

constexpr int burst_steps = OwnFrequencies::forces_a_burst;
constexpr double burst_h_omega = 0.5;

// Positions at the start and after each step of a burst; fewer if the burst failed.
std::vector<Vec> burst(const Model& model, const State& from, double h) {
  const auto integrator = make_integrator(*find_method("verlet"), model.system(), {.step_size = h});
  State state{0, from.q, from.v};
  std::vector<Vec> q{state.q};
  Observer each{{}, [&](const State& seen) { q.push_back(seen.q); }};
  for (int i = 1; i <= burst_steps; ++i) each.times.push_back(i * h);
  integrator->advance(state, each.times.back(), each);
  return q;
}

using Squares = std::array<double, OwnFrequencies::highest_order + 2>;

// The largest k-th differences at the start of a burst, k = 1, 2, ... Some unknowns at a time pass
// the caches once.
Squares largest_differences(const std::vector<Vec>& q) {
  constexpr Index some = 64;
  Eigen::Array<double, some, burst_steps + 1> d;
  Squares most{};
  for (Index first = 0; first < q[0].size(); first += some) {
    const Index count = std::min(some, q[0].size() - first);
    for (Index j = 0; j <= burst_steps; ++j)
      d.col(j).head(count) = q[static_cast<std::size_t>(j)].segment(first, count);
    for (std::size_t k = 1; k < most.size(); ++k) {
      for (Index j = 0; j + static_cast<Index>(k) <= burst_steps; ++j)
        d.col(j).head(count) = d.col(j + 1).head(count) - d.col(j).head(count);
      most[k] = std::max(most[k], d.col(0).head(count).abs().maxCoeff());
    }
  }
  return most;
}

// Adds the squares of the k-th differences of bursts along the path. Returns the number of bursts
// that reached their end.
int add_bursts(const Model& model, const std::vector<State>& path, double h, int bursts,
               Squares& squares) {
  int taken = 0;
  for (int i = 0; i < bursts; ++i) {
    const auto place = static_cast<std::size_t>(i) * path.size() / static_cast<std::size_t>(bursts);
    const std::vector<Vec> q = burst(model, place == 0 ? model.initial() : path[place - 1], h);
    if (q.size() < burst_steps + 1) continue;
    ++taken;
    const Squares most = largest_differences(q);
    for (std::size_t k = 1; k < squares.size(); ++k) squares[k] += most[k] * most[k];
  }
  return taken;
}

// Rounding gives k-th differences a variance of C(2k, k) times the variance of the positions.
// Squares that are no larger than that are replaced by an extrapolation from the orders below.
void leave_out_rounding(Squares& squares, double largest_q) {
  constexpr double largest_of_many = 4;  // standard deviations: the largest of many normal numbers
  const double rounding = largest_of_many * machine_epsilon * largest_q;
  double binomial = 2;
  for (std::size_t k = 2; k < squares.size(); ++k) {
    const double order = static_cast<double>(k);
    binomial *= 2 * (2 * order - 1) / order;
    if (k < 4 || squares[k] > binomial * rounding * rounding) continue;
    // The difference of order k - 1 may contain rounding too, so that the smaller of two ratios is
    // used.
    squares[k] =
        squares[k - 1] * std::min(squares[k - 1] / squares[k - 2], squares[k - 2] / squares[k - 3]);
  }
}

}  // namespace

double OwnFrequencies::at(int order) const {
  const int even = order + order % 2;
  return of_order[static_cast<std::size_t>(std::clamp(even, 1, highest_order))];
}

OwnFrequencies own_frequencies(const Model& model, const std::vector<State>& path, double w_max,
                               int bursts) {
  // A burst fails if forces change little at the start of a motion but much later. It is then
  // repeated with shorter steps.
  constexpr int most_attempts = 8;
  constexpr double shorter = 4;
  Squares squares{};  // of the k-th differences
  double h = burst_h_omega / w_max;
  int taken = 0;
  for (int attempt = 0; attempt < most_attempts && taken == 0; ++attempt) {
    if (attempt > 0) h /= shorter;
    taken = add_bursts(model, path, h, bursts, squares);
  }
  const Vec& start = model.initial().q;
  double farthest = 0;
  for (const State& state : path)
    farthest = std::max(farthest, (state.q - start).lpNorm<Eigen::Infinity>());
  OwnFrequencies own;
  if (taken == 0 || farthest == 0 || squares[1] == 0) return own;
  for (double& square : squares) square /= taken;
  leave_out_rounding(squares, std::max(start.lpNorm<Eigen::Infinity>(), farthest));
  own.speed = std::sqrt(squares[1]) / h / farthest;
  for (std::size_t p = 1; p < own.of_order.size(); ++p)
    own.of_order[p] = std::pow(squares[p + 1] / squares[1], 0.5 / static_cast<double>(p)) / h;
  return own;
}

}  // namespace qddot::inline measure

#include "experiments/bench/same_steps.hpp"

#include <algorithm>
#include <cmath>

#include "experiments/bench/peers.hpp"
#include "qddot/analysis/largest_frequency.hpp"

namespace qddot::bench {
namespace {

std::int64_t springs_of(const Scene& scene) {
  return std::ranges::count_if(scene.springs,
                               [&](const Spring& spring) { return has_free_end(scene, spring); });
}

double largest_distance(const State& a, const State& b, int dimension) {
  const Vec d = a.q - b.q;
  return d.reshaped(dimension, d.size() / dimension).colwise().norm().maxCoeff();
}

}  // namespace

SameSteps same_steps(Peer& peer, bool smallest, const Problem& problem, int repeats, double limit) {
  const auto ours = our_method(peer.twin(), smallest);
  SameSteps same{.solver = peer.name(), .method = ours->name(), .is_smallest = smallest};
  same.unknowns = (smallest ? problem.smallest : problem.scene).system().size();
  same.springs = springs_of(problem.start);
  const double w = frequency_bound(problem.scene.system(), problem.scene.initial().q);
  same.steps = static_cast<std::int64_t>(std::ceil(std::max(1.0, 2 * w * problem.until)));
  same.step_size = problem.until / static_cast<double>(same.steps);
  for (int i = 0; i < repeats; ++i) {
    const Run theirs = peer.run(problem, peer.forces().front(), same.step_size, limit);
    const Run own = ours->run(problem, ForceKind::ours, same.step_size, limit);
    same.peer_outcome = theirs.outcome;
    same.outcome = own.outcome;
    if (!same.is_good()) return same;
    const auto steps = static_cast<double>(same.steps);
    const double their_step = theirs.seconds / steps, step = own.seconds / steps;
    same.peer_step = i == 0 ? their_step : std::min(same.peer_step, their_step);
    same.step = i == 0 ? step : std::min(same.step, step);
    same.distance = largest_distance(theirs.end, own.end, problem.start.dimension);
    same.difference =
        errors_between(problem.scene, theirs.end, own.end, problem.own.energy, problem.own.scales)
            .position;
  }
  return same;
}

}  // namespace qddot::bench

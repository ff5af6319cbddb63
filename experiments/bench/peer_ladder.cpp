#include "experiments/bench/peer_ladder.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "qddot/analysis/largest_frequency.hpp"
#include "qddot/measure/motion/timing.hpp"
#include "qddot/measure/speed/ladder.hpp"

namespace qddot::bench {
namespace {

// A run of so many seconds is long enough to be timed once.
constexpr double long_enough = 1;
// So many points without a smaller error end a ladder, once one was this good.
constexpr int most_idle = 3;
constexpr double converging = 0.1;

// Once untimed where it is short, then up to `repeats` times in all of `long_enough`.
Run timed(Peer& peer, ForceKind force, const Problem& problem, double value, const Pace& pace) {
  Run run = peer.run(problem, force, value, pace.limit);
  // Others kept the processor busy.
  if (run.outcome == Outcome::over_budget && run.seconds < pace.limit / 2) {
    run = peer.run(problem, force, value, pace.limit);
  }
  if (run.outcome != Outcome::reached_end || run.timed > 1) return run;
  std::vector<double> seconds{run.seconds};
  double spent = run.seconds;
  while (std::ssize(seconds) < pace.repeats && spent < long_enough) {
    Run again = peer.run(problem, force, value, pace.limit);
    if (again.outcome != Outcome::reached_end) return again;
    seconds.push_back(again.seconds);
    spent += again.seconds;
  }
  run.seconds = median(seconds);
  run.timed = static_cast<int>(seconds.size());
  return run;
}

// One point.
Measured measured(Peer& peer, ForceKind force, const Problem& problem, double value,
                  const Pace& pace) {
  const Run run = timed(peer, force, problem, value, pace);
  Measured point{.solver = peer.name(),
                 .force = force_name(force),
                 .unknowns = problem.scene.system().size(),
                 .knob = peer.knob(),
                 .value = value,
                 .outcome = run.outcome,
                 .seconds = run.seconds,
                 .steps = run.steps,
                 .force_evaluations = run.force_evaluations};
  if (point.is_good()) {
    point.error = problem.error(run.end);
    point.timed = run.timed;
  }
  return point;
}

// The points of a ladder of step sizes, down to the first that is good enough or over budget.
std::vector<Rung> rungs(const std::vector<Measured>& points, double until, double finest_error) {
  std::vector<Rung> ladder;
  for (const Measured& point : points) {
    if (point.outcome == Outcome::over_budget) break;
    ladder.push_back({std::round(until / point.value),
                      point.is_good() ? point.error : std::numeric_limits<double>::infinity()});
    if (ladder.back().error <= finest_error) break;
  }
  return ladder;
}

std::int64_t springs_of(const Scene& scene) {
  return std::ranges::count_if(scene.springs,
                               [&](const Spring& spring) { return has_free_end(scene, spring); });
}

double largest_distance(const State& a, const State& b, int dimension) {
  const Vec d = a.q - b.q;
  return d.reshaped(dimension, d.size() / dimension).colwise().norm().maxCoeff();
}

}  // namespace

PeerLadder measure_ladder(Peer& peer, ForceKind force, const Problem& problem, const Pace& pace,
                          const Recall& recall) {
  PeerLadder all{.is_stock_implicit = peer.is_stock_implicit()};
  double best = std::numeric_limits<double>::infinity();
  int idle = 0;
  const auto take = [&](double value) {
    const std::string name = fmt::format("{} {} {:.17g}", peer.name(), force_name(force), value);
    return recall(name, [&] { return measured(peer, force, problem, value, pace); });
  };
  for (const double value : peer.values(problem)) {
    const Measured point = take(value);
    if (point.is_good()) {
      idle = point.error > 0.8 * best ? idle + 1 : 0;
      best = std::min(best, point.error);
    }
    all.points.push_back(point);
    const bool is_idle = idle >= most_idle && best < converging;
    if (point.outcome == Outcome::over_budget || best <= pace.finest_error || is_idle) break;
  }

  if (peer.knob() != Knob::step_size) return all;
  while (const auto steps = lacking_rung(rungs(all.points, problem.until, pace.finest_error))) {
    const Measured point = take(problem.until / *steps);
    const auto finer = std::ranges::find_if(
        all.points, [&](const Measured& other) { return other.value < point.value; });
    all.points.insert(finer, point);
    if (point.outcome == Outcome::over_budget) break;  // though a finer one was not
  }
  return all;
}

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

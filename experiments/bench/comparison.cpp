#include "experiments/bench/comparison.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "experiments/kit/program.hpp"
#include "qddot/scene/invalid_input.hpp"
#include "qddot/scene/settle.hpp"

namespace qddot::bench {
namespace {

double until_of(const std::string& word, const Scene& drawn) {
  const auto at = word.rfind('@');
  if (at == word.npos) return end_time(0, false, drawn);
  double until = 0;
  const char *first = word.data() + at + 1, *last = word.data() + word.size();
  if (const auto [end, error] = std::from_chars(first, last, until);
      error != std::errc() || end != last) {
    throw InvalidInput(fmt::format("{}: after @ comes the time to run to in s, a number", word));
  }
  return end_time(until, true, drawn);
}

void add_own_ladders(const Problem& problem, const std::vector<std::string>& methods, bool smallest,
                     Pace pace, const Recall& recall, std::vector<PeerLadder>& ladders) {
  pace.finest_error = accuracies.back() / 30;  // a peer's run may be better than it need be
  for (const std::string& method : methods) {
    const auto solver = our_method(method, smallest);
    ladders.push_back(measure_ladder(*solver, ForceKind::ours, problem, pace, recall));
    progress().finish(method + " is done");
    PeerLadder& last = ladders.back();
    last.is_ours = true;
    last.is_smallest = smallest;
    for (Measured& point : last.points) {
      if (smallest) point.unknowns = problem.smallest.system().size();
      // A run that takes several times as long as the most accurate one is nowhere the fastest.
      if (point.is_good() && point.error <= pace.finest_error)
        pace.limit = std::min(pace.limit, 4 * point.seconds);
    }
  }
}

bool reaches(const Measured& point, double error) {
  return point.is_good() && point.error <= error;
}

// The fastest good point of at most that error, of the ladders that `counts`; nullptr if none.
const Measured* fastest(const std::vector<PeerLadder>& ladders, double error,
                        const std::function<bool(const PeerLadder&)>& counts) {
  const Measured* best = nullptr;
  for (const PeerLadder& ladder : ladders) {
    if (!counts(ladder)) continue;
    for (const Measured& point : ladder.points) {
      if (reaches(point, error) && (!best || point.seconds < best->seconds)) best = &point;
    }
  }
  return best;
}

// The time [s] that a ladder spent without reaching the accuracy before it was over budget;
// infinite if it was not over budget.
double spent_in_vain(const PeerLadder& ladder, double accuracy) {
  const bool was_cut = ladder.points.back().outcome == Outcome::over_budget;
  const auto is_there = [&](const Measured& point) { return reaches(point, accuracy); };
  return was_cut && std::ranges::none_of(ladder.points, is_there)
             ? ladder.points.back().seconds
             : std::numeric_limits<double>::infinity();
}

// The fastest of some peers, all with one f.
Ratio ratio_of(const std::vector<PeerLadder>& ladders, bool smallest, double accuracy,
               const std::function<bool(const PeerLadder&)>& theirs) {
  const auto ours = [&](const PeerLadder& l) { return l.is_ours && l.is_smallest == smallest; };
  double spent = std::numeric_limits<double>::infinity();
  for (const PeerLadder& ladder : ladders) {
    if (theirs(ladder)) spent = std::min(spent, spent_in_vain(ladder, accuracy));
  }
  Ratio ratio{};
  ratio.accuracy = accuracy;
  const Measured* best = fastest(ladders, accuracy, theirs);
  if (best && best->seconds <= spent) {
    ratio.theirs = best;
    ratio.ours = fastest(ladders, best->error, ours);
    if (ratio.ours) ratio.ratio = best->seconds / ratio.ours->seconds;
  } else if (std::isfinite(spent)) {
    ratio.is_bound = true;
    ratio.ours = fastest(ladders, accuracy, ours);
    if (ratio.ours) ratio.ratio = spent / ratio.ours->seconds;
  }
  return ratio;
}

}  // namespace

Comparison::Comparison(const std::string& word)
    : choice{.name = word.substr(0, word.rfind('@')), .no_reduce = {}},
      drawn(load(choice)),
      until(until_of(word, drawn)) {}

void Comparison::measure(const std::vector<std::string>& methods, const std::vector<Peer*>& peers,
                         const Pace& pace, Study& study, const std::string& folder,
                         const nlohmann::json& origin) {
  progress().stage("making the reference");
  const Problem problem(drawn, settled_if_asked(drawn, choice.name).value_or(drawn), until, folder,
                        origin);
  unknowns = problem.scene.system().size();
  fewest_unknowns = problem.smallest.system().size();
  const std::string prefix = fmt::format("{} {:.17g} ", content_hash(drawn), until);
  const auto recall = [&](const std::string& whose) -> Recall {
    return [&, whose](const std::string& name, const auto& take) {
      progress().now_at(name);
      return study.piece(prefix + whose + name, [&] { return nlohmann::json(take()); })
          .template get<Measured>();
    };
  };
  std::size_t forces = 0;
  for (const Peer* peer : peers) forces += peer->forces().size();
  progress().begin(2 * methods.size() + forces);
  add_own_ladders(problem, methods, true, pace, recall("reduced "), ladders);
  add_own_ladders(problem, methods, false, pace, recall("as drawn "), ladders);
  Pace theirs = pace;
  theirs.finest_error = accuracies.back();
  for (Peer* peer : peers) {
    for (const ForceKind force : peer->forces()) {
      ladders.push_back(measure_ladder(*peer, force, problem, theirs, recall("")));
      progress().finish(peer->name() + " is done");
    }
  }
  for (Peer* peer : peers) {
    if (peer->twin().empty()) continue;
    for (const bool smallest : {true, false}) {
      const std::string name = fmt::format("{} beside {}", peer->name(), peer->twin());
      progress().stage(name);
      same_steps.push_back(study.piece(fmt::format("{}{} {}", prefix, name, smallest), [&] {
        return nlohmann::json(
            qddot::bench::same_steps(*peer, smallest, problem, pace.repeats, pace.limit));
      }));
    }
  }
  is_complete = true;
}

std::vector<Ratio> ratios(const std::vector<PeerLadder>& ladders, bool smallest,
                          const std::vector<double>& wanted) {
  std::vector<Ratio> all;
  const auto add = [&](const std::string& peer, const std::string& force, const auto& theirs) {
    for (const double accuracy : wanted) {
      all.push_back(ratio_of(ladders, smallest, accuracy, theirs));
      all.back().peer = peer;
      all.back().force = force;
    }
  };
  for (const PeerLadder& ladder : ladders) {
    if (ladder.is_ours) continue;
    const Measured& any = ladder.points.front();
    add(any.solver, any.force, [&](const PeerLadder& l) { return &l == &ladder; });
  }
  for (const ForceKind kind : {ForceKind::plain, ForceKind::ours}) {
    const std::string force = force_name(kind);
    const auto is_theirs = [&](const PeerLadder& l) {
      return l.is_stock_implicit && l.points.front().force == force;
    };
    if (std::ranges::any_of(ladders, is_theirs)) add("best of KLU", force, is_theirs);
  }
  return all;
}

}  // namespace qddot::bench

#include "experiments/bench/comparison.hpp"

#include <algorithm>
#include <charconv>

#include <fmt/format.h>

#include "experiments/bench/peers.hpp"
#include "experiments/kit/program.hpp"
#include "experiments/kit/progress.hpp"
#include "qddot/scene/invalid_input.hpp"

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

}  // namespace

Comparison::Comparison(const std::string& word)
    : choice{.name = word.substr(0, word.rfind('@')), .no_reduce = {}},
      drawn(load(choice)),
      until(until_of(word, drawn)) {}

void Comparison::measure(const std::vector<std::string>& methods, const std::vector<Peer*>& peers,
                         const Pace& pace, Study& study, const std::string& folder,
                         const nlohmann::json& origin) {
  progress().stage("making the reference");
  const Problem problem(drawn, started(drawn, choice), until, folder, origin);
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

}  // namespace qddot::bench

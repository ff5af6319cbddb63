#include "qddot/integrators/parts.hpp"

#include <algorithm>
#include <utility>

#include "qddot/integrators/registry.hpp"

namespace qddot {

Parts::Parts(const Method& method, const System& system, const Options& options)
    : Integrator(method, system, options) {
  Index first = 0;
  for (const auto& block : blocks_of(system)) {
    parts_.push_back({first, make_integrator(method, *block, options), {}, {}, 1});
    first += block->size();
  }
}

void Parts::start(const State& state) {
  for (Part& part : parts_) {
    const Index n = part.integrator->system().size();
    part.state = {state.t, state.q.segment(part.first, n), state.v.segment(part.first, n)};
    part.integrator->counts_ = {};
    part.integrator->seconds_ = {};
    part.growth = 1;
    start(part);
  }
}

void Parts::start(Part& part) {
  part.integrator->join(*this);
  part.integrator->set_out(part.state);
}

Outcome Parts::run_to(State& state, double t_stop) {
  for (Part& part : parts_) part.begin = part.state;
  Outcome outcome = Outcome::reached_end;
  double t_end = t_stop;
  std::exception_ptr thrown;  // by the part that failed first
  const auto is_there = [&](const Part& part) { return part.state.t == t_end; };
  // Each failure gives an earlier end than the last; parts beyond it run to it again.
  while (!std::ranges::all_of(parts_, is_there)) {
    for (Part& part : parts_) {
      if (is_there(part)) continue;
      const Outcome own = run_part(part, t_end);
      if (own == Outcome::reached_end) continue;
      outcome = own;
      set_message(part.integrator->words_on(own));
      slack_at_ = part.integrator->slack_at_;
      failed_step_ = part.integrator->counts_.steps + 1;
      thrown = std::exchange(part.thrown, nullptr);
      t_end = part.state.t;
    }
  }
  gather(state);
  if (thrown) std::rethrow_exception(thrown);
  return outcome;
}

Outcome Parts::run_part(Part& part, double t_end) {
  Outcome outcome = Outcome::solver_failed;
  try {
    if (part.state.t != part.begin.t) {
      part.growth = std::max(part.growth, part.integrator->energy_change(part.state).growth);
      part.state = part.begin;
      start(part);
    }
    if (part.state.t == t_end) return Outcome::reached_end;
    outcome = part.integrator->run_to(part.state, t_end);
  } catch (const SolverFailure& error) {
    part.integrator->set_message(error.what());
  } catch (...) {  // rethrown when the others have come to the same time
    part.thrown = std::current_exception();
  }
  if (outcome == Outcome::reached_end) part.state.t = t_end;
  return outcome;
}

double Parts::reached() const {
  double sum = 0;
  for (const Part& part : parts_) sum += part.integrator->reached();
  return parts_.empty() ? 0 : sum / static_cast<double>(parts_.size());
}

EnergyChange Parts::energy_change(const State&) {
  EnergyChange all;
  for (Part& part : parts_) {
    const EnergyChange own = part.integrator->energy_change(part.state);
    all.growth = std::max({all.growth, part.growth, own.growth});
    all.lost += own.lost;
    all.own += own.own;
  }
  return all;
}

void Parts::gather(State& state) {
  counts() = {};
  seconds_ = {};
  for (const Part& part : parts_) {
    const Index n = part.state.q.size();
    state.q.segment(part.first, n) = part.state.q;
    state.v.segment(part.first, n) = part.state.v;
    counts() += part.integrator->counts_;
    seconds_ += part.integrator->seconds_;
  }
  state.t = parts_.front().state.t;
}

}  // namespace qddot

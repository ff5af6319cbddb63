#include "qddot/integrators/integrator.hpp"

#include <algorithm>
#include <cmath>
#include <new>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "qddot/integrators/massless_balance.hpp"
#include "qddot/integrators/method.hpp"
#include "qddot/integrators/misfit_words.hpp"

namespace qddot {
namespace {

// Below this, h^2 has lost digits.
constexpr double shortest_squared = 1e-290;

// Throws std::invalid_argument unless a run with these arguments is allowed. Numbers that are not
// finite make the run fail instead.
void check_arguments(const System& system, const State& state, double t_end,
                     const Observer& observer) {
  const auto check_size = [&](const char* which, const Vec& x) {
    if (x.size() == system.size()) return;
    throw std::invalid_argument(
        fmt::format("advance: {} has {} entries, and the system has {} unknowns", which, x.size(),
                    system.size()));
  };
  check_size("q", state.q);
  check_size("v", state.v);
  if (std::isfinite(t_end) && t_end < state.t) {
    throw std::invalid_argument(
        fmt::format("advance: the end t = {:g} s is before the start t = {:g} s", t_end, state.t));
  }
  if (!std::isfinite(state.t) || !std::isfinite(t_end)) return;
  double last = state.t;
  for (const double t : observer.times) {
    if (t >= last && t <= t_end) {
      last = t;
      continue;
    }
    throw std::invalid_argument(
        fmt::format("advance: the observer's time {:g} s is not allowed; its times ascend from "
                    "{:g} s to {:g} s",
                    t, state.t, t_end));
  }
  if (!observer.times.empty() && !observer.see)
    throw std::invalid_argument("advance: the observer has times, but no function to call");
}

}  // namespace

Integrator::Integrator(const Method& method, const System& system, const Options& options)
    : method_(method), system_(system) {
  if (applies_to(method, system)) add_parts(system, 0, 0, options);
}

void Integrator::add_parts(const System& system, Index first, Index first_phase,
                           const Options& options) {
  if (system.size() == 0) return;
  if (system.blocks().empty()) {
    parts_.push_back({first, first_phase, std::make_unique<SystemRun>(method_, system, options)});
    return;
  }
  for (const auto& block : system.blocks()) {
    add_parts(*block, first, first_phase, options);
    first += block->size();
    if (block->switching()) first_phase += block->switching()->phase_count();
  }
}

State Integrator::state_of(const Part& part, const State& whole) const {
  const Index n = part.run->system().size();
  State own{whole.t, whole.q.segment(part.first, n), whole.v.segment(part.first, n)};
  if (const Switching* switching = part.run->system().switching(); switching && whole.phases) {
    const auto begin = whole.phases->begin() + part.first_phase;
    own.phases =
        std::make_shared<const std::vector<Phase>>(begin, begin + switching->phase_count());
  }
  return own;
}

Summary Integrator::advance(State& state, double t_end, const Observer& observer,
                            std::stop_token stop) {
  message_.clear();
  failed_step_ = 0;
  has_begun_ = false;
  Outcome outcome = Outcome::reached_end;
  check_arguments(system_, state, t_end, observer);
  try {
    outcome = run(state, t_end, observer, std::move(stop));
  } catch (const std::bad_alloc&) {
    outcome = Outcome::solver_failed;
    message_ =
        "memory ran out: take a scene of fewer nodes, or a method or solver that factorises "
        "nothing (verlet; conjugate gradients)";
  } catch (const SolverFailure& error) {
    outcome = Outcome::solver_failed;
    message_ = error.what();
  }
  Summary summary;
  summary.outcome = outcome;
  summary.t_reached = state.t;
  summary.message.clear();
  if (has_begun_) {
    for (const Part& part : parts_) {
      summary.counts += part.run->counts();
      summary.seconds += part.run->seconds();
    }
    const EnergyChange energy = energy_change(state);
    summary.energy_growth = energy.growth;
    summary.energy_lost = energy.lost;
    summary.energy_loss = energy.loss();
    summary.work = state.work - work_;
    for (const Part& part : parts_) {
      for (Break broken : part.run->breaks()) {
        broken.number += part.first_phase;
        summary.breaks.push_back(broken);
      }
      summary.phase_changes += part.run->phase_changes();
    }
    std::ranges::stable_sort(summary.breaks, {}, &Break::t);
  }
  if (outcome == Outcome::reached_end) return summary;
  const bool says_part = message_.empty() && has_begun_ && is_whole();
  summary.message = says_part          ? parts_.front().run->words_on(outcome)
                    : message_.empty() ? std::string(advice(outcome))
                                       : message_;
  summary.failed_step = failed_step_ > 0 ? failed_step_ : summary.counts.steps + 1;
  return summary;
}

Outcome Integrator::run(State& state, double t_end, const Observer& observer,
                        std::stop_token stop) {
  if (!std::isfinite(state.t) || !state.q.allFinite() || !state.v.allFinite() ||
      !std::isfinite(t_end)) {
    message_ = "the start is not finite";
    return Outcome::not_finite;
  }
  if (system_.has_massless() && !method_.is(Trait::accepts_massless)) return Outcome::singular_mass;
  if (!method_.is(Trait::accepts_massless_dashpots) && has_massless_dashpots(system_, state.q)) {
    message_ =
        "a massless node beside a dashpot has a velocity of first order: give it a mass, or take "
        "implicit_euler, semi_implicit_euler or bdf2";
    return Outcome::singular_mass;
  }
  if (const auto why = misfit(method_, system_)) {
    message_ = misfit_words(method_, *why);
    return *why;
  }
  if (const double whole = t_end - state.t; whole > 0 && !(whole * whole > shortest_squared)) {
    message_ = fmt::format(
        "the {:g} s to run are too short for their square to be a number: ask for a later end",
        whole);
    return Outcome::step_too_small;
  }

  const bool moves = system_.size() > 0 && t_end > state.t;
  const auto go_to = [&](double t) {
    const Outcome outcome = moves && t > state.t ? run_to(state, t) : Outcome::reached_end;
    if (outcome == Outcome::reached_end) state.t = t;
    return outcome;
  };
  const std::vector<double> corners =
      moves ? corners_between(state.t, t_end) : std::vector<double>();
  if (moves) {
    has_begun_ = true;
    work_ = state.work;
    for (Part& part : parts_) {
      part.run->clear(t_end, stop, is_whole() ? observer.step : nullptr);
      part.growth = 1;
      if (!corners.empty()) part.run->stay_before(state.t, corners.front());
    }
    for (Part& part : parts_) {
      if (!is_whole()) {
        part.state = state_of(part, state);
      }
      part.run->begin(is_whole() ? state : part.state);
    }
  }
  // Steps end on corners, where the method begins anew.
  auto corner = corners.begin();
  const auto go_by_corners = [&](double t) {
    for (; corner != corners.end() && *corner <= t; ++corner) {
      if (const Outcome outcome = go_to(*corner); outcome != Outcome::reached_end) return outcome;
      const auto next = corner + 1;
      for (Part& part : parts_) {
        part.run->begin_anew(is_whole() ? state : part.state,
                             next == corners.end() ? t_end : *next);
      }
    }
    return go_to(t);
  };
  for (const double t : observer.times) {
    if (const Outcome outcome = go_by_corners(t); outcome != Outcome::reached_end) return outcome;
    observer.see(state);
  }
  return go_by_corners(t_end);
}

// A jump in the derivative k of f changes a step across it by h^(k+1) and less.
std::vector<double> Integrator::corners_between(double t, double t_end) const {
  std::vector<double> times;
  const Driving* driving = system_.driving();
  if (!driving) return times;
  for (const Corner& corner : driving->corners()) {
    const bool counts = method_.order == 0 || method_.order > corner.order + 1;
    const bool is_new = times.empty() || corner.t > times.back();
    if (counts && is_new && corner.t > t && corner.t < t_end) times.push_back(corner.t);
  }
  return times;
}

Outcome Integrator::run_to(State& state, double t_stop) {
  return is_whole() ? parts_.front().run->run_to(state, t_stop) : run_parts_to(state, t_stop);
}

Outcome Integrator::run_parts_to(State& state, double t_stop) {
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
      message_ = part.run->words_on(own);
      failed_step_ = part.run->counts().steps + 1;
      thrown = std::exchange(part.thrown, nullptr);
      t_end = part.state.t;
    }
  }
  gather(state);
  if (thrown) std::rethrow_exception(thrown);
  return outcome;
}

Outcome Integrator::run_part(Part& part, double t_end) {
  Outcome outcome = Outcome::solver_failed;
  try {
    if (part.state.t != part.begin.t) {
      part.growth = std::max(part.growth, part.run->energy_change(part.state).growth);
      part.state = part.begin;
      part.run->begin(part.state);
    }
    if (part.state.t == t_end) return Outcome::reached_end;
    outcome = part.run->run_to(part.state, t_end);
  } catch (const SolverFailure& error) {
    part.run->set_message(error.what());
  } catch (...) {  // rethrown when the others have come to the same time
    part.thrown = std::current_exception();
  }
  if (outcome == Outcome::reached_end) part.state.t = t_end;
  return outcome;
}

double Integrator::reached() const {
  double sum = 0;
  for (const Part& part : parts_) sum += part.run->reached();
  return parts_.empty() ? 0 : sum / static_cast<double>(parts_.size());
}

EnergyChange Integrator::energy_change(const State& state) {
  EnergyChange all;
  for (Part& part : parts_) {
    const EnergyChange own = part.run->energy_change(is_whole() ? state : part.state);
    all.growth = std::max({all.growth, part.growth, own.growth});
    all.lost += own.lost;
    all.own += own.own;
  }
  return all;
}

void Integrator::gather_phases(State& state) const {
  state.phases.reset();
  if (std::ranges::none_of(parts_, [](const Part& part) { return bool(part.state.phases); }))
    return;
  std::vector<Phase> phases(static_cast<std::size_t>(system_.switching()->phase_count()),
                            Phase::by_length);
  for (const Part& part : parts_) {
    if (part.state.phases) {
      std::ranges::copy(*part.state.phases, phases.begin() + part.first_phase);
    }
  }
  state.phases = std::make_shared<const std::vector<Phase>>(std::move(phases));
}

void Integrator::gather(State& state) const {
  state.work = work_;
  for (const Part& part : parts_) {
    const Index n = part.state.q.size();
    state.q.segment(part.first, n) = part.state.q;
    state.v.segment(part.first, n) = part.state.v;
    state.work += part.state.work;
  }
  gather_phases(state);
  state.t = parts_.front().state.t;
}

}  // namespace qddot

#include "integrators/parts.hpp"

#include <algorithm>
#include <ranges>

#include "integrators/registry.hpp"

namespace qddot {

Parts::Parts(const Method& method, const System& system, const Knobs& knobs)
    : Integrator(method, system, knobs) {
  Index first = 0;
  for (const auto& part : system.parts()) {
    pieces_.push_back({first, make_integrator(method, *part, knobs), {}, {}});
    first += part->size();
  }
}

void Parts::start(const State& state) {
  for (Piece& piece : pieces_) {
    const Index n = piece.integrator->system().size();
    piece.state = {state.t, state.q.segment(piece.first, n), state.v.segment(piece.first, n)};
    piece.integrator->counts_ = {};
    start(piece);
  }
}

void Parts::start(Piece& piece) {
  piece.integrator->message_.clear();
  piece.integrator->stop_ = stop_;
  piece.integrator->start(piece.state);
}

Outcome Parts::run_to(State& state, double t_stop) {
  for (Piece& piece : pieces_) piece.begin = piece.state;
  const Outcome outcome = run_all(t_stop);
  if (outcome != Outcome::reached_end) step_back();
  gather(state);
  return outcome;
}

Outcome Parts::run_all(double t_stop) {
  for (Piece& piece : pieces_) {
    Outcome outcome = Outcome::solver_failed;
    try {
      outcome = piece.integrator->run_to(piece.state, t_stop);
    } catch (const std::exception& error) {
      piece.integrator->explain(error.what());
    }
    if (outcome != Outcome::reached_end) {
      explain(piece.integrator->message_);
      return outcome;
    }
    piece.state.t = t_stop;
  }
  return Outcome::reached_end;
}

void Parts::step_back() {
  const auto time = [](const Piece& piece) { return piece.state.t; };
  const double begin = pieces_.front().begin.t;
  // A piece may fail earlier on the way to a new end, but each time it is an earlier one.
  for (double t = std::ranges::min(pieces_ | std::views::transform(time)); t >= begin;) {
    for (Piece& piece : pieces_) {
      if (piece.state.t == t) continue;
      piece.state = piece.begin;
      if (t == begin) continue;
      start(piece);
      if (piece.integrator->run_to(piece.state, t) == Outcome::reached_end) piece.state.t = t;
    }
    const double least = std::ranges::min(pieces_ | std::views::transform(time));
    if (least == t) return;
    t = least;
  }
}

void Parts::gather(State& state) {
  Counts& sum = counts();
  sum = {};
  for (const Piece& piece : pieces_) {
    const Index n = piece.state.q.size();
    state.q.segment(piece.first, n) = piece.state.q;
    state.v.segment(piece.first, n) = piece.state.v;
    const Counts& own = piece.integrator->counts_;
    sum.steps += own.steps;
    sum.rejected += own.rejected;
    sum.force_evaluations += own.force_evaluations;
    sum.stiffness_evaluations += own.stiffness_evaluations;
    sum.factorizations += own.factorizations;
    sum.solves += own.solves;
    sum.newton_iterations += own.newton_iterations;
  }
  state.t = pieces_.front().state.t;
}

}  // namespace qddot

#include "qddot/integrators/parts.hpp"

#include <algorithm>
#include <utility>

#include "qddot/integrators/registry.hpp"

namespace qddot {

Parts::Parts(const Method& method, const System& system, const Options& options)
    : Integrator(method, system, options) {
  Index first = 0;
  for (const auto& block : blocks_of(system)) {
    pieces_.push_back({first, make_integrator(method, *block, options), {}, {}, 1});
    first += block->size();
  }
}

void Parts::start(const State& state) {
  for (Piece& piece : pieces_) {
    const Index n = piece.integrator->system().size();
    piece.state = {state.t, state.q.segment(piece.first, n), state.v.segment(piece.first, n)};
    piece.integrator->counts_ = {};
    piece.integrator->seconds_ = {};
    piece.growth = 1;
    start(piece);
  }
}

void Parts::start(Piece& piece) {
  piece.integrator->join(*this);
  piece.integrator->set_out(piece.state);
}

Outcome Parts::run_to(State& state, double t_stop) {
  for (Piece& piece : pieces_) piece.begin = piece.state;
  Outcome outcome = Outcome::reached_end;
  double t_end = t_stop;
  std::exception_ptr thrown;  // by the piece that decides
  const auto is_there = [&](const Piece& piece) { return piece.state.t == t_end; };
  // Each failure is a new end, earlier than the last; pieces that went beyond it run to it anew.
  while (!std::ranges::all_of(pieces_, is_there)) {
    for (Piece& piece : pieces_) {
      if (is_there(piece)) continue;
      const Outcome own = run_piece(piece, t_end);
      if (own == Outcome::reached_end) continue;
      outcome = own;
      set_message(piece.integrator->words_on(own));
      slack_at_ = piece.integrator->slack_at_;
      failed_step_ = piece.integrator->counts_.steps + 1;
      thrown = std::exchange(piece.thrown, nullptr);
      t_end = piece.state.t;
    }
  }
  gather(state);
  if (thrown) std::rethrow_exception(thrown);
  return outcome;
}

Outcome Parts::run_piece(Piece& piece, double t_end) {
  Outcome outcome = Outcome::solver_failed;
  try {
    if (piece.state.t != piece.begin.t) {
      piece.growth = growth_of(piece);
      piece.state = piece.begin;
      start(piece);
    }
    if (piece.state.t == t_end) return Outcome::reached_end;
    outcome = piece.integrator->run_to(piece.state, t_end);
  } catch (const SolverFailure& error) {
    piece.integrator->set_message(error.what());
  } catch (...) {  // kept until the others have come to the same time
    piece.thrown = std::current_exception();
  }
  if (outcome == Outcome::reached_end) piece.state.t = t_end;
  return outcome;
}

double Parts::reached() const {
  double sum = 0;
  for (const Piece& piece : pieces_) sum += piece.integrator->reached();
  return pieces_.empty() ? 0 : sum / static_cast<double>(pieces_.size());
}

double Parts::growth_of(Piece& piece) {
  return std::max(piece.growth, piece.integrator->energy_growth(piece.state));
}

double Parts::energy_growth(const State&) {
  double most = 1;
  for (Piece& piece : pieces_) most = std::max(most, growth_of(piece));
  return most;
}

void Parts::gather(State& state) {
  counts() = {};
  seconds_ = {};
  for (const Piece& piece : pieces_) {
    const Index n = piece.state.q.size();
    state.q.segment(piece.first, n) = piece.state.q;
    state.v.segment(piece.first, n) = piece.state.v;
    counts() += piece.integrator->counts_;
    seconds_ += piece.integrator->seconds_;
  }
  state.t = pieces_.front().state.t;
}

}  // namespace qddot

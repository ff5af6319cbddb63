#pragma once

#include <array>
#include <functional>
#include <memory>
#include <vector>

#include "qddot/model/block_diagonal_system.hpp"
#include "tests/integrators/runs.hpp"

namespace qddot {
inline namespace tests {

// A system that can be made again and again, and where it starts.
struct Piece {
  std::function<std::unique_ptr<System>()> make;
  State start;
};

constexpr double start_time = 0.7;

inline Piece piece(const Problem& p) {
  return {[network = p.network] { return make_mass_spring(network); },
          {start_time, p.initial.q, p.initial.v}};
}

// The oscillator, whose force throws `words` where it has come to `below` [m] or less; it starts at
// 0.8 m and is at -0.2 m after 0.2 s.
inline Piece giving_up(double below, const char* words) {
  const Problem p = Oscillator().problem();
  const std::shared_ptr<System> oscillator = make_mass_spring(p.network);
  const auto make = [oscillator, below, words] {
    auto relay = std::make_unique<Relay>(*oscillator);
    relay->after_force = [below, words](const ConstVec& q, MutableVec) {
      if (q[0] <= below) throw std::runtime_error(words);
    };
    return relay;
  };
  return {make, {start_time, p.initial.q, p.initial.v}};
}

// Pieces as the parts of one system.
struct Together {
  explicit Together(const std::vector<Piece>& pieces) {
    std::vector<std::unique_ptr<System>> parts;
    Index n = 0;
    for (const Piece& one : pieces) {
      parts.push_back(one.make());
      n += parts.back()->size();
    }
    system = std::make_unique<BlockDiagonalSystem>(std::move(parts));
    start = {start_time, Vec(n), Vec(n)};
    Index at = 0;
    for (const Piece& one : pieces) {
      start.q.segment(at, one.start.q.size()) = one.start.q;
      start.v.segment(at, one.start.q.size()) = one.start.v;
      at += one.start.q.size();
    }
  }
  // What part i has of a state.
  State part(const State& state, std::size_t i) const {
    Index at = 0;
    for (std::size_t before = 0; before < i; ++before) at += blocks_of(*system)[before]->size();
    const Index n = blocks_of(*system)[i]->size();
    return {state.t, state.q.segment(at, n), state.v.segment(at, n)};
  }

  std::unique_ptr<System> system;
  State start;
};

// Pieces that the method applies to: of different sizes, dimensions and frequencies.
inline std::vector<Piece> pieces_for(const Method& method) {
  std::vector<Piece> pieces;
  for (Problem& p :
       std::array{method.asks(Need::constant_stiffness) ? linear_hammock(2) : hammock(2),
                  Oscillator().problem(), linear_hammock(3)}) {
    if (method.asks(Need::split_forces)) p.network = with_split(p.network);
    pieces.push_back(piece(p));
  }
  return pieces;
}

inline Run run(const Method& method, const Together& whole, double t_end, const Options& options,
               const Observer& observer = {}, std::stop_token stop = {}) {
  return run(method, *whole.system, whole.start, t_end, options, observer, std::move(stop));
}
inline Run run(const Method& method, const Piece& alone, double t_end, const Options& options,
               const Observer& observer = {}) {
  const auto system = alone.make();
  return run(method, *system, alone.start, t_end, options, observer);
}

}  // namespace tests
}  // namespace qddot

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
struct Part {
  std::function<std::unique_ptr<System>()> make;
  State start;
};

constexpr double start_time = 0.7;

inline Part part(const Problem& p) {
  return {[network = p.network] { return make_mass_spring(network); },
          {start_time, p.initial.q, p.initial.v}};
}

// The oscillator, which starts at 0.8 m and is at -0.2 m after 0.2 s; `watch` sees its forces.
inline Part watched_oscillator(const std::function<void(const ConstVec& q, MutableVec f)>& watch) {
  const Problem p = Oscillator().problem();
  const std::shared_ptr<System> oscillator = make_mass_spring(p.network);
  const auto make = [oscillator, watch] {
    auto relay = std::make_unique<Relay>(*oscillator);
    relay->after_force = watch;
    return relay;
  };
  return {make, {start_time, p.initial.q, p.initial.v}};
}

// The same, whose force throws `words` where it has come to `below` [m] or less.
inline Part giving_up(double below, const char* words) {
  return watched_oscillator([=](const ConstVec& q, MutableVec) {
    if (q[0] <= below) throw std::runtime_error(words);
  });
}

// Parts as one system.
struct Together {
  explicit Together(const std::vector<Part>& parts) {
    std::vector<std::unique_ptr<System>> blocks;
    Index n = 0;
    for (const Part& one : parts) {
      blocks.push_back(one.make());
      n += blocks.back()->size();
    }
    system = std::make_unique<BlockDiagonalSystem>(std::move(blocks));
    start = {start_time, Vec(n), Vec(n)};
    Index at = 0;
    for (const Part& one : parts) {
      start.q.segment(at, one.start.q.size()) = one.start.q;
      start.v.segment(at, one.start.q.size()) = one.start.v;
      at += one.start.q.size();
    }
  }
  // The part of a state that belongs to part i.
  State part(const State& state, std::size_t i) const {
    Index at = 0;
    for (std::size_t before = 0; before < i; ++before) at += system->blocks()[before]->size();
    const Index n = system->blocks()[i]->size();
    return {state.t, state.q.segment(at, n), state.v.segment(at, n)};
  }

  std::unique_ptr<System> system;
  State start;
};

// Parts that the method applies to: of different sizes, dimensions and frequencies.
inline std::vector<Part> parts_for(const Method& method) {
  std::vector<Part> parts;
  for (Problem& p :
       std::array{method.asks(Need::constant_stiffness) ? linear_hammock(2) : hammock(2),
                  Oscillator().problem(), linear_hammock(3)}) {
    if (method.asks(Need::split_forces)) p.network = with_split(p.network);
    parts.push_back(part(p));
  }
  return parts;
}

inline Run run(const Method& method, const Together& whole, double t_end, const Options& options,
               const Observer& observer = {}, std::stop_token stop = {}) {
  return run(method, *whole.system, whole.start, t_end, options, observer, std::move(stop));
}
inline Run run(const Method& method, const Part& alone, double t_end, const Options& options,
               const Observer& observer = {}) {
  const auto system = alone.make();
  return run(method, *system, alone.start, t_end, options, observer);
}

}  // namespace tests
}  // namespace qddot

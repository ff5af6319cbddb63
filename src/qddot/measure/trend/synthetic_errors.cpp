#include "qddot/measure/trend/synthetic_errors.hpp"

#include <cmath>

#include <fmt/format.h>

#include "qddot/measure/trend/sample_steps.hpp"

namespace qddot::inline measure {
namespace {

using Random = std::mt19937_64;
using Draw = std::function<ErrorCourse(Random&)>;

constexpr double size = 1e-4;

double normal(Random& random) { return std::normal_distribution<double>()(random); }
double phase(Random& random) { return std::uniform_real_distribution<double>(0, 2 * M_PI)(random); }

// White noise.
Draw noise(double deviation) {
  return [=](Random& random) {
    return [deviation, own = Random(random())](double) mutable { return deviation * normal(own); };
  };
}

Draw sine(double amplitude, double period) {
  return [=](Random& random) {
    return [=, start = phase(random)](double t) {
      return amplitude * std::sin(2 * M_PI * t / period + start);
    };
  };
}

Draw sum(const Draw& one, const Draw& other) {
  return [=](Random& random) {
    return [a = one(random), b = other(random)](double t) { return a(t) + b(t); };
  };
}

Draw course(const ErrorCourse& fixed) {
  return [=](Random&) { return fixed; };
}

// A vibration with periods of three and of three hundred steps, and a beat of a seventieth of the
// run.
Draw vibration() {
  return sum(sum(sine(0.6 * size, 3.1e-6), sine(0.3 * size, 3.3e-4)), sine(0.1 * size, 0.014));
}

// An Ornstein-Uhlenbeck process in its stationary state, of standard deviation `size`.
Draw coloured(double memory) {
  return [=](Random& random) {
    const double start = normal(random);
    return [=, own = Random(random()), last = 0.0, x = start](double t) mutable {
      const double kept = std::exp(-(t - last) / memory);
      x = kept * x + std::sqrt(1 - kept * kept) * normal(own);
      last = t;
      return size * x;
    };
  };
}

Draw walk(double deviation) {
  return [=](Random& random) {
    return [=, own = Random(random()), last = 0.0, x = 0.0](double t) mutable {
      x += std::sqrt(t - last) * normal(own);
      last = t;
      return deviation * x;
    };
  };
}

Draw line(double slope) {
  return course([=](double t) { return slope * t; });
}

// An oscillation whose amplitude changes from `first` to `last`.
Draw widening(double first, double last) {
  return [=](Random& random) {
    return
        [=, own = vibration()(random)](double t) { return (first + (last - first) * t) * own(t); };
  };
}

// A sine, over noise, with a period in lengths of the run; it has no drift.
SyntheticKind slow_sine(const std::string& name, double period) {
  return {name, sum(sine(size, period), noise(0.3 * size)), {Verdict::bounded}, 0., {}, {}, period};
}

SyntheticKind coloured_noise(double memory) {
  return {fmt::format("coloured noise, memory {:g} T", memory),
          coloured(memory),
          {Verdict::bounded},
          0.,
          {},
          {},
          {},
          memory};
}

SyntheticKind exponential(const std::string& name, double rate, Verdict right) {
  return {name,
          sum(course([=](double t) { return std::expm1(rate * t); }), vibration()),
          {right},
          {},
          rate};
}

SyntheticKind drift(const std::string& name, double slope, const Draw& beside) {
  return {name, sum(line(slope), beside), {Verdict::drifts}, slope};
}

}  // namespace

std::vector<SyntheticKind> synthetic_kinds() {
  const Draw noisy = noise(size);
  const std::vector<Verdict> stays = {Verdict::bounded};
  std::vector<SyntheticKind> kinds = {{"noise", noisy, stays, 0.},
                                      {"fast oscillation", vibration(), stays, 0.},
                                      slow_sine("sine, period T/16", 1. / 16),
                                      slow_sine("sine, period T/8", 1. / 8),
                                      slow_sine("sine, period T/4", 1. / 4),
                                      slow_sine("sine, period T/2", 1. / 2),
                                      slow_sine("sine, period 0.7 T", 0.7),
                                      slow_sine("sine, period T", 1),
                                      slow_sine("sine, period 1.5 T", 1.5),
                                      slow_sine("sine, period 2 T", 2)};
  kinds.push_back({"two sines, T/3 and T/11",
                   sum(sine(size, 1. / 3), sum(sine(0.5 * size, 1. / 11), noise(0.3 * size))),
                   stays, 0.});
  for (const double memory : {0.003, 0.01, 0.03, 0.1, 0.3}) kinds.push_back(coloured_noise(memory));
  SyntheticKind wander{"random walk", walk(size), {}, 0.};
  wander.walk = size;
  kinds.push_back(wander);
  kinds.push_back({"walk under oscillation", sum(walk(size), widening(1, 1)), {}, 0.});
  // A block's mean has 0.09 of the samples' noise. The first drift is below it and may be called
  // bounded: its interval contains it.
  kinds.push_back({"small drift over noise",
                   sum(line(0.1 * size), noisy),
                   {Verdict::drifts, Verdict::bounded},
                   0.1 * size});
  kinds.push_back(drift("drift over noise", size, noisy));
  kinds.push_back(drift("large drift over noise", 10 * size, noisy));
  kinds.push_back(drift("drift over oscillation", 2 * size, vibration()));
  kinds.push_back(drift("drift over walk", 10 * size, walk(size)));
  kinds.push_back(
      drift("drift over sine, period T/5", 3 * size, sum(sine(size, 1. / 5), noise(0.3 * size))));
  kinds.push_back({"loss of a twentieth, exponential",
                   exponential("", std::log(0.95), {}).draw,
                   {Verdict::drifts}});
  kinds.push_back(
      exponential("loss of a third, exponential", std::log(2. / 3), Verdict::dissipates));
  kinds.push_back(exponential("loss of all, exponential", -20, Verdict::dissipates));
  kinds.push_back(exponential("growth by a third, exponential", std::log(4. / 3), Verdict::grows));
  const auto ends = [&](const std::string& name, double loss, double end) {
    kinds.push_back(
        {name, sum(course([=](double t) { return -loss * std::min(t / end, 1.0); }), vibration()),
         stays});
  };
  ends("loss of 0.01 in the first fifth", 0.01, 0.2);
  ends("loss of 0.3 in the first fifth", 0.3, 0.2);
  const auto steps = [&](const std::string& name, double height, double at) {
    kinds.push_back(
        {name, sum(course([=](double t) { return t > at ? -height : 0; }), vibration()), stays});
  };
  steps("step of 0.01 at 0.4 T", 0.01, 0.4);
  steps("step of 0.01 at 0.7 T", 0.01, 0.7);
  steps("step of 0.0001 at 0.4 T", size, 0.4);
  SyntheticKind widens{"amplitude that grows as t", widening(0, 1), {Verdict::widens}, 0.};
  widens.widening = 2;
  kinds.push_back(widens);
  widens = {"amplitude that grows by a half", widening(1, 1.5), {Verdict::widens}, 0.};
  widens.widening = 0.4;
  kinds.push_back(widens);
  kinds.push_back({"blow-up",
                   sum(course([](double t) { return 1e-12 * std::exp(40 * t); }), vibration()),
                   {Verdict::blows_up},
                   {},
                   40.});
  kinds.push_back(
      {"round-off walk", walk(1e-13), {Verdict::round_off}, 0., {}, {}, {}, {}, 1e-13, 1e-16});
  return kinds;
}

Trend synthetic_trend(const SyntheticKind& kind, std::uint64_t seed, int cells) {
  Random random(seed);
  const ErrorCourse error = kind.draw(random);
  const double step = synthetic_duration / synthetic_steps;
  std::vector<Sample> samples;
  for (const auto& [n, weight] : sample_steps(static_cast<std::int64_t>(synthetic_steps), cells)) {
    const double part = static_cast<double>(n) / synthetic_steps;
    samples.push_back({part * synthetic_duration, error(part), weight});
  }
  return trend_of(samples, Outcome::reached_end,
                  {.excess = 1, .frequency = 1, .rounding = kind.rounding, .step = step});
}

}  // namespace qddot::inline measure

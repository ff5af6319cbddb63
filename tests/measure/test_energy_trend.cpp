#include <cmath>
#include <functional>
#include <random>

#include <boost/test/unit_test.hpp>

#include "qddot/measure/trend/energy_trend.hpp"
#include "qddot/measure/trend/sample_steps.hpp"

BOOST_AUTO_TEST_SUITE(energy_trend)

using namespace qddot;

namespace {

constexpr double h = 1e-3, duration = 1000;  // a million steps
constexpr int seeds = 100;
// More than 12 of 100 intervals of 95 % that do not hold their number come by chance once
// in 500 times.
constexpr int most_misses = 12;

std::vector<Sample> series(const std::function<double(double)>& error, double until = duration) {
  std::vector<Sample> samples;
  for (const auto& [step, weight] : sample_steps(static_cast<std::int64_t>(until / h), 512)) {
    const double t = static_cast<double>(step) * h;
    samples.push_back({t, error(t), weight});
  }
  return samples;
}

// Two vibrations, as fast as three steps and as slow as a fortieth of the run, and one beat.
std::function<double(double)> vibration(double amplitude, double phase) {
  return [=](double t) {
    return amplitude * (0.6 * std::sin(2100 * t + phase) + 0.3 * std::sin(37 * t + 2 * phase) +
                        0.1 * std::sin(0.25 * t + 3 * phase));
  };
}

// A sum of a random increment a step.
std::vector<Sample> walk(double size, unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  double sum = 0, last = 0;
  return series([&](double t) {
    sum += size * std::sqrt((t - last) / h) * normal(random);
    last = t;
    return sum;
  });
}

Trend judged(const std::vector<Sample>& samples, const TrendScales& scales = {.step = h},
             Outcome outcome = Outcome::reached_end) {
  return trend_of(samples, outcome, scales);
}

bool holds(const Interval& interval, double value) {
  return interval.low <= value && value <= interval.high;
}

bool says(const Trend& trend, const std::string& words, const TrendScales& scales = {.step = h}) {
  return trend_in_words(trend, scales).find(words) != std::string::npos;
}

}  // namespace

BOOST_AUTO_TEST_CASE(an_oscillation_is_bounded_and_its_slope_is_zero_within_the_interval) {
  int misses = 0;
  for (int seed = 0; seed < seeds; ++seed) {
    const Trend trend = judged(series(vibration(1e-4, 0.7 * seed)));
    // The sum of the three seldom comes near the sum of their amplitudes.
    BOOST_TEST(trend.oscillation > 0.6e-4);
    BOOST_TEST(trend.oscillation < 1e-4);
    // A line that crosses less than half of the oscillation would be seen.
    BOOST_TEST(trend.drift.high - trend.drift.low < 0.8e-4 / duration);
    misses += !holds(trend.drift, 0) || trend.verdict == Verdict::drifts;
    if (holds(trend.drift, 0)) {
      BOOST_TEST(says(trend, "no drift (|slope| <"));
      BOOST_TEST(!says(trend, "drifts"));
    }
  }
  BOOST_TEST(misses <= most_misses);
}

BOOST_AUTO_TEST_CASE(one_sine_spans_its_amplitude) {
  // Also one that takes all of the excess and gives it back.
  const Trend full = judged(series([](double t) { return 0.5 * (std::cos(170 * t) - 1); }));
  BOOST_TEST(verdict_name(full.verdict) == "bounded");
  const Trend trend = judged(series([](double t) { return 3e-5 * std::sin(170 * t) + 1e-5; }));
  // 95 % of its values lie within sin(0.95 pi/2) = 0.997 of it; some 2000 samples.
  BOOST_TEST(trend.oscillation == 3e-5, boost::test_tools::tolerance(0.01));
  BOOST_TEST(verdict_name(trend.verdict) == "bounded");
}

BOOST_AUTO_TEST_CASE(a_slope_under_an_oscillation_is_found_within_its_interval) {
  for (const double sign : {-1, 1}) {
    const double slope = sign * 2e-4 / duration;  // twice the amplitude over the run
    int misses = 0, told = 0;
    for (int seed = 0; seed < seeds; ++seed) {
      const auto vibrates = vibration(1e-4, 0.3 * seed);
      const Trend trend = judged(series([&](double t) { return vibrates(t) + slope * t; }));
      misses += !holds(trend.drift, slope);
      told += trend.verdict == Verdict::drifts;
      if (trend.verdict == Verdict::undecided) continue;
      BOOST_TEST(verdict_name(trend.verdict) == "drifts");
      BOOST_TEST(trend.drift.value * sign > 0);
      BOOST_TEST(trend.drift.excludes_zero());
      BOOST_TEST(says(trend, "drifts by"));
      BOOST_TEST(!says(trend, "no drift"));
    }
    BOOST_TEST(misses <= most_misses);
    // The others may be slow sines by chance, of 5 %.
    BOOST_TEST(told >= seeds - most_misses);
  }
}

BOOST_AUTO_TEST_CASE(a_smaller_slope_may_be_a_part_of_a_slow_sine_and_is_said_to_be) {
  // A block's mean has a deviation of 1.2e-5. A line that rises by five of them differs from half a
  // sine by less than the noise.
  const double slope = 5e-5 / duration;
  int misses = 0;
  for (int seed = 0; seed < seeds; ++seed) {
    const auto vibrates = vibration(1e-4, 0.3 * seed);
    const Trend trend = judged(series([&](double t) { return vibrates(t) + slope * t; }));
    BOOST_TEST((trend.verdict == Verdict::undecided || trend.verdict == Verdict::drifts));
    if (trend.verdict == Verdict::undecided) {
      BOOST_TEST(says(trend, "so far a drift, or an oscillation with a period of"));
      BOOST_TEST(trend.needed >= 2 * trend.slow_period);
    }
    misses += !holds(trend.drift, slope);
  }
  BOOST_TEST(misses <= most_misses);
}

BOOST_AUTO_TEST_CASE(an_error_that_settles_is_bounded_and_one_that_changes_its_slope_says_so) {
  const auto vibrates = vibration(1e-5, 1);
  const auto settling = [&](double time) {
    return judged(series([&](double t) { return vibrates(t) - 1e-3 * -std::expm1(-t / time); }));
  };
  const Trend soon = settling(duration / 30);
  BOOST_TEST(soon.steady_from == duration / 2);
  BOOST_TEST(!soon.drift.excludes_zero());
  BOOST_TEST(soon.last_error == -1e-3, boost::test_tools::tolerance(0.01));
  BOOST_TEST(says(soon, "no drift"));
  BOOST_TEST(says(soon, "from t = 500 s on, after -1.0e-03 until then"));
  const Trend late = settling(duration / 2);
  BOOST_TEST(late.drift.high < 0);
  BOOST_TEST(says(late, "drifts"));
  BOOST_TEST(says(late, "second half"));
  // A line that begins after something else has gone.
  const Trend bent = judged(series([&](double t) {
    return vibrates(t) + 1e-2 * std::expm1(-40 * t / duration) + 1e-3 * t / duration;
  }));
  BOOST_TEST(bent.steady_from == duration / 2);
  BOOST_TEST(bent.drift.low > 0);
  BOOST_TEST(holds(bent.drift, 1e-3 / duration));
}

BOOST_AUTO_TEST_CASE(a_random_walk_is_no_drift_and_its_size_is_found) {
  int misses = 0, seen = 0;
  double size = 0;
  for (unsigned seed = 0; seed < seeds; ++seed) {
    const Trend trend = judged(walk(1e-16, seed), {.rounding = 1e-16, .step = h});
    misses += trend.drift.excludes_zero();
    seen += trend.walk > 0;
    size += trend.walk * std::sqrt(h) / seeds;
    BOOST_TEST(verdict_name(trend.verdict) == "round_off");
    BOOST_TEST(says(trend, "only round-off"));
  }
  BOOST_TEST(misses <= most_misses);
  BOOST_TEST(seen > 0.9 * seeds);
  // One size has a relative error of 1/sqrt(2 (64 - 2)), their mean a tenth of that, 0.9 %. The
  // fitted noise beside a walk cannot be negative, so that the walk comes out a few percent too
  // small.
  BOOST_TEST(size > 0.94e-16);
  BOOST_TEST(size < 1.03e-16);
}

BOOST_AUTO_TEST_CASE(the_same_walk_a_million_roundings_large_is_not_called_round_off) {
  const Trend trend = judged(walk(1e-10, 1), {.rounding = 1e-16, .step = h});
  BOOST_TEST(verdict_name(trend.verdict) == "undecided");
  BOOST_TEST(says(trend, "too short to tell: run it to t = "));
  BOOST_TEST(says(trend, "so far it wanders by"));
  BOOST_TEST(says(trend, "no drift"));
  BOOST_TEST(trend.needed >= 4 * duration);
}

BOOST_AUTO_TEST_CASE(a_slow_sine_is_bounded_once_it_has_been_seen_and_never_a_drift_or_a_walk) {
  // Over the length of the run; a tenth of the noise is left in a block's mean.
  for (const double period : {1. / 16, 1. / 8, 1. / 4, 1. / 2, 0.7, 1., 1.5, 2.}) {
    int drifts = 0;
    for (unsigned seed = 0; seed < 8; ++seed) {
      std::mt19937_64 random(seed);
      std::normal_distribution<double> normal;
      const Trend trend = judged(series([&](double t) {
        return 1e-4 * std::sin(2 * M_PI * t / (period * duration) + 0.8 * seed) +
               3e-5 * normal(random);
      }));
      drifts += trend.verdict == Verdict::drifts;
      if (trend.verdict == Verdict::drifts) continue;
      BOOST_TEST(verdict_name(trend.verdict) == (period < 0.8 ? "bounded" : "undecided"));
      if (trend.period > 0 && period < 0.8) {
        BOOST_TEST(trend.period == period * duration, boost::test_tools::tolerance(0.1));
      }
      BOOST_TEST(!trend.drift.excludes_zero());
      if (period >= 0.8) BOOST_TEST(says(trend, "too short to tell: "));
      if (period >= 0.8) BOOST_TEST(trend.needed > 1.25 * period * duration);
    }
    // 5 % of intervals miss zero: more than 2 of 8 do in one of 200 times.
    BOOST_TEST(drifts <= 2);
  }
}

BOOST_AUTO_TEST_CASE(an_oscillation_that_grows_is_not_bounded) {
  for (const double first : {0., 0.5}) {
    const auto vibrates = vibration(1e-4, 1);
    const Trend trend = judged(
        series([&](double t) { return (first + (1 - first) * t / duration) * vibrates(t); }));
    // Growth by half of the amplitude is little beside the beats of this one.
    BOOST_TEST(
        (trend.verdict == Verdict::widens || (first > 0 && trend.verdict == Verdict::undecided)));
    BOOST_TEST(says(trend, trend.verdict == Verdict::widens ? "widens: its oscillation of"
                                                            : "an oscillation that widens"));
    BOOST_TEST(!trend.drift.excludes_zero());
    BOOST_TEST(holds(trend.widening, 2 * (1 - first) / (1 + first) / duration));
  }
  BOOST_TEST(judged(series(vibration(1e-4, 1))).widening.holds(0));
}

BOOST_AUTO_TEST_CASE(a_level_that_changed_once_is_bounded_after_that) {
  const auto vibrates = vibration(1e-5, 1);
  for (const double loss : {1e-2, 0.3}) {  // a drift, or a dissipation, if it went on
    // At once, or little by little.
    for (const auto& part : {std::pair(0.1, 0.1), {0.4, 0.4}, {0.7, 0.7}, {0., 0.2}}) {
      const double from = part.first * duration, at = part.second * duration;
      const Trend trend = judged(series([&](double t) {
        return vibrates(t) - loss * (t > at ? 1 : t > from ? (t - from) / (at - from) : 0);
      }));
      BOOST_TEST(verdict_name(trend.verdict) == "bounded");
      BOOST_TEST(trend.rate.value == 0);
      BOOST_TEST(trend.steady_from == (part.second < 0.5 ? 0.5 : 0.75) * duration);
      BOOST_TEST(trend.before == -loss, boost::test_tools::tolerance(0.01));
      BOOST_TEST(trend.last_error == -loss, boost::test_tools::tolerance(0.02));
      BOOST_TEST(says(trend, "until then"));
    }
  }
  // A late change has not been observed for long.
  const Trend late =
      judged(series([&](double t) { return vibrates(t) - (t > 0.9 * duration ? 1e-2 : 0); }));
  BOOST_TEST(verdict_name(late.verdict) == "undecided");
}

BOOST_AUTO_TEST_CASE(a_drift_that_outgrows_its_walk_is_one) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    auto samples = walk(1e-13, seed);                                 // 1e-10 by the end
    for (Sample& sample : samples) sample.error -= 1e-12 * sample.t;  // 1e-9
    const Trend trend = judged(samples, {.rounding = 1e-17, .step = h});
    BOOST_TEST(verdict_name(trend.verdict) == "drifts");
    BOOST_TEST(trend.drift.high < 0);
  }
}

BOOST_AUTO_TEST_CASE(round_off_that_adds_up_says_so) {
  const TrendScales scales{.rounding = 2e-16, .step = h};
  const Trend biased = judged(series([](double t) { return 1e-17 / h * t; }), scales);
  BOOST_TEST(verdict_name(biased.verdict) == "round_off");
  BOOST_TEST(says(biased, "adds up", scales));
  BOOST_TEST(!says(biased, "no drift", scales));
  const Trend more = judged(series([](double t) { return 1e-15 / h * t; }), scales);
  BOOST_TEST(verdict_name(more.verdict) == "drifts");
}

BOOST_AUTO_TEST_CASE(a_decay_is_the_damping_that_it_is) {
  const double w = 20;
  // Until half is left; for long after nothing is left; at once.
  for (const double zeta : {1.7e-5, 1e-3, 2e-2}) {
    const TrendScales scales{.excess = 1.4, .frequency = w, .step = h};
    const auto ripple = vibration(1e-3, zeta);
    const Trend trend = judged(series([&](double t) {
                                 const double left = std::exp(-2 * zeta * w * t);
                                 return 1.4 * (left - 1) + left * ripple(t);
                               }),
                               scales);
    BOOST_TEST(verdict_name(trend.verdict) == "dissipates");
    BOOST_TEST(trend.damping_ratio == zeta, boost::test_tools::tolerance(0.01));
    BOOST_TEST(trend.drift.value == -1.4 * 2 * zeta * w, boost::test_tools::tolerance(0.01));
    BOOST_TEST(trend.drift.high < 0);
    BOOST_TEST(says(trend, "dissipates like a damping ratio of", scales));
  }
}

BOOST_AUTO_TEST_CASE(what_is_gone_in_a_few_steps_has_been_dissipated) {
  const Trend trend = judged(series([](double t) { return std::expm1(-0.5 * t / h); }, 200 * h));
  BOOST_TEST(verdict_name(trend.verdict) == "dissipates");
  BOOST_TEST(trend.rate.value == -0.5 / h, boost::test_tools::tolerance(0.1));
}

BOOST_AUTO_TEST_CASE(the_loss_of_a_twentieth_is_a_drift_and_of_a_fifth_a_decay) {
  const auto lost = [&](double part) {
    return judged(series([&](double t) { return std::expm1(std::log1p(-part) * t / duration); }));
  };
  BOOST_TEST(verdict_name(lost(0.05).verdict) == "drifts");
  BOOST_TEST(lost(0.05).drift.high < 0);
  BOOST_TEST(verdict_name(lost(0.2).verdict) == "dissipates");
  const Trend won = judged(series([&](double t) { return 0.2 * t / duration; }));
  BOOST_TEST(verdict_name(won.verdict) == "grows");
  BOOST_TEST(won.drift.low > 0);
}

BOOST_AUTO_TEST_CASE(a_blow_up_has_its_time_and_rate) {
  const double rate = 0.04;
  const Trend trend = judged(series([&](double t) { return std::expm1(rate * t); }));
  BOOST_TEST(verdict_name(trend.verdict) == "blows_up");
  BOOST_TEST(trend.rate.value == rate, boost::test_tools::tolerance(1e-3));
  BOOST_TEST(trend.blow_up_time == std::log(11) / rate, boost::test_tools::tolerance(0.01));
  BOOST_TEST(says(trend, "blows up at t = "));
  // The same from out of an oscillation that has looked bounded for most of the run.
  const auto vibrates = vibration(1e-2, 0);
  const Trend late =
      judged(series([&](double t) { return vibrates(t) + 1e-12 * std::exp(rate * t); }, 900));
  BOOST_TEST(verdict_name(late.verdict) == "blows_up");
  BOOST_TEST(late.rate.value == rate, boost::test_tools::tolerance(0.02));
  // And before it is there.
  BOOST_TEST(
      verdict_name(
          judged(series([&](double t) { return vibrates(t) + 1e-12 * std::exp(rate * t); }, 450))
              .verdict) == "bounded");
}

BOOST_AUTO_TEST_CASE(the_rate_of_a_steady_growth_is_that_until_the_blow_up) {
  // 40 times the energy at the end of the run: less than is needed for a fit of a sudden rise.
  const double rate = std::log(40) / duration;
  const Trend slow = judged(series([&](double t) { return std::expm1(rate * t); }));
  BOOST_TEST(verdict_name(slow.verdict) == "blows_up");
  BOOST_TEST(slow.rate.value == rate, boost::test_tools::tolerance(1e-3));
  BOOST_TEST(says(slow, "rate"));
  // Another rate after the blow-up, as where springs pass through zero length, changes nothing.
  const double fast = 10 * rate, bend = std::log(11.5) / fast;
  const auto bent = [&](double t) {
    return std::expm1(fast * std::min(t, bend) + 0.8 * fast * std::max(t - bend, 0.0));
  };
  const Trend first = judged(series(bent));
  BOOST_TEST(first.rate.value == fast, boost::test_tools::tolerance(1e-3));
  BOOST_TEST(first.rate.holds(fast));
  // If a third of the energy grows, no one rate is right until then; later its own is.
  const Trend part = judged(series([&](double t) { return std::expm1(fast * t) / 3; }));
  BOOST_TEST(part.rate.value == fast, boost::test_tools::tolerance(0.02));
}

BOOST_AUTO_TEST_CASE(a_run_that_diverged_between_two_samples_has_blown_up) {
  const Trend trend =
      judged(series([](double) { return 1e-3; }, 100 * h), {.step = h}, Outcome::diverged);
  BOOST_TEST(verdict_name(trend.verdict) == "blows_up");
  BOOST_TEST(trend.blow_up_time == 100 * h);
  BOOST_TEST(says(trend, "at once"));
}

BOOST_AUTO_TEST_CASE(few_samples_have_no_verdict_and_no_error_is_no_drift) {
  const auto short_series = series([](double t) { return t; }, 3 * h);
  const Trend trend = judged(short_series);
  BOOST_TEST(verdict_name(trend.verdict) == "unknown");
  BOOST_TEST(says(trend, "too short"));
  BOOST_TEST(verdict_name(judged({}).verdict) == "unknown");
  // Means of fours, which are too few to see a walk.
  BOOST_TEST(verdict_name(judged(series(vibration(1e-4, 1), 40 * h)).verdict) == "unknown");
  BOOST_TEST(verdict_name(judged(series(vibration(1e-4, 1), 400 * h)).verdict) != "unknown");
  const Trend nothing = judged(series([](double) { return 0.0; }));
  BOOST_TEST(verdict_name(nothing.verdict) == "round_off");
  BOOST_TEST(!nothing.drift.excludes_zero());
}

BOOST_AUTO_TEST_CASE(steps_are_drawn_alike_in_each_octave) {
  for (const std::int64_t count : {1, 7, 16, 17, 1000, 1000000}) {
    const auto steps = sample_steps(count, 8);
    double sum = 0;
    std::int64_t last = 0;
    for (const auto& [step, weight] : steps) {
      BOOST_TEST(step > last);
      last = step;
      sum += weight;
    }
    BOOST_TEST(last == count);
    BOOST_TEST(sum == static_cast<double>(count));  // each step is stood for
  }
  BOOST_TEST(std::ssize(sample_steps(16, 8)) == 16);
  const auto steps = sample_steps(1 << 20, 8);
  for (int octave = 4; octave < 20; ++octave) {
    const auto within = [&](const SampledStep& s) {
      return s.step > (1 << octave) && s.step <= (2 << octave);
    };
    BOOST_TEST(std::ranges::count_if(steps, within) == 8);
  }
}

BOOST_AUTO_TEST_SUITE_END()

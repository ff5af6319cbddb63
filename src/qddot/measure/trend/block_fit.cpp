#include "qddot/measure/trend/block_fit.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <complex>
#include <limits>
#include <vector>

#include <Eigen/LU>

#include "qddot/algebra/dense_cholesky.hpp"
#include "qddot/algebra/straight_line.hpp"
#include "qddot/measure/trend/block_covariance.hpp"
#include "qddot/model/machine_epsilon.hpp"

namespace qddot::inline measure {
namespace {

// The ratios of a walk's variance in a block to that of the noise. The least, `least_ratio`/n^2,
// adds a third to the variance of the slope; the largest is a walk without noise. The shares are
// the same ratios for an oscillation. Their largest value gives its period to much less than a
// block.
constexpr double least_ratio = 4, most_ratio = 1e4, ratio_step = 2;
constexpr double least_share = 1.0 / 16, most_share = 1e8, share_step = 4, sharp_step = 16;
// 2 ln of the ratio of likelihoods that chance exceeds once in a hundred times. The variance of the
// walk, zero, is at the edge of its range (Self and Liang, J. American Statistical Association 82
// (1987) 605-610).
constexpr double certain_walk = 5.4;
// The same once in twenty times, for the variance of noise beside a walk. Below it the noise is set
// to zero. Else it would take a part of the walk, and the interval of the slope would be too small.
constexpr double likely_noise = 2.7;
// The same for the likeliest coloured noise and the likeliest wave over a walk, if the walk is
// true. Found by simulation (the program `verdicts` prints how often it happens).
constexpr double certain_noise = 7, certain_wave = 12;
// An oscillation surely returns if at least this many of its periods were seen.
constexpr double least_periods = 1.25;
// The 95 % quantile of chi-squared for one fitted number. The one for memories is larger, because
// they are reported only for noise that cannot be told from a walk; found by simulation.
constexpr double chance = 3.84, memory_chance = 9;
// The longest period of a slow sine that is tried, in lengths of the series, and the ratio of two
// trials.
constexpr double slowest_period = 33, slow_step = 1.03;

struct Fit {
  double ratio, slope, slope_variance, level, variance;
  double log_likelihood, profile;  // restricted, and not restricted
};

// Fits of one series.
class Series {
 public:
  explicit Series(const Vec& y) : y_(y) {
    const double rounding = machine_epsilon * y.lpNorm<Eigen::Infinity>();
    least_ = std::max(static_cast<double>(y.size()) * rounding * rounding,
                      std::numeric_limits<double>::min());
  }

  Index size() const { return y_.size(); }

  // Generalised least squares of y on a + b (j - middle) with the covariance s^2 (I + ratio x), and
  // its restricted likelihood (Harville, J. American Statistical Association 72 (1977) 320-338).
  // The sum of squares is at least what rounding of y makes.
  Fit fit(const Eigen::MatrixXd& x, double ratio) const {
    const Index n = size();
    Eigen::MatrixXd columns(n, 3);  // of a and b, and y beside them
    for (Index i = 0; i < n; ++i) columns.row(i) << 1, place(i), y_[i];
    const DenseCholesky factors(Eigen::MatrixXd::Identity(n, n) + ratio * x);
    factors.solve_lower(columns);
    const auto line = columns.leftCols<2>();
    const Eigen::Matrix2d normal = line.transpose() * line, inverse = normal.inverse();
    const Eigen::Vector2d found = inverse * (line.transpose() * columns.col(2));
    const auto freedom = static_cast<double>(n - 2);
    const double squares = std::max(least_, (columns.col(2) - line * found).squaredNorm());
    const double variance = squares / freedom;
    const double log_determinant = factors.log_determinant();
    return {ratio,
            found[1],
            variance * inverse(1, 1),
            found[0],
            variance,
            -0.5 * (log_determinant + std::log(normal.determinant()) + freedom * std::log(squares)),
            -0.5 * (log_determinant + static_cast<double>(n) * std::log(squares))};
  }

  // The frequency [rad/block] of the sine that, with a line, leaves the least squares. The series
  // contains at least a quarter of its period.
  double sharpest_frequency() const {
    const auto n = static_cast<double>(size());
    double least = std::numeric_limits<double>::infinity(), sharpest = 0;
    for (double periods = 0.25; periods <= n / 2; periods += 0.125) {
      const double w = 2 * M_PI * periods / n;
      const double left = squares_beside(4, [&](double t) {
        return Eigen::RowVector4d(1, std::cos(w * t), std::sin(w * t), 2 * t / n);
      });
      if (left < least) {
        least = left;
        sharpest = w;
      }
    }
    return sharpest;
  }

  // The shortest period [blocks], from the length of the series on, of a sine without a slope that
  // explains the means as well as `profile`. Infinite if there is none.
  double shortest_slow_period(double profile) const {
    const auto n = static_cast<double>(size());
    double least = std::numeric_limits<double>::infinity(), best = n;
    for (double period = n; period < slowest_period * n; period *= slow_step) {
      const double left = squares_beside_sine(period);
      if (-0.5 * n * std::log(left) > profile) return period;
      if (left < least) {
        least = left;
        best = period;
      }
    }
    // Refines the best period by ternary search.
    double low = std::max(n, best / slow_step), high = best * slow_step;
    for (int cut = 0; cut < 40; ++cut) {
      const double third = (high - low) / 3;
      const bool is_low = squares_beside_sine(low + third) < squares_beside_sine(high - third);
      (is_low ? high : low) += is_low ? -third : third;
    }
    return -0.5 * n * std::log(squares_beside_sine(low)) > profile
               ? low
               : std::numeric_limits<double>::infinity();
  }

 private:
  // The sum of squares left by least squares on `count` functions of the place. The functions are
  // made orthogonal one after the other, twice, which is enough (Parlett, The Symmetric Eigenvalue
  // Problem, 6.9). A function that depends on those before it is left out.
  template <class Row>
  double squares_beside(int count, const Row& row) const {
    Eigen::MatrixXd columns(size(), count);
    for (Index i = 0; i < size(); ++i) columns.row(i) = row(place(i));
    Vec left = y_;
    for (int c = 0; c < count; ++c) {
      auto column = columns.col(c);
      const double length = column.norm();
      for (int pass = 0; pass < 2; ++pass) {
        for (int b = 0; b < c; ++b) column -= columns.col(b).dot(column) * columns.col(b);
      }
      const double rest = column.norm();
      column *= rest > static_cast<double>(size()) * machine_epsilon * length ? 1 / rest : 0;
      left -= column.dot(left) * column;
    }
    return std::max(least_, left.squaredNorm());
  }

  // The sum of squares that a sine of that period [blocks] leaves, without a slope.
  double squares_beside_sine(double period) const {
    const double w = 2 * M_PI / period;
    // The cosine minus one replaces the cosine, which is nearly constant for long periods.
    return squares_beside(3, [&](double t) {
      const double half = std::sin(w * t / 2);
      return Eigen::RowVector3d(1, half * half, std::sin(w * t));
    });
  }

  double place(Index i) const {
    return static_cast<double>(i) - static_cast<double>(size() - 1) / 2;
  }

  const Vec& y_;
  double least_ = 0;
};

const Fit& likeliest(const std::vector<Fit>& fits) {
  return *std::ranges::max_element(fits, {}, &Fit::log_likelihood);
}

std::vector<Fit> walks(const Series& series) {
  const auto n = static_cast<double>(series.size());
  const Eigen::MatrixXd x = walk_covariance(series.size());
  std::vector<Fit> fits;
  for (double ratio = least_ratio / (n * n); ratio <= most_ratio; ratio *= ratio_step) {
    fits.push_back(series.fit(x, ratio));
  }
  return fits;
}

// Fits with coloured noise, and the memory [blocks] of each.
struct Coloured {
  std::vector<Fit> fits;
  std::vector<double> memory;
};

Coloured coloured(const Series& series) {
  Coloured result;
  for (double memory = 0.5; memory <= static_cast<double>(series.size()); memory *= M_SQRT2) {
    const Eigen::MatrixXd x = oscillation_covariance(series.size(), 1 / memory);
    for (double share = least_share; share <= most_ratio; share *= share_step) {
      result.fits.push_back(series.fit(x, share));
      result.memory.push_back(memory);
    }
  }
  return result;
}

// The parameters of a wave: logarithm of its ratio to noise, frequency [rad/block], decay
// [1/block].
struct Wave {
  double log_ratio, frequency, decay;
};

// Fits with waves: first of the sharpest frequency, then ever closer to the likeliest one.
struct Waves {
  std::vector<Fit> fits;
  Wave best{};
};

Waves waves(const Series& series) {
  Waves result;
  double best = -std::numeric_limits<double>::infinity();
  const auto n = static_cast<double>(series.size());
  const double slowest = M_PI / 2 / n;
  const auto look = [&](const Wave& wave) {
    const std::complex<double> rate(wave.decay, -wave.frequency);
    const Fit fit =
        series.fit(oscillation_covariance(series.size(), rate), std::exp(wave.log_ratio));
    result.fits.push_back(fit);
    if (fit.log_likelihood > best) {
      best = fit.log_likelihood;
      result.best = wave;
    }
  };
  const double sharpest = series.sharpest_frequency();
  for (const double decay : {0.0, 0.25 / n, 1 / n, 4 / n}) {
    for (double share = 1; share <= most_share; share *= sharp_step) {
      look({std::log(share), sharpest, decay});
    }
  }
  double reach = 1;
  for (int halving = 0; halving < 8; ++halving, reach /= 2) {
    const Wave from = result.best;
    for (const double step : {-reach, reach}) {
      const double share =
          std::clamp(from.log_ratio + 2 * step, std::log(least_share), std::log(most_share));
      look({share, from.frequency, from.decay});
      look({result.best.log_ratio, std::max(slowest, from.frequency + step * 0.25 * M_PI / n),
            from.decay});
      if (from.decay > 0) {
        look({result.best.log_ratio, result.best.frequency, from.decay * std::exp(step)});
      }
    }
  }
  return result;
}

// The shortest memory [blocks] that coloured noise is likely to have.
double least_memory(const Coloured& noises, const Fit& walk) {
  const double likely =
      std::max(walk.log_likelihood, likeliest(noises.fits).log_likelihood) - memory_chance / 2;
  for (std::size_t i = 0; i < noises.fits.size(); ++i) {
    if (noises.fits[i].log_likelihood > likely) return noises.memory[i];
  }
  return noises.memory.back();
}

// The slope and its interval, averaged by likelihood.
Interval average(const std::vector<Fit>& fits, Index n) {
  const Fit& best = likeliest(fits);
  double sum = 0, mean = 0, square = 0;
  for (const Fit& f : fits) {
    const double weight = std::exp(f.log_likelihood - best.log_likelihood);
    sum += weight;
    mean += weight * f.slope;
    square += weight * (f.slope_variance + (f.slope - best.slope) * (f.slope - best.slope));
  }
  mean /= sum;
  const double deviation =
      std::sqrt(std::max(square / sum - (mean - best.slope) * (mean - best.slope), 0.0));
  const double half = student_half_width(static_cast<double>(n - 2)) * deviation;
  return {mean, mean - half, mean + half};
}

}  // namespace

BlockFit fit_blocks(const Vec& y) {
  assert(y.size() >= 4);
  const Series series(y);
  const std::vector<Fit> walking = walks(series);
  const Fit& walk = likeliest(walking);
  const Fit none = series.fit(walk_covariance(y.size()), 0);
  BlockFit result{.slope = average(walking, y.size()),
                  .level = walk.level,
                  .walk = std::sqrt(walk.ratio * walk.variance),
                  .noise = std::sqrt(walk.variance),
                  .walk_evidence = 2 * (walk.log_likelihood - none.log_likelihood)};
  double profile = std::max(walk.profile, none.profile);
  if (result.walk_evidence > certain_walk) {
    const Coloured noises = coloured(series);
    const Waves waving = waves(series);
    const Fit &noise = likeliest(noises.fits), &wave = likeliest(waving.fits);
    profile = std::max({profile, noise.profile, wave.profile});
    result.noise_evidence = 2 * (noise.log_likelihood - walk.log_likelihood);
    result.wave_evidence = 2 * (wave.log_likelihood - walk.log_likelihood);
    result.memory = least_memory(noises, walk);
    const bool is_wave = result.wave_evidence > certain_wave;
    const double period = 2 * M_PI / waving.best.frequency;
    if (is_wave) result.period = period;
    if (is_wave && period * least_periods > static_cast<double>(y.size())) {
      result.colour = Colour::turns;
    } else if (is_wave || result.noise_evidence > certain_noise) {
      result.colour = Colour::oscillates;
      result.level = (is_wave ? wave : noise).level;
      result.slope = average(is_wave ? waving.fits : noises.fits, y.size());
    } else {
      result.colour = Colour::undecided;
      const Fit& alone = walking.back();
      if (2 * (walk.log_likelihood - alone.log_likelihood) < likely_noise) {
        result.level = alone.level;
        result.walk = std::sqrt(alone.ratio * alone.variance);
        result.slope = average({alone}, y.size());
      }
    }
  }
  if (result.slope.excludes_zero()) {
    result.slow_period = series.shortest_slow_period(profile - chance / 2);
  }
  return result;
}

}  // namespace qddot::inline measure

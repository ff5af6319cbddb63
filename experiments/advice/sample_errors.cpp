#include "experiments/advice/sample_errors.hpp"

#include <algorithm>

#include "experiments/advice/path_errors.hpp"
#include "experiments/advice/worth.hpp"
#include "qddot/integrators/registry.hpp"
#include "qddot/measure/speed/measurement.hpp"

namespace qddot::judged_advice {
namespace {

constexpr double tolerances[] = {1e-3, 1e-4, 1e-6, 1e-8};
constexpr double far_above = 20;

// The tolerance of a position, rtol (|q| + length) as in AdaptiveStep, relative to the motion.
// Where a motion is small beside its scene, it is larger than rtol.
double relative_tolerance(const Method& method, double rtol, const JudgedMotion& motion) {
  const Model& model = motion.model();
  const double largest = model.initial().q.lpNorm<Eigen::Infinity>(),
               length = options_for(method, rtol, model).length,
               displacement = motion.scales().displacement;
  return rtol * (displacement > 0 ? std::max(1.0, (largest + length) / displacement) : 1);
}

SampledRun sampled_run(const Method& method, double value, const JudgedMotion& motion) {
  SampledRun run{.method = method.name, .value = value};
  const auto samples = errors_at_looks(method, value, motion);
  run.reached_end = samples.size() == motion.truth().times.size();
  if (!run.reached_end) return run;
  // Without interpolation each look ends a step.
  const auto at_steps =
      method.is(Trait::interpolates) ? errors_at_steps(method, value, motion) : samples;
  run.end_error = samples.back();
  const double least = std::max(run.end_error, value),
               tolerance = relative_tolerance(method, value, motion);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    run.sample_error = std::max(run.sample_error, samples[i]);
    run.error_at_steps = std::max(run.error_at_steps, at_steps[i]);
    // The uncertainty of the true motion is counted in favour of the run.
    const double error = samples[i] - motion.conditioning();
    run.plain_ratio = std::max(run.plain_ratio, error / least);
    run.ratio = std::max(run.ratio, error / std::max({least, tolerance, run.error_at_steps}));
  }
  return run;
}

}  // namespace

SampledCase sampled_case(const HardCase& hard) {
  HardCase on_path = hard;  // so that the conditioning is that of all times
  on_path.of = AccuracyOf::path;
  const JudgedMotion motion(on_path);
  const System& system = motion.model().system();
  SampledCase result{.name = hard.scene.name, .left_out = motion.truth().unknown_because};
  if (!motion.truth().is_known() || system.size() == 0) return result;
  result.conditioning = motion.conditioning();
  for (const Method& method : methods()) {
    if (method.knob != Knob::rtol || !applies_to(method, system)) continue;
    for (const double rtol : tolerances) {
      if (!(motion.conditioning() <= well_posed * rtol)) continue;
      SampledRun& run = result.runs.emplace_back(sampled_run(method, rtol, motion));
      run.name = hard.scene.name;
      run.kind = hard.kind;
    }
  }
  if (result.runs.empty()) result.left_out = "it is not well posed";
  return result;
}

const Columns<SampledRun>& sample_columns() {
  using R = SampledRun;
  static const Columns<SampledRun> columns = {{"case", &R::name},
                                              {"kind", &R::kind},
                                              {"method", &R::method},
                                              {"value", &R::value},
                                              {"sample_error", &R::sample_error},
                                              {"end_error", &R::end_error},
                                              {"error_at_steps", &R::error_at_steps},
                                              {"ratio", &R::ratio},
                                              {"plain_ratio", &R::plain_ratio}};
  return columns;
}

std::vector<SampledMethod> by_method(const std::vector<SampledCase>& cases) {
  std::vector<SampledMethod> sums;
  for (const Method& method : methods()) {
    SampledMethod sum{.method = method.name};
    std::vector<double> ratios, plain;
    for (const SampledCase& one : cases) {
      for (const SampledRun& run : one.runs) {
        if (run.method != method.name) continue;
        ++(run.reached_end ? sum.runs : sum.ended_early);
        if (!run.reached_end) continue;
        ratios.push_back(run.ratio);
        plain.push_back(run.plain_ratio);
      }
    }
    if (ratios.empty()) continue;
    const auto share = [](const std::vector<double>& all) {
      const auto above = std::ranges::count_if(all, [](double ratio) { return ratio > far_above; });
      return 100 * static_cast<double>(above) / static_cast<double>(all.size());
    };
    sum.largest = std::ranges::max(ratios), sum.plain_largest = std::ranges::max(plain);
    sum.median = quantile(ratios, 0.5), sum.plain_median = quantile(plain, 0.5);
    sum.share = share(ratios), sum.plain_share = share(plain);
    sums.push_back(sum);
  }
  return sums;
}

}  // namespace qddot::judged_advice

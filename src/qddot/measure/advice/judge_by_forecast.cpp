// Pairs of runs that a forecast chooses, where runs with error control would take long.
#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "qddot/analysis/largest_frequency.hpp"
#include "qddot/integrators/registry.hpp"
#include "qddot/measure/advice/search.hpp"
#include "qddot/measure/advice/step_cost.hpp"
#include "qddot/measure/stability/linear_step.hpp"

namespace qddot::inline measure {
namespace {

constexpr double forces_a_bound = 4;  // the measured cost of frequency_bound for a network

// The factor by which w_max grows over the path, from the growth of its bound at some places.
double growth_of_frequency(const Model& model, const std::vector<State>& path, double bound,
                           std::size_t places) {
  if (model.system().stiffness_is_constant() || !(bound > 0)) return 1;
  double most = bound;
  places = std::min(places, path.size());
  for (std::size_t i = 1; i <= places; ++i)
    most = std::max(most, frequency_bound(model.system(), path[i * path.size() / places - 1].q));
  return most / bound;
}

// The explicit method of fixed steps that is stable with the fewest forces: Verlet's.
const Method& of_fewest_forces(const System& system) {
  const Method* best = nullptr;
  double most = 0;
  for (const Method& method : methods()) {
    if (!is_forecast_by_frequency(method) || !applies_to(method, system)) continue;
    const double limit = linear_limit(method) / forces_a_step(method);
    if (limit > most) best = &method;
    most = std::max(most, limit);
  }
  return *best;
}

}  // namespace

// The first run: near the stability limit, with shorter steps if it fails or its energy grows.
const Trial* Search::survey() {
  const Method& method = of_fewest_forces(system_);
  const double bound = runs_.bound_of_w(), limit = linear_limit(method);
  // Few products with K give a value that is a percent too small. Forces that push away from the
  // start bring no frequency; the motion is then as fast as the bound.
  constexpr Index few = 15;
  w_start_ = std::min(bound, frequency_at_least(system_, model_.initial().q, few));
  if (w_start_ < rules_.small * bound) w_start_ = bound;
  double steps =
      std::max(rules_.places, std::ceil(until_ * w_start_ / (limit * rules_.clearly_below)));
  for (int i = 0; i < static_cast<int>(rules_.rounds);
       ++i, steps = std::ceil(rules_.doubt * steps)) {
    const Trial& trial = runs_.make(method, until_ / steps);
    if (runs_.is_sound(trial)) return &trial;
    const Outcome outcome = trial.summary.outcome;
    if (outcome == Outcome::over_budget || outcome == Outcome::went_slack) break;
  }
  return nullptr;
}

// Whether there is a forecast; begins one along the trial if its motion vibrates.
bool Search::may_forecast(const Trial& trial) {
  if (forecast_) return true;
  if (system_.switching() || is_constrained(system_)) return false;
  double w = runs_.bound_of_w();
  for (const State& state : trial.path) w = std::max(w, frequency_bound(system_, state.q));
  if (!(w > 0) || !std::isfinite(w)) return false;
  forecast_.emplace(runs_, trial.path, w);
  return true;
}

// The explicit run of fixed steps that is expected to have the error with the fewest forces; as a
// check of a run, whatever doubt there is about the ratio of the two errors. Errors of such runs
// fall by their order from the first one on. Forces of a method that was not seen count `unseen`
// times.
std::optional<Candidate> Search::explicit_candidate(double error, const Method* checked,
                                                    double unseen) const {
  std::optional<Candidate> best;
  double least = INFINITY;
  for (const Candidate& c : forecast_->candidates(error)) {
    if (!is_forecast_by_frequency(*c.method) || runs_.find(*c.method, c.value)) continue;
    const double doubt = checked ? forecast_->doubt(*c.method, *checked) : 1;
    const auto own = doubt > 1 ? forecast_->candidate(*c.method, error / doubt) : c;
    // Largest steps are limited, and whole numbers of steps rounded.
    const double most = (1 + rules_.small * rules_.small) * error / doubt;
    if (!own || own->error > most) continue;
    const bool has_run =
        std::ranges::find(runs_.all(), c.method, &Trial::method) != runs_.all().end();
    const double forces = own->forces * (has_run ? 1 : unseen);
    if (forces >= least) continue;
    least = forces;
    best = own;
  }
  return best;
}

// Takes the finer run of a pair as a judge, and the coarser one, if the finer one's error is
// expected to be at most this share of the other.
void Search::accept_pair(const Trial& coarse, const Trial& fine, double share) {
  const double between = runs_.distance_on_the_way(coarse, fine);
  // Errors may not fall by their order. The finer one's is then still at most half of the other.
  double own = between;
  // The motion keeps its energy, so that what a run gains bounds its error from below.
  const double kinetic = runs_.stage().scales().kinetic;
  double told = rules_.small * fine.energy_gain;
  // A force that turns within a step gives both runs a wrong push, and other steps another one. Two
  // may be near each other by chance, but the error of the energy does not fall.
  if (fine.energy_gap > rules_.drawn_together * coarse.energy_gap)
    told = std::max(told, rules_.doubt_of_two() * fine.energy_gap);
  // Rounding tells nothing of steps.
  if (kinetic > 0 && told > own * kinetic &&
      rules_.small * rules_.small * fine.energy_gap > kinetic * runs_.stage().energy_rounding(fine))
    own = told / kinetic;
  check_.accept(coarse, {std::max(rules_.doubt * between / (1 - share), own + between), &fine});
  check_.accept(fine, {own, &coarse, true});
}

// Whether a run has the accuracy, by a finer one that was to be checked itself.
bool Search::is_enough(const Trial& run, const Trial& finer, double accuracy) {
  runs_.measure_by(finer);
  const double between = runs_.distance_on_the_way(run, finer);
  const double share = forecast_->error(*finer.method, finer.value) / between;
  if (!(share <= 1 / rules_.finer) ||
      rules_.doubt * between / (1 - share) > rules_.clearly_below * accuracy)
    return false;
  accept_pair(run, finer, share);
  check_.condition(run, accuracy);
  if (check_.conditioning() && check_.is_known(run, accuracy)) return true;
  check_.set({});
  return false;
}

// A run chosen to have a part of the accuracy as its error, and a run that checks it; the check
// begins one rounding away. Each distance corrects the forecast for the next pair.
bool Search::judge_by_forecast(double accuracy) {
  const Trial* first = survey();
  if (!first) return false;
  runs_.measure_by(*first);
  const double growth =
      growth_of_frequency(model_, first->path, runs_.bound_of_w(), runs_.places(forces_a_bound));
  // The bound of w_max may grow more than w_max does. The run was stable.
  forecast_.emplace(runs_, first->path,
                    std::min(w_start_ * growth, linear_limit(*first->method) / first->value));
  // A pair's bound of the coarser error is then clearly below the accuracy.
  const double aim = rules_.clearly_below * (1 - 1 / rules_.finer) / rules_.doubt * accuracy;
  const Trial* tried = first;
  bool is_kept = false;  // whether it was a check and is to be checked itself
  std::optional<double> effect_on_first;
  for (int round = 0; round < static_cast<int>(rules_.rounds) && runs_.seconds_left() > 0;
       ++round) {
    const double unseen = round == 0 ? 1 : rules_.doubt;
    double error = forecast_->error(*tried->method, tried->value);
    if (!(error <= aim) && !is_kept) {
      const auto next = explicit_candidate(aim, nullptr, unseen);
      if (!next) return false;
      const Trial& trial = runs_.make(*next->method, next->value);
      forecast_->learn(check_);
      if (!runs_.is_sound(trial)) continue;
      tried = &trial;
      error = forecast_->error(*trial.method, trial.value);
      if (is_enough(*first, trial, accuracy)) return true;
    }
    // A long run that is far more accurate than need be has a check that is hardly finer: where
    // vibrations bound the steps, that takes 1.4 times its work and not twice.
    const bool is_long =
        runs_.forces(*tried) > static_cast<double>(runs_.forces_within(rules_.much_work));
    const double finer = is_long && error <= rules_.small * accuracy ? rules_.doubt : rules_.finer;
    const auto chosen = explicit_candidate(error / finer, tried->method, std::sqrt(rules_.doubt));
    if (!chosen) return false;
    // The run may be more accurate than it was to be. It then checks one that takes less work than
    // its own check.
    const auto cheaper =
        explicit_candidate(rules_.clearly_below * rules_.clearly_below / rules_.doubt * accuracy,
                           nullptr, std::sqrt(rules_.doubt));
    if (!is_kept && cheaper && cheaper->forces < chosen->forces &&
        error <= cheaper->error / rules_.finer) {
      const Trial& trial = runs_.make(*cheaper->method, cheaper->value);
      forecast_->learn(check_);
      if (runs_.is_sound(trial) && is_enough(trial, *tried, accuracy)) return true;
    }
    // One of the two is pushed.
    const bool is_pushed = !tried->is_pushed;
    const Trial* made = runs_.find(*chosen->method, chosen->value, is_pushed);
    if (!made && is_pushed) made = &runs_.make_pushed(*chosen->method, chosen->value);
    if (!made) made = &runs_.make(*chosen->method, chosen->value);
    const Trial& checked = *made;
    const Trial& unpushed = is_pushed ? *tried : checked;
    forecast_->learn(check_);
    if (!runs_.is_sound(checked)) continue;
    runs_.measure_by(checked);
    const double between = runs_.distance_on_the_way(*tried, checked);
    const double share = std::max(1 / finer, chosen->error / error);
    accept_pair(*tried, checked, share);
    forecast_->learn(check_);
    forecast_->learn(*tried, between / (1 - share));
    // The check's own bound may do where that of the run does not.
    const Trial* known = tried;
    double pushed_by = std::max(between, runs_.distance(*tried, checked));
    if (!check_.is_known(*tried, accuracy) &&
        check_.error_of(checked) <= rules_.clearly_below * accuracy) {
      known = is_pushed ? &runs_.make(*checked.method, checked.value) : &checked;
      if (is_pushed) pushed_by = runs_.distance(*known, checked);
    }
    if (check_.is_known(*known, accuracy)) {
      // The first run tells cheaply what rounding does; one that resolves the motion, if need be.
      const auto is_known_beside_rounding = [&] {
        return check_.conditioning() && check_.is_known(*known, accuracy);
      };
      check_.condition_by_pair(*known, pushed_by, *first, accuracy);
      if (!is_known_beside_rounding() && known != first) check_.condition(*known, accuracy);
      return is_known_beside_rounding();
    }
    // Runs that should be near each other and are not: rounding may be the reason. The first run
    // tells cheaply whether it leaves nothing known.
    if (between > rules_.small) {
      if (!effect_on_first) {
        check_.condition(*first, accuracy);
        if (check_.is_hopeless(rules_.small)) return false;
        effect_on_first = check_.conditioning() ? check_.conditioning()->worst() : INFINITY;
        check_.set({});
      }
    }
    const bool is_calm = effect_on_first && *effect_on_first <= rules_.small * accuracy;
    if (round > 0 && !is_calm && !check_.conditioning()) check_.condition(unpushed, accuracy);
    if (check_.is_hopeless(accuracy)) return false;
    // Errors so much larger than the forecast show no order: at first, and once it has learned.
    const double unforeseen = round == 0 ? rules_.small * rules_.small : rules_.small;
    if (between > (round == 0 ? rules_.small : accuracy) && error < unforeseen * between)
      return false;
    // The check may be the run that a finer one checks, which may be the answer then.
    is_kept = forecast_->error(*checked.method, checked.value) <= rules_.clearly_below * accuracy;
    if (is_kept) tried = &checked;
  }
  return false;
}

}  // namespace qddot::inline measure

#include "qddot/integrators/spring_changes.hpp"

#include <algorithm>
#include <cmath>

#include "qddot/model/machine_epsilon.hpp"

namespace qddot {
namespace {

// Newton's method doubles the digits of each try, and a try beyond the moment costs one more.
constexpr int most_tries = 40;
// Times that are as close are one moment.
constexpr double moment_roundings = 8;
// The part of a step to which a cubic's ends of phases are told apart, see first_below().
constexpr double same_moment = 1e-5;

double rounding_of(double t) { return moment_roundings * machine_epsilon * std::abs(t); }

}  // namespace

// A jump in the derivative k of f changes a step across it by h^(k+1) and less.
bool steps_over_slack(int order, const System& system) {
  if (!system.switching()) return false;
  const std::optional<int> slack = system.switching()->order_of_slack();
  // A jump of f itself may leave an implicit equation without a solution.
  return slack && *slack > 0 && order > 0 && order <= *slack + 1;
}

SpringChanges::SpringChanges(const System& system, int order, double rtol)
    : switching_(system.switching()), rtol_(rtol) {
  if (!switching_) return;
  finds_slack_ = switching_->order_of_slack() && !steps_over_slack(order, system);
  phases_.resize(static_cast<std::size_t>(switching_->phase_count()));
  has_changed_.resize(phases_.size());
}

void SpringChanges::clear() {
  breaks_.clear();
  count_ = 0;
}

void SpringChanges::begin(const State& state) {
  if (!switching_) return;
  broken_ = state.phases;
  if (broken_) {
    phases_ = *broken_;
  } else {
    std::ranges::fill(phases_, Phase::by_length);
  }
  switching_->set_phases(state, finds_slack_, phases_);
  std::erase_if(breaks_, [&](const Break& one) { return one.t > state.t; });
  target_.reset();
  at_once_ = 0;
  last_ = state.t;
  std::ranges::fill(has_changed_, 0);
}

bool SpringChanges::passes_end(const State& from, const State& to) {
  passed_ = switching_->first_change(from, to, phases_,
                                     {has_changed_, rtol_ * from.q.lpNorm<Eigen::Infinity>()});
  // The place that is looked for is a little beyond the end of its phase at first, and so may those
  // be that end with it. The next tries come closer.
  if (passed_ && target_) {
    const double same = same_moment * (target_->t - from.t) + rounding_of(from.t);
    if (passed_->t >= target_->t - same) return false;
  }
  if (passed_) {
    before_passed_ = from;
    return true;
  }
  return false;
}

bool SpringChanges::is_at_moment() const {
  return !(target_->t > before_.t + rounding_of(before_.t));
}

void SpringChanges::aim() {
  target_ = passed_;
  std::swap(before_, before_passed_);
  tries_ = 0;
}

SpringChanges::Landing SpringChanges::land(State& state) {
  const Switching::Change looked_for = *target_;
  At at(state);
  at.phases = phases_.data();
  const Switching::Margin margin = switching_->margin(at, looked_for.number, looked_for.to);
  const double rounded = rounding_of(state.t);
  const double left = margin.rate != 0 ? -margin.length / margin.rate : 0;
  const bool is_there = std::abs(margin.length) <= margin.rounding || std::abs(left) <= rounded;
  if (!is_there && ++tries_ < most_tries) {
    if (margin.length > 0) {
      if (!(margin.rate < 0)) {
        target_.reset();
        return Landing::missed;
      }
      before_ = state;
      target_->t = state.t + left;
      return Landing::closer;
    }
    // The next try had better end before the moment than beyond it: it is then kept.
    const double whole = state.t - before_.t;
    const double back = margin.rate < 0 ? std::min(1.5 * -left, whole / 2) : whole / 2;
    if (whole - back > rounded) {
      target_->t = state.t - back;
      return Landing::beyond;
    }
  }
  due_.clear();
  switching_->add_due_changes(at, phases_, due_);
  if (tries_ < most_tries && goes_back_for_others(at)) return Landing::beyond;
  target_.reset();
  change(looked_for, state);
  for (const Switching::Change& also : due_) {
    const bool is_broken = phases_[static_cast<std::size_t>(also.number)] == Phase::broken;
    if (also.number != looked_for.number && !is_broken) change(also, state);
  }
  if (!(state.t > last_ + rounded)) {
    if (++at_once_ > 4 * switching_->phase_count() + 16) return Landing::endless;
  } else {
    at_once_ = 0;
    last_ = state.t;
  }
  return Landing::changed;
}

// Whether another spring has passed the end of its phase by more than rounding: it was too near to
// be told apart from the first one. Then it is looked for.
bool SpringChanges::goes_back_for_others(const At& at) {
  const double allowance = rtol_ * at.q.lpNorm<Eigen::Infinity>();
  double back = 0;
  for (const Switching::Change& also : due_) {
    const bool has_changed =
        has_changed_[static_cast<std::size_t>(also.number)] && also.to != Phase::broken;
    const Switching::Margin margin = switching_->margin(at, also.number, also.to);
    const double beyond = -margin.length - 4 * margin.rounding - (has_changed ? allowance : 0);
    if (!(beyond > 0) || !(beyond / -margin.rate > back)) continue;
    back = beyond / -margin.rate;
    target_ = also;
  }
  if (back <= 2 * rounding_of(at.t) || !(at.t - back > before_.t + rounding_of(at.t))) return false;
  target_->t = at.t - back;
  ++tries_;
  return true;
}

void SpringChanges::change(const Switching::Change& change, State& state) {
  if (change.to == Phase::broken) {
    At at(state);
    at.phases = phases_.data();
    const double energy = switching_->energy_of(at, change.number);
    breaks_.push_back({state.t, change.number, switching_->strain_of(at, change.number), energy});
    state.work.released += energy;
    std::vector<Phase> broken =
        broken_ ? *broken_ : std::vector<Phase>(phases_.size(), Phase::by_length);
    broken[static_cast<std::size_t>(change.number)] = Phase::broken;
    broken_ = std::make_shared<const std::vector<Phase>>(std::move(broken));
  }
  phases_[static_cast<std::size_t>(change.number)] = change.to;
  has_changed_[static_cast<std::size_t>(change.number)] = 1;
  ++count_;
  state.phases = broken_;
}

}  // namespace qddot

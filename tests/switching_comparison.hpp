#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <exception>
#include <map>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "qddot/integrators/registry.hpp"
#include "qddot/scene/model.hpp"
#include "tests/method_comparisons.hpp"
#include "tests/random_switching.hpp"

namespace qddot {
inline namespace tests {

// All nodes of a scene at one time.
using Nodes = std::vector<Node>;

// The motion of a scene with springs that go slack and break, by the independent model; and how
// well any other code can know it.
class KnownSwitching {
 public:
  explicit KnownSwitching(const Scene& scene);

  const Scene& scene() const { return scene_; }
  double until() const { return *scene_.until; }
  // A time on the way at which motions are compared, too.
  double on_the_way() const { return 0.618 * until(); }
  // The reason why no other code need agree; empty if all must.
  const std::string& why_unknown() const { return why_unknown_; }
  // The factor by which a disturbance of the start [m, m/s] grows by the end; at least 1.
  double growth() const { return growth_; }
  const std::vector<HoldChange>& changes() const { return changes_; }
  std::vector<HoldChange> breaks() const {
    std::vector<HoldChange> gone = changes_;
    std::erase_if(gone, [](const HoldChange& one) { return one.to != Hold::gone; });
    return gone;
  }
  // Whether each change is so clear that a method finds it which is off by some 1e-5.
  bool is_clear() const { return is_clear_; }
  double released() const { return released_; }
  double dissipated() const { return dissipated_; }
  double energy_size() const { return energy_size_; }
  double length() const { return length_; }

  // The largest difference of a position or a velocity over the largest displacement or speed.
  double difference(const Nodes& a, const Nodes& b) const;
  double error_at_end(const Nodes& nodes) const { return difference(nodes, end_); }
  double error_on_the_way(const Nodes& nodes) const { return difference(nodes, on_the_way_); }

 private:
  Nodes nodes_of(const SwitchingMotion& motion) const;
  void set_sizes(const SwitchingMotion& motion, double start_energy);
  // Whether the motion itself says why it is unknown.
  bool is_on_edge(const SwitchingMotion& motion);
  void disturb();

  Scene scene_;
  std::string why_unknown_{};
  std::vector<HoldChange> changes_{};
  Nodes on_the_way_{}, end_{};
  double growth_ = 1, length_ = 1, speed_ = 1, energy_size_ = 1, released_ = 0, dissipated_ = 0;
  bool is_clear_ = true;
};

// A run by one of qddot's methods.
struct SwitchingRun {
  Summary summary{};
  Nodes on_the_way{}, end{};
  double released = 0, dissipated = 0;  // [J]
  std::vector<Break> breaks{};          // by the scene's numbers
  std::string thrown{};
};

inline KnownSwitching::KnownSwitching(const Scene& scene) : scene_(scene) {
  SwitchingMotion motion(scene);
  const double start_energy = static_cast<double>(motion.energy());
  const bool is_whole = motion.advance(on_the_way());
  on_the_way_ = nodes_of(motion);
  if (!is_whole || !motion.advance(until())) {
    why_unknown_ = "too many steps";
    return;
  }
  end_ = nodes_of(motion);
  changes_ = motion.changes();
  set_sizes(motion, start_energy);
  if (!is_on_edge(motion)) disturb();
}

inline Nodes KnownSwitching::nodes_of(const SwitchingMotion& motion) const {
  Nodes nodes = scene_.nodes;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    nodes[i].position = motion.position(i);
    nodes[i].velocity = motion.velocity(i);
  }
  return nodes;
}

inline void KnownSwitching::set_sizes(const SwitchingMotion& motion, double start_energy) {
  speed_ = static_cast<double>(motion.fastest());
  length_ = std::max(static_cast<double>(motion.farthest()), speed_ * until());
  released_ = static_cast<double>(motion.released());
  dissipated_ = start_energy - static_cast<double>(motion.energy()) - released_;
  double mass = 0;
  for (const Node& node : scene_.nodes) mass += node.pinned ? 0 : node.mass;
  energy_size_ = std::max({0.5 * mass * speed_ * speed_, dissipated_, released_});
}

inline bool KnownSwitching::is_on_edge(const SwitchingMotion& motion) {
  // A spring that breaks as slowly may as well not break, in a run that is off by 1e-5.
  constexpr double slow = 0.05;       // [m/s]
  constexpr double near_miss = 1e-4;  // of the rest length
  if (static_cast<double>(motion.smallest_rate()) < 1e-6) why_unknown_ = "grazing";
  is_clear_ = static_cast<double>(motion.smallest_rate()) > slow;
  // Errors of 1e-5 move a change beyond the end.
  const auto is_late = [&](const HoldChange& one) { return one.t > 0.999L * until(); };
  if (std::ranges::any_of(changes_, is_late)) is_clear_ = false;
  for (std::size_t e = 0; e < scene_.springs.size(); ++e) {
    const SpringLaw& law = scene_.springs[e].law;
    const bool is_near = static_cast<double>(motion.least_margin(e)) < near_miss * law.rest_length;
    if (!is_near) continue;
    is_clear_ = false;
    if (law.can_break()) why_unknown_ = "nearly breaking";
  }
  const auto gone = breaks();
  for (std::size_t i = 0; i < gone.size(); ++i) {
    if (!gone[i].is_at_start && std::abs(static_cast<double>(gone[i].rate)) < slow)
      why_unknown_ = "grazing";
    const double gap = i > 0 ? static_cast<double>(gone[i].t - gone[i - 1].t) : INFINITY;
    // Images break together to the last digits of long double.
    if (gap > 1e-13 && gap < 1e-9) why_unknown_ = "breakings too close";
  }
  return !why_unknown_.empty();
}

// Moves the start by 1e-10. The motion is known if all springs still do the same.
inline void KnownSwitching::disturb() {
  constexpr double by = 1e-10;
  std::mt19937_64 random(1);
  const auto any = [&] { return by * (static_cast<double>(random() >> 11) * 0x1p-52 - 1); };
  SwitchingMotion moved(scene_, 1e-17L);
  for (std::size_t i = 0; i < scene_.nodes.size(); ++i) {
    if (scene_.nodes[i].pinned) continue;
    for (std::size_t d = 0; d < static_cast<std::size_t>(scene_.dimension); ++d)
      moved.displace(i, d, any(), any());
  }
  if (!moved.advance(on_the_way()) || !moved.advance(until())) {
    why_unknown_ = "too many steps";
    return;
  }
  // The state of each spring; at the start some begin at their rest lengths.
  const auto by_spring = [&](const std::vector<HoldChange>& all) {
    std::vector<std::vector<Hold>> own(scene_.springs.size());
    for (const HoldChange& one : all) {
      if (!one.is_at_start || one.to == Hold::gone) own[one.spring].push_back(one.to);
    }
    return own;
  };
  const double off = difference(nodes_of(moved), end_) * std::max(length_, speed_);
  growth_ = std::max(1.0, off / by);
  if (by_spring(moved.changes()) != by_spring(changes_)) why_unknown_ = "another order of events";
  // Then errors of 1e-8 stay in sight.
  if (off > 1e-6) why_unknown_ = "ill conditioned";
}

inline double KnownSwitching::difference(const Nodes& a, const Nodes& b) const {
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double apart = std::max((a[i].position - b[i].position).norm() / length_,
                                  (a[i].velocity - b[i].velocity).norm() / speed_);
    if (!(apart <= largest)) largest = apart;
  }
  return largest;
}

// Compares methods with a known motion.
class SwitchingComparison {
 public:
  explicit SwitchingComparison(const KnownSwitching& known) : known_(known) {}

  // Runs the method twice, with half the step or a smaller tolerance the second time.
  void compare(const Method& method, const Model& model, const std::string& where);
  const MethodComparisons& results() const { return all_; }

 private:
  // The largest of all errors, each over its size.
  double error(const SwitchingRun& run) const {
    return std::max({known_.error_at_end(run.end), known_.error_on_the_way(run.on_the_way),
                     std::abs(run.released - known_.released()) / known_.energy_size(),
                     std::abs(run.dissipated - known_.dissipated()) / known_.energy_size()});
  }
  double apart(const SwitchingRun& a, const SwitchingRun& b) const {
    return std::max({known_.difference(a.end, b.end), known_.difference(a.on_the_way, b.on_the_way),
                     std::abs(a.released - b.released) / known_.energy_size(),
                     std::abs(a.dissipated - b.dissipated) / known_.energy_size()});
  }
  // An error that a smaller knob does not lessen is none of the method. Runs round to 1e-16, some
  // thousand steps of them to 1e-11 of sizes at most.
  double allowed_after(const SwitchingRun& run, const SwitchingRun& before) const {
    constexpr double irregular = 30, rounding = 1e-11;
    return irregular * apart(run, before) + rounding * known_.growth();
  }
  SwitchingRun run(const Method& method, const Model& model, double knob, bool is_observed) const;
  double longest_step(const Method& method) const;
  bool breaks_as_known(const SwitchingRun& run) const;
  std::string words(const SwitchingRun& run) const;
  void compare_adaptive(const Method& method, const Model& model, const std::string& where);
  void compare_fixed(const Method& method, const Model& model, const std::string& where);
  // Whether the run reached its end.
  bool ended(const SwitchingRun& run, const std::string& where);
  void compare_observed(const Method& method, const Model& model, double knob,
                        const SwitchingRun& run, const std::string& where);
  // `allowed`: of the error of a position over lengths.
  void compare_breaks(const SwitchingRun& run, double allowed, const std::string& where);
  void compare_count(const Method& method, const SwitchingRun& run, const std::string& where);
  void disagree(std::string sentence) { all_.disagreements.push_back(std::move(sentence)); }

  const KnownSwitching& known_;
  MethodComparisons all_{};
};

inline void SwitchingComparison::compare(const Method& method, const Model& model,
                                         const std::string& where) {
  if (!applies_to(method, model.system())) {
    ++all_.refused;
    return;
  }
  const std::string own = fmt::format("{}{}", method.name, where);
  if (method.knob == Knob::rtol) {
    compare_adaptive(method, model, own);
  } else {
    compare_fixed(method, model, own);
  }
}

inline SwitchingRun SwitchingComparison::run(const Method& method, const Model& model, double knob,
                                             bool is_observed) const {
  SwitchingRun run;
  Options options{.length = known_.length(), .speed = known_.length() / known_.until()};
  (method.knob == Knob::step_size ? options.step_size : options.rtol) = knob;
  options.most_forces = 3'000'000;  // a hundred times what the longest run takes
  State state = model.initial();
  Observer observer;
  if (is_observed) observer.times = {known_.on_the_way()};
  observer.see = [&](const State& seen) { run.on_the_way = model.expand(seen); };
  try {
    const auto integrator = make_integrator(method, model.system(), options);
    run.summary = integrator->advance(state, known_.until(), observer);
  } catch (const std::exception& error) {
    run.thrown = error.what();
    return run;
  }
  run.end = model.expand(state);
  run.released = model.released(state);
  run.dissipated = model.dissipated(state);
  for (Break one : run.summary.breaks) {
    one.number = static_cast<Index>(model.general_springs()[static_cast<std::size_t>(one.number)]);
    run.breaks.push_back(one);
  }
  return run;
}

// A step that resolves the fastest vibration, and that dashpots let be stable.
inline double SwitchingComparison::longest_step(const Method& method) const {
  const Scene& scene = known_.scene();
  std::vector<double> squares(scene.nodes.size()), rates(scene.nodes.size());
  for (const Spring& spring : scene.springs) {
    const SpringLaw& law = spring.law;
    // Lengths change by a third of rest lengths.
    const double s = law.rest_length / 3;
    const double k = law.stiffness + 2 * std::abs(law.cubic) * s + 3 * law.quartic * s * s;
    for (const std::size_t node : spring.nodes) {
      if (scene.nodes[node].pinned) continue;
      squares[node] += 2 * k / scene.nodes[node].mass;
      rates[node] += 2 * law.damping / scene.nodes[node].mass;
    }
  }
  const double w = std::sqrt(std::ranges::max(squares)), rate = std::ranges::max(rates);
  const double part = method.order <= 1   ? 0.005
                      : method.order <= 2 ? 0.05
                      : method.order <= 4 ? 0.15
                                          : 0.4;
  return known_.until() / std::ceil(known_.until() * std::max(w / part, 4 * rate));
}

inline bool SwitchingComparison::ended(const SwitchingRun& run, const std::string& where) {
  if (!run.thrown.empty()) {
    disagree(fmt::format("{}: throws: {}", where, run.thrown));
    return false;
  }
  if (run.summary.outcome == Outcome::reached_end) return true;
  disagree(fmt::format("{}: ends with {} at {:.9g} of {:.9g} s: {}", where,
                       name(run.summary.outcome), run.summary.t_reached, known_.until(),
                       run.summary.message));
  return false;
}

inline bool SwitchingComparison::breaks_as_known(const SwitchingRun& run) const {
  std::vector<std::size_t> own, expected;
  for (const Break& one : run.breaks) own.push_back(static_cast<std::size_t>(one.number));
  for (const HoldChange& one : known_.breaks()) expected.push_back(one.spring);
  std::ranges::sort(own);
  std::ranges::sort(expected);
  return own == expected;
}

inline std::string SwitchingComparison::words(const SwitchingRun& run) const {
  std::string all;
  for (const Break& one : run.breaks) all += fmt::format(" {} at {:.12g},", one.number, one.t);
  all += " expected";
  for (const HoldChange& one : known_.breaks())
    all += fmt::format(" {} at {:.12g},", one.spring, static_cast<double>(one.t));
  return all;
}

inline void SwitchingComparison::compare_breaks(const SwitchingRun& run, double allowed,
                                                const std::string& where) {
  if (!breaks_as_known(run)) {
    disagree(fmt::format("{}: other springs break:{}", where, words(run)));
    return;
  }
  if (!std::ranges::is_sorted(run.breaks, {}, &Break::t))
    disagree(fmt::format("{}: breakings are not in order:{}", where, words(run)));
  for (const HoldChange& expected : known_.breaks()) {
    const auto own =
        std::ranges::find(run.breaks, static_cast<Index>(expected.spring), &Break::number);
    // Lengths are off by no more than positions.
    const double rate = std::abs(static_cast<double>(expected.rate));
    const double latest =
        expected.is_at_start ? 1e-7 : 4 * allowed * known_.length() / rate + 1e-12;
    const double off = std::abs(own->t - static_cast<double>(expected.t));
    if (!(off <= latest)) {
      disagree(fmt::format("{}: spring {} breaks {:.3g} s off, at {:.12g} s; allowed are {:.3g}",
                           where, own->number, off, own->t, latest));
    }
    // A step lands on the strain to roundings of lengths, and what it holds follows.
    constexpr double rounding = 1e-10;
    const double strain = static_cast<double>(expected.strain);
    const double energy = static_cast<double>(expected.energy);
    if (!(std::abs(own->strain - strain) <= rounding * (1 + strain)) ||
        !(std::abs(own->energy - energy) <= rounding / strain * energy + rounding)) {
      disagree(
          fmt::format("{}: spring {} breaks at strain {:.15g} with {:.15g} J, not at {:.15g} "
                      "with {:.15g} J",
                      where, own->number, own->strain, own->energy, strain, energy));
    }
  }
}

// A method that lands on each change counts as many as there are.
inline void SwitchingComparison::compare_count(const Method& method, const SwitchingRun& run,
                                               const std::string& where) {
  if (!known_.is_clear()) return;
  std::int64_t gone = 0, all = 0, at_start = 0;
  bool has_dashpots = false, has_cables = false;
  for (const Spring& spring : known_.scene().springs) {
    has_cables = has_cables || spring.law.goes_slack();
    has_dashpots = has_dashpots || (spring.law.goes_slack() && spring.law.damping > 0);
  }
  for (const HoldChange& one : known_.changes()) {
    gone += one.to == Hold::gone;
    at_start += one.to != Hold::gone && one.is_at_start;
    ++all;
  }
  // Dashpots make f itself jump there, cables without them its derivative. Beside both, methods of
  // order 2 step over some.
  const bool finds = has_cables && method.order > (has_dashpots ? 1 : 2);
  const bool finds_some = finds && method.order == 2;
  if (!finds) all = gone, at_start = 0;
  const std::int64_t own = run.summary.phase_changes;
  if (own < (finds_some ? gone : all - at_start) || own > all + at_start)
    disagree(fmt::format("{}: {} changes of phases, not {}", where, own, all));
}

inline void SwitchingComparison::compare_observed(const Method& method, const Model& model,
                                                  double knob, const SwitchingRun& seen,
                                                  const std::string& where) {
  if (method.ends_steps_at_looks()) return;
  ++all_.runs;
  const SwitchingRun alone = run(method, model, knob, false);
  if (!ended(alone, where)) return;
  if (known_.difference(alone.end, seen.end) != 0)
    disagree(fmt::format("{}: moves otherwise by {:.3g} if it is seen", where,
                         known_.difference(alone.end, seen.end)));
}

inline void SwitchingComparison::compare_adaptive(const Method& method, const Model& model,
                                                  const std::string& where) {
  constexpr double coarse = 1e-6, fine = 1e-8;
  all_.runs += 2;
  const SwitchingRun first = run(method, model, coarse, true);
  const SwitchingRun second = run(method, model, fine, true);
  if (!ended(first, where + " at 1e-6") || !ended(second, where + " at 1e-8")) return;
  compare_observed(method, model, fine, second, where + " at 1e-8");
  // As in the suite `order`: multistep methods err by up to 1100 tolerances. The growth is of one
  // disturbance at the start; others grow more.
  const double allowed = (method.varies_order() ? 2000 : 300) * fine * known_.growth();
  const double off = error(second), moved = apart(first, second);
  all_.tolerances[method.name].push_back(off / (fine * known_.growth()));
  if (!(off <= allowed))
    disagree(fmt::format("{} at 1e-8: {:.3g} off; allowed are {:.3g}, growth {:.3g}", where, off,
                         allowed, known_.growth()));
  if (!(off <= allowed_after(second, first)))
    disagree(fmt::format("{}: {:.3g} off, where it changed by {:.3g}", where, off, moved));
  compare_breaks(second, allowed, where + " at 1e-8");
  compare_count(method, second, where + " at 1e-8");
}

inline void SwitchingComparison::compare_fixed(const Method& method, const Model& model,
                                               const std::string& where) {
  double h = longest_step(method);
  std::vector<SwitchingRun> runs;
  // A long step may pass a maximum of a strain; then more are needed.
  constexpr std::size_t most_runs = 5;
  while (runs.size() < most_runs) {
    if (!runs.empty()) h /= 2;
    ++all_.runs;
    runs.push_back(run(method, model, h, true));
    if (!ended(runs.back(), fmt::format("{} at {:.6g}", where, h))) return;
    if (runs.size() > 1 && breaks_as_known(runs.back())) {
      // Errors of two runs may be alike by chance, most so those of steps over slack moments.
      const SwitchingRun &last = runs.back(), &before = runs[runs.size() - 2];
      if (breaks_as_known(before) && error(last) <= allowed_after(last, before)) break;
    }
  }
  const std::string named = fmt::format("{} at {:.6g}", where, h);
  const SwitchingRun &last = runs.back(), &before = runs[runs.size() - 2];
  compare_observed(method, model, h, last, named);
  const double off = error(last), was = error(before), moved = apart(last, before);
  const double allowed = allowed_after(last, before);
  if (!(off <= allowed))
    disagree(fmt::format("{}: {:.3g} off, where it changed by {:.3g}", named, off, moved));
  // The step resolves the fastest vibration; methods of low order leave some percent.
  const double most = 0.1 * known_.growth();
  if (!(off <= most)) disagree(fmt::format("{}: {:.3g} off", named, off));
  compare_breaks(last, allowed, named);
  // A step of a high order leaves less than 1e-5, which clear changes are clear to.
  if (off < 1e-5) compare_count(method, last, named);
  // Rounding hides the order below.
  if (off > 1e-8 * known_.growth()) all_.orders[method.name].push_back(std::log2(was / off));
}

}  // namespace tests
}  // namespace qddot

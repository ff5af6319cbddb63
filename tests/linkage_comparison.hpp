#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <exception>
#include <initializer_list>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "qddot/integrators/registry.hpp"
#include "qddot/scene/model.hpp"
#include "tests/method_comparisons.hpp"
#include "tests/random_linkage.hpp"

namespace qddot {
inline namespace tests {

// All nodes of a scene at one time.
using Nodes = std::vector<Node>;

// The largest of errors; one that is no number is larger than any.
inline double largest_error(std::initializer_list<double> errors) {
  double largest = 0;
  for (const double own : errors)
    largest = std::isnan(own) ? std::numeric_limits<double>::infinity() : std::max(largest, own);
  return largest;
}

// The motion of a scene with rods by the independent model, and how well any other code can know
// it.
class KnownLinkage {
 public:
  explicit KnownLinkage(const Scene& scene);

  const Scene& scene() const { return scene_; }
  double until() const { return *scene_.until; }
  // A time on the way at which motions are compared, too.
  double on_the_way() const { return 0.618 * until(); }
  // The reason why no other code need agree; empty if all must.
  const std::string& why_unknown() const { return why_unknown_; }
  // The factor by which a disturbance of the start grows by the end; at least 1.
  double growth() const { return growth_; }
  double length() const { return length_; }
  // The fastest vibration, turn or support [rad/s], and the fastest decay [1/s].
  double fastest() const { return fastest_; }
  double decay() const { return decay_; }
  Eigen::Index freedoms() const { return freedoms_; }

  // The largest difference of a position or a velocity over the largest displacement or speed.
  double difference(const Nodes& a, const Nodes& b) const;
  double error_at_end(const Nodes& nodes) const { return difference(nodes, end_); }
  double error_on_the_way(const Nodes& nodes) const { return difference(nodes, on_the_way_); }
  // The largest difference of tensions [N], by the scene's numbers, over the largest of the motion.
  double difference(const std::vector<double>& a, const std::vector<double>& b) const;
  double tension_error(const std::vector<double>& tensions) const {
    return difference(tensions, tensions_);
  }
  // The error of an energy lost [J] to dashpots and air, less that gained from supports.
  double loss_error(double loss) const { return std::abs(loss - loss_) / energy_size_; }
  // By what rods are too long or short, over lengths, or grow, over the largest speed.
  double stretch(const Nodes& nodes) const;

 private:
  Nodes nodes_of(const LinkageMotion& motion) const;
  void set_sizes(const LinkageMotion& motion, double start_energy);
  void disturb();

  Scene scene_;
  std::string why_unknown_{};
  Nodes on_the_way_{}, end_{};
  std::vector<double> tensions_{};
  double growth_ = 1, length_ = 1, speed_ = 1, energy_size_ = 1, loss_ = 0, tension_ = 1;
  double fastest_ = 0, decay_ = 0;
  Eigen::Index freedoms_ = 0;
};

inline KnownLinkage::KnownLinkage(const Scene& scene) : scene_(scene) {
  LinkageMotion motion(scene);
  const auto start_energy = static_cast<double>(motion.energy());
  const bool is_halfway = motion.advance(on_the_way());
  on_the_way_ = nodes_of(motion);
  if (!is_halfway || !motion.advance(until())) {
    why_unknown_ = motion.why_stopped();
    return;
  }
  end_ = nodes_of(motion);
  set_sizes(motion, start_energy);
  // Fixed steps of low order would be millions.
  constexpr double most_radians = 2000;
  if (fastest_ * until() > most_radians) why_unknown_ = "too fast";
  if (why_unknown_.empty()) disturb();
}

inline Nodes KnownLinkage::nodes_of(const LinkageMotion& motion) const {
  Nodes nodes = scene_.nodes;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    nodes[i].position = motion.position(i);
    nodes[i].velocity = motion.velocity(i);
  }
  return nodes;
}

inline void KnownLinkage::set_sizes(const LinkageMotion& motion, double start_energy) {
  // Supports may move where nothing else does.
  speed_ = std::max(static_cast<double>(motion.fastest()), 1e-3);
  length_ = std::max(static_cast<double>(motion.farthest()), speed_ * until());
  loss_ = start_energy - static_cast<double>(motion.energy());
  double mass = 0;
  for (const Node& node : scene_.nodes) mass += node.pinned ? 0 : node.mass;
  energy_size_ = std::max(0.5 * mass * speed_ * speed_, std::abs(loss_));
  for (const auto tension : motion.tensions()) tensions_.push_back(static_cast<double>(tension));
  tension_ = std::max(static_cast<double>(motion.largest_tension()), 1e-6);
  fastest_ = static_cast<double>(std::max(motion.fastest_vibration(), motion.fastest_turn()));
  for (const TimeCurve& curve : scene_.curves) {
    for (const TimeCurve::Harmonic& one : curve.harmonics)
      fastest_ = std::max(fastest_, one.frequency);
  }
  decay_ = static_cast<double>(motion.fastest_decay());
  freedoms_ = motion.freedoms();
}

// Moves the start by 1e-13, which leaves three digits of the difference.
inline void KnownLinkage::disturb() {
  constexpr double by = 1e-13, most_growth = 1e4;
  LinkageMotion moved(scene_);
  moved.disturb(by);
  if (!moved.advance(until())) {
    why_unknown_ = moved.why_stopped();
    return;
  }
  const Nodes nodes = nodes_of(moved);
  growth_ = std::max(1.0, difference(nodes, end_) * std::max(length_, speed_) / by);
  if (growth_ > most_growth) why_unknown_ = "ill conditioned";
}

inline double KnownLinkage::difference(const Nodes& a, const Nodes& b) const {
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    largest = largest_error({largest, (a[i].position - b[i].position).norm() / length_,
                             (a[i].velocity - b[i].velocity).norm() / speed_});
  }
  return largest;
}

inline double KnownLinkage::difference(const std::vector<double>& a,
                                       const std::vector<double>& b) const {
  double largest = 0;
  for (std::size_t e = 0; e < a.size(); ++e)
    largest = largest_error({largest, std::abs(a[e] - b[e]) / tension_});
  return largest;
}

inline double KnownLinkage::stretch(const Nodes& nodes) const {
  double largest = 0;
  for (const Spring& spring : scene_.springs) {
    if (!spring.law.rigid) continue;
    const Node &a = nodes[spring.nodes[0]], &b = nodes[spring.nodes[1]];
    const Eigen::Vector3d d = b.position - a.position;
    const double l = d.norm(), rate = d.dot(b.velocity - a.velocity) / l;
    largest =
        largest_error({largest, std::abs(l / spring.law.rest_length - 1), std::abs(rate) / speed_});
  }
  return largest;
}

// A run by one of qddot's methods.
struct LinkageRun {
  Summary summary{};
  Nodes on_the_way{}, end{};
  std::vector<double> tensions{};  // at the end [N], by the scene's numbers; zero for springs
  double loss = 0;                 // of energy to dashpots and air, less the gain from supports [J]
  std::string thrown{};
};

// Compares methods with a known motion.
class LinkageComparison {
 public:
  explicit LinkageComparison(const KnownLinkage& known) : known_(known) {}

  // Runs the method with ever smaller steps or tolerances. `where` is said after its name.
  void compare(const Method& method, const Model& model, const std::string& where);
  // Compares the start of the model, and the number of its rods. A reduction leaves out those that
  // fall without a tension.
  void compare_start(const Model& model, bool is_reduced, const std::string& where);
  const MethodComparisons& results() const { return all_; }

 private:
  // The largest of all errors of motion, each over its size.
  double error(const LinkageRun& run) const {
    return largest_error({known_.error_at_end(run.end), known_.error_on_the_way(run.on_the_way),
                          known_.loss_error(run.loss)});
  }
  double apart(const LinkageRun& a, const LinkageRun& b) const {
    return largest_error({known_.difference(a.end, b.end),
                          known_.difference(a.on_the_way, b.on_the_way),
                          std::abs(known_.loss_error(a.loss) - known_.loss_error(b.loss))});
  }
  // An error that a smaller knob does not lessen is none of the method. Runs round to 1e-16, some
  // thousand steps of them to 1e-11 of sizes at most.
  double allowed(double moved) const { return 30 * moved + 1e-11 * known_.growth(); }
  LinkageRun run(const Method& method, const Model& model, double knob, bool is_observed) const;
  double longest_step(const Method& method) const;
  void compare_adaptive(const Method& method, const Model& model, const std::string& where);
  void compare_fixed(const Method& method, const Model& model, const std::string& where);
  // Whether the run reached its end.
  bool ended(const LinkageRun& run, const std::string& where);
  void compare_observed(const Method& method, const Model& model, double knob,
                        const LinkageRun& seen, const std::string& where);
  // Compares two runs, of which the second is finer: errors may be no more than changes explain.
  void compare_two(const LinkageRun& before, const LinkageRun& last, const std::string& where);
  void compare_rods(const Method& method, const LinkageRun& run, double most,
                    const std::string& where);
  void disagree(std::string sentence) { all_.disagreements.push_back(std::move(sentence)); }

  const KnownLinkage& known_;
  MethodComparisons all_{};
};

inline void LinkageComparison::compare_start(const Model& model, bool is_reduced,
                                             const std::string& where) {
  const double off = known_.difference(model.expand(model.initial()), known_.scene().nodes);
  // Pins start where their curves are, at other velocities than drawn.
  const bool is_driven = !known_.scene().curves.empty();
  if (!is_driven && !(off <= 1e-13)) disagree(fmt::format("{}: starts {:.3g} off", where, off));
  std::size_t rods = 0;
  for (const Spring& spring : known_.scene().springs) rods += spring.law.rigid;
  const std::size_t own = model.rods().size();
  if (own > rods || (own < rods && !is_reduced))
    disagree(fmt::format("{}: has {} rods, not {}", where, own, rods));
}

inline void LinkageComparison::compare(const Method& method, const Model& model,
                                       const std::string& where) {
  if (misfit(method, model.system())) {
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

inline LinkageRun LinkageComparison::run(const Method& method, const Model& model, double knob,
                                         bool is_observed) const {
  LinkageRun run;
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
    run.end = model.expand(state);
    run.loss = model.dissipated(state) - model.driven(state);
    run.tensions.resize(known_.scene().springs.size());
    const Vec tensions = model.tensions(state);
    for (std::size_t k = 0; k < model.rods().size(); ++k)
      run.tensions[model.rods()[k]] = tensions[static_cast<Index>(k)];
  } catch (const std::exception& error) {
    run.thrown = error.what();
  }
  return run;
}

// A step that resolves the fastest vibration and turn, and that dashpots let be stable.
inline double LinkageComparison::longest_step(const Method& method) const {
  const double part = method.order <= 1   ? 0.005
                      : method.order <= 2 ? 0.05
                      : method.order <= 4 ? 0.3
                                          : 1.0;
  const double rate = std::max(known_.fastest() / part, 4 * known_.decay());
  return known_.until() / std::ceil(known_.until() * rate);
}

inline bool LinkageComparison::ended(const LinkageRun& run, const std::string& where) {
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

inline void LinkageComparison::compare_observed(const Method& method, const Model& model,
                                                double knob, const LinkageRun& seen,
                                                const std::string& where) {
  if (method.ends_steps_at_looks()) return;
  ++all_.runs;
  const LinkageRun alone = run(method, model, knob, false);
  if (!ended(alone, where)) return;
  if (known_.difference(alone.end, seen.end) != 0)
    disagree(fmt::format("{}: moves otherwise by {:.3g} if it is seen", where,
                         known_.difference(alone.end, seen.end)));
}

inline void LinkageComparison::compare_two(const LinkageRun& before, const LinkageRun& last,
                                           const std::string& where) {
  const double off = error(last), moved = apart(last, before);
  if (!(off <= allowed(moved)))
    disagree(fmt::format("{}: {:.3g} off, where it changed by {:.3g}; growth {:.3g}", where, off,
                         moved, known_.growth()));
  const double tension = known_.tension_error(last.tensions);
  const double tension_moved = known_.difference(last.tensions, before.tensions);
  // Tensions are quotients of roundings: their rates are those of the fastest vibration.
  if (!(tension <= 10 * allowed(tension_moved + moved)))
    disagree(fmt::format("{}: tensions are {:.3g} off, where they changed by {:.3g}; growth {:.3g}",
                         where, tension, tension_moved, known_.growth()));
}

inline void LinkageComparison::compare_rods(const Method& method, const LinkageRun& run,
                                            double most, const std::string& where) {
  const double own = largest_error({known_.stretch(run.end), known_.stretch(run.on_the_way)});
  all_.stretches[method.name].push_back(own);
  if (!(own <= most))
    disagree(fmt::format("{}: rods stretch by {:.3g}; allowed are {:.3g}", where, own, most));
}

inline void LinkageComparison::compare_adaptive(const Method& method, const Model& model,
                                                const std::string& where) {
  constexpr double coarse = 1e-6, fine = 1e-8;
  all_.runs += 2;
  const LinkageRun first = run(method, model, coarse, true);
  const LinkageRun second = run(method, model, fine, true);
  if (!ended(first, where + " at 1e-6") || !ended(second, where + " at 1e-8")) return;
  compare_observed(method, model, fine, second, where + " at 1e-8");
  // As in the suite `order`: multistep methods err by up to 1100 tolerances. The growth is of one
  // disturbance at the start; others grow more.
  const double most = (method.varies_order() ? 2000 : 300) * fine * known_.growth();
  const double off = error(second);
  all_.tolerances[method.name].push_back(off / (fine * known_.growth()));
  if (!(off <= most))
    disagree(fmt::format("{} at 1e-8: {:.3g} off; allowed are {:.3g}, growth {:.3g}", where, off,
                         most, known_.growth()));
  compare_two(first, second, where);
  compare_rods(method, second, most, where + " at 1e-8");
}

inline void LinkageComparison::compare_fixed(const Method& method, const Model& model,
                                             const std::string& where) {
  double h = longest_step(method);
  std::vector<LinkageRun> runs;
  // Errors of two runs may be alike by chance; then a third decides.
  constexpr std::size_t most_runs = 4;
  while (runs.size() < most_runs) {
    if (!runs.empty()) h /= 2;
    ++all_.runs;
    runs.push_back(run(method, model, h, true));
    if (!ended(runs.back(), fmt::format("{} at {:.6g}", where, h))) return;
    if (runs.size() < 3) continue;
    if (error(runs.back()) <= allowed(apart(runs.back(), runs[runs.size() - 2]))) break;
  }
  const std::string named = fmt::format("{} at {:.6g}", where, h);
  const LinkageRun &last = runs.back(), &before = runs[runs.size() - 2];
  compare_observed(method, model, h, last, named);
  compare_two(before, last, named);
  // Two halvings of a step that resolves the fastest vibration leave this at most.
  const double off = error(last), was = error(before);
  const double most = (method.order <= 2 ? 0.05 : 1e-3) * known_.growth();
  if (!(off <= most)) disagree(fmt::format("{}: {:.3g} off", named, off));
  constexpr double held = 1e-9;
  compare_rods(method, last, held, named);
  // Rounding hides the order below.
  if (off > 1e-9 * known_.growth()) all_.orders[method.name].push_back(std::log2(was / off));
}

}  // namespace tests
}  // namespace qddot

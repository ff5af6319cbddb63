// How stiff springs exchange their energy, by method and step size: the figures of Hairer, Lubich
// and Wanner, Geometric Numerical Integration, I.5.2 and XIII.2.
//
//   exchange --scene fpu --out results/fpu
//   exchange --scene fpu --methods verlet,trbdf2 --h-omega 0.1,0.5,1 --until 400 --out results/fpu
//
//  1. w is the highest frequency at the start that the stiff springs (Scene::stiff_above) make by
//     themselves, without the soft ones: in scene fpu it is its parameter `frequency`, as h w is
//     meant there. A method's step is h = (h w)/w, all of the way: the motion is seen at
//     multiples of h only, those nearest to multiples of --every.
//  2. The reference is Kahan and Li's composition of order 8 at h w = 0.1, certified by how far
//     Dormand and Prince's Nystrom pair 12(10) at rtol = 1e-12 is from it.
//  3. exchange.csv has the oscillatory energy of each stiff spring over time (stiff_energies.hpp),
//     springs counted from 0 among the stiff ones, and their sum.
//  4. summary.csv has, for each method and h w:
//       sum_deviation   the largest |sum I(t) - sum I(0)| / sum I(0)
//       energy_error    the largest |H(t) - H(0)| / |H(0)|
//     over the times seen; and, of running means over 40 periods of w (a quarter of the time if
//     that is less; see energy_exchange.hpp),
//       exchange_error  the largest |I_j(t) - I_j,ref(t)| / sum I(0)
//       tempo           the a for which I_j(t) is nearest to I_j,ref(a t): how fast they exchange
//       misfit          the root mean square of what is left then
//       verdict         in words; "as it should" is a tempo within 10 % and a misfit below 0.1
//     What drives the exchange is the soft springs' slow motion, which may be chaotic: in scene fpu
//     1 % more frequency moves I_j(t) by up to 0.06, so that a few per cent of tempo mean nothing.
//     A run that fails has its outcome, and leaves the rest empty.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "experiments/kit/allowed_options.hpp"
#include "experiments/kit/command_line.hpp"
#include "experiments/kit/csv.hpp"
#include "experiments/kit/entry.hpp"
#include "experiments/kit/program.hpp"
#include "experiments/kit/progress.hpp"
#include "experiments/kit/provenance.hpp"
#include "experiments/kit/reference_file.hpp"
#include "experiments/kit/scene_choice.hpp"
#include "experiments/kit/study.hpp"
#include "experiments/kit/summary_record.hpp"
#include "qddot/integrators/registry.hpp"
#include "qddot/measure/exchange/exchange_words.hpp"
#include "qddot/measure/exchange/excitation.hpp"
#include "qddot/scene/invalid_input.hpp"

namespace qddot::exchange {
namespace {

struct Arguments {
  SceneChoice scene;
  std::string out;
  double until = 0, every = 0;
  std::vector<std::string> methods = {"symplectic_euler", "verlet",
                                      "position_verlet",  "rk4",
                                      "blanes_moan4",     "blanes_moan6",
                                      "kahan_li8",        "implicit_midpoint",
                                      "trapezoidal",      "discrete_gradient",
                                      "linear_midpoint",  "linear_midpoint4",
                                      "implicit_euler"};
  std::vector<double> h_omega = {0.1, 1, 2.25, 5};
};

void declare(CommandLine& line, Arguments& a) {
  add_scene_options(line, a.scene);
  line.add_option("--methods", a.methods, "a,b,...: the methods, of fixed steps")
      .delimiter(',')
      .capture_default_str();
  line.add_option("--h-omega", a.h_omega,
                  "a,b,...: step sizes as h w, with w the highest frequency of the stiff springs")
      .delimiter(',')
      .capture_default_str();
  line.add_option("--until", a.until, "the time to run to in s (default: the scene's own)");
  line.add_option("--every", a.every,
                  "the approximate time between samples in exchange.csv in s (default: a "
                  "thousandth of --until)");
  line.add_option("--out", a.out, "the folder for exchange.csv and summary.csv");
}

// As a journal keeps it, and back.
nlohmann::json record_of(const ExchangeRun& result) {
  nlohmann::json energies = nlohmann::json::array();
  for (const Vec& e : result.course.energies) energies.push_back(std::vector(e.begin(), e.end()));
  return {{"times", result.course.times},
          {"energies", energies},
          {"summary", result.summary},
          {"sum_deviation", result.sum_deviation},
          {"energy_error", result.energy_error}};
}

ExchangeRun run_of(const nlohmann::json& record) {
  ExchangeRun result{.summary = record.at("summary"),
                     .sum_deviation = record.at("sum_deviation"),
                     .energy_error = record.at("energy_error")};
  result.course.times = record.at("times").get<std::vector<double>>();
  for (const auto& energies : record.at("energies")) {
    const auto values = energies.get<std::vector<double>>();
    result.course.energies.push_back(Vec::Map(values.data(), std::ssize(values)));
  }
  return result;
}

void write_course(CsvFile& csv, const std::string& method, double h, double h_omega,
                  const EnergyCourse& course) {
  for (std::size_t i = 0; i < course.times.size(); ++i) {
    const Vec& energies = course.energies[i];
    for (Index j = 0; j < energies.size(); ++j)
      csv.row(method, h, h_omega, course.times[i], j, energies[j]);
    csv.row(method, h, h_omega, course.times[i], "sum", energies.sum());
  }
  csv.flush_if_large();
}

// Methods of fixed step among those named; of the others it is said that they are left out.
std::vector<const Method*> select_fixed_step(const Arguments& a, const ReducedScene& scene) {
  std::vector<const Method*> selected, others;
  for (const Method* method : select_methods(a.methods, scene, a.scene.name)) {
    (method->knob == Knob::step_size ? selected : others).push_back(method);
  }
  if (selected.empty()) {
    throw InvalidInput(
        fmt::format("--methods: none of {} has a fixed step; allowed are methods "
                    "whose knob is step_size in simulate --list-methods --csv",
                    fmt::join(a.methods, ", ")));
  }
  for (const Method* method : others) {
    fmt::print("{} is left out: it chooses its steps by itself, so that it has no h w\n",
               method->name);
  }
  return selected;
}

// A scene as drawn, and as its stiff springs start.
struct Subject {
  Scene drawn;
  Excitation excitation;
};

// Checks what was asked for and looks at the start.
Subject subject_of(const CommandLine& line, const Arguments& a) {
  const Scene drawn = load(a.scene);
  const Scene start = started(drawn, a.scene);
  ReducedScene scene(start, reductions_of(a.scene));
  require_reference_exists(scene, a.scene.name);
  const double until = end_time(a.until, line.has("--until"), drawn);
  Excitation excitation = excitation_of(start, std::move(scene), until, a.scene.name);
  for (const double h_omega : a.h_omega) {
    require_step_size(h_omega / excitation.omega, fmt::format("--h-omega {:g}: h =", h_omega),
                      until);
  }
  const double longest = std::ranges::max(a.h_omega) / excitation.omega;
  if (!(10 * longest <= until)) {
    throw InvalidInput(
        fmt::format("--until {} is not allowed with --h-omega {}; it is at least ten steps of it, "
                    "{:.3g} s",
                    until, std::ranges::max(a.h_omega), 10 * longest));
  }
  if (line.has("--every")) excitation.every = a.every;
  if (!(excitation.every <= until / 10)) {
    throw InvalidInput(
        fmt::format("--every {} is not allowed; it is at most a tenth of the time, "
                    "{} s",
                    excitation.every, until));
  }
  return {drawn, std::move(excitation)};
}

// Writes and prints what came of each run, against the reference.
class Reporter {
 public:
  Reporter(const std::string& scene, const Excitation& excitation, const CertifiedCourse& reference,
           CsvFile& courses, CsvFile& table)
      : excitation_(excitation),
        exact_(reference.run.course),
        own_(compare(exact_, exact_, excitation.window)),
        courses_(courses),
        table_(table) {
    fmt::print(
        "{} to t = {:g} s: w = {:.7g} rad/s; reference certified to {:.1e} of the energy\n\n",
        scene, excitation.until, excitation.omega, reference.certified);
    fmt::print("{:<24} {:>6} {:>10} {:>10} {:>10} {:>7}  {}\n", "method", "h w", "sum I off",
               "H off", "I_j off", "tempo", "verdict");
  }

  void operator()(const std::string& method, double h, double h_omega, const ExchangeRun& result) {
    const double nothing = std::numeric_limits<double>::quiet_NaN();
    const bool reached = result.summary.outcome == Outcome::reached_end;
    ExchangeComparison c{.distance = nothing, .tempo = nothing, .misfit = nothing};
    if (reached) c = compare(result.course, exact_, excitation_.window);
    const std::string verdict = reached ? verdict_on(c, own_) : verdict_on(result.summary);
    write_course(courses_, method, h, h_omega, result.course);
    table_.row(method, h, h_omega, name(result.summary.outcome), result.summary.t_reached,
               result.summary.counts.steps, result.summary.counts.force_evaluations,
               result.sum_deviation, result.energy_error, c.distance, c.tempo, c.misfit, verdict);
    fmt::print("{:<24} {:>6g} {:>10.2e} {:>10.2e} {:>10.2e} {:>7.3f}  {}\n", method, h_omega,
               result.sum_deviation, result.energy_error, c.distance, c.tempo, verdict);
  }

 private:
  const Excitation& excitation_;
  const EnergyCourse& exact_;
  const ExchangeComparison own_;
  CsvFile &courses_, &table_;
};

int exchange(const CommandLine& line, const Arguments& a,
             const std::vector<std::string>& command_line) {
  require_given(a.out, "--out", "the folder for the results");
  for (const double h_omega : a.h_omega) {
    require_positive(h_omega, "--h-omega",
                     "a step times the highest frequency of the stiff springs");
    if (std::ranges::count(a.h_omega, h_omega) > 1)
      throw InvalidInput(fmt::format("--h-omega: {} is named twice; allowed is once", h_omega));
  }
  if (line.has("--every")) require_positive(a.every, "--every", "a time in s");
  const auto [drawn, excitation] = subject_of(line, a);
  const auto selected = select_fixed_step(a, excitation.scene);
  require_folder(a.out);
  Study study(line, a.out, {"exchange.csv", "summary.csv"},
              {{"scene", content_hash(drawn)}, {"name", drawn.name}});
  if (const auto status = study.completed()) return *status;
  CsvFile courses(a.out + "/exchange.csv", {"method", "h", "h_omega", "t", "spring", "energy"});
  CsvFile table(a.out + "/summary.csv",
                {"method", "h", "h_omega", "outcome", "t_reached", "steps", "force_evaluations",
                 "sum_deviation", "energy_error", "exchange_error", "tempo", "misfit", "verdict"});

  nlohmann::json origin = provenance(command_line, drawn, excitation.start, excitation.scene);
  origin["omega"] = excitation.omega;
  origin["until"] = excitation.until;
  origin["window"] = excitation.window;
  study.measure([&] {
    progress().stage("making the reference");
    const CertifiedCourse reference =
        certified_course(excitation, [&](const std::string& name, const auto& make) {
          return run_of(study.piece(name, [&] { return record_of(make()); }));
        });
    origin["certified"] = reference.certified;
    progress().wipe();
    Reporter report(drawn.name, excitation, reference, courses, table);
    report("reference", reference.h, CertifiedCourse::h_omega, reference.run);
    progress().begin(selected.size());
    for (const Method* method : selected) {
      for (const double h_omega : a.h_omega) {
        const double h = h_omega / excitation.omega;
        progress().now_at(fmt::format("{} at h w = {:g}", method->name, h_omega));
        const auto times = multiples_near(excitation.every, h, excitation.until);
        const ExchangeRun result =
            run_of(study.piece(fmt::format("{} {:.17g}", method->name, h), [&] {
              return record_of(exchange_run(excitation, *method, h, times));
            }));
        progress().wipe();
        report(method->name, h, h_omega, result);
      }
      progress().finish(method->name + " is done");
    }
  });
  return study.finish({&courses, &table}, origin, done);
}

}  // namespace
}  // namespace qddot::exchange

int main(int argc, char** argv) {
  using namespace qddot::exchange;
  return qddot::kit::enter<Arguments>(
      {.name = "exchange",
       .summary = "Follows the energy that stiff springs exchange, by method and step size.",
       .has_resume = true},
      declare, exchange, argc, argv);
}

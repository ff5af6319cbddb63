// Comparison with other people's solvers (peers): how many times as long as our methods do they
// take to the same accuracy? All run on the same scenes, in one process, on one thread.
//
//   bench --out results/bench
//   bench cloth@0.5 my.toml --point-limit 5 --out results/mine
//
//  1. Each peer is set up as its users would, compiled with the same flags, and runs over its
//     tolerances or step sizes. It runs with the f that a user writes: a loop over springs, in
//     Python NumPy with a sparse matrix. It also runs with ours, if it can take one. It gets the
//     scene without reductions: only pinned nodes are no unknowns.
//  2. Our explicit methods run on the smallest system of the scene (reduced: all), and on the one
//     that the peers get (pins).
//  3. A ratio is the time of the peer's fastest run that reaches the accuracy, over that of our
//     fastest run with at most the same error. If the peer was over budget before, its time so far
//     over our fastest run is a lower bound of the ratio. Times are the processor's.
//  4. Some peers take the same steps as one of our methods, as LAMMPS and verlet. They are compared
//     at one step size: time of a step, springs a second, and distance of the ends.
//  5. bench.csv has every point, ratios.csv the ratios with their two runs, same_steps.csv the
//     results of step 4. `left_out` in their sidecars says which peers are missing and why.
#include <filesystem>

#include <fmt/format.h>

#include "experiments/bench/tables.hpp"
#include "experiments/kit/program.hpp"
#include "experiments/kit/provenance.hpp"
#include "experiments/kit/scene_choice.hpp"

namespace qddot::bench {
namespace {

// The library through which Python calls our f, where it was built.
std::string force_library() {
  std::error_code error;
  return std::filesystem::exists(FORCE_LIBRARY, error) ? FORCE_LIBRARY : "";
}

}  // namespace
}  // namespace qddot::bench

int main(int argc, char** argv) {
  using namespace qddot;
  using namespace qddot::bench;
  Program p("bench",
            "Measures how many times as long as our methods other solvers take to an accuracy.",
            {has_resume});
  std::vector<std::string> scenes = {"cloth@0.1", "cloth@0.5", "chain", "lattice"};
  p.bind("scenes", scenes, "generators' names or scene files; @T after a name runs it to T s",
         true);
  auto methods = p.words("--methods", explicit_methods(),
                         "a,b,...: our methods; naming the most accurate first saves time")
                     .check_each(method_named);
  auto beginnings = p.words(
      "--peers", "a,b,...: the other solvers, by the beginnings of their names (default: all)");
  auto repeats =
      p.whole("--repeats", Pace().repeats, "timed runs of a point that takes under a second")
          .last()
          .within(1, 1000);
  auto limit = p.number("--point-limit", Pace().limit, "seconds that one run may take")
                   .last()
                   .positive("the seconds a run may take");
  auto& points = p.table("bench.csv", {"scene", "until", "side", "solver", "force", "reduced",
                                       "unknowns", "knob", "value", "outcome", "error_position",
                                       "time_s", "timed_runs", "steps", "force_evaluations"});
  auto& all_ratios =
      p.table("ratios.csv",
              {"scene", "until", "reduced", "accuracy", "peer", "force", "ratio", "is_at_least",
               "peer_solver", "peer_time_s", "peer_error", "method", "time_s", "error"});
  auto& same_steps =
      p.table("same_steps.csv",
              {"scene", "until", "peer", "method", "reduced", "unknowns", "springs", "step_size",
               "steps", "peer_outcome", "outcome", "peer_step_s", "step_s", "peer_springs_per_s",
               "springs_per_s", "ratio", "position_difference", "distance"});
  return p.run(argc, argv, [&] {
    std::vector<Comparison> comparisons(scenes.begin(), scenes.end());
    nlohmann::json about = nlohmann::json::array();
    for (const Comparison& c : comparisons) about.push_back({content_hash(c.drawn), c.until});
    LeftOut left_out;
    return p.study(
        about,
        [&](Study& study) {
          const auto peers = selected_peers(beginnings, force_library(), left_out);
          for (Comparison& c : comparisons) {
            const std::string folder = fmt::format("{}/{}_{:g}", p.folder(), c.drawn.name, c.until);
            require_folder(folder);
            nlohmann::json origin = provenance(p.command_line(), c.drawn);
            origin["until"] = c.until;
            c.measure(methods, fitting(peers, c.drawn, left_out),
                      {.limit = limit, .repeats = repeats}, study, folder, origin);
            progress().wipe();
            print(c);
          }
        },
        [&] {
          nlohmann::json origin = p.origin();
          for (const Comparison& c : comparisons) {
            origin["scenes"].push_back(
                {{"scene", provenance(p.command_line(), c.drawn).at("scene")}, {"until", c.until}});
            add_rows(c, *points, *all_ratios, *same_steps);
          }
          origin["left_out"] = left_out.sentences();
          return origin;
        });
  });
}

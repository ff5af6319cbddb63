#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "experiments/command/command_line.hpp"
#include "qddot/integrators/method.hpp"
#include "qddot/scene/reduce/reduced_scene.hpp"
#include "qddot/scene/scene.hpp"

namespace qddot::command {

// The scene that a user names, and what of it is to be left as it is.
struct SceneChoice {
  std::string name;                    // a generator's or a file's
  std::vector<std::string> no_reduce;  // names of reductions
};

// Adds --scene and --no-reduce.
void add_scene_options(CommandLine& line, SceneChoice& choice);

// The scene of that name, a generator's or a file's; its warnings are printed to standard error.
// Throws InvalidInput where there is none or it is wrong.
Scene load(const std::string& name);
Scene load(const SceneChoice& choice);

// The scene as its motion starts: moved to its equilibrium where it says so. Throws InvalidInput
// where it has none.
Scene started(const Scene& drawn, const SceneChoice& choice);

// All reductions but those that the user does without. Throws InvalidInput for an unknown name.
Reductions reductions_of(const SceneChoice& choice);

// Throws InvalidInput unless the method can be used on the scene: K must be constant for some,
// stiff springs be named for others, and no node without mass may be left for most; the sentence
// names the node and the methods that take it. `source` names the scene.
void require_fit(const Method& method, const ReducedScene& scene, const std::string& source);

// The methods named in `list` (a,b,...), or all that can be used on the scene if it is empty;
// throws InvalidInput for an unknown or repeated name, and as require_fit does.
std::vector<const Method*> select_methods(const std::vector<std::string>& list,
                                          const ReducedScene& scene, const std::string& source);

// The methods' names.
std::vector<std::string> names_of(const std::vector<const Method*>& methods);

}  // namespace qddot::command

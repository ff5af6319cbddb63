#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "qddot/integrators/method.hpp"
#include "qddot/scene/model.hpp"
#include "qddot/scene/scene.hpp"

namespace qddot::inline kit {

// The scene that a user names, and the reductions to leave out.
struct SceneChoice {
  std::string name;                    // a generator's or a file's
  std::vector<std::string> no_reduce;  // names of reductions
};

// Loads the scene of that name, a generator's or a file's, and prints its warnings to stderr.
// Throws InvalidInput if there is none or it is wrong.
Scene load(const SceneChoice& choice);

// Says that a scene is being reduced while this lives, where that takes a while.
class Reducing {
 public:
  explicit Reducing(const Scene& scene);
  ~Reducing();
  Reducing(const Reducing&) = delete;
  Reducing& operator=(const Reducing&) = delete;
};

// The end time [s]: the one the user asked for, else the scene's own. Throws InvalidInput if there
// is neither or it is not positive.
double end_time(double asked, bool is_asked, const Scene& scene);

// All reductions but those in `no_reduce`. Throws InvalidInput for an unknown name.
Reductions reductions_of(const SceneChoice& choice);

// A scene that a program works on.
struct Subject {
  std::string source;  // as the user named it
  Scene drawn;
  std::optional<Scene> settled;  // if its motion starts at its equilibrium
  Model model;                   // of start()
  double until = 0;              // [s]; 0 if the program has times of its own

  // The scene as its motion starts.
  const Scene& start() const { return settled ? *settled : drawn; }

  const System& system() const { return model.system(); }
  // The facts that decide a study of it: hash, name and time.
  nlohmann::json about() const;
};

// The scene that was chosen, to the time `until` [s]. Throws InvalidInput.
Subject subject_of(const SceneChoice& choice, double until = 0);
// The same of a scene that is loaded already.
Subject subject_of(Scene drawn, const SceneChoice& choice, double until);

// Throws InvalidInput unless the method can run the scene. Some methods need a constant K, others
// need named stiff springs, and most allow no massless node. The message names the node and the
// methods that allow it. `source` names the scene.
void require_fit(const Method& method, const Model& model, const std::string& source);

// Throws InvalidInput if the scene is damped or driven, or a spring may break. `why` completes "it
// is damped, and ...".
void require_kept_energy(const Scene& drawn, const std::string& source, const std::string& why);
// Throws InvalidInput, with the reason `why`, if the scene has rods.
void require_no_rods(const Scene& drawn, const std::string& source, const std::string& why);

// The method of that name, which the option has. Throws InvalidInput if there is none.
const Method& method_named(const std::string& name, const std::string& option);

// The methods named in `list` (a,b,...), or all that can run the scene if the list is empty. Throws
// InvalidInput for an unknown or repeated name, and as require_fit does.
std::vector<const Method*> select_methods(const std::vector<std::string>& list, const Model& model,
                                          const std::string& source);

std::vector<const Method*> select_methods(const std::vector<std::string>& list,
                                          const Subject& subject);

// The methods of fixed steps, and of an error that depends on them, among these. Refuses others
// that are named.
std::vector<const Method*> select_fixed_step(const std::vector<std::string>& list,
                                             const Subject& subject);

// The methods of fixed steps among these. Prints a sentence for each other one, which is left out.
// Throws InvalidInput if none is left.
std::vector<const Method*> fixed_step_among(const std::vector<std::string>& list,
                                            const Subject& subject);

// The names of all methods, as "a, b, c", or of those that have the given property.
std::string method_names();
std::string names_where(const std::function<bool(const Method&)>& has);

// The methods' names.
std::vector<std::string> names_of(const std::vector<const Method*>& methods);

}  // namespace qddot::inline kit

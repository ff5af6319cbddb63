#include "experiments/kit/scene_choice.hpp"

#include <algorithm>
#include <cstdio>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "experiments/kit/allowed_options.hpp"
#include "experiments/kit/memory.hpp"
#include "experiments/kit/program.hpp"
#include "experiments/kit/progress.hpp"
#include "experiments/kit/whole_file.hpp"
#include "qddot/integrators/misfit_words.hpp"
#include "qddot/integrators/registry.hpp"
#include "qddot/scene/invalid_input.hpp"
#include "qddot/scene/rods.hpp"
#include "qddot/scene/scene_file.hpp"
#include "qddot/scene/settle.hpp"

namespace qddot::inline kit {
namespace {

// They are reduced in about a quarter of a second, and a text of that size is read in that time.
constexpr std::size_t springs_that_take_a_while = 1'000'000, bytes_that_take_a_while = 20'000'000;

}  // namespace

Scene load(const SceneChoice& choice) {
  require_given(choice.name, "--scene", "a generator's name or a scene file");
  Scene scene = load_scene(choice.name,
                           [](const std::string& path) {
                             protect_input(path);
                             std::string text = read_text(path);
                             if (text.size() >= bytes_that_take_a_while)
                               progress().stage("reading " + path);
                             return text;
                           },
                           {.bytes = free_memory()});
  progress().wipe();
  scene.name = in_one_line(scene.name);  // it reaches terminals and tables
  for (const std::string& warning : scene.warnings) {
    fmt::print(stderr, "{}: warning: {}\n", program_invocation_short_name, in_one_line(warning));
  }
  return scene;
}

Reducing::Reducing(const Scene& scene) {
  if (scene.springs.size() >= springs_that_take_a_while)
    progress().stage(
        fmt::format("reducing {} nodes and {} springs", scene.nodes.size(), scene.springs.size()));
}

Reducing::~Reducing() { progress().wipe(); }

double end_time(double asked, bool is_asked, const Scene& scene) {
  if (is_asked) {
    require_positive(asked, "--until", "the time to run to in s");
    return asked;
  }
  if (!scene.until) {
    throw InvalidInput(fmt::format(
        "--until is missing, and scene {} has no end time of its own; it is the time to "
        "run to in s, greater than 0",
        scene.name));
  }
  return *scene.until;
}

Reductions reductions_of(const SceneChoice& choice) {
  Reductions reductions;
  for (const std::string& name : choice.no_reduce) {
    const auto found = std::ranges::find(reduction_names, name);
    if (found == reduction_names.end()) {
      throw InvalidInput(fmt::format("--no-reduce: {} is not a reduction; allowed are {}", name,
                                     fmt::join(reduction_names, ", ")));
    }
    reductions = reductions.without(static_cast<Reduction>(found - reduction_names.begin()));
  }
  return reductions;
}

nlohmann::json Subject::about() const {
  nlohmann::json about = {{"scene", content_hash(drawn)}, {"name", drawn.name}};
  if (until > 0) about["until"] = until;
  return about;
}

Subject subject_of(const SceneChoice& choice, double until) {
  return subject_of(load(choice), choice, until);
}

Subject subject_of(Scene drawn, const SceneChoice& choice, double until) {
  std::optional<Scene> settled = settled_if_asked(drawn, choice.name);
  const Scene& start = settled ? *settled : drawn;
  const Reducing reducing(start);
  Model model(start, reductions_of(choice));
  return {choice.name, std::move(drawn), std::move(settled), std::move(model), until};
}

void require_kept_energy(const Scene& drawn, const std::string& source, const std::string& why) {
  if (is_driven(drawn)) {
    throw InvalidInput(fmt::format(
        "{}: it is driven, and {}; allowed are scenes without motion and without forces in time",
        source, why));
  }
  const auto can_break = [](const Spring& spring) { return spring.law.can_break(); };
  if (std::ranges::any_of(drawn.springs, can_break)) {
    throw InvalidInput(
        fmt::format("{}: its springs may break, and {}; allowed are scenes without "
                    "breaks_at",
                    source, why));
  }
  if (!is_damped(drawn)) return;
  throw InvalidInput(fmt::format(
      "{}: it is damped, and {}; allowed are scenes without damping and air_damping", source, why));
}

void require_no_rods(const Scene& drawn, const std::string& source, const std::string& why) {
  if (!has_rods(drawn)) return;
  throw InvalidInput(fmt::format(
      "{}: it has rods, and {}; allowed are scenes without rods and rods_above", source, why));
}

void require_fit(const Method& method, const Model& model, const std::string& source) {
  const auto why = misfit(method, model.system());
  const auto others = [&] {
    return names_where([&](const Method& other) { return applies_to(other, model.system()); });
  };
  if (why == Outcome::stiffness_varies) {
    throw InvalidInput(
        fmt::format("{}: {} needs a K that is the same everywhere, and K of this scene changes "
                    "with the motion; allowed are {}",
                    source, method.name, others()));
  }
  if (why == Outcome::no_stiff_set) {
    throw InvalidInput(fmt::format(
        "{}: stiff_above: it is missing, and {} integrates the forces of stiff springs apart from "
        "the others; allowed are finite numbers above 0 in N/m, or the methods {}",
        source, method.name, others()));
  }
  if (why == Outcome::refuses_constraints || why == Outcome::no_constraints) {
    throw InvalidInput(fmt::format("{}: rods: {}: {}; allowed are {}", source, method.name,
                                   misfit_words(method, *why), others()));
  }
  if (why == Outcome::refuses_damping) {
    throw InvalidInput(fmt::format("{}: damping: {}: {}; allowed are {}", source, method.name,
                                   misfit_words(method, *why), others()));
  }
  const auto massless = model.massless_nodes();
  if (!massless.empty() && !method.is(Trait::accepts_massless)) {
    throw InvalidInput(fmt::format(
        "{}: nodes[{}].mass: 0 is not allowed with {}, which divides by it; allowed are masses "
        "above 0, or the methods {}",
        source, massless.front(), method.name,
        names_where([](const Method& other) { return other.is(Trait::accepts_massless); })));
  }
}

const Method& method_named(const std::string& name, const std::string& option) {
  if (const std::string why = why_not_built(name); !why.empty())
    throw InvalidInput(fmt::format("{}: {}", option, why));
  return named(name, methods(), &Method::name, option, "a method");
}

std::vector<const Method*> select_methods(const std::vector<std::string>& list, const Model& model,
                                          const std::string& source) {
  std::vector<const Method*> selected;
  if (list.empty()) {
    for (const Method& method : methods()) {
      if (applies_to(method, model.system())) selected.push_back(&method);
    }
  }
  for (const std::string& name : list) {
    selected.push_back(&method_named(name, "--methods"));
    require_fit(*selected.back(), model, source);
  }
  require_each_once(list, "--methods");
  return selected;
}

std::vector<const Method*> select_methods(const std::vector<std::string>& list,
                                          const Subject& subject) {
  return select_methods(list, subject.model, subject.source);
}

std::vector<const Method*> select_fixed_step(const std::vector<std::string>& list,
                                             const Subject& subject) {
  std::vector<const Method*> selected;
  for (const Method* method : select_methods(list, subject)) {
    if (method->knob == Knob::step_size && method->order > 0) {
      selected.push_back(method);
    } else if (!list.empty()) {
      throw InvalidInput(fmt::format("--methods: {} {}; allowed are methods of fixed step",
                                     method->name,
                                     method->order > 0 ? "chooses its steps by itself"
                                                       : "has no error that depends on a step"));
    }
  }
  return selected;
}

std::vector<const Method*> fixed_step_among(const std::vector<std::string>& list,
                                            const Subject& subject) {
  std::vector<const Method*> selected, others;
  for (const Method* method : select_methods(list, subject)) {
    (method->knob == Knob::step_size ? selected : others).push_back(method);
  }
  if (selected.empty()) {
    throw InvalidInput(
        fmt::format("--methods: none of {} has a fixed step; allowed are methods "
                    "whose knob is step_size in simulate --list-methods --csv",
                    fmt::join(list, ", ")));
  }
  for (const Method* method : others) {
    fmt::print("{} is left out: it chooses its steps by itself, so that it has no h w\n",
               method->name);
  }
  return selected;
}

std::string method_names() {
  return names_where([](const Method&) { return true; });
}

std::string names_where(const std::function<bool(const Method&)>& has) {
  std::vector<std::string> names;
  for (const Method& method : methods()) {
    if (has(method)) names.push_back(method.name);
  }
  return fmt::format("{}", fmt::join(names, ", "));
}

std::vector<std::string> names_of(const std::vector<const Method*>& methods) {
  std::vector<std::string> names;
  for (const Method* method : methods) names.push_back(method->name);
  return names;
}

}  // namespace qddot::inline kit

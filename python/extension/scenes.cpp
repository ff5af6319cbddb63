#include <limits>

#include "python/extension/bindings.hpp"
#include "python/extension/curves.hpp"
#include "python/extension/outside.hpp"
#include "qddot/measure/motion/simulation.hpp"
#include "qddot/model/differenced_stiffness.hpp"
#include "qddot/scene/drawn_system.hpp"
#include "qddot/scene/explain.hpp"
#include "qddot/scene/generators.hpp"
#include "qddot/scene/rods.hpp"
#include "qddot/scene/scene_arrays.hpp"
#include "qddot/scene/scene_file.hpp"
#include "qddot/scene/settle.hpp"

namespace qddot::python {
namespace {

using Given = std::optional<Doubles>;

Eigen::MatrixXd matrix_of(const Doubles& array, const char* name) {
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  if (array.ndim() != 2)
    throw std::invalid_argument(std::string(name) +
                                ": it is no table of (nodes, dimension) numbers");
  return RowMajor::Map(array.data(), array.shape(0), array.shape(1));
}

Scene scene_from(const Doubles& positions, const Indices& springs, const Doubles& mass,
                 const Doubles& stiffness, const Indices& pinned, const Given& gravity,
                 const Given& velocities, const Given& load, const Given& rest_length,
                 const Given& quartic, const Given& damping, const Given& cubic,
                 const Given& breaks_at, const Given& pulls_only, const Given& rigid,
                 double air_damping, const py::list& curves, const Indices& curve_of_node,
                 int of_gravity) {
  SceneArrays a;
  const auto node = [](std::int64_t number, const char* name) {
    if (number >= 0) return static_cast<std::size_t>(number);
    throw std::invalid_argument(std::string(name) + ": node " + std::to_string(number) +
                                " is none; nodes count from 0");
  };
  a.positions = matrix_of(positions, "positions");
  if (springs.size() > 0 && (springs.ndim() != 2 || springs.shape(1) != 2))
    throw std::invalid_argument("springs: they are no table of (springs, 2) nodes");
  for (py::ssize_t s = 0; s < springs.size() / 2; ++s) {
    const std::int64_t* ends = springs.data() + 2 * s;
    a.springs.push_back({node(ends[0], "springs"), node(ends[1], "springs")});
  }
  a.mass = vec_of(mass);
  a.stiffness = vec_of(stiffness);
  for (py::ssize_t i = 0; i < pinned.size(); ++i)
    a.pinned.push_back(node(pinned.data()[i], "pinned"));
  if (gravity) a.gravity = vec_of(*gravity);
  if (velocities) a.velocities = matrix_of(*velocities, "velocities");
  if (load) a.load = matrix_of(*load, "load");
  if (rest_length) a.rest_length = vec_of(*rest_length);
  if (quartic) a.quartic = vec_of(*quartic);
  if (damping) a.damping = vec_of(*damping);
  if (cubic) a.cubic = vec_of(*cubic);
  if (breaks_at) a.breaks_at = vec_of(*breaks_at);
  if (pulls_only) a.pulls_only = vec_of(*pulls_only);
  if (rigid) a.rigid = vec_of(*rigid);
  a.air_damping = air_damping;
  set_curves(curves, curve_of_node, of_gravity, a);
  return scene_of(a);
}

// A number of each node or spring.
template <class Value, class Items, class Take>
py::array_t<Value> column(const Items& items, const Take& take) {
  py::array_t<Value> array(static_cast<py::ssize_t>(items.size()));
  std::transform(items.begin(), items.end(), array.mutable_data(), take);
  return array;
}

py::array_t<std::int64_t> ends_of(const Scene& scene) {
  py::array_t<std::int64_t> array({static_cast<py::ssize_t>(scene.springs.size()), py::ssize_t{2}});
  std::int64_t* to = array.mutable_data();
  for (const Spring& spring : scene.springs)
    to = std::copy(spring.nodes.begin(), spring.nodes.end(), to);
  return array;
}

const Generator& generator_named(const std::string& name) {
  if (const Generator* generator = find_generator(name)) return *generator;
  std::string all;
  for (const Generator& other : generators()) all += (all.empty() ? "" : ", ") + other.name;
  throw std::invalid_argument(name + " is no generator of scenes; there are " + all);
}

py::list generator_records() {
  using py::arg;
  py::list all;
  for (const Generator& generator : generators()) {
    py::list parameters;
    for (const GeneratorParameter& p : generator.parameters) {
      parameters.append(py::dict(arg("name") = p.name, arg("standard") = p.standard,
                                 arg("low") = p.low, arg("high") = p.high,
                                 arg("meaning") = p.meaning, arg("whole") = p.whole));
    }
    all.append(py::dict(arg("name") = generator.name, arg("summary") = generator.summary,
                        arg("parameters") = parameters));
  }
  return all;
}

// The smallest system of a scene as it starts (see reduced_for), for a method or for none.
HeldModel model_of(const std::shared_ptr<Scene>& start, const std::optional<std::string>& name,
                   const Names& kept) {
  const Reductions reductions = reductions_without(kept);
  auto model = made_outside([&] {
    return std::make_shared<const Model>(name ? reduced_for(method(*name), *start, reductions)
                                              : Model(*start, reductions));
  });
  return {std::move(model), start};
}

OwnForces::Force force_of(const py::object& given) {
  if (py::isinstance<py::int_>(given))
    return reinterpret_cast<CForce>(given.cast<std::uintptr_t>());
  return given;
}
OwnForces::Potential potential_of(const py::object& given) {
  if (given.is_none()) return {};
  if (py::isinstance<py::int_>(given))
    return reinterpret_cast<CPotential>(given.cast<std::uintptr_t>());
  return given;
}

// A system of the caller's own. `pattern`: rows and columns of K, which is made of differences of f
// without `stiffness`. `is_linear`: whether K is the same everywhere.
HeldModel own_model(const Doubles& mass, const std::vector<py::ssize_t>& shape,
                    const py::object& force, const py::object& potential,
                    const py::object& stiffness, const py::object& damping,
                    const std::optional<std::pair<Indices, Indices>>& pattern, double length,
                    const Doubles& q, const Doubles& v, int dimension, bool is_linear) {
  const Vec m = vec_of(mass);
  const bool computes = !stiffness.is_none();
  SymmetricMatrix own_pattern;
  SymmetricMatrix of_damping;
  if (computes) own_pattern = pattern_of(pattern->first, pattern->second, m.size());
  if (!damping.is_none()) of_damping = pattern_of(pattern->first, pattern->second, m.size());
  std::shared_ptr<const System> system = std::make_shared<OwnForces>(
      m, shape, force_of(force), potential_of(potential), stiffness, std::move(own_pattern),
      is_linear, damping, std::move(of_damping));
  if (!computes && pattern) {
    std::vector<std::pair<Index, Index>> pairs;
    for (py::ssize_t a = 0; a < pattern->first.size(); ++a)
      pairs.emplace_back(pattern->first.at(a), pattern->second.at(a));
    system = std::make_shared<DifferencedStiffness>(system, pairs, length);
  }
  return {std::make_shared<const Model>(system, State{0, vec_of(q), vec_of(v)}, dimension)};
}

Vec unknowns(const System& system, const Doubles& q) {
  const Index n = system.size();
  if (q.size() != n)
    throw std::invalid_argument("q: " + std::to_string(q.size()) + " numbers; there are " +
                                std::to_string(n) + " unknowns");
  return vec_of(q);
}

// Entries that a force does not write stay NaN.
py::array_t<double> force_at(const System& system, const Doubles& q) {
  const Vec x = unknowns(system, q);
  Vec f = Vec::Constant(x.size(), std::numeric_limits<double>::quiet_NaN());
  inside_python([&] { system.force(x, f); });
  return array_of(f);
}

// K as (data, indices, indptr) of its lower triangle, column by column.
py::tuple stiffness_at(const System& system, const Doubles& q) {
  const Vec x = unknowns(system, q);
  SymmetricMatrix k = system.stiffness_pattern();
  inside_python([&] { system.stiffness(x, k); });
  k.makeCompressed();
  const auto copied = [](const auto* from, Index count) {
    py::array_t<std::decay_t<decltype(*from)>> array(count);
    std::copy_n(from, count, array.mutable_data());
    return array;
  };
  return py::make_tuple(copied(k.valuePtr(), k.nonZeros()), copied(k.innerIndexPtr(), k.nonZeros()),
                        copied(k.outerIndexPtr(), k.cols() + 1));
}

double potential_at(const System& system, const Doubles& q) {
  const Vec x = unknowns(system, q);
  double v = 0;
  inside_python([&] { v = system.potential(x); });
  return v;
}

py::dict explanation_of(const HeldModel& held) {
  using py::arg;
  Explanation e;
  std::string words;
  outside(1, [&](const std::stop_token&) {
    e = explain(*held.start, *held.model);
    words = explanation_in_words(e, *held.start);
  });
  py::list findings;
  for (const Finding& finding : e.findings)
    findings.append(py::make_tuple(std::string(name(finding.reduction)), finding.what));
  return py::dict(arg("text") = in_python(words), arg("drawn_unknowns") = e.drawn_unknowns,
                  arg("unknowns") = e.unknowns, arg("left_out") = py::tuple(findings),
                  arg("stiffness_is_constant") = e.stiffness_is_constant,
                  arg("omega_max") = e.omega_max, arg("omega_bound") = e.omega_bound,
                  arg("unstable") = e.unstable, arg("flat") = e.flat, arg("growth") = e.growth);
}

}  // namespace

Reductions reductions_without(const Names& kept) {
  Reductions reductions;
  for (const std::string& name : kept) {
    const auto found = std::ranges::find(reduction_names, name);
    if (found == reduction_names.end()) {
      std::string all;
      for (const auto other : reduction_names)
        all += (all.empty() ? "" : ", ") + std::string(other);
      throw std::invalid_argument("keep: " + name + " is no reduction; allowed are " + all);
    }
    reductions = reductions.without(static_cast<Reduction>(found - reduction_names.begin()));
  }
  return reductions;
}

void add_scenes(py::module_& module) {
  using Shared = std::shared_ptr<Scene>;
  const auto shared = [](Scene scene) { return std::make_shared<Scene>(std::move(scene)); };
  py::class_<Scene, Shared> scene(module, "Scene");
  scene.def_static("load", [=](const std::string& name) { return shared(load_scene(name)); });
  scene.def_static(
      "parse", [=](const std::string& text, const std::string& name, const std::string& folder) {
        return shared(parse_scene(text, name, folder));
      });
  scene.def_static("generate", [=](const std::string& name, const GeneratorValues& values) {
    return shared(generate(generator_named(name), values, name));
  });
  scene.def_static(
      "from_arrays",
      [=](const Doubles& positions, const Indices& springs, const Doubles& mass,
          const Doubles& stiffness, const Indices& pinned, const Given& gravity,
          const Given& velocities, const Given& load, const Given& rest_length,
          const Given& quartic, const Given& damping, const Given& cubic, const Given& breaks_at,
          const Given& pulls_only, const Given& rigid, std::optional<double> rods_above,
          double air_damping, const std::string& name, std::optional<double> until,
          std::optional<double> stiff_above, bool starts_at_equilibrium, const py::list& curves,
          const Indices& curve_of_node, int of_gravity) {
        Scene made = scene_from(positions, springs, mass, stiffness, pinned, gravity, velocities,
                                load, rest_length, quartic, damping, cubic, breaks_at, pulls_only,
                                rigid, air_damping, curves, curve_of_node, of_gravity);
        made.name = name;
        made.until = until;
        made.stiff_above = stiff_above;
        made.starts_at_equilibrium = starts_at_equilibrium;
        if (rods_above) make_rods_above(*rods_above, made);
        validate(made, name);
        return shared(std::move(made));
      });
  // The scene as its motion starts: with its nodes at equilibrium if it starts there.
  scene.def("started", [=](const Shared& self) {
    return self->starts_at_equilibrium ? shared(settled(*self, self->name)) : self;
  });
  scene.def("to_toml", [](const Scene& self) { return to_toml(self); });
  scene.def("content_hash", [](const Scene& self) { return content_hash(self); });
  scene.def_readonly("name", &Scene::name);
  scene.def_readonly("dimension", &Scene::dimension);
  scene.def_readonly("until", &Scene::until);
  scene.def_readonly("stiff_above", &Scene::stiff_above);
  scene.def_readonly("air_damping", &Scene::air_damping);
  scene.def_readonly("starts_at_equilibrium", &Scene::starts_at_equilibrium);
  scene.def_readonly("warnings", &Scene::warnings);
  const auto has = [&](const char* name, const auto& get) {
    scene.def_property_readonly(name, get);
  };
  const auto of_nodes = [=](const char* name, Eigen::Vector3d Node::*which) {
    has(name, [which](const Scene& s) { return array_of(s.nodes, which, s.dimension); });
  };
  of_nodes("positions", &Node::position);
  of_nodes("velocities", &Node::velocity);
  of_nodes("loads", &Node::load);
  has("curves", [](const Scene& s) {
    py::list records;
    for (const TimeCurve& curve : s.curves) records.append(record_of(curve, s.dimension));
    return records;
  });
  has("curve_of_node", [](const Scene& s) {
    return column<std::int64_t>(s.nodes, [](const Node& node) { return node.curve; });
  });
  scene.def_readonly("curve_of_gravity", &Scene::gravity_curve);
  has("gravity", [](const Scene& s) { return array_of(Vec(s.gravity.head(s.dimension))); });
  has("mass", [](const Scene& s) {
    return column<double>(s.nodes, [](const Node& node) { return node.mass; });
  });
  has("pinned", [](const Scene& s) {
    return column<bool>(s.nodes, [](const Node& node) { return node.pinned; });
  });
  has("springs", &ends_of);
  const auto of_springs = [=](const char* name, double SpringLaw::*which) {
    has(name, [which](const Scene& s) {
      return column<double>(s.springs, [which](const Spring& one) { return one.law.*which; });
    });
  };
  of_springs("stiffness", &SpringLaw::stiffness);
  of_springs("rest_length", &SpringLaw::rest_length);
  of_springs("quartic", &SpringLaw::quartic);
  of_springs("damping", &SpringLaw::damping);
  of_springs("cubic", &SpringLaw::cubic);
  of_springs("breaks_at", &SpringLaw::breaks_at);
  has("pulls_only", [](const Scene& s) {
    return column<bool>(s.springs, [](const Spring& one) { return one.law.pulls_only; });
  });
  has("rigid", [](const Scene& s) {
    return column<bool>(s.springs, [](const Spring& one) { return one.law.rigid; });
  });
  module.def("generators", &generator_records);
}

void add_models(py::module_& module) {
  py::class_<HeldModel> model(module, "Model");
  const auto has = [&](const char* name, const auto& get) {
    model.def_property_readonly(name, get);
  };
  has("nodes", [](const HeldModel& m) { return m.model->expand(m.model->initial()).size(); });
  has("dimension", [](const HeldModel& m) { return m.model->dimension(); });
  has("size", [](const HeldModel& m) { return m.model->system().size(); });
  has("mass", [](const HeldModel& m) { return array_of(m.model->system().mass()); });
  has("q", [](const HeldModel& m) { return array_of(m.model->initial().q); });
  has("v", [](const HeldModel& m) { return array_of(m.model->initial().v); });
  has("has_potential", [](const HeldModel& m) { return m.model->system().has_potential(); });
  has("has_stiffness", [](const HeldModel& m) { return m.model->system().has_stiffness(); });
  model.def("force", [](const HeldModel& self, const Doubles& q) {
    return force_at(self.model->system(), q);
  });
  model.def("stiffness", [](const HeldModel& self, const Doubles& q) {
    return stiffness_at(self.model->system(), q);
  });
  model.def("potential", [](const HeldModel& self, const Doubles& q) {
    return potential_at(self.model->system(), q);
  });
  // The positions and velocities of all nodes of the scene, from the unknowns q and v.
  model.def("nodes_at", [](const HeldModel& self, const Doubles& q, const Doubles& v, double t) {
    const System& system = self.model->system();
    const auto nodes = self.model->expand({t, unknowns(system, q), unknowns(system, v)});
    const int d = self.model->dimension();
    return py::make_tuple(array_of(nodes, &Node::position, d), array_of(nodes, &Node::velocity, d));
  });
  model.def("explain", &explanation_of);
  // The forces of a scene as drawn, over the coordinates of all nodes.
  py::class_<System>(module, "Drawn")
      .def(py::init([](const Scene& scene) { return drawn_system(scene); }))
      .def("force", &force_at)
      .def("stiffness", &stiffness_at)
      .def("potential", &potential_at);
  module.def("model_of", &model_of);
  module.def("own_model", &own_model);
}

}  // namespace qddot::python

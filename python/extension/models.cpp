#include <limits>

#include "python/extension/bindings.hpp"
#include "python/extension/outside.hpp"
#include "qddot/measure/motion/simulation.hpp"
#include "qddot/model/differenced_stiffness.hpp"
#include "qddot/scene/explain.hpp"

namespace qddot::python {
namespace {

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

// The smallest system of a scene as it starts (see reduced_for), for a method or for none.
Model model_of(const std::shared_ptr<Scene>& start, const std::optional<std::string>& name,
               const Names& kept) {
  const Reductions reductions = reductions_without(kept);
  auto reduced = made_outside([&] {
    return std::make_shared<const ReducedScene>(
        name ? reduced_for(method(*name), *start, reductions) : ReducedScene(*start, reductions));
  });
  return {std::move(reduced), start};
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
// without `stiffness`.
Model own_model(const Doubles& mass, const std::vector<py::ssize_t>& shape, const py::object& force,
                const py::object& potential, const py::object& stiffness,
                const std::optional<std::pair<Indices, Indices>>& pattern, double length,
                const Doubles& q, const Doubles& v, int dimension) {
  const Vec m = vec_of(mass);
  const bool computes = !stiffness.is_none();
  SymmetricMatrix own_pattern;
  if (computes) own_pattern = pattern_of(pattern->first, pattern->second, m.size());
  std::shared_ptr<const System> system = std::make_shared<OwnForces>(
      m, shape, force_of(force), potential_of(potential), stiffness, std::move(own_pattern));
  if (!computes && pattern) {
    std::vector<std::pair<Index, Index>> pairs;
    for (py::ssize_t a = 0; a < pattern->first.size(); ++a)
      pairs.emplace_back(pattern->first.at(a), pattern->second.at(a));
    system = std::make_shared<DifferencedStiffness>(system, pairs, length);
  }
  return {std::make_shared<const ReducedScene>(system, State{0, vec_of(q), vec_of(v)}, dimension)};
}

Vec unknowns(const Model& model, const Doubles& q) {
  const Index n = model.reduced->system().size();
  if (q.size() != n)
    throw std::invalid_argument("q: " + std::to_string(q.size()) + " numbers; there are " +
                                std::to_string(n) + " unknowns");
  return vec_of(q);
}

// Entries that a force does not write stay NaN.
py::array_t<double> force_at(const Model& model, const Doubles& q) {
  const Vec x = unknowns(model, q);
  Vec f = Vec::Constant(x.size(), std::numeric_limits<double>::quiet_NaN());
  inside_python([&] { model.reduced->system().force(x, f); });
  return array_of(f);
}

// K as (data, indices, indptr) of its lower triangle, column by column.
py::tuple stiffness_at(const Model& model, const Doubles& q) {
  const System& system = model.reduced->system();
  const Vec x = unknowns(model, q);
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

py::dict explanation_of(const Model& model) {
  using py::arg;
  Explanation e;
  std::string words;
  outside(1, [&](const std::stop_token&) {
    e = explain(*model.start, *model.reduced);
    words = explanation_in_words(e, *model.start);
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

void add_models(py::module_& module) {
  py::class_<Model> model(module, "Model");
  const auto has = [&](const char* name, const auto& get) {
    model.def_property_readonly(name, get);
  };
  has("nodes", [](const Model& m) { return m.reduced->expand(m.reduced->initial()).size(); });
  has("dimension", [](const Model& m) { return m.reduced->dimension(); });
  has("size", [](const Model& m) { return m.reduced->system().size(); });
  has("mass", [](const Model& m) { return array_of(m.reduced->system().mass()); });
  has("q", [](const Model& m) { return array_of(m.reduced->initial().q); });
  has("v", [](const Model& m) { return array_of(m.reduced->initial().v); });
  has("has_potential", [](const Model& m) { return m.reduced->system().has_potential(); });
  has("has_stiffness", [](const Model& m) { return m.reduced->system().has_stiffness(); });
  model.def("force", &force_at);
  model.def("stiffness", &stiffness_at);
  model.def("potential", [](const Model& self, const Doubles& q) {
    const Vec x = unknowns(self, q);
    double v = 0;
    inside_python([&] { v = self.reduced->system().potential(x); });
    return v;
  });
  // The positions and velocities of all nodes of the scene, from the unknowns q and v.
  model.def("nodes_at", [](const Model& self, const Doubles& q, const Doubles& v, double t) {
    const auto nodes = self.reduced->expand({t, unknowns(self, q), unknowns(self, v)});
    const int d = self.reduced->dimension();
    return py::make_tuple(array_of(nodes, &Node::position, d), array_of(nodes, &Node::velocity, d));
  });
  model.def("explain", &explanation_of);
  module.def("model_of", &model_of);
  module.def("own_model", &own_model);
}

}  // namespace qddot::python

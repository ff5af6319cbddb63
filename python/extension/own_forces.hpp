#pragma once

#include <cstdint>
#include <optional>
#include <variant>
#include <vector>

#include "python/extension/arrays.hpp"
#include "qddot/model/system.hpp"

namespace qddot::python {

// f and V as C functions of n unknowns: void force(const double* q, double* f, int64_t n) and
// double potential(const double* q, int64_t n). They are called without the GIL.
using CForce = void (*)(const double*, double*, std::int64_t);
using CPotential = double (*)(const double*, std::int64_t);

// What a callable of Python sees of the solver's memory: arrays of a fixed shape, each made once
// for a place and shown again while nobody else has it. To be called with the GIL.
class Views {
 public:
  explicit Views(std::vector<py::ssize_t> shape) : shape_(std::move(shape)) {}

  // An array whose numbers are those at `place`, for one call.
  py::object show(const double* place, bool may_write);
  // Ends that call. Throws std::runtime_error where somebody has kept the array, whose memory is
  // the solver's.
  void take_back(py::object view, const char* callable, const char* argument);
  // Gives the array, which a traceback may hold, memory of its own.
  static void part(const py::object& view);

 private:
  std::vector<py::ssize_t> shape_;
  std::vector<py::object> spare_;
};

// The forces of somebody who writes Python: f, and V and K where he has them, as callables or, of f
// and V, as C functions. What a callable raises ends the run (see outside()). Callables:
//   force(q, f)    writes f [N], returns nothing or f
//   potential(q)   returns V [J]
//   stiffness(q)   returns K [N/m], n x n and symmetric: dense, or a tuple (data, indices, indptr)
//                  of its sorted columns
// q and f are arrays of `shape` over the solver's memory, q read-only.
class OwnForces final : public System {
 public:
  using Force = std::variant<CForce, py::object>;
  using Potential = std::variant<std::monostate, CPotential, py::object>;

  // `pattern`: of K; 0 x 0 where there is no stiffness.
  OwnForces(Vec mass, std::vector<py::ssize_t> shape, Force force, Potential potential,
            py::object stiffness, SymmetricMatrix pattern);
  ~OwnForces() override;

  bool has_potential() const override { return potential_.index() > 0; }
  double potential(const ConstVec& q) const override;
  void force(const ConstVec& q, MutableVec f) const override;
  const SymmetricMatrix& stiffness_pattern() const override { return pattern_; }
  void stiffness(const ConstVec& q, SymmetricMatrix& k) const override;

 private:
  // Calls with a view of q; `use` sees what is returned.
  template <class Use>
  void call(const py::object& callable, const char* name, const ConstVec& q, const Use& use) const;

  Force force_;
  Potential potential_;
  py::object stiffness_;
  SymmetricMatrix pattern_;
  mutable Views views_;
};

// The lower triangle that has these entries and all of the diagonal, with values zero. Throws
// std::invalid_argument for one beyond n.
SymmetricMatrix pattern_of(const Indices& rows, const Indices& columns, Index n);

}  // namespace qddot::python
